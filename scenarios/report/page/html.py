"""Pieces of HTML. Every text passes `text` on its way between the tags, whatever file it comes from."""

from __future__ import annotations

import html
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Number:
    """A cell that is sorted by its value and read as it is shown."""

    value: float | None
    shown: str


Cell = str | Number
_LONG = 32  # letters of a text that may be broken into lines


def number(value: float | None, digits: int = 1, sign: bool = False) -> Number:
    """A number with so many digits after the point; a dash where there is none."""
    if value is None or math.isnan(value):
        return Number(None, "–")
    if math.isinf(value):
        return Number(value, "∞" if value > 0 else "-∞")
    return Number(value, f"{value:{'+' if sign else ''},.{digits}f}")


def integer(value: int) -> Number:
    """A count or a seed: without separators, so that it can be copied."""
    return Number(value, str(value))


def text(value: object) -> str:
    """Text as HTML that says it and does nothing."""
    return html.escape(str(value), quote=True)


def told(value: Any) -> str:
    """A setting as a reader would write it."""
    if isinstance(value, str):
        return value
    if value is None:
        return "–"
    if isinstance(value, bool):
        return json.dumps(value)
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, Mapping):
        return ", ".join(f"{key} {told(item)}" for key, item in value.items()) or "none"
    if isinstance(value, (list, tuple)):
        return ", ".join(told(item) for item in value) or "none"
    return str(value)


def table(
    caption: str, columns: Sequence[str], rows: Sequence[Sequence[Cell]], foot: Sequence[Sequence[Cell]] = ()
) -> str:
    """A table that can be sorted by any column where there is a script, and read where there is none.

    Parameters
    ----------
    columns : their heads; those of numbers, by the first row, stand to the right
    foot : rows that stay below, means of the others say
    """
    first = next(iter((*rows, *foot)), ())
    right = [isinstance(cell, Number) for cell in first] or [False] * len(columns)
    heads = "".join(
        f'<th scope="col"{_side(side)}>{text(column)}</th>'
        for column, side in zip(columns, right, strict=True)
    )
    below = f"<tfoot>{''.join(_row(row, right) for row in foot)}</tfoot>" if foot else ""
    return (
        f'{_scroll(caption)}<table class="sortable">'
        f"<caption>{text(caption)}</caption><thead><tr>{heads}</tr></thead>"
        f"<tbody>{''.join(_row(row, right) for row in rows)}</tbody>{below}</table></div>\n"
    )


def pairs(caption: str, values: Mapping[str, Any]) -> str:
    """Names and what they are, one a row; nothing where there are none."""
    rows = "".join(
        f'<tr><th scope="row">{text(name)}</th><td>{text(told(value))}</td></tr>'
        for name, value in values.items()
    )
    if not rows:
        return ""
    return (
        f'{_scroll(caption)}<table class="pairs">'
        f"<caption>{text(caption)}</caption><tbody>{rows}</tbody></table></div>\n"
    )


def command(line: str) -> str:
    """A command line to copy."""
    return f'<pre tabindex="0"><code>{text(line)}</code></pre>\n'


def paragraph(line: str) -> str:
    """A paragraph."""
    return f"<p>{text(line)}</p>\n"


def tiles(entries: Sequence[tuple[str, str, str, str]]) -> str:
    """What is to be seen at a glance: name, colour, figure and what else there is to say, of each."""
    made = "".join(
        f'<li><span class="name"><i class="{colour}"></i>{text(name)}</span>'
        f"<strong>{text(value)}</strong><span>{text(more)}</span></li>"
        for name, colour, value, more in entries
    )
    return f'<ul class="tiles">{made}</ul>\n'


def figure(place: str, heading: str, caption: str = "", *, kind: str = "", legend: str = "") -> str:
    """Room for a chart, which a script draws into it."""
    return (
        f'<figure class="{kind}"><h3 id="{place}-heading">{text(heading)}</h3>{legend}'
        f'<div class="chart" id="{place}" role="group" tabindex="0" aria-labelledby="{place}-heading" '
        f'aria-describedby="{place}-caption"></div>'
        f'<p class="readout" id="{place}-readout" aria-live="polite"></p>'
        f'<figcaption id="{place}-caption">{text(caption)}</figcaption></figure>\n'
    )


def legend(entries: Mapping[str, str]) -> str:
    """Name -> colour of the lines in one chart."""
    items = "".join(f'<li><i class="{colour}"></i>{text(name)}</li>' for name, colour in entries.items())
    return f'<ul class="legend">{items}</ul>'


def radios(name: str, title: str, options: Mapping[str, str]) -> str:
    """Choose one of value -> label; the first is chosen."""
    return _choice(name, title, options, "radio", {})


def boxes(name: str, title: str, options: Mapping[str, str], colours: Mapping[str, str]) -> str:
    """Choose any of value -> label, with a colour each; all are chosen."""
    return _choice(name, title, options, "checkbox", colours)


def controls(*choices: str, kept: bool = True) -> str:
    """Choices in a bar, which is `kept` in sight on a wide screen; without a script it is not shown."""
    return f'<form class="controls{" kept" if kept else ""}">{"".join(choices)}</form>\n'


def _choice(name: str, title: str, options: Mapping[str, str], kind: str, colours: Mapping[str, str]) -> str:
    made = []
    for i, (value, label) in enumerate(options.items()):
        checked = " checked" if kind == "checkbox" or i == 0 else ""
        swatch = f'<i class="{colours[value]}"></i>' if value in colours else ""
        made.append(
            f'<label><input type="{kind}" name="{text(name)}" value="{text(value)}"{checked} '
            f'autocomplete="off">{swatch}<span>{text(label)}</span></label>'
        )
    return f"<fieldset><legend>{text(title)}</legend>{''.join(made)}</fieldset>"


def _scroll(caption: str) -> str:
    return f'<div class="scroll" role="region" tabindex="0" aria-label="{text(caption)}">'


def _side(right: bool) -> str:
    return ' class="n"' if right else ""


def _row(cells: Sequence[Cell], right: Sequence[bool]) -> str:
    made = []
    for i, (cell, side) in enumerate(zip(cells, right, strict=True)):
        tag, scope = ("td", "") if i else ("th", ' scope="row"')
        if isinstance(cell, Number):
            value = "" if cell.value is None else f' data-v="{cell.value!r}"'
            made.append(f"<{tag}{scope}{_side(side)}{value}>{text(cell.shown)}</{tag}>")
        else:
            long = ' class="long"' if len(cell) > _LONG else _side(side)
            made.append(f"<{tag}{scope}{long}>{text(cell)}</{tag}>")
    return f"<tr>{''.join(made)}</tr>"
