"""A data sheet from a recording at rest: what the Allan deviation tells of a sensor, and nothing else."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping

import numpy as np

from footfall.models.imu.spec import ACCEL_KEYS, GYRO_KEYS
from footfall.pdr.allan import fit_allan
from footfall.recording import Recording
from footfall.tables import replacing

FLOOR_OF_FLICKER = math.sqrt(2 * math.log(2) / math.pi)  # IEEE Std 952: floor of the Allan deviation, in B


def noise_of(x: np.ndarray, interval: float) -> dict[str, float]:
    """White noise, flicker, random walk and resolution of a triad (n, 3) at rest, as `TriadSpec` calls them.

    What the recording does not show is left out.

    Raises
    ------
    InputError
        As `fit_allan`.
    """
    fit = fit_allan(x, interval)
    step = resolution_of(x)
    # Rounding adds a noise of step^2 / 12 a sample, which the simulated sensor will add again.
    white = math.sqrt(max(fit.white**2 - step**2 / 12 * interval, 0.0))
    found = {"white": white, "flicker": fit.floor / FLOOR_OF_FLICKER, "random_walk": fit.random_walk}
    found["resolution"] = step
    return {name: value for name, value in found.items() if value > 0}


def resolution_of(x: np.ndarray) -> float:
    """The step of what is written, for all axes (n, 3); 0 where values do not repeat."""
    steps = []
    for values in x.T:
        distinct = np.unique(values)
        if len(distinct) < 2 or len(distinct) > len(values) / 2:
            return 0.0
        gaps = np.diff(distinct)
        steps.append(float(np.median(gaps[gaps < 1.5 * gaps[gaps > 1e-3 * np.median(gaps)].min()])))
    return max(steps)


def sheet_text(resting: Recording, name: str, source: str | os.PathLike[str]) -> str:
    """The sheet in TOML.

    Parameters
    ----------
    name : of the sensor
    source : file that was measured, for the sheet's first line

    Raises
    ------
    InputError
        The recording is too short, or holds one constant.
    """
    gyro, accel = (noise_of(x, resting.interval) for x in (resting.gyro, resting.accel))
    # One recording is one draw of the three turn-on biases.
    gyro["turn_on_sigma"] = float(np.sqrt(np.mean(resting.gyro.mean(axis=0) ** 2)))
    minutes = float(resting.t[-1] - resting.t[0]) / 60
    told, called = (text.replace("\\", "/").replace('"', "'") for text in (os.path.basename(source), name))
    return f'''# Measured: {told}, {minutes:.0f} min at rest at {1 / resting.interval:.0f} Hz.
# Allan deviation from 10 samples to {minutes * 60 / 9:.0f} s, mean of three axes.
# turn_on_sigma is the mean rate of this one recording.
# A rest does not show range, bandwidth, scale factor, misalignment, non-linearity, g-sensitivity and what the
# temperature does. Without these keys the sensor has no such errors: take them from its maker.
name = "{called}"

[gyro]
{_keys(gyro, GYRO_KEYS)}

[accel]
{_keys(accel, ACCEL_KEYS)}
'''


def _keys(values: Mapping[str, float], keys: Mapping[str, tuple[str, float]]) -> str:
    told = [(key, values[at] / size) for key, (at, size) in keys.items() if at in values]
    return "\n".join(f"{key} = {float(f'{value:.4g}')!r}" for key, value in told)


def write_sheet(
    resting: Recording, name: str, source: str | os.PathLike[str], output: str | os.PathLike[str]
) -> None:
    """Write `sheet_text` to a file.

    Raises
    ------
    InputError
        As `sheet_text`, or the file cannot be written.
    """
    text = sheet_text(resting, name, source)
    with replacing(output) as temporary:
        temporary.write_text(text, encoding="utf-8")
