"""When the foot is on the ground at rest: footfalls, and the instants of zero velocity."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from footfall.late import late
from footfall.settings import require, setting

_detection = late("footfall.pdr._detection")


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
        score, whole = self._score(t, gyro, accel)
        if whole:
            return score
        finite = np.isfinite(gyro), np.isfinite(accel)
        score, _ = self._score(t, np.where(finite[0], gyro, 0.0), np.where(finite[1], accel, 0.0))
        share = moving_mean(np.hstack(finite).all(axis=1).astype(float), t, self.window_s)
        return np.where(share < 1, np.inf, score)

    def _score(self, t: np.ndarray, gyro: np.ndarray, accel: np.ndarray) -> tuple[np.ndarray, bool]:
        """The score, and whether it means something: whether all sums were finite."""
        score, whole = _detection.threshold(
            compact(t), compact(gyro), compact(accel), self.window_s, self.gyro_max, self.accel_max
        )
        return score, whole


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


def compact(values: np.ndarray) -> np.ndarray:
    """Values as the kernels take them, floats row by row: the same array where it is that."""
    return np.ascontiguousarray(values, dtype=float)


def moving_mean(values: np.ndarray, t: np.ndarray, window_s: float) -> np.ndarray:
    """Mean of (n, ...) values over a centred window of `window_s` seconds, cut at the record's ends.

    The window is one of time, not of samples, so that dropped samples and other rates change little. A mean
    over a value that is not finite is NaN; other windows do not feel it.
    """
    finite = np.isfinite(values)
    if not finite.all():
        share = moving_mean(finite.astype(float), t, window_s)
        return np.where(share < 1, np.nan, moving_mean(np.where(finite, values, 0.0), t, window_s))
    low = np.searchsorted(t, t - window_s / 2 - _detection.SLACK)
    high = np.searchsorted(t, t + window_s / 2 + _detection.SLACK)
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
    resets, footfalls = _detection.stances(
        compact(t), compact(score), params.min_stance_s, params.min_stride_s, params.reset_s
    )
    return Stances(resets=resets, footfalls=footfalls)
