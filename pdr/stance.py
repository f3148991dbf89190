"""When the foot is on the ground at rest: footfalls, and the instants of zero velocity."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol

import numpy as np

from footfall.conventions import GRAVITY
from footfall.settings import require, setting


class Detector(Protocol):
    """Says how unquiet the foot is: at rest where the score is below 1, the quieter the lower.

    Takes t (n,) s, gyro (n, 3) rad/s and accel (n, 3) m/s2; returns (n,) scores >= 0 without unit
    (a statistic over its threshold).
    """

    def __call__(self, t: np.ndarray, gyro: np.ndarray, accel: np.ndarray) -> np.ndarray: ...


@dataclass(frozen=True)
class ThresholdDetector:
    """At rest where the rate is small and the force close to gravity, both averaged over a short window.

    Of some 9,000 simulated strides these thresholds missed none and doubled none.

    Attributes
    ----------
    gyro_max : rad/s
    accel_max : m/s2, deviation of the specific force's norm from g
    window_s : s
    """

    gyro_max: float = setting(math.radians(60.0), unit="rad/s", gt=0)
    accel_max: float = setting(4.0, unit="m/s2", gt=0)
    window_s: float = setting(0.020, unit="s", ge=0)

    def __post_init__(self) -> None:
        require("threshold", self)

    def __call__(self, t: np.ndarray, gyro: np.ndarray, accel: np.ndarray) -> np.ndarray:
        rate = np.linalg.norm(moving_mean(gyro, t, self.window_s), axis=1)
        force = np.linalg.norm(moving_mean(accel, t, self.window_s), axis=1)
        score = np.maximum(rate / self.gyro_max, np.abs(force - GRAVITY) / self.accel_max)
        return np.where(np.isnan(score), np.inf, score)


@dataclass(frozen=True)
class StanceParams:
    """How moments of rest become stances.

    Attributes
    ----------
    min_stance_s : s, shorter moments of rest are none
    min_stride_s : s, two stances closer than this are one (the quieter counts)
    reset_s : s, a stance longer than two of these is a still period with zero velocity this often
    """

    min_stance_s: float = setting(0.100, unit="s", ge=0)
    min_stride_s: float = setting(0.4, unit="s", ge=0)
    reset_s: float = setting(0.3, unit="s", gt=0, le=math.inf)

    def __post_init__(self) -> None:
        require("stance", self)


@dataclass(frozen=True)
class Stances:
    """Instants of zero velocity, and which of them are footfalls.

    Attributes
    ----------
    resets : (m,) sample index of each instant of zero velocity: one a stance, more in a still period
    footfalls : (k,) the footfalls' places in `resets`: one a stance; the last reset of a still period
    """

    resets: np.ndarray
    footfalls: np.ndarray


def moving_mean(values: np.ndarray, t: np.ndarray, window_s: float) -> np.ndarray:
    """Mean of (n, ...) values over a centred window of `window_s` seconds, cut at the record's ends.

    The window is one of time, not of samples, so that dropped samples and other rates change little. A mean
    over a value that is not finite is NaN; other windows do not feel it.
    """
    finite = np.isfinite(values)
    if not finite.all():
        share = moving_mean(finite.astype(float), t, window_s)
        return np.where(share < 1, np.nan, moving_mean(np.where(finite, values, 0.0), t, window_s))
    slack = 1e-6  # stamps are decimal numbers: a sample on the window's edge counts
    low = np.searchsorted(t, t - window_s / 2 - slack)
    high = np.searchsorted(t, t + window_s / 2 + slack)
    total = np.concatenate([np.zeros_like(values[:1]), np.cumsum(values, axis=0)])
    count = (high - low).reshape((-1,) + (1,) * (values.ndim - 1))
    return (total[high] - total[low]) / count


def find_stances(t: np.ndarray, score: np.ndarray, params: StanceParams | None = None) -> Stances:
    """Group moments of rest into stances and place the instants of zero velocity.

    Parameters
    ----------
    t : (n,) s
    score : (n,) of a `Detector`

    Notes
    -----
    A stance's velocity is zero once, at its quietest instant: the foot rolls on during stance, and more
    updates than one call that roll an error. Where the foot stands still, one update is too few: errors
    grow with the cube of the time between them.
    """
    params = params or StanceParams()
    kept: list[np.ndarray] = []
    for start, stop in runs(score < 1.0):
        if t[stop] - t[start] < params.min_stance_s:
            continue
        resets = _resets(t, score, start, stop, params.reset_s)
        if kept and t[resets[0]] - t[kept[-1][-1]] < params.min_stride_s:
            if score[resets].min() >= score[kept[-1]].min():
                continue
            kept.pop()
        kept.append(resets)
    counts = np.array([len(resets) for resets in kept], dtype=int)
    return Stances(
        resets=np.concatenate(kept) if kept else np.empty(0, dtype=int), footfalls=np.cumsum(counts) - 1
    )


def runs(flags: np.ndarray) -> np.ndarray:
    """First and last index of each run of true flags: (k, 2)."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]])))
    return edges.reshape(-1, 2) - [0, 1]


def _resets(t: np.ndarray, score: np.ndarray, start: int, stop: int, reset_s: float) -> np.ndarray:
    """The quietest instant of a stance, or of each part of a still period."""
    duration = t[stop] - t[start]
    parts = int(duration / reset_s) if duration > 2 * reset_s else 1
    edges = np.searchsorted(t[start : stop + 1], t[start] + np.arange(1, parts) * (duration / parts)) + start
    bounds = np.concatenate([[start], edges, [stop + 1]])
    # A gap in the samples may leave a part empty.
    return np.array([a + np.argmin(score[a:b]) for a, b in pairwise(bounds) if b > a])
