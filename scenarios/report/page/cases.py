"""Rows of scores as a page draws them: cases behind what many of them come to."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from footfall.scenarios.report.page.charts import Hover
from footfall.scenarios.studies.rows import read_rows


@dataclass(frozen=True)
class Cases:
    """Rows of scores by column: `numbers` are NaN and `texts` empty where there is none."""

    table: Any
    _read: dict[str, np.ndarray] = field(default_factory=dict, repr=False, compare=False)

    @classmethod
    def read(cls, file: Path) -> Cases:
        """Those in a file.

        Raises
        ------
        InputError
            No such file, or not one of rows.
        """
        return cls(read_rows(file))

    def __len__(self) -> int:
        return int(self.table.num_rows)

    @property
    def columns(self) -> list[str]:
        return list(self.table.column_names)

    def numbers(self, name: str) -> np.ndarray:
        """(n,) of a column, as floats."""
        values = self.texts(name)
        return np.array([np.nan if value == "" else float(value) for value in values])

    def texts(self, name: str) -> np.ndarray:
        """(n,) of a column, as they are; of numbers, too."""
        if name not in self._read:
            values = self.table[name].to_pylist()
            self._read[name] = np.array(["" if value is None else value for value in values], object)
        return self._read[name]

    def scores(self, name: str) -> np.ndarray:
        """(n,) magnitudes of a score; NaN where a case failed."""
        return np.abs(self.numbers(name))

    @property
    def lost(self) -> int:
        """How many failed."""
        return int((self.texts("stage") != "").sum())

    def where(self, chosen: np.ndarray) -> Cases:
        """The rows that are chosen, by a mask or by their numbers."""
        return Cases(self.table.take(np.flatnonzero(chosen) if chosen.dtype == bool else chosen))

    def hover(self) -> tuple[Hover, ...]:
        """Which case it is."""
        return (
            Hover("walk seed", self.numbers("walk_seed"), 0),
            Hover("unit", self.numbers("unit_seed"), 0),
        )

    def failures(self) -> list[tuple[int, str, str, str]]:
        """How many rows failed, of which method, at which stage and why; the most frequent first."""
        lost = self.texts("stage") != ""
        told = zip(*(self.texts(name)[lost] for name in ("method", "stage", "error")), strict=True)
        counts: dict[tuple[str, str, str], int] = {}
        for one in told:
            counts[one] = counts.get(one, 0) + 1
        return sorted(((count, *one) for one, count in counts.items()), key=lambda row: (-row[0], row))

    def groups(self, names: Sequence[str]) -> Iterator[tuple[tuple[Any, ...], np.ndarray]]:
        """Each combination of columns that is there, in the rows' order, and the numbers of its rows."""
        found: dict[tuple[Any, ...], list[int]] = {}
        for i, key in enumerate(zip(*(self.texts(name) for name in names), strict=True)):
            found.setdefault(key, []).append(i)
        for key, rows in found.items():
            yield key, np.array(rows)


def middle(values: np.ndarray) -> dict[str, float]:
    """Median and 90th percentile of what is there; NaN where nothing is."""
    values = values[np.isfinite(values)]
    if not len(values):
        return {"median": np.nan, "p90": np.nan}
    return {"median": float(np.median(values)), "p90": float(np.percentile(values, 90))}


def flat(values: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    """Nested settings by dotted name."""
    for key, value in values.items():
        if isinstance(value, Mapping):
            yield from flat(value, f"{before}{key}.")
        else:
            yield f"{before}{key}", value
