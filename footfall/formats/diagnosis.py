"""What is wrong where strides do not close: units, axes, a sensor that lags, a clock or a scale.

Each cause is tried, and the one with which strides close is named. A lag and a wrong clock (or gyros' scale,
which is the same to mechanics) show in the vertical velocity that strides leave. Nine real walks leave .001
to .005 g there as they are. 10 ms of lag add .005 to .025, a clock that is 3 % off .006 to .028.
Biases of accelerometers show there too, those of phones up to .025.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from footfall.columns import ACCEL, GYRO
from footfall.conventions import GRAVITY
from footfall.formats.closure import misclosure, resting_force, rests_of, strides_of, velocities_left
from footfall.recording import Recording

MISCLOSURE = (0.02, 0.16)  # g: above the first a cause is sought, above the second none need be found
RISE = 0.012  # g, vertical velocity that strides leave: above it a lag or a wrong clock is sought
MISFIT = 0.04  # g, of the whole velocity: likewise
LAG_S = 0.015  # a smaller one may be a bias of the accelerometers
SCALE = 0.045  # likewise, from 1
CLOSED = (0.0045, 0.055)  # g, along the vertical and in all: no more is left where the cause is the cause
CLEARLY = 1.5  # times by which one cause must close strides better than the other, or both are named
BIASED = 0.03  # g, of the vertical velocity: so much biases may explain
MENDED = (0.015, 0.25)  # g, and share of it that is left, for a lag to be put right
LEVEL = 0.05  # share of g by which the force at rest may differ for the accelerometers not to be the cause
_LAGS = np.arange(-0.12, 0.121, 0.01)  # s
_SCALES = np.array([0.4, 0.5, 0.63, 0.8, 0.9, 1.0, 1.1, 1.25, 1.6, 2.0, 2.5])
_BEFORE_S, _AFTER_S = 5.0, 0.3  # with the strides: there the force is that of rest


@dataclass(frozen=True)
class Fit:
    """The lag (s, of the gyros) or the scale (of the rates) with which strides close best.

    Attributes
    ----------
    value : s, or a factor
    rise : g, median size of the vertical velocity that is left with it
    misclosure : g, of the whole velocity
    """

    value: float
    rise: float
    misclosure: float

    @property
    def left(self) -> float:
        """By how much strides do not close (g): along the vertical above all, where it is known best."""
        return self.rise + self.misclosure / 20

    @classmethod
    def of(cls, value: float, recording: Recording, strides: Sequence[tuple[int, int]]) -> Fit:
        """Of a recording that was changed by that value."""
        if not strides:
            return cls(value, math.inf, math.inf)
        level = GRAVITY / resting_force(recording.t, recording.gyro, recording.accel)
        left = velocities_left(replace(recording, accel=recording.accel * level), strides)
        rise = float(np.median(np.abs(left[:, 2])))
        return cls(value, rise, float(np.median(np.linalg.norm(left, axis=1))))


@dataclass(frozen=True)
class Diagnosis:
    """How well a recording's strides close, and what is likely to be wrong.

    Attributes
    ----------
    misclosure : g, median over strides of the velocity left over its duration
    cause : in words; "" where none was found
    swapped : whether that is a unit or an axis, with which no track is right
    lag_s : s by which the gyros are late, where that is the cause beyond doubt; else 0
    """

    misclosure: float
    cause: str = ""
    swapped: bool = False
    lag_s: float = 0.0


def diagnose(recording: Recording, clipped: bool = False) -> Diagnosis | None:
    """Judge how strides close, and seek the cause where they do not; None where too few strides are seen.

    clipped : whether samples are known to be clipped, which opens strides too: no lag or clock is named then
    """
    strides = strides_of(recording, rests_of(recording))
    if not strides:
        return None
    found = Diagnosis(misclosure(recording, strides))
    changed, least = "", math.inf
    if found.misclosure > MISCLOSURE[0]:
        left = {cause: misclosure(recording, strides, change) for cause, change in CHANGES.items()}
        changed = min(left, key=left.__getitem__)
        least = left[changed] if left[changed] <= found.misclosure / 2 else math.inf
    if not clipped or least < math.inf:
        late = _late_or_scaled(recording, strides, found, least)
        if late.cause:
            return found if clipped else late
    return found if least == math.inf else replace(found, cause=changed, swapped=True)


def unlagged(recording: Recording, lag_s: float) -> Recording:
    """With the gyros heard `lag_s` earlier, where both sensors have said something."""
    at = recording.t + lag_s
    both = (at >= recording.t[0]) & (at <= recording.t[-1])
    gyro = np.column_stack([np.interp(at[both], recording.t, axis) for axis in recording.gyro.T])
    warm = None if recording.temperature is None else recording.temperature[both]
    return replace(recording, t=recording.t[both], gyro=gyro, accel=recording.accel[both], temperature=warm)


def told_lag(lag_s: float) -> str:
    """Which sensor is late, and by how much, in words."""
    sensors = ("gyros", "accelerometers") if lag_s > 0 else ("accelerometers", "gyros")
    return f"the {sensors[0]} are {1000 * abs(lag_s):.3g} ms later than the {sensors[1]}"


def _late_or_scaled(
    recording: Recording, strides: Sequence[tuple[int, int]], found: Diagnosis, least: float
) -> Diagnosis:
    """With a lag or a scale as the cause, where with it strides close better than to `least` (g)."""
    part, moved = _opening(recording, strides)
    force = resting_force(part.t, part.gyro, part.accel)
    if abs(force / GRAVITY - 1) > LEVEL:
        told = f"the accelerometers are off: they measure {force:.3g} m/s2 at rest"
        return replace(found, cause="" if least < math.inf else told)
    rise = Fit.of(0.0, part, moved).rise
    if rise < RISE and found.misclosure <= MISFIT:
        return found
    lag, scale = _fits(part, moved)
    best = min(lag, scale, key=lambda one: one.left)
    if best.rise > min(rise / 2, CLOSED[0]) or best.misclosure > min(
        least, CLOSED[1], 1.1 * found.misclosure
    ):
        return found
    likely = lag.left < CLEARLY * best.left, scale.left < CLEARLY * best.left
    beyond = abs(lag.value) >= LAG_S, abs(scale.value - 1) >= SCALE
    if not (likely[0] and beyond[0]) and not (likely[1] and beyond[1]):
        return found
    if not likely[1]:
        sure = rise >= MENDED[0] and lag.rise <= MENDED[1] * rise
        return replace(found, cause=told_lag(lag.value), lag_s=lag.value if sure else 0.0)
    rate = 1 / part.interval
    causes = [told_lag(lag.value)] if likely[0] else []
    causes.append(f"samples came at {rate / scale.value:.3g} Hz, not {rate:.3g}")
    causes.append(f"the rates are {1 / scale.value:.2f} times what they should be")
    if likely[0] or rise < BIASED:
        causes.append("a sensor is biased")
    return replace(found, cause=", or ".join(causes))


def _fits(part: Recording, strides: Sequence[tuple[int, int]]) -> tuple[Fit, Fit]:
    """The lag and the scale with which these strides close best."""

    def late(lag: float) -> Fit:
        one = unlagged(part, lag)
        return Fit.of(lag, one, strides_of(one, rests_of(one)))

    def scaled(scale: float) -> Fit:
        return Fit.of(scale, replace(part, gyro=part.gyro * scale), strides)

    lag, scale = _best(late, _LAGS), _best(scaled, _SCALES)
    for step in (0.0025, 0.001):
        lag = _best(late, lag.value + step * np.arange(-3, 4))
    for step in (0.01, 0.002):
        scale = _best(scaled, scale.value * (1 + step * np.arange(-12, 13)))
    return lag, scale


def _opening(
    recording: Recording, strides: Sequence[tuple[int, int]]
) -> tuple[Recording, list[tuple[int, int]]]:
    """The part of the recording that holds these strides, and them in it."""
    first = max(0, strides[0][0] - round(_BEFORE_S / recording.interval))
    rows = slice(first, strides[-1][1] + round(_AFTER_S / recording.interval))
    part = Recording(recording.t[rows], recording.gyro[rows], recording.accel[rows])
    return part, [(begin - first, end - first) for begin, end in strides]


def _best(fit: Callable[[float], Fit], values: np.ndarray) -> Fit:
    """The fit that leaves least."""
    return min((fit(float(value)) for value in values), key=lambda one: one.left)


def _exchanged(order: Sequence[int]) -> np.ndarray:
    return np.eye(3)[list(order)]


_PAIRS = {(0, 1): (1, 0, 2), (0, 2): (2, 1, 0), (1, 2): (0, 2, 1)}
_ROUND = {"y, z, x": (1, 2, 0), "z, x, y": (2, 0, 1)}

# Cause -> what would have to be done to the rates. An accelerometer that is turned mirrors the body's axes:
# rates that fit it have the other two axes turned. Exchanging two axes mirrors them too.
CHANGES: Mapping[str, np.ndarray] = {
    "the gyros are probably in deg/s": np.eye(3) * math.pi / 180,
    "the gyros are probably in revolutions a minute": np.eye(3) * math.pi / 30,
    "the gyros are probably in revolutions a second": np.eye(3) * math.pi * 2,
    "the gyros are probably in rad/s, and were taken for deg/s": np.eye(3) * 180 / math.pi,
    "the gyros probably turn the other way about every axis": -np.eye(3),
    **{
        f"{name} probably turns the other way": np.diag(np.where(np.arange(3) == axis, -1.0, 1.0))
        for axis, name in enumerate(GYRO)
    },
    **{
        f"{name} probably has the other sign": np.diag(np.where(np.arange(3) == axis, 1.0, -1.0))
        for axis, name in enumerate(ACCEL)
    },
    **{
        f"the gyros' {'xyz'[a]} and {'xyz'[b]} are probably exchanged": _exchanged(order)
        for (a, b), order in _PAIRS.items()
    },
    **{
        f"the accelerometers' {'xyz'[a]} and {'xyz'[b]} are probably exchanged": -_exchanged(order)
        for (a, b), order in _PAIRS.items()
    },
    **{
        f"the gyros' x, y, z are probably the accelerometers' {told}": _exchanged(order).T
        for told, order in _ROUND.items()
    },
}
