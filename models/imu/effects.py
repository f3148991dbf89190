"""The error effects of gyros and accelerometers, in the order in which a sensor suffers them."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.signal import butter, lfilter, sosfilt, sosfilt_zi

from footfall.errors import InputError
from footfall.models.imu.unit import TriadUnit

# A Gauss-Markov process per decade of correlation time, each of standard deviation .856 B, adds up to an
# Allan deviation of .664 B: within 3 % from 1 s to 3,000 s.
FLICKER_TIMES = (0.1, 1.0, 10.0, 100.0, 1e3, 1e4)
FLICKER_SHARE = 0.856


@dataclass(frozen=True)
class Channel:
    """What the effects of one triad may look at.

    Attributes
    ----------
    unit : the triad's constants
    true : (n, 3) what a perfect triad says, rad/s or m/s2
    force : (n, 3) m/s2, the true specific force
    warmth : (n,) K, the die above the sheet's reference temperature
    interval : s between samples
    stream : name of a noise -> its generator
    """

    unit: TriadUnit
    true: np.ndarray
    force: np.ndarray
    warmth: np.ndarray
    interval: float
    stream: Callable[[str], np.random.Generator]


Effect = Callable[[np.ndarray, Channel], np.ndarray]


def scale(x: np.ndarray, channel: Channel) -> np.ndarray:
    return x + channel.true * channel.unit.scale


def misalignment(x: np.ndarray, channel: Channel) -> np.ndarray:
    return x + channel.true @ channel.unit.misalignment.T


def non_linearity(x: np.ndarray, channel: Channel) -> np.ndarray:
    """Deviation of each axis from the best straight line through its range: n FS T3(x / FS).

    T3(u) = 4 u^3 - 3 u, the third Chebyshev polynomial: the cubic whose best line is zero, so that a
    calibrated scale factor leaves it. It is as far off at full scale as, the other way, at half of it.
    """
    full_scale = channel.unit.spec.range
    u = np.clip(channel.true / full_scale, -1, 1)  # what lies beyond is clipped later
    return x + channel.unit.non_linearity * full_scale * (4 * u**3 - 3 * u)


def g_sensitivity(x: np.ndarray, channel: Channel) -> np.ndarray:
    return x + channel.force @ channel.unit.g.T


def g2(x: np.ndarray, channel: Channel) -> np.ndarray:
    return x + channel.force**2 @ channel.unit.g2.T


def temperature(x: np.ndarray, channel: Channel) -> np.ndarray:
    warmth = channel.warmth[:, None]
    return x + channel.unit.temperature * warmth + channel.unit.temperature2 * warmth**2


def turn_on(x: np.ndarray, channel: Channel) -> np.ndarray:
    return x + channel.unit.spec.turn_on_sigma * channel.stream("turn_on").standard_normal(3)


def flicker(x: np.ndarray, channel: Channel) -> np.ndarray:
    sigma = FLICKER_SHARE * channel.unit.spec.flicker
    return x + sum(
        gauss_markov(sigma, tau, x.shape, channel.interval, channel.stream(f"flicker.{tau:g}"))
        for tau in FLICKER_TIMES
    )


def rate_random_walk(x: np.ndarray, channel: Channel) -> np.ndarray:
    step = channel.unit.spec.random_walk * math.sqrt(channel.interval)
    return x + step * np.cumsum(channel.stream("rate_random_walk").standard_normal(x.shape), axis=0)


def bandwidth(x: np.ndarray, channel: Channel) -> np.ndarray:
    """Second-order Butterworth low-pass, causal, started in the steady state of the first sample.

    Its delay is the real one (3.5 ms for 50 Hz at 200 Hz), the same for gyros and accelerometers of one
    bandwidth. A bandwidth beyond half the sampling rate is none: there is nothing left to cut.
    """
    cutoff, rate = channel.unit.spec.bandwidth, 1 / channel.interval
    if cutoff >= rate / 2:
        return x
    sos = butter(2, cutoff, fs=rate, output="sos")
    filtered, _ = sosfilt(sos, x, axis=0, zi=sosfilt_zi(sos)[:, :, None] * x[0])
    return filtered


def white(x: np.ndarray, channel: Channel) -> np.ndarray:
    sigma = channel.unit.spec.white / math.sqrt(channel.interval)
    return x + sigma * channel.stream("white").standard_normal(x.shape)


def saturation(x: np.ndarray, channel: Channel) -> np.ndarray:
    return np.clip(x, -channel.unit.spec.range, channel.unit.spec.range)


def quantisation(x: np.ndarray, channel: Channel) -> np.ndarray:
    step = channel.unit.spec.resolution
    return np.round(x / step) * step


def gauss_markov(
    sigma: float, tau: float, shape: tuple[int, ...], interval: float, rng: np.random.Generator
) -> np.ndarray:
    """First-order Gauss-Markov process along axis 0, started from its stationary law.

    b' = exp(-dt/tau) b + sigma sqrt(1 - exp(-2 dt/tau)) n. A start from zero would make the first minutes
    too good.
    """
    drive = sigma * rng.standard_normal(shape)
    drive[1:] *= math.sqrt(-math.expm1(-2 * interval / tau))
    return lfilter([1.0], [1.0, -math.exp(-interval / tau)], drive, axis=0)


# Name -> (the effect, the numbers that make it: where all are zero, the triad does not have it).
# The order is the order in the sensor.
_CHAIN: dict[str, tuple[Effect, Callable[[TriadUnit], ArrayLike]]] = {
    "scale": (scale, lambda unit: unit.scale),
    "misalignment": (misalignment, lambda unit: unit.misalignment),
    "non_linearity": (non_linearity, lambda unit: unit.non_linearity),
    "g_sensitivity": (g_sensitivity, lambda unit: unit.g),
    "g2": (g2, lambda unit: unit.g2),
    "temperature": (temperature, lambda unit: (unit.temperature, unit.temperature2)),
    "turn_on": (turn_on, lambda unit: unit.spec.turn_on_sigma),
    "flicker": (flicker, lambda unit: unit.spec.flicker),
    "rate_random_walk": (rate_random_walk, lambda unit: unit.spec.random_walk),
    "bandwidth": (bandwidth, lambda unit: 1 / unit.spec.bandwidth),
    "white": (white, lambda unit: unit.spec.white),
    "saturation": (saturation, lambda unit: 1 / unit.spec.range),
    "quantisation": (quantisation, lambda unit: unit.spec.resolution),
}
EFFECTS = tuple(_CHAIN)


def require_effects(names: Collection[str]) -> None:
    """Raise InputError when a name is not one of `EFFECTS`."""
    for name in names:
        if name not in EFFECTS:
            raise InputError(f"effect {name!r} does not exist (expected {', '.join(EFFECTS)})")


def stages(channel: Channel, without: Collection[str] = ()) -> Iterator[tuple[str, np.ndarray]]:
    """The signal after each effect, in order; the last is what the triad says.

    An effect that is switched off, or that the triad does not have, passes the signal on untouched, bit for
    bit, and leaves every other effect's random draws as they are.

    Yields
    ------
    name of the effect, (n, 3) signal
    """
    require_effects(without)
    x = channel.true
    for name, (effect, numbers) in _CHAIN.items():
        if name not in without and np.any(numbers(channel.unit)):
            x = effect(x, channel)
        yield name, x
