"""What a stride closes to: the force, turned by the gyros and less gravity, must leave no velocity.

From one moment of rest to the next it leaves some, as a share of g times the duration. Feet are not quite at
rest in a stance, so across the ground right recordings leave a few hundredths. Along the vertical they leave
some thousandths only: a foot that is at rest twice has risen as fast as it sank.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from footfall.conventions import GRAVITY
from footfall.pdr.stance import moving_mean
from footfall.pdr.strapdown import integrate
from footfall.recording import Recording

STILL_S = 0.06
REST = 0.35  # shares of RMS: stances have .03-.15, the quietest of swing .45
APART_S = 0.5  # between moments of rest
STRIDE_S = (0.4, 4.0)  # a clock may be twice as slow as it should be
STRIDES = (5, 40)  # so many are needed, so many are looked at
WALKING = 3.0  # m/s2, by which the force's norm varies in a stride


def resting_force(t: np.ndarray, gyro: np.ndarray, accel: np.ndarray) -> float:
    """The force's norm where the IMU is stillest, in whatever unit."""
    still = _unrest(t, gyro, accel)
    quiet = still <= np.quantile(still, 0.05)
    return float(np.median(np.linalg.norm(accel[quiet], axis=1)))


def _unrest(t: np.ndarray, gyro: np.ndarray, accel: np.ndarray) -> np.ndarray:
    """How unquiet the IMU is, in shares of its own RMS: whatever the units. (n,)"""

    def share(x: np.ndarray) -> np.ndarray:
        mean = float(np.mean(x))
        return np.sqrt(np.maximum(moving_mean(x, t, STILL_S), 0) / mean) if mean else np.zeros_like(x)

    turn = share((gyro**2).sum(axis=1))
    force = np.linalg.norm(accel, axis=1)
    rest = np.median(force[turn <= np.quantile(turn, 0.1)])
    return turn + share((force - rest) ** 2)


def rests_of(recording: Recording) -> np.ndarray:
    """Samples at the stillest instants, at least half a second apart."""
    unrest = _unrest(recording.t, recording.gyro, recording.accel)
    return lowest(unrest, REST, max(1, round(APART_S / recording.interval)))


def lowest(x: np.ndarray, most: float, apart: int) -> np.ndarray:
    """Local minima of (n,) `x` of `most` at most: the lowest first, no other within `apart` samples of it.

    As `scipy.signal.find_peaks(-x, height=-most, distance=apart)`, whose import takes longer than all
    else that is done to a recording.
    """
    first = np.concatenate([[0], np.flatnonzero(np.diff(x)) + 1])  # of each run of equal samples
    last = np.append(first[1:], len(x)) - 1
    low = x[first]
    inside = (low[1:-1] < low[:-2]) & (low[1:-1] < low[2:]) & (low[1:-1] <= most)
    at = ((first + last) // 2)[1:-1][inside]
    kept = np.ones(len(at), dtype=bool)
    for i in np.argsort(-x[at])[::-1]:
        if kept[i]:
            near = slice(np.searchsorted(at, at[i] - apart, side="right"), np.searchsorted(at, at[i] + apart))
            kept[near] = False
            kept[i] = True
    return at[kept]


def upright(up: np.ndarray) -> np.ndarray:
    """An attitude (4,) in which `up` (3,), of any length, points up."""
    x, y, z = up / np.linalg.norm(up)
    # The shortest turn; from below, after half a turn about x.
    quaternion = np.array([1 + z, y, -x, 0.0] if z >= 0 else [y, 1 - z, 0.0, x])
    return quaternion / np.linalg.norm(quaternion)


def strides_of(recording: Recording, rests: np.ndarray) -> list[tuple[int, int]]:
    """The first strides from one of these moments of rest to the next, in rows; none where there are few."""
    found: list[tuple[int, int]] = []
    for first, last in pairwise(map(int, rests)):
        force = np.linalg.norm(recording.accel[first : last + 1], axis=1)
        duration = float(recording.t[last] - recording.t[first])
        if STRIDE_S[0] < duration < STRIDE_S[1] and np.ptp(force) >= WALKING:
            found.append((first, last))
        if len(found) == STRIDES[1]:
            break
    return found if len(found) >= STRIDES[0] else []


def velocities_left(
    recording: Recording, strides: Sequence[tuple[int, int]], change: np.ndarray | None = None
) -> np.ndarray:
    """Velocity (k, 3) that each of `strides_of` leaves, over g times its duration, z up.

    change : (3, 3), applied to the rates first
    """
    gyro = recording.gyro if change is None else recording.gyro @ change.T
    left = np.empty((len(strides), 3))
    margin = max(1, round(0.02 / recording.interval))
    for place, (first, last) in enumerate(strides):
        rows = slice(first, last + 1)
        t = recording.t[rows]
        up = recording.accel[max(0, first - margin) : first + margin + 1].mean(axis=0)
        _, _, velocity = integrate(t, gyro[rows], recording.accel[rows], quaternion=upright(up))
        left[place] = velocity[-1] / (GRAVITY * (t[-1] - t[0]))
    return left


def misclosure(
    recording: Recording, strides: Sequence[tuple[int, int]], change: np.ndarray | None = None
) -> float:
    """Median over strides of the size of `velocities_left` (g)."""
    return float(np.median(np.linalg.norm(velocities_left(recording, strides, change), axis=1)))
