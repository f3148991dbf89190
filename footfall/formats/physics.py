"""Can a foot have moved so? Units, axes, gravity and rate of a recording, judged by mechanics."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise

import numpy as np

from footfall.columns import ACCEL, GYRO
from footfall.conventions import GRAVITY
from footfall.errors import InputError
from footfall.formats.samples import Samples
from footfall.pdr.stance import moving_mean
from footfall.pdr.strapdown import integrate
from footfall.recording import Recording

GRAVITY_TOLERANCE = 1.0  # m/s2, of the force at rest
MISCLOSURE = (0.04, 0.16)  # g: above the first a cause is sought, above the second none need be found
WALK_RATES = (40.0, 20_000.0)  # Hz
MOST_CLIPPED = 0.2  # share of the samples
STILL_S = 0.06
REST = 0.35  # shares of RMS: stances have .03-.15, the quietest of swing .45
STRIDES = (5, 40)  # so many are needed, so many are looked at
GYRO_RMS = (0.02, 60.0)  # rad/s, of a walking foot
FORCE_SPREAD = 1.0  # m/s2: less is no walk

_FORCES = (
    (1.0, "they are probably in g"),
    (1000.0, "they are probably in mg"),
    (0.0, "gravity was probably removed from them"),
    (32.17, "they are probably in ft/s2"),
)


def check_alive(recording: Recording) -> None:
    """Refuse a sensor that says nothing, whole or of one axis.

    Raises
    ------
    InputError
        Every row is the same.
    """
    if len(recording.t) <= 10:
        return
    for what, values in (("gyros", recording.gyro), ("accelerometers", recording.accel)):
        if (values == values[0]).all():
            raise InputError(f"the {what} say the same in every row: they recorded nothing", "recording")
    for names, values in ((GYRO, recording.gyro), (ACCEL, recording.accel)):
        for name, axis in zip(names, values.T, strict=True):
            if (axis == axis[0]).all():
                raise InputError(f"{name} says the same in every row: it recorded nothing", "recording")


def likely_units(samples: Samples, unstated: frozenset[str], walk: bool) -> tuple[Samples, list[str]]:
    """Samples in SI where nothing states their unit, and only another than SI is possible; and what to tell.

    Accelerometers measure gravity at rest; what the gyros say must turn it (`check_walk`).
    """
    told: list[str] = []
    if "accel" in unstated and len(samples) > 10:
        force = resting_force(samples.t, samples.gyro, samples.accel)
        for unit, size in (("g", GRAVITY), ("mg", GRAVITY / 1000)):
            if abs(force * size - GRAVITY) <= GRAVITY_TOLERANCE:
                samples = replace(samples, accel=samples.accel * size)
                told.append(f"nothing states the accelerometers' unit: taken for {unit}")
    if "gyro" in unstated and walk and len(samples) > 10:
        recording = Recording(t=samples.t, gyro=samples.gyro, accel=samples.accel)
        rests = rests_of(recording)
        left = {size: misclosure(recording, rests, np.eye(3) * size) for size in (1.0, math.pi / 180, 1e-3)}
        off, deg = left[1.0], left[math.pi / 180]
        if off is not None and deg is not None and deg < off / 2 and deg < MISCLOSURE[1]:
            samples = replace(samples, gyro=samples.gyro * (math.pi / 180))
            told.append("nothing states the gyros' unit: taken for deg/s, with which gravity stays vertical")
    return samples, told


def check_values(recording: Recording, clipped: Mapping[str, int]) -> None:
    """Refuse a saturated sensor, and stamps in another unit.

    Raises
    ------
    InputError
        With the likely cause.
    """
    for name, count in clipped.items():
        if count > MOST_CLIPPED * len(recording.t):
            raise InputError(
                f"{name} is at the end of its range in {count} of {len(recording.t)} samples", "recording"
            )
    interval = recording.interval
    if not 1e-5 <= interval <= 1.0:
        units = {1e-3: "ms", 1e-6: "us", 1e-9: "ns"}
        cause = next((unit for size, unit in units.items() if 1e-4 <= interval * size <= 0.1), None)
        guess = f": t is probably in {cause}" if cause else ""
        raise InputError(f"samples are {interval:.3g} s apart, expected 0.00001 to 1 s{guess}", "recording")


def check_gravity(recording: Recording) -> None:
    """Refuse accelerometers that do not measure gravity where the IMU is stillest.

    Raises
    ------
    InputError
        With the likely cause.
    """
    force = resting_force(recording.t, recording.gyro, recording.accel)
    if abs(force - GRAVITY) > GRAVITY_TOLERANCE:
        cause = next((f": {text}" for size, text in _FORCES if abs(force - size) <= 0.1 * max(size, 1)), "")
        raise InputError(
            f"the accelerometers measure {force:.3g} at rest, "
            f"expected {GRAVITY:.3g} +- {GRAVITY_TOLERANCE:g} m/s2{cause}",
            "recording",
        )


def check_walk(recording: Recording) -> float | None:
    """Refuse what no walking foot can have measured.

    From one moment of rest to the next, turning the force with the gyros and taking gravity away must leave
    almost no velocity. It leaves metres a second where the gyros are in other units, or their axes are not
    those of the accelerometers: median over strides, as a share of g. Of seven real walks right ones have
    .016-.037, wrong ones .06-1.
    (A sensor that gives -f instead of f passes: it is the mirror image of a possible walk.)

    Returns
    -------
    That share; None where too few strides are seen.

    Raises
    ------
    InputError
        With the likely cause.
    """
    rate = 1 / recording.interval
    if not WALK_RATES[0] <= rate <= WALK_RATES[1]:
        raise InputError(
            f"sampled at {rate:.3g} Hz, a walking foot needs {WALK_RATES[0]:g} Hz or more", "recording"
        )
    spread = float(np.linalg.norm(recording.accel, axis=1).std())
    rms = math.sqrt(np.mean(recording.gyro**2) * 3)
    if spread < FORCE_SPREAD:
        return None  # no walk: dead reckoning will say so
    if not GYRO_RMS[0] <= rms <= GYRO_RMS[1]:
        cause = "deg/s" if rms > GYRO_RMS[1] else "rad/s, and were taken for deg/s"
        raise InputError(
            f"the gyros turn at {rms:.3g} rad/s RMS while the foot walks: they are probably in {cause}",
            "recording",
        )
    rests = rests_of(recording)
    off = misclosure(recording, rests, np.eye(3))
    if off is None or off <= MISCLOSURE[0]:
        return off
    left = {cause: misclosure(recording, rests, change) or math.inf for cause, change in CHANGES.items()}
    likely = min(left, key=left.__getitem__)
    if left[likely] <= off / 2:
        raise InputError(f"turned by its gyros, gravity does not stay vertical: {likely}", "recording")
    if off > MISCLOSURE[1]:
        raise InputError(
            "turned by its gyros, gravity does not stay vertical: "
            "the gyros' unit or axes do not match the accelerometers'",
            "recording",
        )
    return off


CHANGES: Mapping[str, np.ndarray] = {
    "the gyros are probably in deg/s": np.eye(3) * math.pi / 180,
    "the gyros are probably in rad/s, and were taken for deg/s": np.eye(3) * 180 / math.pi,
    "the gyros probably turn the other way about every axis": -np.eye(3),
    **{
        f"{name} probably turns the other way": np.diag(np.where(np.arange(3) == axis, -1.0, 1.0))
        for axis, name in enumerate(GYRO)
    },
    **{
        f"the gyros' {'xyz'[a]} and {'xyz'[b]} are probably exchanged": np.eye(3)[
            [b if i == a else a if i == b else i for i in range(3)]
        ]
        for a, b in ((0, 1), (0, 2), (1, 2))
    },
}


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
    return lowest(unrest, REST, max(1, round(0.5 / recording.interval)))


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


def misclosure(recording: Recording, rests: np.ndarray, change: np.ndarray) -> float | None:
    """Median over strides of the velocity left at the end over g T; None where too few strides are seen.

    `change` (3, 3) is applied to the rates first.
    """
    gyro = recording.gyro @ change.T
    left: list[float] = []
    margin = max(1, round(0.02 / recording.interval))
    for first, last in pairwise(rests):
        t, force = recording.t[first : last + 1], recording.accel[first : last + 1]
        duration = float(t[-1] - t[0])
        if not 0.4 < duration < 2.0 or np.ptp(np.linalg.norm(force, axis=1)) < 3.0:
            continue
        up = recording.accel[max(0, first - margin) : first + margin + 1].mean(axis=0)
        _, _, velocity = integrate(t, gyro[first : last + 1], force, quaternion=upright(up))
        left.append(float(np.linalg.norm(velocity[-1])) / (GRAVITY * duration))
        if len(left) == STRIDES[1]:
            break
    return float(np.median(left)) if len(left) >= STRIDES[0] else None
