"""Any method on a scenario, scored in one line."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from pickle import PicklingError, dumps
from typing import Any, overload

import numpy as np

from footfall.hdr.method import Method
from footfall.pdr.track import Track
from footfall.scenarios.execute import Progress, execute
from footfall.scenarios.judge.score import unit_of
from footfall.scenarios.parameters import documents, with_values
from footfall.scenarios.report.progress import showing
from footfall.scenarios.report.style import colours_of, label_of
from footfall.scenarios.run import OTHER_UNITS_FROM
from footfall.scenarios.studies.rows import SCORES
from footfall.scenarios.trial import Row, Setup, Trial
from footfall.shown import Shown, table_html

AnyMethod = str | Method | Callable[..., Track]

_HEADINGS = {
    "heading_error_mean_deg": "mean heading error",
    "heading_error_final_deg": "final heading error",
}

NOISE_STEP = 100_000  # between the seeds of one unit's noises: more than there are units


@dataclass(frozen=True)
class Rows(Shown, Sequence[Row]):
    """Rows of scores, one a trial and method."""

    rows: tuple[Row, ...]

    @overload
    def __getitem__(self, index: int) -> Row: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Row, ...]: ...
    def __getitem__(self, index: int | slice) -> Row | tuple[Row, ...]:
        return self.rows[index]

    def __len__(self) -> int:
        return len(self.rows)

    def __iter__(self) -> Iterator[Row]:
        return iter(self.rows)

    def of(self, method: str) -> Rows:
        """Those of one method."""
        return Rows(tuple(row for row in self.rows if row.method == method))

    @property
    def failures(self) -> Rows:
        """Those without a score."""
        return Rows(tuple(row for row in self.rows if row.score is None))

    def values(self, score: str) -> np.ndarray:
        """(n,) of one score, by its name in `Score`; NaN where there is none."""
        return np.array([np.nan if row.score is None else getattr(row.score, score) for row in self.rows])

    def _columns(self) -> dict[str, list[Any]]:
        told = [row.as_dict() for row in self.rows]
        return {name: [row[name] for row in told] for name in (told[0] if told else ())}

    def _units(self) -> Mapping[str, str]:
        return {name: unit_of(name) for name in SCORES}

    def _repr_html_(self) -> str:
        columns = {name: list(values) for name, values in self._summary().items()}
        return table_html(f"Rows ({len(self.rows):,}) by method, in deg", columns, {})

    def _summary(self) -> dict[str, list[Any]]:
        """By method: trials, failures, median and 90th percentile of the heading errors."""
        told: list[dict[str, Any]] = []
        for method in dict.fromkeys(row.method for row in self.rows):
            mine = self.of(method)
            told.append({"method": method, "trials": len(mine), "failed": len(mine.failures)})
            for name, words in _HEADINGS.items():
                values = mine.values(name)
                values = values[~np.isnan(values)]
                told[-1][f"{words}, median"] = float(np.median(values)) if len(values) else math.nan
                told[-1][f"{words}, p90"] = float(np.percentile(values, 90)) if len(values) else math.nan
        return {name: [row[name] for row in told] for name in (told[0] if told else ())}

    def _draw(self) -> np.ndarray:
        from matplotlib import pyplot

        methods = list(dict.fromkeys(row.method for row in self.rows))
        colours, high = colours_of(methods), 0.35 * len(methods) + 1.2
        _, axes = pyplot.subplots(1, 2, figsize=(8, high), sharey=True)
        for axis, (name, words) in zip(axes, _HEADINGS.items(), strict=True):
            for place, method in enumerate(methods):
                values = self.of(method).values(name)
                values = values[~np.isnan(values)]
                spread = place + 0.18 * np.sin(2.4 * np.arange(len(values)))  # points apart, always alike
                axis.plot(values, spread, "o", color=colours[method], ms=3.5, alpha=0.5, mew=0)
                if len(values):
                    axis.plot(np.median(values), place, "|", color="#222222", ms=18, mew=2)
            axis.set_xlabel(f"{words} (deg)")
            axis.set_xlim(left=0)
        axes[0].set_yticks(range(len(methods)), [label_of(method) for method in methods])
        axes[0].invert_yaxis()
        axes[0].set_title("one point a trial; bars: medians")
        return np.asarray(axes)

    def __str__(self) -> str:
        """Median and 90th percentile of the heading errors by method."""
        lines = []
        for method in dict.fromkeys(row.method for row in self.rows):
            mine = self.of(method)
            told = [f"{method}: {len(mine)} trials"]
            for name in ("heading_error_mean_deg", "heading_error_final_deg"):
                values = mine.values(name)
                values = values[~np.isnan(values)]
                if len(values):
                    told.append(f"{name} {np.median(values):.2f} (p90 {np.percentile(values, 90):.2f})")
            if failed := len(mine.failures):
                told.append(f"{failed} failed: {mine.failures[0].error}")
            lines.append(", ".join(told))
        return "\n".join(lines)


def cases(
    setup: Setup,
    *,
    units: int,
    walks: int | None = None,
    seed: int | None = None,
    crossed: bool = False,
    first_unit: int = OTHER_UNITS_FROM,
    noises: int = 1,
) -> list[Trial]:
    """Units dealt to the walks of a scenario, each with the noise of its own seed.

    Parameters
    ----------
    walks, seed : how many, and of the first; the scenario's when None
    crossed : whether every unit is worn on every walk
    first_unit : seed of the first unit, the next has the next
    noises : how many a unit is heard through: of its own seed, and of seeds `NOISE_STEP` apart
    """
    scenario = setup.scenario
    count = scenario.seeds.walks if walks is None else walks
    base = scenario.seeds.base if seed is None else seed
    worn = range(first_unit, first_unit + units)
    pairs = product(range(count), worn) if crossed else ((unit % count, unit) for unit in worn)
    return [
        Trial(setup, number, walk_seed=base + number, unit_seed=unit, noise_seed=unit + NOISE_STEP * noise)
        for number, unit in sorted(pairs)
        for noise in range(noises)
    ]


def travelling(methods: Sequence[Method], workers: int | None = None) -> int | None:
    """`workers`; or 1 where a method (a lambda, a function of a notebook) cannot travel to others."""
    try:
        dumps(methods)
    except (PicklingError, AttributeError, TypeError):
        return 1
    return workers


def evaluate(
    method: AnyMethod | Iterable[AnyMethod],
    scenario: str,
    *,
    units: int = 20,
    walks: int | None = None,
    seed: int | None = None,
    imu: str | None = None,
    values: Mapping[str, Any] | None = None,
    workers: int | None = None,
    on_progress: Callable[[Progress], None] | None = None,
) -> Rows:
    """Score a method, or several on the same recordings, on the walks of a scenario.

    Parameters
    ----------
    method : a function `(recording, start) -> Track`, a name, a `Method`, or several of these
    scenario : stock name or TOML file
    units : number of individual IMUs, spread over the walks
    walks, seed, imu : the scenario's own when None
    values : address -> value (`footfall parameters`), as `--set` takes them
    workers : processes, one a core when None; a method that cannot be pickled (`travelling`) runs in this one
    on_progress : as of `execute`; bars on a terminal when None

    Returns
    -------
    Rows
        By walk and unit; a method's own mistake is a row with its reason.

    Raises
    ------
    InputError
        An unknown scenario, IMU, method or address.
    """
    single = isinstance(method, (str, Method)) or callable(method)
    methods: Iterable[AnyMethod] = [method] if single else method  # type: ignore[list-item, assignment]
    made = with_values(documents(scenario, imu=imu, methods=methods), values or {}).setup()
    trials = cases(made, units=units, walks=walks, seed=seed)
    with showing() as progress:
        found = execute(
            trials, workers=travelling(made.methods, workers), on_progress=on_progress or progress
        )
        return Rows(tuple(row for outcome in found for row in outcome.rows))
