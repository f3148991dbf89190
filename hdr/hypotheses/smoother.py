"""The filter over hypotheses with hindsight: what a whole walk says of the drift at each footfall."""

from __future__ import annotations

import numpy as np

from footfall.hdr.hypotheses.filter import APART, Beliefs, beliefs, fitting, rows_of
from footfall.hdr.hypotheses.params import HypothesesParams
from footfall.late import late
from footfall.pdr.footfalls import Footfalls

_beam, _smooth = late("footfall.hdr.hypotheses._beam"), late("footfall.hdr.hypotheses._smooth")

SEQUENCES = 5  # best ones, along which is smoothed
LEAST = 0.02  # weight beside the best, below which a sequence is left out


def smoothed(footfalls: Footfalls, params: HypothesesParams | None = None) -> Beliefs:
    """Every footfall's belief, given the whole walk.

    The sequences of modes that lead to the hypotheses at the end that stand for all (`leaders`) are smoothed
    one by one, and averaged by their weights. A beam remembers something of all that it joined. Where it says
    something else of the end than these few do, the walk is undecided and the filter's beliefs stand.
    `evidence` is that of the filter.

    Raises
    ------
    InputError
        An interval between two footfalls is not positive.
    """
    c = fitting(params or HypothesesParams(), footfalls)
    rows = rows_of(footfalls, c)
    told, history, last = _beam.beam(rows, c, True)
    if not len(last):  # nothing was walked
        return beliefs(footfalls, params)
    best, share = leaders(*last.T)
    drifts, variances, modes = [], [], []
    for k in best:
        labels, first = sequence(history, int(k))
        ways = len(c.scales)
        first_mode, habit = divmod(first % (2 * len(c.wander_m) * ways), len(c.wander_m) * ways)
        mode_of, habit_of, scale, world, entry, *_ = labels.T
        drift, variance = _smooth.smooth(
            rows,
            c,
            mode_of.copy(),
            habit_of.copy(),
            entry.copy(),
            c.scales[scale[-1]],
            first_mode,
            habit // ways,
            _beam.tells(world[-1], first_mode, c),
        )
        drifts.append(drift)
        variances.append(variance)
        modes.append(mode_of)
    drift, variance, mode = np.array(drifts), np.array(variances), np.array(modes)
    mean = share @ drift
    if abs(mean[-1] - told[-1, _beam.MEAN]) > told[-1, _beam.SD]:
        return beliefs(footfalls, params)
    sd = np.sqrt(np.maximum(share @ (variance + (drift - mean) ** 2), 0.0))
    straight, curve, turn = (share @ (mode == which) for which in range(3))
    second, second_weight = _second(drift, variance, share)
    rate = np.diff(mean, prepend=0.0) / np.maximum(footfalls.interval, 1e-9)
    rate[0] = 0.0
    heading = footfalls.heading
    return Beliefs(
        heading=heading - mean,
        heading_sd=sd,
        straight=straight,
        curve=curve,
        turn=turn,
        drift_rate=rate,
        second_heading=heading - second,
        second_weight=second_weight,
        evidence=told[:, _beam.EVIDENCE],
    )


def leaders(weights: np.ndarray, drift: np.ndarray, variance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Which hypotheses (m,) stand for all, and their shares: the best, and the best of those far from it.

    One that is within a standard deviation of a better one goes with it, or more where they are too many.
    """
    share = np.exp(weights - weights.max())
    order = np.argsort(-weights, kind="stable")
    sd = np.sqrt(np.maximum(variance, 0.0))
    found, reach = list(order), 1.0
    while len(found) > SEQUENCES or reach == 1.0:
        found = []
        for k in order:
            if not (np.abs(drift[found] - drift[k]) <= reach * sd[found]).any():
                found.append(k)
        reach *= 1.5
    nearest = np.abs(drift[:, None] - drift[found]).argmin(axis=1)
    shares = np.bincount(nearest, share, minlength=len(found))
    kept = shares >= LEAST * shares.max()
    return np.array(found)[kept], shares[kept] / shares[kept].sum()


def sequence(history: np.ndarray, last: int) -> tuple[np.ndarray, int]:
    """Labels (n, 7) that lead to the hypothesis `last` of the end, and which of the first they begin with.

    history : (n, hypotheses, 7) of `_beam.beam`; row 0 of the labels is that of row 1
    """
    n = len(history)
    labels = np.zeros((n, history.shape[2]), dtype=np.int64)
    at = last
    for i in range(n - 1, 0, -1):
        labels[i] = history[i, at]
        at = int(labels[i, _beam.PARENT])
    labels[0] = labels[min(1, n - 1)]
    return labels, at


def _second(drift: np.ndarray, variance: np.ndarray, share: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Drift and weight of the best of the sequences (s, n) that is far from the first."""
    far = np.abs(drift - drift[0]) > APART * np.sqrt(np.maximum(variance[0], 0.0))
    some, which = far.any(axis=0), far.argmax(axis=0)
    second = np.where(some, drift[which, np.arange(drift.shape[1])], drift[0])
    return second, share @ far
