"""A method's error over two of its parameters: compiled for HDR, by the full chain for others."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from footfall.errors import InputError
from footfall.hdr.method import Method
from footfall.scenarios.execute import Progress
from footfall.scenarios.parameters import Documents
from footfall.scenarios.studies.budget import METRICS, Case, hdr_params
from footfall.scenarios.studies.factors import Factor, points_at
from footfall.scenarios.studies.listening import Heard, Lost, listened
from footfall.scenarios.studies.points import Over, Worn, evaluate_points, over_cases, require_allowed
from footfall.settings import did_you_mean, leaves

SPAN = 4.0  # by how much a parameter goes below and above its default, where nothing else is asked for


@dataclass(frozen=True)
class ErrorMap:
    """A score over two parameters.

    Attributes
    ----------
    x, y : what is varied; xs (nx,), ys (ny,) its values
    scores : (ny, nx) the metric over the cases
    default : (x, y, score) as the method is
    lost : cases that came to no end, left out: why
    """

    method: str
    x: Factor
    y: Factor
    xs: np.ndarray
    ys: np.ndarray
    scores: np.ndarray
    default: tuple[float, float, float]
    cases: int
    lost: tuple[str, ...] = ()

    @property
    def best(self) -> tuple[float, float, float]:
        """(x, y, score) where the score is smallest."""
        row, column = np.unravel_index(int(np.argmin(self.scores)), self.scores.shape)
        return float(self.xs[column]), float(self.ys[row]), float(self.scores[row, column])


def is_compiled(method: Method, metric: str) -> bool:
    """Whether a method's errors at many parameter sets come from one compiled pass."""
    return hdr_params(method) is not None and method.params is not None and metric in METRICS


def default_of(method: Method, address: str) -> float:
    """The value of a method's parameter.

    Raises
    ------
    InputError
        No such parameter, or one that is no number.
    """
    known = {f"{method.name}.{leaf.name}": leaf.value for leaf in leaves(method.params)}
    if address not in known:
        raise InputError(f"unknown{did_you_mean(address, known)}", address)
    value = known[address]
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InputError(f"{value!r} is no number, and has no range", address)
    return float(value)


def factor_about(method: Method, address: str) -> Factor:
    """A quarter to four times a parameter's value.

    Raises
    ------
    InputError
        As `default_of`; or the value is 0 or infinite, about which there is no such range.
    """
    now = default_of(method, address)
    if not 0 < now < math.inf:
        raise InputError(f"is {now:g}, about which there is no range: say from where to where", address)
    return Factor(address, now / SPAN, now * SPAN, log=True)


def error_map(
    base: Documents,
    x: Factor,
    y: Factor,
    *,
    cases: Worn,
    metric: str = METRICS[0],
    over: Over = "median",
    steps: int = 32,
    workers: int | None = None,
    on_cases: Callable[[int, int], None] | None = None,
    on_trials: Callable[[Progress], None] | None = None,
) -> ErrorMap:
    """The error of the one method of `base` at steps x steps pairs.

    Parameters
    ----------
    x, y : what is varied, and its range
    cases : walks and units
    metric, over : which score, and its median, mean or p90 over the cases
    steps : values of each
    workers : processes; None for one a core
    on_cases, on_trials : called with what is done

    Raises
    ------
    InputError
        What a parameter, a walk or a recording refuses.
    """
    (method,) = base.methods
    if x.address == y.address:
        raise InputError("given twice: a map is over two parameters", x.address)
    own = (default_of(method, x.address), default_of(method, y.address))
    require_allowed(base, (x, y))
    setup = base.setup()
    share = np.linspace(0.0, 1.0, steps)
    shares = np.stack([grid.ravel() for grid in np.meshgrid(share, share)], axis=1)
    lost: tuple[str, ...] = ()
    if is_compiled(method, metric):
        heard = listened(cases.deal(setup), workers=workers, on_progress=on_cases)
        there = [case for case in heard if isinstance(case, Case)]
        lost = tuple(one[1] for one in heard if not isinstance(one, Case))
        if not there:
            raise InputError(f"no case came to its end: {lost[0]}")
        pairs = np.column_stack([x.at(shares[:, 0]), y.at(shares[:, 1])])
        errors = mapped(there, base, (x.address, y.address), metric, np.vstack([pairs, own]))
    else:
        points = [*points_at((x, y), shares), {}]
        found = evaluate_points(base, points, cases.deal, metric, workers=workers, on_progress=on_trials)
        (errors,) = found.errors
        there_ = np.isfinite(errors[-1])
        if not there_.any():
            raise InputError(f"no case came to its end: {next(iter(found.failures))}")
        errors, lost = errors[:, there_], tuple(found.failures)[: int((~there_).sum())]
    scores = over_cases(errors, over)
    return ErrorMap(
        method.name,
        x,
        y,
        x.at(share),
        y.at(share),
        scores[:-1].reshape(steps, steps),
        (*own, float(scores[-1])),
        errors.shape[1],
        lost,
    )


def mapped(
    cases: Sequence[Case | Lost], base: Documents, addresses: Sequence[str], metric: str, points: np.ndarray
) -> np.ndarray:
    """Errors (p, cases) of HDR at points (p, addresses), compiled: nothing but the scores is kept."""
    setup = base.setup()
    return Heard(cases, setup.spec, base.methods[0], addresses, metric)(points)


def ranged(factor: Factor, low: float, high: float) -> Factor:
    """The same over another range, logarithmic where that is possible."""
    return replace(factor, low=low, high=high, log=low > 0)
