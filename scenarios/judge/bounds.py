"""Bounds of quantiles and shares that assume nothing but independent cases.

One fact carries all of it: of n cases the number within a limit is binomial. A p-quantile is at most the
limit where a share p of all cases is within it, so that a quantile is bounded by order statistics (David and
Nagaraja 2003, Order Statistics, section 7.1) and a share by Clopper and Pearson (1934). Ties and infinities
are cases like others.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from footfall.late import late

stats = late("scipy.stats")

ALPHA = 0.05  # how often each one-sided bound may miss
MANY = 10_000  # cases; more than these are no advice


class Bounds(NamedTuple):
    """An estimate between its lower and its upper one-sided bound; infinite where there is none."""

    estimate: float
    low: float
    high: float


def quantile(values: np.ndarray, share: float) -> float:
    """The sample's quantile, between neighbours in proportion; between -inf and inf it is inf.

    As `np.quantile`, which has no answer where a neighbour is infinite.
    """
    ordered = np.sort(values)
    place = share * (len(ordered) - 1)
    below, above = float(ordered[math.floor(place)]), float(ordered[math.ceil(place)])
    part = place - math.floor(place)
    if part == 0 or below == above:
        return below
    if math.isinf(above) or math.isinf(below):
        return above
    return below + part * (above - below)


def quantile_bounds(values: np.ndarray, share: float, alpha: float = ALPHA) -> Bounds:
    """A quantile of all cases, from (n,) of them: bounded by the values of `ranks`."""
    ordered, n = np.sort(values), len(values)
    low, high = ranks(n, share, alpha)
    return Bounds(
        quantile(values, share),
        float(ordered[low - 1]) if low > 0 else -math.inf,
        float(ordered[high - 1]) if high <= n else math.inf,
    )


@lru_cache
def ranks(n: int, share: float, alpha: float = ALPHA) -> tuple[int, int]:
    """Which of n ordered values, counted from 1, bound the `share`-quantile; 0 and n + 1 where none does.

    With B binomial of n and `share`: the largest l with P(B < l) <= alpha, and the smallest u with
    P(B >= u) <= alpha.
    """
    k = np.arange(1, n + 1)
    low = np.flatnonzero(stats.binom.cdf(k - 1, n, share) <= alpha)
    high = np.flatnonzero(stats.binom.sf(k - 1, n, share) <= alpha)
    return (int(k[low[-1]]) if len(low) else 0), (int(k[high[0]]) if len(high) else n + 1)


def share_bounds(within: int, n: int, alpha: float = ALPHA) -> Bounds:
    """A share of all cases, `within` of n of which are counted (Clopper and Pearson 1934)."""
    low = float(stats.beta.ppf(alpha, within, n - within + 1)) if within > 0 else 0.0
    high = float(stats.beta.ppf(1 - alpha, within + 1, n - within)) if within < n else 1.0
    return Bounds(within / n, low, high)


def chance_of_so_few(within: int, n: int, share: float) -> float:
    """Largest probability of no more than `within` of n, where at least `share` of all cases are within.

    At most alpha exactly where the lower bound of the `share`-quantile exceeds the limit.
    """
    return float(stats.binom.cdf(within, n, share))


def chance_of_so_many(within: int, n: int, share: float) -> float:
    """Largest probability of `within` of n or more, where less than `share` of all cases are within.

    At most alpha exactly where the upper bound of the `share`-quantile is within the limit.
    """
    return float(stats.binom.sf(within - 1, n, share))


def fewest(share: float, alpha: float = ALPHA) -> int:
    """How many cases a `share`-quantile needs for an upper bound: fewer may all lie below it by chance."""
    return math.ceil(math.log(alpha) / math.log(share) - 1e-9)


def deciding(within: int, n: int, share: float, alpha: float, alpha_few: float) -> int | None:
    """How many cases would decide, if the same share of them as of these n is within.

    Parameters
    ----------
    alpha, alpha_few : what the chances of so many, and of so few, must not exceed

    Returns
    -------
    In tens; None where more than `MANY` are needed, or the estimate lies on the limit.
    """
    found = within / n
    more = np.arange(n + 1, MANY + 1)
    expected = np.floor(found * more + 1e-9) if found > share else np.ceil(found * more - 1e-9)
    many = stats.binom.sf(expected - 1, more, share) <= alpha
    few = stats.binom.cdf(expected, more, share) <= alpha_few
    decided = np.flatnonzero(many | few)
    return 10 * math.ceil(int(more[decided[0]]) / 10) if len(decided) else None


def log_ratios(values: np.ndarray, reference: np.ndarray, floor: float) -> np.ndarray:
    """(n,) natural logarithms of values over those of the same cases by another method.

    Parameters
    ----------
    values, reference : (n,) not negative; infinite where a method failed
    floor : what is smaller counts as this

    Returns
    -------
    inf where the method alone failed, -inf where the reference alone did, NaN where both did.
    """
    with np.errstate(invalid="ignore"):
        return np.log(np.maximum(values, floor)) - np.log(np.maximum(reference, floor))


def holm(chances: Sequence[float]) -> list[float]:
    """Each chance as it counts among all (Holm 1979): at most alpha where Holm's procedure rejects."""
    order = np.argsort(chances, kind="stable")
    counted, largest = [0.0] * len(chances), 0.0
    for rank, index in enumerate(order):
        largest = max(largest, min(1.0, (len(chances) - rank) * chances[index]))
        counted[index] = largest
    return counted
