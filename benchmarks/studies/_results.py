"""The rows of a study as columns: chosen, compared pair by pair, and summed up."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from footfall.scenarios.studies.rows import read_rows

AVERAGE, FINAL = "heading_error_mean_deg", "heading_error_final_deg"
SHAPES = ("straight", "turning", "closed-loop", "errands", "curving")  # from straight to hardly a straight


@dataclass(frozen=True)
class Results:
    """Rows of a study. `columns`: name -> (n,), all equally long."""

    columns: Mapping[str, np.ndarray]

    def __getitem__(self, name: str) -> np.ndarray:
        return self.columns[name]

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    def where(self, chosen: Mapping[str, Any] | None = None, **more: Any) -> Results:
        """The rows whose columns hold these values."""
        rows = np.ones(len(self), dtype=bool)
        for name, value in {**(chosen or {}), **more}.items():
            rows &= self[name] == value
        return Results({name: column[rows] for name, column in self.columns.items()})

    def values(self, name: str) -> list[Any]:
        """The different values of a column, in the order in which they appear; none for an absent value."""
        found = dict.fromkeys(self[name].tolist())
        return [value for value in found if value is not None and value == value]

    @property
    def shapes(self) -> list[str]:
        """Its scenarios, from straight to curving."""
        return [shape for shape in SHAPES if shape in self["scenario"]]

    @property
    def failed(self) -> int:
        """How many rows have no score."""
        return int(np.isnan(self[AVERAGE]).sum())

    def score(self, name: str = AVERAGE) -> np.ndarray:
        """(n,) of one score, of the rows that have one."""
        values = self[name]
        return values[~np.isnan(values)]

    def beside(self, others: Results, name: str = AVERAGE) -> np.ndarray:
        """(n, 2) a score of these rows and of those of `others`, of every recording that both have once.

        A sheet that the temperature does not touch makes the same recording in any weather.
        """
        theirs = dict(zip(others["recording_sha"], others[name], strict=True))
        mine = dict(zip(self["recording_sha"], self[name], strict=True))
        pairs = [(value, theirs[sha]) for sha, value in mine.items() if sha in theirs]
        found = np.array(pairs, dtype=float).reshape(-1, 2)
        return found[~np.isnan(found).any(axis=1)]


def read_results(path: Path) -> Results:
    """A study's results.parquet.

    Raises
    ------
    InputError
        As `read_rows`.
    """
    table = read_rows(path)
    return Results({name: table.column(name).to_numpy(zero_copy_only=False) for name in table.column_names})


def quantiles(values: np.ndarray, at: Sequence[float] = (50, 90)) -> np.ndarray:
    """Percentiles, or NaN where there is nothing."""
    return np.percentile(values, at) if len(values) else np.full(len(at), np.nan)


def figure(value: float) -> str:
    """A figure in degrees or per cent: three digits, but no more than one behind the point."""
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:.1f}"


def pair(mine: Results, base: Results, name: str = AVERAGE, at: float = 50) -> str:
    """`base -> mine (worse in so many % of the cases)`, of the same recordings."""
    both = mine.beside(base, name)
    if not len(both):
        return "-"
    after, before = np.percentile(both, at, axis=0)
    worse = 100 * np.mean(both[:, 0] > both[:, 1])
    return f"{figure(before)} / {figure(after)} ({worse:.0f})"


def combinations(results: Results, *names: str) -> Iterator[tuple[tuple[Any, ...], Results]]:
    """Every combination of values of some columns that there is, and its rows."""
    if not names:
        yield (), results
        return
    for value in results.values(names[0]):
        for rest, rows in combinations(results.where({names[0]: value}), *names[1:]):
            yield (value, *rest), rows
