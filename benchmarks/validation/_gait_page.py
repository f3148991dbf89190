"""The tables of gait_realism.py."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from benchmarks._page import Sheet
from benchmarks.validation._gait_rows import FEET, UNJUDGED, WALKS, Row, inside, judged, spread, verdict

Figures = Mapping[str, Mapping[str, float]]  # of each foot or walk, by name
JUDGED_PACE = (1.2, 1.4)  # m/s asked for, at which people's ground forces and supports are stated


def shown(row: Row, value: float) -> str:
    """A figure at the decimals it is worth."""
    return f"{value:.{row.decimals}f}" if np.isfinite(value) else "-"


def bounds(row: Row, real: Figures) -> tuple[float, float]:
    """The spread of the real feet."""
    return spread(row, [figures[row.key] for figures in real.values()])


def feet_lines(real: Figures, simulated: Figures) -> Iterator[tuple[str, list[tuple[Row, list[str], str]]]]:
    """Every group of rows: spread, simulated figures (outside ones marked with \\*) and verdict."""
    for group, rows in FEET.items():
        lines = []
        for row in rows:
            low, high = bounds(row, real)
            values = [figures[row.key] for figures in simulated.values()]
            cells = [f"{shown(row, low)} .. {shown(row, high)}"]
            judge = group != UNJUDGED
            for value in values:
                wrong = judge and np.isfinite(value) and not inside(row, value, low, high)
                cells.append(shown(row, value) + (r"\*" if wrong else ""))
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
            cells.append(shown(row, value) + (r"\*" if wrong else ""))
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


def sheets(real: Figures, simulated: Figures, walks: Figures) -> list[Sheet]:
    """Simulated feet beside real ones, walks beside people, and every real recording."""
    feet = Sheet("feet", "Feet: simulated beside real", ["", "real", *simulated, "verdict"])
    for group, lines in feet_lines(real, simulated):
        feet.rows.append(_across(group, feet))
        feet.rows += [[row.label, *cells, mark] for row, cells, mark in lines]
    heads = ["", "people", *walks, "verdict", "people after"]
    beside = Sheet("walks", "Walks: simulated beside people", heads)
    beside.rows = [[row.label, *cells, mark, row.source] for row, cells, mark in walk_lines(walks)]
    each = Sheet("recordings", "Each real recording", ["", *real])
    for group, rows in FEET.items():
        each.rows.append(_across(group, each))
        for row in rows:
            each.rows.append([row.label, *(shown(row, figures[row.key]) for figures in real.values())])
    return [feet, beside, each]


def _across(group: str, sheet: Sheet) -> list[str]:
    """The row above a group."""
    return [f"**{group}**", *[""] * (len(sheet.headings) - 1)]
