"""The error effects of gyros and accelerometers, in the order in which they act."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from footfall.late import late
from footfall.models.imu.names import EFFECTS, require_effects
from footfall.models.imu.unit import ImuUnit, TriadUnit
from footfall.streams import stream

_kernels = late("footfall.models.imu._kernels")

# A Gauss-Markov process per decade of correlation time, each of standard deviation .856 B, adds up to an
# Allan deviation of .664 B: within 3 % from 1 s to 3,000 s.
FLICKER_TIMES = (0.1, 1.0, 10.0, 100.0, 1e3, 1e4)
FLICKER_SHARE = 0.856


@dataclass(frozen=True)
class Channel:
    """What the effects of one triad depend on.

    Attributes
    ----------
    unit : the triad's constants
    true : (n, 3) what a perfect triad measures, rad/s or m/s2
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

    @classmethod
    def of(
        cls,
        unit: ImuUnit,
        sensor: str,
        true: np.ndarray,
        *,
        force: np.ndarray,
        die: np.ndarray,
        interval: float,
        seed: int,
    ) -> Channel:
        """The channel of the "gyro" or the "accel" of `unit`; `die` (n,) degC, `seed` of the noises."""
        return cls(
            unit=getattr(unit, sensor),
            true=true,
            force=force,
            warmth=die - unit.spec.thermal.reference,
            interval=interval,
            stream=lambda noise: stream(seed, f"noise.{sensor}.{noise}"),
        )


# Adds an error to the signal (n, 3), or alters it, in place.
Effect = Callable[[np.ndarray, Channel], None]


def scale(x: np.ndarray, channel: Channel) -> None:
    _kernels.add_linear(x, np.diag(channel.unit.scale), channel.true)


def misalignment(x: np.ndarray, channel: Channel) -> None:
    _kernels.add_linear(x, channel.unit.misalignment, channel.true)


def non_linearity(x: np.ndarray, channel: Channel) -> None:
    """Deviation of each axis from the best straight line through its range: n FS T3(x / FS).

    T3(u) = 4 u^3 - 3 u, the third Chebyshev polynomial: the cubic whose best line is zero, so that a
    calibrated scale factor leaves it. At half of full scale it is minus what it is at full scale.
    """
    full_scale = channel.unit.spec.range
    _kernels.add_cubic(x, channel.unit.non_linearity * full_scale, full_scale, channel.true)


def g_sensitivity(x: np.ndarray, channel: Channel) -> None:
    _kernels.add_linear(x, channel.unit.g, channel.force)


def g2(x: np.ndarray, channel: Channel) -> None:
    _kernels.add_quadratic(x, channel.unit.g2, channel.force)


def temperature(x: np.ndarray, channel: Channel) -> None:
    _kernels.add_parabola(x, channel.unit.temperature, channel.unit.temperature2, channel.warmth)


def turn_on(x: np.ndarray, channel: Channel) -> None:
    unit_size = channel.stream("turn_on").standard_normal(3)
    for axis, normal in zip(x.T, unit_size, strict=True):
        axis += channel.unit.spec.turn_on_sigma * normal


def flicker(x: np.ndarray, channel: Channel) -> None:
    sigma = FLICKER_SHARE * channel.unit.spec.flicker
    for tau in FLICKER_TIMES:
        gauss_markov(x, sigma, tau, channel.interval, channel.stream(f"flicker.{tau:g}"))


def rate_random_walk(x: np.ndarray, channel: Channel) -> None:
    step = channel.unit.spec.random_walk * math.sqrt(channel.interval)
    _kernels.add_noise(x, step, 1.0, 1.0, 1.0, channel.stream("rate_random_walk"))


def bandwidth(x: np.ndarray, channel: Channel) -> None:
    """Second-order Butterworth low-pass, causal, started in the steady state of the first sample.

    Its delay is the real one (3.5 ms for 50 Hz at 200 Hz), the same for gyros and accelerometers of one
    bandwidth. A bandwidth beyond half the sampling rate changes nothing.
    """
    if channel.unit.spec.bandwidth < 0.5 / channel.interval:
        _kernels.low_pass(x, *butterworth(channel.unit.spec.bandwidth * channel.interval))


def white(x: np.ndarray, channel: Channel) -> None:
    sigma = channel.unit.spec.white / math.sqrt(channel.interval)
    _kernels.add_noise(x, sigma, 1.0, 0.0, 1.0, channel.stream("white"))


def saturation(x: np.ndarray, channel: Channel) -> None:
    np.clip(x, -channel.unit.spec.range, channel.unit.spec.range, out=x)


def quantisation(x: np.ndarray, channel: Channel) -> None:
    x /= channel.unit.spec.resolution
    np.rint(x, out=x)
    x *= channel.unit.spec.resolution


def gauss_markov(
    x: np.ndarray, sigma: float, tau: float, interval: float, generator: np.random.Generator
) -> None:
    """Add a first-order Gauss-Markov process to each axis, started from its stationary distribution.

    b' = exp(-dt/tau) b + sqrt(1 - exp(-2 dt/tau)) n, scaled by sigma. A start from zero would make the first
    minutes too good.
    """
    drive = math.sqrt(-math.expm1(-2 * interval / tau))
    _kernels.add_noise(x, sigma, 1.0, math.exp(-interval / tau), drive, generator)


def butterworth(cutoff: float) -> tuple[float, float, float, float, float]:
    """b0, b1, b2, a1, a2 of the second-order low-pass; `cutoff` in cycles a sample, below one half.

    The analogue 1 / (s^2 + sqrt(2) s + 1) by the bilinear transform, prewarped at the corner.
    """
    k = math.tan(math.pi * cutoff)
    norm = 1 + math.sqrt(2) * k + k * k
    gain = k * k / norm
    return gain, 2 * gain, gain, 2 * (k * k - 1) / norm, (1 - math.sqrt(2) * k + k * k) / norm


# Name -> (the effect, the numbers that make it: where all are zero, the triad does not have it).
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


def sensed(channel: Channel, without: Collection[str] = ()) -> np.ndarray:
    """What the triad measures: (n, 3), an array of its own.

    An effect that is switched off, or that the triad does not have, passes the signal on untouched, bit for
    bit, and leaves every other effect's random draws as they are.
    """
    x = _copy(channel.true)
    for _, effect in _effects(channel, without):
        if effect is not None:
            effect(x, channel)
    return x


def stages(channel: Channel, without: Collection[str] = ()) -> Iterator[tuple[str, np.ndarray]]:
    """The signal after each effect, in order; the last is `sensed`.

    Yields
    ------
    name of the effect, (n, 3) signal: an array of its own, or the one before where the effect does nothing
    """
    x = channel.true
    for name, effect in _effects(channel, without):
        if effect is not None:
            x = _copy(x)
            effect(x, channel)
        yield name, x


def _copy(x: np.ndarray) -> np.ndarray:
    return np.array(x, dtype=float, order="C")


def _effects(channel: Channel, without: Collection[str]) -> Iterator[tuple[str, Effect | None]]:
    """Each effect by its name; None where it is switched off or the triad does not have it."""
    require_effects(without)
    for name in EFFECTS:
        effect, numbers = _CHAIN[name]
        yield name, effect if name not in without and np.any(numbers(channel.unit)) else None
