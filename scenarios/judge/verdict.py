"""Verdicts: what cases say of a gate, and what they leave open.

Every gate but "same" asks whether a share of all cases lies within a limit (`judge.bounds`). It passes where
so many of these cases within it would be a rare chance if not, fails where so few would be one if so, and is
undecided else.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from footfall.scenarios.judge.bounds import (
    ALPHA,
    Bounds,
    chance_of_so_few,
    chance_of_so_many,
    deciding,
    holm,
    log_ratios,
    quantile_bounds,
    share_bounds,
)
from footfall.scenarios.judge.gate import Gate, floor_of
from footfall.scenarios.judge.score import unit_of

Decision = Literal["pass", "fail", "undecided"]
Scores = Mapping[str, np.ndarray]  # metric -> (n,) magnitudes, one a case; infinite where the method failed


@dataclass(frozen=True)
class Verdict:
    """What became of a gate.

    Attributes
    ----------
    name, method, against, metric, statistic : of the gate
    unit : of estimate, bounds and limit; "%" for a change against another and for a share, "cases" for the
        number of those that moved
    estimate, low, high, limit : an infinite bound is none; NaN where there is nothing of the kind
    verdict, reason : the reason is empty where the figures say all
    needed : how many cases would decide, at the present estimate
    scatter : standard deviation of the cases' log ratios
    cases, left_out : how many count, and how many do not because both methods failed in them
    failed, failure : in how many of them the method came to no score, and the first reason
    """

    name: str
    method: str
    against: str | None
    metric: str
    unit: str
    statistic: str
    estimate: float
    low: float
    high: float
    limit: float
    verdict: Decision
    reason: str = ""
    needed: int | None = None
    scatter: float | None = None
    cases: int = 0
    left_out: int = 0
    failed: int = 0
    failure: str = ""


@dataclass(frozen=True)
class Evidence:
    """What the cases say of a gate by itself.

    Attributes
    ----------
    bounds, limit, unit : as people read them; `sense` is what a value must be to the limit
    within, n : how many of the cases that count are within the limit
    settled : a verdict and its reason that no chance has a part in
    """

    gate: Gate
    bounds: Bounds
    limit: float
    unit: str
    within: int
    n: int
    left_out: int = 0
    scatter: float | None = None
    settled: tuple[Decision, str] | None = None


def weigh(
    gate: Gate, scores: Scores, against: Scores | None, margin_percent: float, alpha: float = ALPHA
) -> Evidence:
    """A gate over the cases that are there.

    Parameters
    ----------
    scores, against : of the gate's method, and of the other on the same recordings
    margin_percent : where the gate leaves it open
    """
    if gate.statistic == "same":
        assert against is not None
        return _sameness(gate, scores, against)
    own = scores[gate.metrics[0]]
    if against is not None:
        margin = margin_percent if gate.margin_percent is None else gate.margin_percent
        return _comparison(gate, own, against[gate.metrics[0]], margin, alpha)
    n = len(own)
    if gate.statistic == "share_below":
        assert gate.below is not None
        within = int((own < gate.below).sum())
        found = Bounds(*(100 * value for value in share_bounds(within, n, alpha)))
        return Evidence(gate, found, 100 * gate.share, "%", within, n)
    assert gate.at_most is not None
    within = int((own <= gate.at_most).sum())
    found = quantile_bounds(own, gate.share, alpha)
    return Evidence(gate, found, gate.at_most, unit_of(gate.metrics[0]), within, n)


def decide(found: Sequence[Evidence], alpha: float = ALPHA) -> list[Verdict]:
    """The verdicts of a file's gates.

    All of them must pass, so that each passes by itself; one among many fails by chance sooner than one
    alone, so that they fail by Holm's procedure.
    """
    open_ = [one for one in found if one.settled is None]
    few = iter(holm([chance_of_so_few(one.within, one.n, one.gate.share) for one in open_]))
    return [
        _verdict(one, *one.settled) if one.settled else _decided(one, next(few), alpha, len(open_))
        for one in found
    ]


def _decided(one: Evidence, few: float, alpha: float, among: int) -> Verdict:
    share, within, n = one.gate.share, one.within, one.n
    if n and chance_of_so_many(within, n, share) <= alpha:
        return _verdict(one, "pass")
    if few <= alpha:
        return _verdict(one, "fail")
    if not n:
        return _verdict(one, "undecided", "no case has a score of both")
    needed = deciding(within, n, share, alpha, alpha / among)
    advice = f"about {needed} would" if needed else "the estimate lies on the limit: no number will"
    if chance_of_so_few(within, n, share) <= alpha:
        what = f"{n} cases lie beyond the limit, but by chance one of {among} gates may (Holm)"
    else:
        what = f"{n} cases cannot tell {told(one.bounds.estimate, one)} from {told(one.limit, one)}"
    return _verdict(one, "undecided", f"{what}; {advice}", needed)


def _verdict(one: Evidence, verdict: Decision, reason: str = "", needed: int | None = None) -> Verdict:
    metrics = one.gate.metrics
    return Verdict(
        name=one.gate.name,
        method=one.gate.method,
        against=one.gate.against,
        metric=metrics[0] if len(metrics) == 1 else "every score",
        unit=one.unit,
        statistic=one.gate.statistic,
        estimate=one.bounds.estimate,
        low=one.bounds.low,
        high=one.bounds.high,
        limit=one.limit,
        verdict=verdict,
        reason=reason,
        needed=needed,
        scatter=one.scatter,
        cases=one.n,
        left_out=one.left_out,
    )


def _comparison(gate: Gate, own: np.ndarray, other: np.ndarray, margin: float, alpha: float) -> Evidence:
    """The median of the cases' log ratios against the margin."""
    ratios = log_ratios(own, other, floor_of(gate.metrics[0]))
    counted = ratios[~np.isnan(ratios)]
    left_out, n = len(ratios) - len(counted), len(counted)
    limit = math.log1p(margin / 100)
    within = int((counted <= limit).sum())
    found = quantile_bounds(counted, 0.5, alpha) if n else Bounds(math.nan, -math.inf, math.inf)
    change = Bounds(
        *(100 * math.expm1(min(value, 700.0)) if value < math.inf else math.inf for value in found)
    )
    finite = counted[np.isfinite(counted)]
    scatter = float(np.std(finite, ddof=1)) if len(finite) > 1 else None
    identical = margin >= 0 and np.array_equal(own, other)
    settled: tuple[Decision, str] | None = ("pass", "identical") if identical else None
    return Evidence(gate, change, margin, "%", within, n, left_out, scatter, settled)


def _sameness(gate: Gate, own: Scores, other: Scores) -> Evidence:
    """How many cases have a score that moved by more than the tolerance."""
    moved = np.zeros(len(own[gate.metrics[0]]), bool)
    furthest, which = 0.0, gate.metrics[0]
    for metric in gate.metrics:
        mine, theirs = own[metric], other[metric]
        with np.errstate(invalid="ignore"):
            off = 100 * np.abs(mine - theirs) / np.maximum(theirs, floor_of(metric))
        off = np.where(mine == theirs, 0.0, np.where(np.isnan(off), math.inf, off))  # one of the two failed
        moved |= off > gate.tolerance_percent
        if len(off) and off.max() > furthest:
            furthest, which = float(off.max()), metric
    n, count = len(moved), int(moved.sum())
    settled: tuple[Decision, str] = ("pass", "identical" if furthest == 0 else "")
    if count:
        by = f"{which} of one by {furthest:.3g} %" if math.isfinite(furthest) else "one of them failed"
        settled = "fail", f"{count} of {n} cases moved, {by}"
    return Evidence(
        gate,
        Bounds(float(count), math.nan, math.nan),
        gate.tolerance_percent,
        "cases",
        n - count,
        n,
        settled=settled,
    )


def told(value: float, of: Evidence | Verdict) -> str:
    """A value with its unit, as people read it: a change with its sign."""
    return f"{figure(value, signed=is_change(of.gate if isinstance(of, Evidence) else of))} {of.unit}"


def is_change(gate: Gate | Verdict) -> bool:
    """Whether values of this gate are changes against another."""
    return gate.against is not None and gate.statistic != "same"


def figure(value: float, signed: bool = False) -> str:
    """A number in two or three digits, or with its sign."""
    digits = 2 if abs(value) < (1 if signed else 10) else 1 if abs(value) < (10 if signed else 100) else 0
    return f"{value:+.{digits}f}" if signed else f"{value:.{digits}f}"
