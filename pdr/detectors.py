"""Zero-velocity detectors by name. All answer alike: a score without unit, below 1 where the foot is at rest.

Each statistic is a mean over a window of time, so that no threshold depends on the sampling rate (papers sum
over N samples: their threshold is N times larger). Windows overlap: a sample is at rest when any window that
holds it is (as in OpenShoe), and the score is that of the window about it. Windows end where the record ends,
and in a gap they hold fewer samples. A window with a sample that is not finite is not at rest.

Detectors: Skog et al. (2010), "Zero-velocity detection - an algorithm evaluation", IEEE Trans. Biomed. Eng.
57(11); the GLRT in the form of Deng et al. (2018), Eq. 14-19.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from footfall.conventions import GRAVITY
from footfall.errors import InputError
from footfall.late import late
from footfall.pdr.stance import Detector, ThresholdDetector, compact
from footfall.runs import runs
from footfall.settings import require, setting

_detection = late("footfall.pdr._detection")


class Means(NamedTuple):
    """Means (n,) over the window that begins at each sample.

    Attributes
    ----------
    x, y, z : m/s2, force
    force2 : (m/s2)^2, square of the force
    rate2 : (rad/s)^2, square of the rate
    off2 : (m/s2)^2, square of the deviation of the force's norm from g
    """

    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    force2: np.ndarray
    rate2: np.ndarray
    off2: np.ndarray

    @property
    def along2(self) -> np.ndarray:
        """(m/s2)^2, square of the mean force."""
        return self.x**2 + self.y**2 + self.z**2


def scored(
    t: np.ndarray,
    gyro: np.ndarray,
    accel: np.ndarray,
    window_s: float,
    statistic: Callable[[Means], np.ndarray],
) -> np.ndarray:
    """A detector's scores (n,).

    `statistic` gives, over its threshold, the value (n,) of the window that begins at each sample.
    """
    found, whole = _detection.means(compact(t), compact(gyro), compact(accel), window_s)
    if not whole:
        finite = (np.isfinite(gyro) & np.isfinite(accel)).all(axis=1)
        gyro, accel = np.where(finite[:, None], gyro, 0.0), np.where(finite[:, None], accel, 0.0)
        found, _ = _detection.means(compact(t), gyro, accel, window_s)
    value = np.maximum(statistic(Means(*found)), 0.0)  # rounding
    if not whole:
        lost = np.concatenate([[0], np.cumsum(~finite)])
        value[lost[np.searchsorted(t, t + window_s + _detection.SLACK)] > lost[:-1]] = np.inf
    return np.asarray(_detection.held(compact(t), compact(value), window_s))


@dataclass(frozen=True)
class Shoe:
    """SHOE, the generalised likelihood ratio (GLRT) of "at rest" (Deng Eq. 14-19; Skog et al.).

    T = mean of |f_k - g u|^2 / sigma_accel^2 + |w_k|^2 / sigma_gyro^2, u the direction of the window's mean
    force.

    Attributes
    ----------
    sigma_accel : m/s2, noise of the accelerometers (OpenShoe's)
    sigma_gyro : rad/s, noise of the gyros (OpenShoe's)
    threshold : of T, without unit; Deng's th_G is N times as much
    window_s : s
    """

    sigma_accel: float = setting(0.01, unit="m/s2", gt=0)
    sigma_gyro: float = setting(math.radians(0.1), unit="rad/s", gt=0)
    threshold: float = setting(2e5, gt=0)
    window_s: float = setting(0.020, unit="s", ge=0)

    def __post_init__(self) -> None:
        require("shoe", self)

    def __call__(self, t: np.ndarray, gyro: np.ndarray, accel: np.ndarray) -> np.ndarray:
        def statistic(mean: Means) -> np.ndarray:
            # mean |f - g u|^2 = mean |f|^2 - 2 g |mean f| + g^2, for u is along the mean
            off = mean.force2 - 2 * GRAVITY * np.sqrt(mean.along2) + GRAVITY**2
            return (off / self.sigma_accel**2 + mean.rate2 / self.sigma_gyro**2) / self.threshold

        return scored(t, gyro, accel, self.window_s, statistic)


@dataclass(frozen=True)
class AngularRateEnergy:
    """ARE: the mean square of the rate (Skog et al.).

    Attributes
    ----------
    rate_max : rad/s, RMS over the window
    window_s : s
    """

    rate_max: float = setting(math.radians(50.0), unit="rad/s", gt=0)
    window_s: float = setting(0.020, unit="s", ge=0)

    def __post_init__(self) -> None:
        require("are", self)

    def __call__(self, t: np.ndarray, gyro: np.ndarray, accel: np.ndarray) -> np.ndarray:
        return scored(t, gyro, accel, self.window_s, lambda mean: mean.rate2 / self.rate_max**2)


@dataclass(frozen=True)
class MovingVariance:
    """MV: the variance of the specific force within the window (Skog et al.).

    It takes any steady force for rest, so a short window finds rest in swing.

    Attributes
    ----------
    sd_max : m/s2, standard deviation of the force vector over the window
    window_s : s
    """

    sd_max: float = setting(1.0, unit="m/s2", gt=0)
    window_s: float = setting(0.150, unit="s", ge=0)

    def __post_init__(self) -> None:
        require("mv", self)

    def __call__(self, t: np.ndarray, gyro: np.ndarray, accel: np.ndarray) -> np.ndarray:
        return scored(
            t, gyro, accel, self.window_s, lambda mean: (mean.force2 - mean.along2) / self.sd_max**2
        )


@dataclass(frozen=True)
class Magnitude:
    """MAG: the mean square of the deviation of the force's norm from g (Skog et al.).

    The least sure of all: the norm passes g in swing, and a fast stance is too short for a window that is
    long enough to see that.

    Attributes
    ----------
    off_max : m/s2, RMS over the window
    window_s : s
    """

    off_max: float = setting(0.5, unit="m/s2", gt=0)
    window_s: float = setting(0.200, unit="s", ge=0)

    def __post_init__(self) -> None:
        require("mag", self)

    def __call__(self, t: np.ndarray, gyro: np.ndarray, accel: np.ndarray) -> np.ndarray:
        return scored(t, gyro, accel, self.window_s, lambda mean: mean.off2 / self.off_max**2)


@dataclass(frozen=True)
class Adaptive:
    """At rest where rate and force are small beside those of the swings around: nothing to set for a pace.

    The threshold of each is a share of its swing level, the 90th percentile over the seconds around. A foot
    that stands still has no swings: there the level is held up by that of the fastest swings of the record,
    and by what any swing has.

    Attributes
    ----------
    share : of the swing level
    around_s : s, over which swings are looked at: more than a stride
    held : share of the record's highest level below which no level falls
    window_s : s
    """

    share: float = setting(0.2, gt=0)
    around_s: float = setting(3.0, unit="s", gt=0)
    held: float = setting(0.2, ge=0)
    window_s: float = setting(0.020, unit="s", ge=0)

    def __post_init__(self) -> None:
        require("adaptive", self)

    def __call__(self, t: np.ndarray, gyro: np.ndarray, accel: np.ndarray) -> np.ndarray:
        def statistic(mean: Means) -> np.ndarray:
            turn, force = np.sqrt(mean.rate2), np.sqrt(mean.off2)
            return np.maximum(
                turn / (self.share * self._level(t, turn, SWING_RATE)),
                force / (self.share * self._level(t, force, SWING_FORCE)),
            )

        return scored(t, gyro, accel, self.window_s, statistic)

    def _level(self, t: np.ndarray, size: np.ndarray, least: float) -> np.ndarray:
        """Swing level (n,) of a (n,) size: never below `least`, which any swing has."""
        every = np.arange(t[0], t[-1] + self.around_s / 12, self.around_s / 12)
        first = np.searchsorted(t, every - self.around_s / 2)
        last = np.maximum(np.searchsorted(t, every + self.around_s / 2), first + 1)
        high = np.array([_ninth(size[a:b]) for a, b in zip(first, last, strict=True)])
        return np.interp(t, every, np.maximum(high, max(self.held * high.max(), least)))


@dataclass(frozen=True)
class Patient:
    """Threshold; where that finds no rest for longer than a swing lasts, adaptive, ever less demanding.

    Where the thresholds find every stance the scores are theirs; people who walk faster than those allow have
    theirs found all the same.

    Attributes
    ----------
    threshold, adaptive : the two detectors
    longest_s : s between rests that one swing may last; slow walkers' lasts 1.1 s
    """

    threshold: ThresholdDetector = field(default_factory=ThresholdDetector)
    adaptive: Adaptive = field(default_factory=Adaptive)
    longest_s: float = setting(1.2, unit="s", gt=0)

    def __post_init__(self) -> None:
        require("patient", self)

    def __call__(self, t: np.ndarray, gyro: np.ndarray, accel: np.ndarray) -> np.ndarray:
        score = self.threshold(t, gyro, accel)
        if len(t) < 2 or not len(self._movements(t, score)):
            return score
        other = self.adaptive(t, gyro, accel)
        score = score.copy()
        for less in LESS_DEMANDING:
            for first, stop in self._movements(t, score):
                score[first:stop] = np.minimum(score[first:stop], other[first:stop] / less)
        return score

    def _movements(self, t: np.ndarray, score: np.ndarray) -> np.ndarray:
        """(k, 2) rows between rests that are further apart than a swing lasts."""
        rests = runs(score < 1.0)
        rests = rests[t[rests[:, 1] - 1] - t[rests[:, 0]] >= LEAST_REST_S]
        edges = np.concatenate([[0], rests.ravel(), [len(t)]]).reshape(-1, 2)
        ends = np.minimum(edges[:, 1], len(t) - 1)
        return edges[t[ends] - t[np.minimum(edges[:, 0], len(t) - 1)] > self.longest_s]


def _ninth(size: np.ndarray) -> float:
    """The 90th percentile; 0 of nothing, in a gap."""
    place = int(0.9 * (len(size) - 1))
    return float(np.partition(size, place)[place]) if len(size) else 0.0


SWING_RATE = 2.0  # rad/s
SWING_FORCE = 4.0  # m/s2
LESS_DEMANDING = (1.0, 1.6, 2.5)  # by which the adaptive detector's thresholds grow
LEAST_REST_S = 0.1  # shorter moments of rest are none, as for `StanceParams`

DETECTORS: Mapping[str, Detector] = MappingProxyType(
    {
        "threshold": ThresholdDetector(),
        "shoe": Shoe(),
        "are": AngularRateEnergy(),
        "mv": MovingVariance(),
        "mag": Magnitude(),
        "adaptive": Adaptive(),
        "patient": Patient(),
    }
)


def summary(detector: Detector) -> str:
    """What it is, in a line."""
    return (type(detector).__doc__ or "").partition("\n")[0].rstrip(".")


def require_detector(name: str) -> Detector:
    """The detector of that name, as it comes.

    Raises
    ------
    InputError
        There is none.
    """
    if name not in DETECTORS:
        raise InputError(f"detector {name!r} is unknown, expected one of {', '.join(DETECTORS)}")
    return DETECTORS[name]
