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
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from footfall.conventions import GRAVITY
from footfall.errors import InputError
from footfall.pdr.stance import Detector, ThresholdDetector
from footfall.settings import require, setting

_BARELY = math.nextafter(1.0, 0.0)  # at rest, but no candidate for the quietest instant
_SLACK = 1e-6  # s; stamps are decimal numbers: a sample on the window's edge counts


@dataclass(frozen=True)
class Windows:
    """The window that begins at each sample: samples [i, stop[i]) are within `window_s` of sample i.

    Attributes
    ----------
    stop : (n,) one past the last sample of each
    first : (n,) the first window that holds sample k; the last is k itself
    """

    stop: np.ndarray
    first: np.ndarray

    @classmethod
    def of(cls, t: np.ndarray, window_s: float) -> Windows:
        return cls(
            stop=np.searchsorted(t, t + window_s + _SLACK), first=np.searchsorted(t, t - window_s - _SLACK)
        )

    def mean(self, values: np.ndarray) -> np.ndarray:
        """Mean of (n, ...) values over each window."""
        total = np.concatenate([np.zeros_like(values[:1]), np.cumsum(values, axis=0)])
        start = np.arange(len(values))
        count = (self.stop - start).reshape((-1,) + (1,) * (values.ndim - 1))
        return (total[self.stop] - total[start]) / count

    def least(self, statistic: np.ndarray) -> np.ndarray:
        """For each sample the least (n,) statistic of the windows that hold it."""
        low, length = self.first, np.arange(len(statistic)) + 1 - self.first
        out = np.empty_like(statistic)
        # Minima over spans of 1, 2, 4, ... windows: any range is two of them.
        spans, span = statistic, 1
        while True:
            rows = np.flatnonzero((length >= span) & (length < 2 * span))
            out[rows] = np.minimum(spans[low[rows]], spans[rows + 1 - span])
            if 2 * span > length.max(initial=0):
                return out
            spans = np.minimum(spans[:-span], spans[span:])
            span *= 2


Statistic = Callable[[Windows, np.ndarray, np.ndarray], np.ndarray]


def scored(
    t: np.ndarray, gyro: np.ndarray, accel: np.ndarray, window_s: float, statistic: Statistic
) -> np.ndarray:
    """A detector's scores (n,).

    `statistic` gives, over its threshold, the value (n,) of the window that begins at each sample.
    """
    finite = np.isfinite(gyro).all(axis=1) & np.isfinite(accel).all(axis=1)
    windows = Windows.of(t, window_s)
    whole = finite.all()
    if not whole:
        gyro, accel = np.where(finite[:, None], gyro, 0.0), np.where(finite[:, None], accel, 0.0)
    value = np.maximum(statistic(windows, gyro, accel), 0.0)  # rounding
    if not whole:
        value = np.where(windows.mean(finite.astype(float)) < 1, np.inf, value)
    about = value[np.searchsorted(t, t - window_s / 2 - _SLACK)]
    return np.where((about >= 1) & (windows.least(value) < 1), _BARELY, about)


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
        def statistic(windows: Windows, gyro: np.ndarray, accel: np.ndarray) -> np.ndarray:
            # mean |f - g u|^2 = mean |f|^2 - 2 g |mean f| + g^2, for u is along the mean
            force = np.linalg.norm(windows.mean(accel), axis=1)
            off = windows.mean((accel**2).sum(axis=1)) - 2 * GRAVITY * force + GRAVITY**2
            turn = windows.mean((gyro**2).sum(axis=1))
            return (off / self.sigma_accel**2 + turn / self.sigma_gyro**2) / self.threshold

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
        return scored(
            t, gyro, accel, self.window_s, lambda w, gyro, _: w.mean((gyro**2).sum(axis=1)) / self.rate_max**2
        )


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
        def statistic(windows: Windows, _: np.ndarray, accel: np.ndarray) -> np.ndarray:
            spread = windows.mean((accel**2).sum(axis=1)) - (windows.mean(accel) ** 2).sum(axis=1)
            return spread / self.sd_max**2

        return scored(t, gyro, accel, self.window_s, statistic)


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
        def statistic(windows: Windows, _: np.ndarray, accel: np.ndarray) -> np.ndarray:
            off = np.linalg.norm(accel, axis=1) - GRAVITY
            return windows.mean(off**2) / self.off_max**2

        return scored(t, gyro, accel, self.window_s, statistic)


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
        def statistic(windows: Windows, gyro: np.ndarray, accel: np.ndarray) -> np.ndarray:
            turn = np.sqrt(windows.mean((gyro**2).sum(axis=1)))
            force = np.sqrt(windows.mean((np.linalg.norm(accel, axis=1) - GRAVITY) ** 2))
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


def _ninth(size: np.ndarray) -> float:
    """The 90th percentile; 0 of nothing, in a gap."""
    place = int(0.9 * (len(size) - 1))
    return float(np.partition(size, place)[place]) if len(size) else 0.0


SWING_RATE = 2.0  # rad/s
SWING_FORCE = 4.0  # m/s2

DETECTORS: Mapping[str, Detector] = MappingProxyType(
    {
        "threshold": ThresholdDetector(),
        "shoe": Shoe(),
        "are": AngularRateEnergy(),
        "mv": MovingVariance(),
        "mag": Magnitude(),
        "adaptive": Adaptive(),
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
