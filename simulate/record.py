"""From the truth of a walk to what one IMU unit would have recorded."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import asdict

import numpy as np

from footfall.conventions import BIAS_TIME
from footfall.identity import WALK, digest_of
from footfall.late import late
from footfall.models.imu import ROOM, ImuUnit, TemperatureProfile
from footfall.models.imu.effects import Channel, sensed, stages
from footfall.recording import Recording
from footfall.simulate.budget import DriftBudget, drift_budget
from footfall.simulate.walk import Walk

transform = late("scipy.spatial.transform")


def record(
    walk: Walk,
    unit: ImuUnit,
    *,
    seed: int,
    temperature: TemperatureProfile = ROOM,
    without: Collection[str] = (),
    bias_shift: float = 0.0,
) -> Recording:
    """What `unit` measures on `walk`, sample by sample at the walk's rate.

    Parameters
    ----------
    seed : of the noises of this recording (turn-on bias, flicker, random walk, white noise)
    temperature : of the air; the unit is as warm as `temperature.start` at the walk's first sample
    without : names of effects to switch off (`footfall.models.imu.EFFECTS`), in gyros and accelerometers;
        the random draws of the others stay as they are
    bias_shift : rad/s, a gyro bias about the vertical (left positive) of the standing IMU that appears when
        the motionless start is over: no average over the start can remove it

    Raises
    ------
    InputError
        An effect that does not exist, or a seed that is no integer of 0 or more.
    """
    die = temperature.die(walk.t, unit.spec.thermal.time_constant)
    gyro = sensed(_channel(walk, unit, "gyro", die, seed), without)
    if bias_shift:
        _shift(gyro, walk, bias_shift)
    return _recording(walk, unit, gyro, die, seed, temperature, without, bias_shift)


def record_with_budget(
    walk: Walk,
    unit: ImuUnit,
    *,
    seed: int,
    temperature: TemperatureProfile = ROOM,
    without: Collection[str] = (),
    bias_shift: float = 0.0,
    bias_time: float = BIAS_TIME,
) -> tuple[Recording, DriftBudget]:
    """`record`, and which cause turned the heading by how much in each stride.

    Parameters
    ----------
    bias_time : s of motionless start over which the static bias is averaged

    Raises
    ------
    InputError
        As `record`; or the walk's motionless start is shorter than `bias_time`.
    """
    die = temperature.die(walk.t, unit.spec.thermal.time_constant)
    gyro = walk.gyro

    def signals() -> Iterator[tuple[str, np.ndarray]]:
        nonlocal gyro
        for name, gyro in stages(_channel(walk, unit, "gyro", die, seed), without):
            yield name, gyro
        if bias_shift:
            gyro = gyro.copy()
            _shift(gyro, walk, bias_shift)
            yield "bias_shift", gyro

    budget = drift_budget(walk, signals(), bias_time)  # of one signal after the other, none of them kept
    if gyro is walk.gyro:
        gyro = gyro.copy()
    return _recording(walk, unit, gyro, die, seed, temperature, without, bias_shift), budget


def _shift(gyro: np.ndarray, walk: Walk, bias_shift: float) -> None:
    """Add a bias of `bias_shift` rad/s about the vertical, from the first step on, to the gyro (n, 3)."""
    rest = transform.Rotation.from_quat(walk.quaternion[0], scalar_first=True)
    up = rest.inv().apply([0.0, 0.0, bias_shift])
    first = int(np.searchsorted(walk.t - walk.t[0], walk.calibration_s + 1e-6, side="right"))
    gyro[first:] += up


def _channel(walk: Walk, unit: ImuUnit, name: str, die: np.ndarray, seed: int) -> Channel:
    true = getattr(walk, name)
    return Channel.of(unit, name, true, force=walk.accel, die=die, interval=walk.interval, seed=seed)


def _recording(
    walk: Walk,
    unit: ImuUnit,
    gyro: np.ndarray,
    die: np.ndarray,
    seed: int,
    temperature: TemperatureProfile,
    without: Collection[str],
    bias_shift: float,
) -> Recording:
    position, heading = walk.pose_at_rest(BIAS_TIME)
    return Recording(
        t=walk.t - walk.t[0],
        gyro=gyro,
        accel=sensed(_channel(walk, unit, "accel", die, seed), without),
        temperature=_reported(unit, die),
        meta={
            WALK: dict(walk.meta),
            "start": {"position_m": list(position), "heading_rad": heading},
            "imu": unit.spec.name,
            "imu_digest": digest_of(unit.spec),
            "unit_seed": unit.seed,
            "unit_digest": digest_of(unit),
            "noise_seed": seed,
            "temperature": asdict(temperature),
            "without": sorted(without),
            "bias_shift": bias_shift,
        },
    )


def _reported(unit: ImuUnit, die: np.ndarray) -> np.ndarray | None:
    thermal = unit.spec.thermal
    if not thermal.reported:
        return None
    return np.round(die / thermal.resolution) * thermal.resolution if thermal.resolution else die
