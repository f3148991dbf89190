"""Constants of one individual IMU, given by hand in place of those that its seed draws."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from footfall.errors import InputError
from footfall.models.imu.spec import ACCEL_KEYS, GYRO_KEYS
from footfall.models.imu.unit import ImuUnit
from footfall.settings import did_you_mean


@dataclass(frozen=True)
class Constant:
    """A constant of a unit: `triad`, `attribute` of TriadUnit, `factor` from it to SI units, `shape`."""

    triad: str
    attribute: str
    factor: float
    shape: tuple[int, ...]


def _constants() -> dict[str, Constant]:
    """The constants that differ between units, by the name of their spread in a sheet, less `_sigma`."""
    square = {"misalignment", "g", "g2"}
    found = {}
    for triad, keys in (("gyro", GYRO_KEYS), ("accel", ACCEL_KEYS)):
        for key, (attribute, factor) in keys.items():
            name = attribute.removesuffix("_sigma")
            if attribute == name or name == "turn_on":  # no constant: it differs between recordings
                continue
            shape = (3, 3) if name in square else (3,)
            found[f"{triad}.{key.replace('_sigma', '')}"] = Constant(triad, name, factor, shape)
    return found


CONSTANTS = _constants()


def overridden(unit: ImuUnit, values: Mapping[str, Any]) -> ImuUnit:
    """`unit` with other constants, by their names in `CONSTANTS`, in the units of these names.

    Raises
    ------
    InputError
        No such constant; or not as many finite numbers as it has.
    """
    for name, value in values.items():
        constant = CONSTANTS.get(name)
        if constant is None:
            raise InputError(f"unit.{name}: unknown{did_you_mean(name, CONSTANTS)}")
        rows = " rows of 3" if len(constant.shape) == 2 else ""
        wrong = InputError(f"unit.{name} = {value}: expected a list of 3{rows} numbers")
        try:
            array = np.array(value, dtype=float)
        except (TypeError, ValueError):
            raise wrong from None
        if array.shape != constant.shape or not np.isfinite(array).all():
            raise wrong
        triad = replace(getattr(unit, constant.triad), **{constant.attribute: constant.factor * array})
        unit = replace(unit, **{constant.triad: triad})
    return unit
