"""One individual IMU: the constants that differ from unit to unit, drawn from a data sheet."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from footfall.models.imu.spec import ImuSpec, TriadSpec
from footfall.streams import stream


@dataclass(frozen=True)
class TriadUnit:
    """The gyros or the accelerometers of one unit; `unit` as in `TriadSpec`.

    Attributes
    ----------
    spec : the sheet's numbers, which every unit shares
    scale : (3,) scale factor errors
    misalignment : (3, 3) rad, zero diagonal: row = sensing axis, column = true axis
    non_linearity : (3,) largest deviation from a straight line, as a share of the range
    g : (3, 3) unit/(m/s2), g-sensitivity: row = sensing axis, column = axis of the specific force
    g2 : (3, 3) unit/(m/s2)2, rectification of the squared specific force
    temperature : (3,) unit/K
    temperature2 : (3,) unit/K2
    """

    spec: TriadSpec
    scale: np.ndarray
    misalignment: np.ndarray
    non_linearity: np.ndarray
    g: np.ndarray
    g2: np.ndarray
    temperature: np.ndarray
    temperature2: np.ndarray


@dataclass(frozen=True)
class ImuUnit:
    """One unit of `spec`, the one that `seed` draws."""

    spec: ImuSpec
    seed: int
    gyro: TriadUnit
    accel: TriadUnit


def draw_unit(spec: ImuSpec, seed: int) -> ImuUnit:
    """Draw one unit. Each constant has its own stream: a new effect leaves the others' draws alone.

    Raises
    ------
    InputError
        The seed is negative or no integer.
    """

    def triad(name: str, sheet: TriadSpec, g2_mask: np.ndarray) -> TriadUnit:
        def draw(effect: str, sigma: float, *shape: int) -> np.ndarray:
            return sigma * stream(seed, f"unit.{name}.{effect}").standard_normal(shape)

        return TriadUnit(
            spec=sheet,
            scale=draw("scale", sheet.scale_sigma, 3),
            misalignment=draw("misalignment", sheet.misalignment_sigma, 3, 3) * (1 - np.eye(3)),
            non_linearity=draw("non_linearity", sheet.non_linearity_sigma, 3),
            g=draw("g", sheet.g_sigma, 3, 3),
            g2=draw("g2", sheet.g2_sigma, 3, 3) * g2_mask,
            temperature=draw("temperature", sheet.temperature_sigma, 3),
            temperature2=draw("temperature2", sheet.temperature2_sigma, 3),
        )

    return ImuUnit(
        spec=spec,
        seed=seed,
        gyro=triad("gyro", spec.gyro, np.ones((3, 3))),
        # An accelerometer rectifies vibration along its own axis.
        accel=triad("accel", spec.accel, np.eye(3)),
    )
