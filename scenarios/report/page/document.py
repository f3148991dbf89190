"""One HTML file of a page's sections and charts, with style, script and plotly's own script in it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.resources import files
from string import Template

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
