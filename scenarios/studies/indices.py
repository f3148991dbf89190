"""Which factors matter: Morris' screening and Sobol's indices of any function on the unit cube (SALib).

Morris (1991) as Campolongo et al. (2007) have it: mu*, the mean size of a factor's elementary effects, and
sigma, their spread. Sobol's first-order and total indices: the estimators of Saltelli et al. (2010) on a
scrambled Sobol sequence. Intervals are SALib's, by bootstrap, at 95 %.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from footfall.scenarios.studies.extra import needed

RESAMPLES = 500
LEVELS = 4  # of Morris' grid


@dataclass(frozen=True)
class Screened:
    """Morris' figures of one factor: mu*, half the width of its interval, and sigma."""

    mu_star: float
    half: float
    sigma: float


@dataclass(frozen=True)
class Index:
    """A sensitivity index and half the width of its 95 % interval."""

    value: float
    half: float

    @property
    def low(self) -> float:
        return self.value - self.half

    @property
    def high(self) -> float:
        return self.value + self.half

    @property
    def shown(self) -> float:
        """The same; what is negative inside of its interval is 0, as no index can be less."""
        return 0.0 if self.low <= 0 and self.value < 0 <= self.high else self.value


@dataclass(frozen=True)
class Sobol:
    """Indices of each factor after a number of samples: first order, and total."""

    samples: int
    first: tuple[Index, ...]
    total: tuple[Index, ...]

    @property
    def widest(self) -> float:
        """Half the width of the widest interval."""
        return max(index.half for index in (*self.first, *self.total))

    @property
    def interplay(self) -> float:
        """Sum of the total indices less 1: what is counted more than once, as factors do it together."""
        return sum(index.value for index in self.total) - 1.0


def morris_design(factors: int, trajectories: int, seed: int) -> np.ndarray:
    """Points (trajectories x (factors + 1), factors) of the unit cube, one factor changed at a time."""
    sample = needed("SALib.sample.morris").sample
    return np.asarray(sample(_problem(factors), trajectories, num_levels=LEVELS, seed=seed))


def morris(points: np.ndarray, values: np.ndarray, seed: int) -> tuple[Screened, ...]:
    """Figures of each factor from the values (p,) at the points of `morris_design`."""
    analyze = needed("SALib.analyze.morris").analyze
    found = analyze(
        _problem(points.shape[1]), points, values, num_levels=LEVELS, num_resamples=RESAMPLES, seed=seed
    )
    columns = (np.asarray(found[name], dtype=float) for name in ("mu_star", "mu_star_conf", "sigma"))
    return tuple(Screened(*map(float, row)) for row in zip(*columns, strict=True))


def sobol_design(factors: int, samples: int, seed: int) -> np.ndarray:
    """Points (samples x (factors + 2), factors) of the unit cube; those of half the samples come first."""
    sample = needed("SALib.sample.sobol").sample
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of scipy, about the keyword by which SALib tells the seed
        return np.asarray(sample(_problem(factors), samples, calc_second_order=False, seed=seed))


def sobol(factors: int, values: np.ndarray, seed: int) -> Sobol:
    """Indices from the values (p,) at the points of `sobol_design`; constant values depend on nothing."""
    samples = len(values) // (factors + 2)
    if np.ptp(values) == 0:
        none = (Index(0.0, 0.0),) * factors
        return Sobol(samples, none, none)
    analyze = needed("SALib.analyze.sobol").analyze
    found = analyze(
        _problem(factors),
        np.asarray(values, dtype=float),
        calc_second_order=False,
        num_resamples=RESAMPLES,
        seed=seed + 1,  # SALib takes 0 for none
    )

    def indices(name: str) -> tuple[Index, ...]:
        return tuple(map(Index, map(float, found[name]), map(float, found[f"{name}_conf"])))

    return Sobol(samples, indices("S1"), indices("ST"))


def sobol_until(
    function: Callable[[np.ndarray], np.ndarray],
    factors: int,
    *,
    samples: int,
    at_most: int,
    widest: float,
    seed: int,
) -> Iterator[tuple[Sobol, ...]]:
    """Indices of several functions with twice as many samples each time, until every interval is narrow.

    Parameters
    ----------
    function : values (p, functions) at points (p, factors); called with new points alone
    samples : to begin with, a power of 2
    at_most : no more samples than that
    widest : half of an interval's width that is narrow enough

    Yields
    ------
    Of each function: first with an eighth, a quarter and a half of `samples`, which tell how they converge.
    """

    def found(samples: int) -> tuple[Sobol, ...]:
        return tuple(sobol(factors, column, seed) for column in values[: samples * (factors + 2)].T)

    values = function(sobol_design(factors, samples, seed))
    for early in (samples // 8, samples // 4, samples // 2):
        if early >= 16:
            yield found(early)
    while True:
        now = found(samples)
        yield now
        samples *= 2
        if max(one.widest for one in now) <= widest or samples > at_most:
            return
        values = np.concatenate([values, function(sobol_design(factors, samples, seed)[len(values) :])])


def not_told_apart(indices: Sequence[Index]) -> list[tuple[int, ...]]:
    """The largest groups of factors whose intervals all meet each other, the greatest index first."""
    order = sorted(range(len(indices)), key=lambda i: -indices[i].value)
    groups: list[set[int]] = []
    # Intervals that all meet have a common point, and the lower end of one of them is such a point.
    for one in order:
        at = indices[one].low
        group = {i for i in order if indices[i].low <= at <= indices[i].high}
        if len(group) > 1 and not any(group <= other for other in groups):
            groups = [other for other in groups if not other < group] + [group]
    return [tuple(i for i in order if i in group) for group in groups]


def _problem(factors: int) -> dict[str, Any]:
    return {
        "num_vars": factors,
        "names": [f"x{i}" for i in range(factors)],
        "bounds": [[0.0, 1.0]] * factors,
    }
