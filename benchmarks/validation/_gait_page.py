"""The tables of gait_realism.py: on a terminal and on the page docs/gait.md."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
from rich.table import Table

from benchmarks.validation._gait_rows import FEET, UNJUDGED, WALKS, Row, inside, judged, spread, verdict
from footfall.errors import InputError

BEGIN, END = "<!-- tables: begin -->", "<!-- tables: end -->"
Figures = Mapping[str, Mapping[str, float]]  # of each foot or walk, by name
JUDGED_PACE = (1.2, 1.4)  # m/s asked for, at which people's ground forces and supports are stated


def shown(row: Row, value: float) -> str:
    """A figure at the decimals it is worth."""
    return f"{value:.{row.decimals}f}" if np.isfinite(value) else "-"


def bounds(row: Row, real: Figures) -> tuple[float, float]:
    """The spread of the real feet."""
    return spread(row, [figures[row.key] for figures in real.values()])


def feet_lines(real: Figures, simulated: Figures) -> Iterator[tuple[str, list[tuple[Row, list[str], str]]]]:
    """Every group of rows: spread, simulated figures (outside ones marked with *) and verdict."""
    for group, rows in FEET.items():
        lines = []
        for row in rows:
            low, high = bounds(row, real)
            values = [figures[row.key] for figures in simulated.values()]
            cells = [f"{shown(row, low)} .. {shown(row, high)}"]
            judge = group != UNJUDGED
            for value in values:
                wrong = judge and np.isfinite(value) and not inside(row, value, low, high)
                cells.append(shown(row, value) + ("*" if wrong else ""))
            lines.append((row, cells, verdict(row, values, low, high) if judge else ""))
        yield group, lines


def walk_lines(walks: Figures) -> Iterator[tuple[Row, list[str], str]]:
    """Rows of the walks: people's range, figures, verdict over the walks that the row judges."""
    for row in WALKS:
        values = [figures[row.key] for figures in walks.values()]
        cells, mark = [""], ""
        if row.people is not None:
            low, high = row.people
            cells = [f"{shown(row, low)} .. {shown(row, high)}"]
            mark = verdict(row, [values[i] for i in judged_walks(row, walks)], low, high)
        for index, value in enumerate(values):
            wrong = (
                row.people is not None
                and index in judged_walks(row, walks)
                and not inside(row, value, *row.people)
            )
            cells.append(shown(row, value) + ("*" if wrong else ""))
        yield row, cells, mark


def judged_walks(row: Row, walks: Figures) -> list[int]:
    """Which walks a row judges."""
    near = [JUDGED_PACE[0] <= figures["asked_m_s"] <= JUDGED_PACE[1] for figures in walks.values()]
    return [index for index, close in enumerate(near) if close or row.any_pace]


def tally(real: Figures, simulated: Figures) -> dict[str, str]:
    """Key of each judged row of feet -> verdict."""
    return {
        row.key: verdict(row, [figures[row.key] for figures in simulated.values()], *bounds(row, real))
        for row in judged()
    }


def terminal(real: Figures, simulated: Figures, walks: Figures) -> Iterator[Table]:
    """The three tables."""
    for title, heads, groups in _tables(real, simulated, walks):
        table = Table(title=title, title_justify="left")
        for number, head in enumerate(heads):
            table.add_column(head, justify="right" if number else "left", no_wrap=True)
        for group, lines in groups:
            if group:
                table.add_row(f"[bold]{group}[/bold]")
            for line in lines:
                table.add_row(*(f"[red]{cell}[/red]" if cell.endswith("*") else cell for cell in line))
        yield table


def markdown(real: Figures, simulated: Figures, walks: Figures) -> str:
    """The three tables as a page has them."""
    parts = []
    for title, heads, groups in _tables(real, simulated, walks):
        lines = [f"### {title}", "", "| " + " | ".join(heads) + " |", "|---" * len(heads) + "|"]
        for group, rows in groups:
            if group:
                lines.append(f"| **{group}** |" + " |" * (len(heads) - 1))
            lines += ["| " + " | ".join(cell.replace("*", "\\*") for cell in row) + " |" for row in rows]
        parts.append("\n".join(lines))
    return "\n\n".join(parts)


Groups = Sequence[tuple[str, Sequence[Sequence[str]]]]


def _tables(real: Figures, simulated: Figures, walks: Figures) -> Iterator[tuple[str, list[str], Groups]]:
    groups = [
        (group, [[row.label, *cells, mark] for row, cells, mark in lines])
        for group, lines in feet_lines(real, simulated)
    ]
    yield "Feet: simulated beside real", ["", "real", *simulated, "verdict"], groups
    lines = [[row.label, *cells, mark, row.source] for row, cells, mark in walk_lines(walks)]
    yield "Walks: simulated beside people", ["", "people", *walks, "verdict", "people after"], [("", lines)]
    each = [
        (group, [[row.label, *(shown(row, figures[row.key]) for figures in real.values())] for row in rows])
        for group, rows in FEET.items()
    ]
    yield "Each real recording", ["", *real], each


def insert(page: Path, tables: str) -> None:
    """Replace what stands between the page's marks.

    Raises
    ------
    InputError
        The page has no such marks.
    """
    text = page.read_text(encoding="utf-8")
    if BEGIN not in text or END not in text:
        raise InputError(f"{page}: expected the marks {BEGIN} and {END}")
    before, rest = text.split(BEGIN, 1)
    after = rest.split(END, 1)[1]
    page.write_text(f"{before}{BEGIN}\n\n{tables}\n\n{END}{after}", encoding="utf-8")
