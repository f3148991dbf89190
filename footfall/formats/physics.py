"""Can a foot have moved so? Units, axes, gravity and rate of a recording, judged by mechanics."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from footfall.columns import ACCEL, GYRO
from footfall.conventions import GRAVITY
from footfall.errors import InputError
from footfall.formats.closure import misclosure, resting_force, rests_of, strides_of
from footfall.formats.diagnosis import MISCLOSURE, Diagnosis
from footfall.formats.samples import Samples
from footfall.formats.units import UNITS
from footfall.recording import Recording

GRAVITY_TOLERANCE = 1.0  # m/s2, of the force at rest
WALK_RATES = (40.0, 20_000.0)  # Hz
MOST_CLIPPED = 0.2  # share of the samples
GYRO_RMS = (0.02, 60.0)  # rad/s, of a walking foot
FORCE_SPREAD = 1.0  # m/s2: less is no walk

_FORCES = (
    (1.0, "they are probably in g"),
    (1000.0, "they are probably in mg"),
    (0.0, "gravity was probably removed from them"),
    (32.17, "they are probably in ft/s2"),
    *((float(1 << bits), "they are probably the sensor's raw counts") for bits in range(11, 15)),
)
_RATES = {"deg/s": 180 / math.pi, "mrad/s": 1e3, "mdeg/s": 180e3 / math.pi}
BRIEF_S = 3.0  # no walk is so short
USUAL_RMS = 3.0  # rad/s
DEAD = 0.02  # of the liveliest axis' standard deviation: real walks' stillest axis has .24 and more


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

    Accelerometers measure gravity at rest; what the gyros say must turn it (`footfall.formats.closure`).
    """
    told: list[str] = []
    if "accel" in unstated and len(samples) > 10:
        force = resting_force(samples.t, samples.gyro, samples.accel)
        sizes = {unit: UNITS["accel"][unit] for unit in ("g", "mg", "cm/s2", "mm/s2")}
        unit, size = min(sizes.items(), key=lambda one: abs(force * one[1] - GRAVITY))
        # m/s2 is meant where it is possible.
        if abs(force * size - GRAVITY) <= GRAVITY_TOLERANCE < abs(force - GRAVITY):
            samples = replace(samples, accel=samples.accel * size)
            told.append(f"nothing states the accelerometers' unit: taken for {unit}")
    if "gyro" in unstated and walk and len(samples) > 10:
        recording = Recording(t=samples.t, gyro=samples.gyro, accel=samples.accel)
        strides = strides_of(recording, rests_of(recording))
        off, deg = (
            misclosure(recording, strides, np.eye(3) * size) if strides else 0.0
            for size in (1.0, math.pi / 180)
        )
        if deg < off / 2 and deg < MISCLOSURE[1]:
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
    brief = recording.t[-1] - recording.t[0] < BRIEF_S and len(recording.t) > 1000 and interval < 2e-4
    if brief or not 1e-5 <= interval <= 1.0:
        units = {1e-3: "ms", 1e-6: "us", 1e-9: "ns", 60.0: "minutes", 3600.0: "hours", 86400.0: "days"}
        cause = next((unit for size, unit in units.items() if 5e-4 <= interval * size <= 0.1), None)
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
        if abs(resting_force(recording.t, recording.accel, recording.gyro) - GRAVITY) <= GRAVITY_TOLERANCE:
            cause = ": gyros and accelerometers are probably exchanged"
        raise InputError(
            f"the accelerometers measure {force:.3g} at rest, "
            f"expected {GRAVITY:.3g} +- {GRAVITY_TOLERANCE:g} m/s2{cause}",
            "recording",
        )


def check_walk(recording: Recording) -> bool:
    """Refuse rates of samples and of turning that no walking foot has; returns whether it walks at all.

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
        return False  # dead reckoning will say so
    if not GYRO_RMS[0] <= rms <= GYRO_RMS[1]:
        likely = min(_RATES, key=lambda unit: abs(math.log(rms / _RATES[unit] / USUAL_RMS)) if rms else 0.0)
        cause = likely if rms > GYRO_RMS[1] else "rad/s, and were taken for deg/s"
        raise InputError(
            f"the gyros turn at {rms:.3g} rad/s RMS while the foot walks: they are probably in {cause}",
            "recording",
        )
    for names, values in ((GYRO, recording.gyro), (ACCEL, recording.accel)):
        lively = values.std(axis=0) / values.std(axis=0).max()
        if lively.min() < DEAD:
            name = names[int(lively.argmin())]
            raise InputError(
                f"{name} hardly says anything while the others do: it is probably dead", "recording"
            )
    return True


def check_closure(found: Diagnosis) -> None:
    """Refuse what no walking foot can have measured.

    (A sensor that gives -f instead of f passes: it is the mirror image of a possible walk.)

    Raises
    ------
    InputError
        With the likely cause.
    """
    if found.swapped or found.misclosure > MISCLOSURE[1]:
        cause = (
            found.cause or "the gyros' unit or axes do not match the accelerometers', or samples are spoilt"
        )
        raise InputError(f"turned by its gyros, gravity does not stay vertical: {cause}", "recording")
