"""Holes between samples: bridged by straight lines where that is harmless."""

from __future__ import annotations

from typing import Any

import numpy as np

from footfall.formats.samples import Samples

CALM_RATE = 1.0  # rad/s, mean beside a hole in a stance
CALM_S = 0.04
STANDING_S = 1.0  # at rest for so long on both sides, and the foot stood
STANDING_RATE = 0.3  # rad/s
BRIDGED_S = 5.0  # the longest hole at rest
DOUBTFUL_S = 0.03  # lost of a swing, beyond which its stride is not known to centimetres
SWING_S = 0.35  # a hole of a stance that is longer may hide a stride

Hole = tuple[float, float]


def bridged(samples: Samples, interval: float, most_s: float) -> tuple[Samples, int, tuple[Hole, ...]]:
    """Samples with holes of up to `most_s` filled, longer ones where the foot rests on both sides.

    Returns
    -------
    Samples, how many were filled in, and those holes (s, first and last sample) in which it may have moved.
    """
    step = np.diff(samples.t)
    lost = np.zeros(len(step))
    doubtful = []
    for place in np.flatnonzero(step > 1.5 * interval):
        duration = step[place]
        rests = _calm(samples, place, CALM_S, CALM_RATE)
        stands = rests and _calm(samples, place, STANDING_S, STANDING_RATE)
        if duration > (BRIDGED_S if stands or (rests and duration < 2 * SWING_S) else most_s):
            continue
        lost[place] = np.round(duration / interval) - 1
        if duration > DOUBTFUL_S + 1.5 * interval and not stands and not (rests and duration < SWING_S):
            doubtful.append((float(samples.t[place]), float(samples.t[place + 1])))
    if not lost.any():
        return samples, 0, ()
    at = np.concatenate([[0], np.cumsum(lost + 1)])
    every = np.arange(at[-1] + 1)

    def fill(values: np.ndarray) -> np.ndarray:
        return np.interp(every, at, values)

    warm = samples.temperature
    made = Samples(
        row=samples.row,
        t=fill(samples.t),
        gyro=np.column_stack([fill(axis) for axis in samples.gyro.T]),
        accel=np.column_stack([fill(axis) for axis in samples.accel.T]),
        temperature=None if warm is None else fill(warm),
    )
    return made, int(lost.sum()), tuple(doubtful)


def _calm(samples: Samples, place: Any, around_s: float, most: float) -> bool:
    """Whether the foot turns by less than `most` before and after the hole that follows a sample."""
    t = samples.t
    before = slice(int(np.searchsorted(t, t[place] - around_s)), place + 1)
    after = slice(place + 1, int(np.searchsorted(t, t[place + 1] + around_s, side="right")))
    return all(float(np.linalg.norm(samples.gyro[rows], axis=1).mean()) < most for rows in (before, after))
