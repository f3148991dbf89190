"""Parameters chosen on one set of cases and judged on another: what is tuned and judged alike is too good.

A case is whatever an error can be told of: a trial, or footfalls with their true headings.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any, Generic, TypeVar

import numpy as np

from footfall.errors import InputError
from footfall.scenarios.judge.statistics import spread
from footfall.settings import changed

C = TypeVar("C")
P = TypeVar("P")


def grid(base: P, axes: Mapping[str, Sequence[Any]]) -> list[P]:
    """`base` with every combination of values; the last axis changes fastest.

    Parameters
    ----------
    base : a frozen dataclass
    axes : a field's name at the edge (`theta_w_deg_s`) -> its values

    Raises
    ------
    InputError
        No such field, or a value that it refuses.
    """
    return [changed(base, dict(zip(axes, values, strict=True))) for values in product(*axes.values())]


def require_apart(what: str, train: Iterable[Hashable], test: Iterable[Hashable]) -> None:
    """Raise InputError where the two sides share one.

    Parameters
    ----------
    what : "walk seed", "unit"
    """
    if shared := set(train) & set(test):
        raise InputError(f"tuning and judging share a {what} ({min(shared, key=repr)}): choose other seeds")


def smallest(errors: Sequence[np.ndarray]) -> int:
    """Which parameter set errs least.

    Parameters
    ----------
    errors : of each group of cases (cases, sets), positive

    Returns
    -------
    The set with the smallest geometric mean over the groups of the mean over a group's cases: each group
    counts alike, whatever its errors' size. The first of equal ones.
    """
    with np.errstate(divide="ignore"):
        return int(np.argmin(np.mean([np.log(group.mean(axis=0)) for group in errors], axis=0)))


@dataclass(frozen=True)
class Tuned(Generic[P]):
    """What tuning chose and whether it is better.

    Attributes
    ----------
    default, chosen : parameters
    errors : (train, sets) of each training case under each set
    figures : "train" and "test" -> "default" and "tuned" -> mean, median and p90 over the cases
    """

    default: P
    chosen: P
    errors: np.ndarray
    figures: Mapping[str, Mapping[str, Mapping[str, float]]]


def tune(
    error: Callable[[C, Sequence[P]], np.ndarray],
    sets: Sequence[P],
    default: P,
    *,
    train: Sequence[C],
    test: Sequence[C],
) -> Tuned[P]:
    """Choose the set with the smallest mean error over `train`, and judge it beside the default on `test`.

    Parameters
    ----------
    error : errors (n,) of a case under n sets
    sets : to choose from
    train, test : cases; what they must not share is theirs to tell (`require_apart`)
    """

    def errors(cases: Sequence[C], judged: Sequence[P]) -> np.ndarray:
        return np.array([error(case, judged) for case in cases])

    found = errors(train, sets)
    chosen = sets[smallest([found])]
    sides = {"train": errors(train, [default, chosen]), "test": errors(test, [default, chosen])}
    return Tuned(
        default,
        chosen,
        found,
        {
            side: {name: spread(rows[:, i]) for i, name in enumerate(("default", "tuned"))}
            for side, rows in sides.items()
        },
    )
