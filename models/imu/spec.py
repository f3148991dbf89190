"""Data sheets: what a maker, a paper or a guess says of one model of IMU."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, Field, create_model

from footfall.conventions import GRAVITY
from footfall.errors import InputError
from footfall.toml import Strict, checked, no_such_file, parse_toml

SHEETS = Path(__file__).resolve().parent / "sheets"

DEG = math.pi / 180
HOUR = 3600.0


@dataclass(frozen=True)
class TriadSpec:
    """Three gyros or three accelerometers. `unit` below is rad/s for gyros, m/s2 for accelerometers.

    Each `_sigma` is the standard deviation over units (of the turn-on bias: over recordings) of a zero-mean
    normal distribution, for every axis or matrix element by itself. A value of 0 (or an infinite range or
    bandwidth) means that the sensor has no such error.

    Attributes
    ----------
    range : unit, the output is clipped beyond it
    bandwidth : Hz, -3 dB point of the low-pass before sampling
    resolution : unit, step of the output
    white : unit/sqrt(Hz), one number for angle and velocity random walk
    flicker : unit, the coefficient B of bias instability; the floor of the Allan deviation is 0.664 B
    random_walk : unit/sqrt(s), rate random walk K
    turn_on_sigma : unit, bias that changes from switch-on to switch-on
    scale_sigma : 1, scale factor error of each axis
    misalignment_sigma : rad, each off-diagonal element of the scale and misalignment matrix
    non_linearity_sigma : 1, largest deviation of each axis from a straight line, as a share of `range`
    g_sigma : unit/(m/s2), each element of the g-sensitivity matrix G (gyros only)
    g2_sigma : unit/(m/s2)2, each element of the rectification G2; accelerometers have its diagonal only
    temperature_sigma : unit/K, residual of the temperature compensation, linear
    temperature2_sigma : unit/K2, the same, quadratic about the reference temperature

    Raises
    ------
    InputError
        A non-linearity without a range that it is a share of.
    """

    range: float = math.inf
    bandwidth: float = math.inf
    resolution: float = 0.0
    white: float = 0.0
    flicker: float = 0.0
    random_walk: float = 0.0
    turn_on_sigma: float = 0.0
    scale_sigma: float = 0.0
    misalignment_sigma: float = 0.0
    non_linearity_sigma: float = 0.0
    g_sigma: float = 0.0
    g2_sigma: float = 0.0
    temperature_sigma: float = 0.0
    temperature2_sigma: float = 0.0

    def __post_init__(self) -> None:
        if self.non_linearity_sigma > 0 and math.isinf(self.range):
            raise InputError(
                f"non-linearity of {self.non_linearity_sigma:g} of full scale, but no range is given"
            )


@dataclass(frozen=True)
class ThermalSpec:
    """The die's temperature.

    Attributes
    ----------
    time_constant : s, lag of the die behind its surroundings
    reference : degC, where the temperature errors are zero
    resolution : degC, step of the reported temperature
    reported : whether the IMU reports its temperature at all
    """

    time_constant: float = 0.0
    reference: float = 25.0
    resolution: float = 0.0
    reported: bool = False


@dataclass(frozen=True)
class ImuSpec:
    """One model of IMU, from which units are drawn."""

    name: str
    gyro: TriadSpec = TriadSpec()
    accel: TriadSpec = TriadSpec()
    thermal: ThermalSpec = ThermalSpec()


# Key in a sheet -> (attribute of the spec, its SI value).
GYRO_KEYS = {
    "range_deg_s": ("range", DEG),
    "bandwidth_hz": ("bandwidth", 1.0),
    "resolution_deg_s": ("resolution", DEG),
    "angle_random_walk_deg_rt_h": ("white", DEG / math.sqrt(HOUR)),
    "flicker_deg_h": ("flicker", DEG / HOUR),
    "rate_random_walk_deg_h_rt_h": ("random_walk", DEG / HOUR / math.sqrt(HOUR)),
    "turn_on_sigma_deg_s": ("turn_on_sigma", DEG),
    "scale_sigma": ("scale_sigma", 1.0),
    "misalignment_sigma_deg": ("misalignment_sigma", DEG),
    "non_linearity_sigma_percent_fs": ("non_linearity_sigma", 0.01),
    "g_sensitivity_sigma_deg_s_g": ("g_sigma", DEG / GRAVITY),
    "g2_sigma_deg_s_g2": ("g2_sigma", DEG / GRAVITY**2),
    "temperature_sigma_deg_s_k": ("temperature_sigma", DEG),
    "temperature2_sigma_deg_s_k2": ("temperature2_sigma", DEG),
}
ACCEL_KEYS = {
    "range_g": ("range", GRAVITY),
    "bandwidth_hz": ("bandwidth", 1.0),
    "resolution_mg": ("resolution", 1e-3 * GRAVITY),
    "noise_density_ug_rt_hz": ("white", 1e-6 * GRAVITY),
    "flicker_ug": ("flicker", 1e-6 * GRAVITY),
    "random_walk_ug_rt_h": ("random_walk", 1e-6 * GRAVITY / math.sqrt(HOUR)),
    "turn_on_sigma_mg": ("turn_on_sigma", 1e-3 * GRAVITY),
    "scale_sigma": ("scale_sigma", 1.0),
    "misalignment_sigma_deg": ("misalignment_sigma", DEG),
    "non_linearity_sigma_percent_fs": ("non_linearity_sigma", 0.01),
    "g2_sigma_ug_g2": ("g2_sigma", 1e-6 / GRAVITY),
    "temperature_sigma_mg_k": ("temperature_sigma", 1e-3 * GRAVITY),
    "temperature2_sigma_mg_k2": ("temperature2_sigma", 1e-3 * GRAVITY),
}

_Keys = Mapping[str, tuple[str, float]]


def _section(name: str, keys: _Keys) -> type[Strict]:
    """Model of a sheet's table: every key may be absent (no such error), none may be negative."""
    bounds = {
        "range": Field(gt=0),  # zero would silence the sensor
        "bandwidth": Field(gt=0),
        # Beyond these the value is probably in another unit.
        "scale_sigma": Field(ge=0, le=0.5),
        "misalignment_sigma": Field(ge=0, le=45),
        "non_linearity_sigma": Field(ge=0, le=50),
    }
    fields: dict[str, Any] = {
        key: (Annotated[float | None, bounds.get(attribute, Field(ge=0))], None)
        for key, (attribute, _) in keys.items()
    }
    return create_model(name, __base__=Strict, **fields)


GyroSheet = _section("GyroSheet", GYRO_KEYS)
AccelSheet = _section("AccelSheet", ACCEL_KEYS)


class ThermalSheet(Strict):
    time_constant_s: Annotated[float, Field(ge=0)] = 0.0
    reference_degC: float = 25.0
    resolution_degC: Annotated[float, Field(ge=0)] = 0.0
    reported: bool = False


class ImuSheet(Strict):
    name: Annotated[str, Field(min_length=1)]
    gyro: GyroSheet  # type: ignore[valid-type]
    accel: AccelSheet  # type: ignore[valid-type]
    thermal: ThermalSheet = ThermalSheet()


def stock_specs() -> tuple[str, ...]:
    """Names of the data sheets that come with Footfall."""
    return tuple(sorted(path.stem for path in SHEETS.glob("*.toml")))


@dataclass(frozen=True)
class SheetDocument:
    """A data sheet as it stands in TOML.

    Attributes
    ----------
    name : as it was asked for: a stock name or a path
    source : for messages
    table : the keys, unchecked
    """

    name: str
    source: str
    table: Mapping[str, Any]


def load_spec(name_or_path: str | os.PathLike[str]) -> ImuSpec:
    """A stock data sheet by name, or another by the path of its TOML file.

    Raises
    ------
    InputError
        Neither a stock name nor a file; a key that is unknown, or its value of the wrong kind or negative; a
        non-linearity without a range.
    """
    return build_spec(read_sheet(name_or_path))


def read_sheet(name_or_path: str | os.PathLike[str]) -> SheetDocument:
    """The document of a data sheet, unchecked.

    Raises
    ------
    InputError
        Neither a stock name nor a file, or not TOML.
    """
    if (name := os.fspath(name_or_path)) in stock_specs():
        path = SHEETS / f"{name}.toml"
    elif not (path := Path(name)).is_file():
        raise no_such_file("IMU", name, stock_specs())
    return SheetDocument(name, str(path), parse_toml(path))


def build_spec(document: SheetDocument) -> ImuSpec:
    """The model of IMU that a data sheet describes.

    Raises
    ------
    InputError
        A key that is unknown, or its value of the wrong kind or negative; a non-linearity without a range.
    """
    sheet = checked(document.table, ImuSheet, document.source)
    thermal = sheet.thermal
    return ImuSpec(
        name=sheet.name,
        gyro=_triad(f"{document.source}: gyro", sheet.gyro, GYRO_KEYS),
        accel=_triad(f"{document.source}: accel", sheet.accel, ACCEL_KEYS),
        thermal=ThermalSpec(
            time_constant=thermal.time_constant_s,
            reference=thermal.reference_degC,
            resolution=thermal.resolution_degC,
            reported=thermal.reported,
        ),
    )


def _triad(where: str, sheet: BaseModel, keys: _Keys) -> TriadSpec:
    given = {key: value for key, value in sheet.model_dump().items() if value is not None}
    try:
        return TriadSpec(**{keys[key][0]: keys[key][1] * value for key, value in given.items()})
    except InputError as error:
        raise error.about(where) from None
