"""Scores of a method at many points of its and its sensor's parameters, by the full chain.

What differs in the method's own parameters alone is recorded once: such points are many methods of one trial.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal, cast, get_args

import numpy as np

from footfall.errors import InputError
from footfall.hdr.method import Method
from footfall.scenarios.evaluate import cases
from footfall.scenarios.execute import Progress
from footfall.scenarios.judge.bounds import quantile
from footfall.scenarios.judge.gate import METRICS
from footfall.scenarios.parameters import Documents, with_values
from footfall.scenarios.studies.factors import Factor
from footfall.scenarios.studies.spreading import Workers, perform_trials
from footfall.scenarios.studies.study import CasesTable
from footfall.scenarios.trial import Setup, Trial
from footfall.settings import did_you_mean

Over = Literal["median", "mean", "p90"]

TOGETHER = 50  # methods of one trial: so many tracks of a recording before the next progress


class Worn(CasesTable):
    """Who wears what on which walk, the same at every point."""

    def deal(self, setup: Setup) -> list[Trial]:
        """The trials of a setup."""
        return cases(setup, **self.model_dump())


@dataclass(frozen=True)
class Evaluated:
    """Errors (m, p, c) of methods at points in cases, infinite where there is none; reason -> how often."""

    errors: np.ndarray
    failures: Mapping[str, int]


def require_metric(name: str) -> str:
    """A figure of `Score` by its name.

    Raises
    ------
    InputError
        There is none of that name.
    """
    if name not in METRICS:
        raise InputError(f"metric = {name!r}: unknown{did_you_mean(name, METRICS)}")
    return name


def require_over(name: str) -> Over:
    """What many cases come to, by its name.

    Raises
    ------
    InputError
        There is none of that name.
    """
    if name not in get_args(Over):
        raise InputError(f"over = {name!r}: expected one of {', '.join(get_args(Over))}")
    return cast(Over, name)


def require_allowed(base: Documents, factors: Sequence[Factor]) -> None:
    """Refuse a factor whose address is unknown, or that has an end which the models refuse.

    Raises
    ------
    InputError
        What a file with that value would get.
    """
    for factor in factors:
        for value in factor.ends:
            with_values(base, {factor.address: value}).setup()


def evaluate_points(
    base: Documents,
    points: Sequence[Mapping[str, Any]],
    deal: Callable[[Setup], Sequence[Trial]],
    metric: str,
    *,
    which: np.ndarray | None = None,
    workers: Workers = None,
    store: Path | None = None,
    on_progress: Callable[[Progress], None] | None = None,
) -> Evaluated:
    """The full chain at every point.

    Parameters
    ----------
    base : with the methods that are judged, on the same recordings
    points : address -> value
    deal : the cases of a setup, in the same order for each
    metric : of `Score`; its size counts
    which : (p,) the one case of each point; all where None
    workers, store, on_progress : as of `perform_trials`
    """
    shared, methods = base.setup().scenario, base.methods
    own = [[_own(method, point) for point in points] for method in methods]
    groups: dict[str, list[int]] = {}
    for index, point in enumerate(points):
        rest = {address: value for address, value in point.items() if not _owned(methods, address)}
        groups.setdefault(json.dumps([rest, _case(which, index)], sort_keys=True), []).append(index)
    trials: list[Trial] = []
    told: list[tuple[int, _Owners]] = []  # of each trial: its case, and whose its rows are
    for key, members in groups.items():
        rest, chosen = json.loads(key)
        setup = with_values(base, rest).setup()
        if not any(address.startswith("scenario.") for address in rest):
            setup = replace(setup, scenario=shared)  # whose plan is then hashed once
        for made, owners in _parts(methods, own, members):
            dealt = list(enumerate(deal(replace(setup, methods=made))))
            for case, trial in dealt if chosen is None else [dealt[chosen]]:
                trials.append(trial)
                told.append((case, owners))
    count = len(deal(base.setup())) if which is None else 1
    errors = np.full((len(methods), len(points), count), np.inf)
    failures: Counter[str] = Counter()
    done = perform_trials(trials, workers=workers, store=store, on_progress=on_progress)
    for outcome, (case, owners) in zip(done, told, strict=True):
        for row in outcome.rows:
            place, members = owners[row.method]
            if row.score is None:
                failures[row.error] += len(members)
            else:
                errors[place, members, case if which is None else 0] = abs(getattr(row.score, metric))
    return Evaluated(errors, dict(failures))


# Name of a method with a point's parameters -> which of the methods it is, and the points that it belongs to.
_Owners = Mapping[str, tuple[int, list[int]]]


def _own(method: Method, point: Mapping[str, Any]) -> dict[str, Any]:
    """The values of a point that the method itself takes."""
    values = {address: value for address, value in point.items() if _owned([method], address)}
    return {address.removeprefix(f"{method.name}."): value for address, value in values.items()}


def _owned(methods: Sequence[Method], address: str) -> bool:
    """Whether an address is a parameter of one of the methods; dead reckoning has none of its own."""
    return any(one.params is not None and address.startswith(f"{one.name}.") for one in methods)


def _case(which: np.ndarray | None, index: int) -> int | None:
    return None if which is None else int(which[index])


def _parts(
    methods: Sequence[Method], own: Sequence[Sequence[Mapping[str, Any]]], members: Sequence[int]
) -> list[tuple[tuple[Method, ...], _Owners]]:
    """The different methods of points that share all else, in parts of a trial's size."""
    made: dict[str, Method] = {}
    owners: dict[str, tuple[int, list[int]]] = {}
    for place, method in enumerate(methods):
        by_params: dict[str, list[int]] = {}
        for index in members:
            by_params.setdefault(json.dumps(own[place][index], sort_keys=True), []).append(index)
        for same in by_params.values():
            name = f"{method.name}-{same[0]}"
            made[name] = method.with_params(own[place][same[0]]).renamed(name)
            owners[name] = place, same
    names = list(made)
    parts = [names[first : first + TOGETHER] for first in range(0, len(names), TOGETHER)]
    return [(tuple(made[name] for name in part), {name: owners[name] for name in part}) for part in parts]


def over_cases(errors: np.ndarray, over: Over) -> np.ndarray:
    """Median, mean or 90th percentile (p,) of errors (p, c); infinite ones rank last."""
    if over == "mean":
        return np.asarray(errors.mean(axis=1))
    share = {"median": 0.5, "p90": 0.9}[over]
    return np.array([quantile(row, share) for row in errors])


def require_finite(
    values: np.ndarray, shares: np.ndarray, factors: Sequence[Factor], failures: Mapping[str, int]
) -> None:
    """Refuse points whose value is infinite: too many of their cases failed.

    Parameters
    ----------
    values, shares : (p,) and (p, factors)

    Raises
    ------
    InputError
        How many, in which corner of the parameters, and the commonest reason.
    """
    bad = ~np.isfinite(values)
    if not bad.any():
        return
    where = []
    for i, factor in enumerate(factors):
        low, high = shares[bad, i].min(), shares[bad, i].max()
        if high - low <= 0.5 and len(factor.ends) == 2:
            ends = factor.at(np.array([low, high])).tolist()
            where.append(f"{factor.address} from {ends[0]:.4g} to {ends[1]:.4g}")
    corner = f", all with {' and '.join(where)}" if where else ""
    reason = max(failures, key=lambda text: failures[text]) if failures else "no reason was told"
    raise InputError(
        f"{int(bad.sum())} of {len(values)} points have no score{corner}: too many of their cases failed "
        f"({reason})"
    )
