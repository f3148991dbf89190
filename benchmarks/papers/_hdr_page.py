"""What hdr_table2.py found, summed up: on a terminal, as Markdown for a page, for programs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from rich.table import Table

from benchmarks._page import Sheet
from footfall.scenarios.judge.papers import HDR_TABLE_2_MEAN
from footfall.scenarios.judge.statistics import extent, spread

ERRORS = {"average": 1, "final": 0}  # columns of the errors, in the order in which the paper gives them
STATISTICS = ("mean", "median", "p90")
_HEADINGS = ["judged on", "", "mean", "median", "90th percentile"]


@dataclass(frozen=True)
class Summary:
    """One method on a group of recordings (deg).

    Attributes
    ----------
    over_all : error -> statistic over all recordings
    by_noise : error -> statistic -> its extent from noise to noise; the same where there was only one
    unit : error -> how far apart one unit's smallest and largest lie, median over the units
    """

    over_all: Mapping[str, Mapping[str, float]]
    by_noise: Mapping[str, Mapping[str, Mapping[str, float]]]
    unit: Mapping[str, float]

    def pair(self, statistic: str) -> str:
        """Average / final."""
        return " / ".join(f"{self.over_all[error][statistic]:.1f}" for error in ERRORS)

    def extents(self, statistic: str) -> str:
        """The same from noise to noise."""
        found = [self.by_noise[error][statistic] for error in ERRORS]
        return " / ".join(f"{one['smallest']:.1f}-{one['largest']:.1f}" for one in found)


def summary(errors: np.ndarray, chosen: np.ndarray) -> Summary:
    """Sum up the errors (r, c, 2) of c units through r noises, where `chosen` (r, c)."""
    over_all, by_noise, unit = {}, {}, {}
    for error, column in ERRORS.items():
        values = errors[..., column]
        over_all[error] = spread(values[chosen].tolist())
        rounds = [spread(row[mask].tolist()) for row, mask in zip(values, chosen, strict=True) if mask.any()]
        by_noise[error] = {name: extent([one[name] for one in rounds]) for name in STATISTICS}
        worn = [row[mask] for row, mask in zip(values.T, chosen.T, strict=True) if mask.any()]
        unit[error] = float(np.median([np.ptp(row) for row in worn]))
    return Summary(over_all, by_noise, unit)


@dataclass(frozen=True)
class Group:
    """Some of the units; of those that are told by their errors, some of their recordings."""

    units: int
    recordings: int
    methods: Mapping[str, Summary]


def _paper_rows() -> list[list[str]]:
    paper = {"uncorrected": HDR_TABLE_2_MEAN.uncorrected, "HDR": HDR_TABLE_2_MEAN.hdr}
    cells = [[method, f"{row.average:g} / {row.final:g}", "", ""] for method, row in paper.items()]
    return [["the paper's five walks", *cells[0]], ["", *cells[1]]]


@dataclass(frozen=True)
class Judged:
    """All groups of one scenario."""

    title: str
    groups: Mapping[str, Group]

    def _rows(self) -> Iterator[tuple[str, str, Summary]]:
        """Label of a group in its first row, method, its figures."""
        for name, group in self.groups.items():
            label = f"{group.recordings} recordings of {group.units} units, {name}"
            for method, found in group.methods.items():
                yield label, method, found
                label = ""

    def table(self) -> Table:
        """For a terminal: over all recordings, and below from noise to noise."""
        title = f"Heading error, average / final (deg), {self.title}; below: from noise to noise"
        table = Table(title=title, title_justify="left")
        for heading in ("", "", *STATISTICS):
            table.add_column(heading, justify="right" if heading else "left")
        for label, method, found in self._rows():
            if label:
                table.add_section()
            table.add_row(
                label, method, *(f"{found.pair(name)}\n{found.extents(name)}" for name in STATISTICS)
            )
        table.add_section()
        for row in _paper_rows():
            table.add_row(*row)
        return table

    def sheet(self) -> Sheet:
        """Over all recordings, for a page."""
        sheet = Sheet("hdr", self.title, _HEADINGS, left=2)
        for label, method, found in self._rows():
            sheet.rows.append([label, method, *(found.pair(name) for name in STATISTICS)])
        sheet.rows += _paper_rows()
        return sheet

    def noise_sheet(self) -> Sheet:
        """From noise to noise, for a page."""
        heads = ["", "", "mean", "median", "one unit's smallest to largest, median"]
        sheet = Sheet("hdr noise", self.title, heads, left=2)
        for label, method, found in self._rows():
            apart = " / ".join(f"{found.unit[error]:.1f}" for error in ERRORS)
            sheet.rows.append([label, method, found.extents("mean"), found.extents("median"), apart])
        return sheet

    def as_dict(self) -> dict[str, Any]:
        """Plain numbers."""
        return {name: asdict(group) for name, group in self.groups.items()}


def mounts_sheet(judged: Mapping[str, Judged]) -> Sheet:
    """All units drawn, from one place of the IMU to the next, for a page."""
    sheet = Sheet("hdr mounts", "From one mount to the next", _HEADINGS, left=2)
    for title, found in judged.items():
        group = found.groups["all units drawn"]
        for method in list(group.methods)[:2]:  # uncorrected, and HDR as it comes
            cells = [group.methods[method].pair(name) for name in STATISTICS]
            sheet.rows.append([title if method == "uncorrected" else "", method, *cells])
    return sheet
