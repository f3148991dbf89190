"""One HTML file of a page's sections and charts, with style, script and plotly's own script in it."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from string import Template
from typing import Any

from footfall.scenarios.report.page import html
from footfall.scenarios.report.page.charts import Chart, chart_data
from footfall.scenarios.report.page.html import text


@dataclass(frozen=True)
class Section:
    """A part of a page under its heading; `body` is HTML."""

    name: str
    heading: str
    body: str


@dataclass(frozen=True)
class Page:
    """What a page says. `kind` and `lead` are plain text, above and below the title."""

    kind: str
    title: str
    lead: str
    sections: Sequence[Section]
    charts: Sequence[Chart]


def sentence(described: str | None) -> str:
    """A description as a first sentence; nothing where there is none."""
    return f"{described[0].upper()}{described[1:].rstrip('.')}. " if described else ""


def versions(told: Mapping[str, Any]) -> str:
    """What made the results, as their document says it: versions, and digests of the sources."""
    return html.pairs("Versions", told["versions"]) + html.pairs("Digests", told.get("digests") or {})


def again(told: Mapping[str, Any], file: str) -> str:
    """The command that makes the results again, as the document in `file` says it."""
    if not told.get("command"):
        return html.paragraph(f"{file} does not tell the command: an earlier version wrote it.")
    return html.command(told["command"]) + html.paragraph(
        "With the versions above the same scores come out, bit for bit."
    )


def render(page: Page) -> str:
    """The page as HTML, with all that it needs inside."""
    # Late: nothing but a report needs it.
    from plotly.offline import get_plotlyjs

    shown = [section for section in page.sections if section.body]
    links = "".join(f'<li><a href="#{part.name}">{text(part.heading)}</a></li>' for part in shown)
    body = "".join(
        f'<section id="{part.name}"><h2>{text(part.heading)}</h2>\n{part.body}</section>\n' for part in shown
    )
    return Template(_ours("page.html")).substitute(
        kind=text(page.kind),
        title=text(page.title),
        lead=text(page.lead),
        links=links,
        body=body,
        style=_ours("page.css"),
        plotly=get_plotlyjs(),
        # "</script>" in a text must not end the element that it stands in.
        data=json.dumps(chart_data(page.charts), separators=(",", ":")).replace("<", "\\u003c"),
        tables=_ours("tables.js"),
        script=_ours("page.js"),
    )


def _ours(name: str) -> str:
    return files(__package__).joinpath(name).read_text(encoding="utf-8")
