"""A method of anybody's on a scenario, scored in one line."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from pickle import PicklingError, dumps
from typing import Any, overload

import numpy as np

from footfall.hdr.method import Method
from footfall.pdr.track import Track
from footfall.scenarios.execute import Progress, execute
from footfall.scenarios.parameters import documents, with_values
from footfall.scenarios.report.progress import showing
from footfall.scenarios.run import OTHER_UNITS_FROM
from footfall.scenarios.trial import Row, Setup, Trial

AnyMethod = str | Method | Callable[..., Track]

NOISE_STEP = 100_000  # between the seeds of one unit's noises: more than there are units


@dataclass(frozen=True)
class Rows(Sequence[Row]):
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

    def to_pandas(self) -> Any:
        """A pandas DataFrame, one row each; needs pandas."""
        import pandas

        return pandas.DataFrame([row.as_dict() for row in self.rows])

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
    units : individual IMUs, dealt to the walks
    walks, seed, imu : the scenario's own when None
    values : address -> value (`footfall parameters`), as `--set` takes them
    workers : processes, one a core when None; what cannot travel to another (`travelling`) is called in this
        one
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
