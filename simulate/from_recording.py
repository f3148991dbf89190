"""Errors of another IMU added to a real recording."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import asdict

import numpy as np

from footfall.identity import digest_of
from footfall.models.imu import EFFECTS, ROOM, ImuUnit, TemperatureProfile, require_effects
from footfall.models.imu.effects import Channel, sensed
from footfall.recording import Recording

# Effects that make a heading drift and can be added. A real recording has the others already: its sensor's
# scale and alignment, bandwidth, noise, range and resolution. Added twice they would be those of no sensor.
ADDED = ("g_sensitivity", "g2", "temperature", "turn_on", "flicker", "rate_random_walk")


def add_errors(
    recording: Recording,
    unit: ImuUnit,
    *,
    seed: int,
    temperature: TemperatureProfile = ROOM,
    without: Collection[str] = (),
) -> Recording:
    """`recording` with the biases, temperature errors and g-sensitivity of `unit` (`ADDED`) on top.

    The unit's axes are those of the recording, and its force is the recorded one, noise included. The drift
    of the recording's own sensor stays in, so use a recording whose track is good as it is.

    Parameters
    ----------
    seed : of the noises of this recording (turn-on bias, flicker, random walk)
    temperature : of the air; the unit is as warm as `temperature.start` at the first sample
    without : names of effects to leave out; the random draws of the others stay as they are

    Raises
    ------
    InputError
        An effect that does not exist, or a seed that is no integer of 0 or more.
    """
    require_effects(without)
    left_out = {*without, *EFFECTS} - (set(ADDED) - set(without))
    die = temperature.die(recording.t, unit.spec.thermal.time_constant)

    def worse(name: str) -> np.ndarray:
        channel = Channel.of(
            unit,
            name,
            getattr(recording, name),
            force=recording.accel,
            die=die,
            interval=recording.interval,
            seed=seed,
        )
        return sensed(channel, left_out)

    return Recording(
        t=recording.t,
        gyro=worse("gyro"),
        accel=worse("accel"),
        temperature=die if unit.spec.thermal.reported else recording.temperature,
        meta={
            **recording.meta,
            "added": {
                "imu": unit.spec.name,
                "imu_digest": digest_of(unit.spec),
                "unit_seed": unit.seed,
                "unit_digest": digest_of(unit),
                "noise_seed": seed,
                "temperature": asdict(temperature),
                "effects": [name for name in ADDED if name not in without],
            },
        },
    )
