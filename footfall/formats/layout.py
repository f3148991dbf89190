"""Which columns of a table are the sensor's axes, and in which units: one function a format."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from footfall.columns import ACCEL, GYRO
from footfall.conventions import GRAVITY
from footfall.formats.units import DEG, unit_size

AXES = "xyz"
CHANNELS = ("t", *GYRO, *ACCEL, "temperature")


@dataclass(frozen=True)
class Layout:
    """Where a table holds what.

    Attributes
    ----------
    format : name in `LAYOUTS`
    columns : channel ("t", "gyro_x", ..., "temperature") -> the column's name in the file
    sizes : channel -> how much SI one unit of that column is; None where the file does not say
    valid : columns that are 0 where the sensor distrusts itself
    """

    format: str
    columns: Mapping[str, str]
    sizes: Mapping[str, float | None]
    valid: tuple[str, ...] = ()


def missing(columns: Mapping[str, str]) -> list[str]:
    """Channels of a gyro and an accelerometer that `columns` lacks."""
    return [name for name in (*GYRO, *ACCEL) if name not in columns]


def footfall(names: Sequence[str]) -> Layout | None:
    """Footfall's own recordings: SI, by exact names."""
    if not {"t", *GYRO, *ACCEL} <= set(names):
        return None
    columns = {name: name for name in CHANNELS if name in names}
    return Layout("footfall", columns, dict.fromkeys(columns, 1.0))


def xio(names: Sequence[str]) -> Layout | None:
    """x-io (NGIMU, x-IMU3): `Time (s), Gyroscope X (deg/s), ..., Accelerometer X (g), ...`."""
    columns = {"t": "Time (s)"}
    columns |= {f"gyro_{axis}": f"Gyroscope {axis.upper()} (deg/s)" for axis in AXES}
    columns |= {f"accel_{axis}": f"Accelerometer {axis.upper()} (g)" for axis in AXES}
    if not set(columns.values()) <= set(names):
        return None
    sizes = {name: {"t": 1.0, "gyro": DEG, "accel": GRAVITY}[name.split("_")[0]] for name in columns}
    return Layout("xio", columns, sizes)


# MicroStrain's columns: raw ones in g, those of the on-board filter (less its bias estimates) in m/s2.
_SENSORCONNECT = (("scaledAccel", GRAVITY), ("estCompensatedAccel", 1.0))
_SENSORCONNECT_GYRO = ("scaledGyro", "estAngularRate")


def sensorconnect(names: Sequence[str]) -> Layout | None:
    """MicroStrain SensorConnect: `Time, inertial-NODE:scaledAccelX, ...`, columns chosen by name.

    The scaled (raw) quantities where they are all there, else those that the on-board filter compensated.
    """
    channels = {name.partition(":")[2]: name for name in names if name.startswith("inertial")}
    accel = next(((key, size) for key, size in _SENSORCONNECT if _has_axes(channels, key)), None)
    gyro = next((key for key in _SENSORCONNECT_GYRO if _has_axes(channels, key)), None)
    if "Time" not in names or accel is None or gyro is None:
        return None
    columns = {"t": "Time"}
    columns |= {f"gyro_{axis}": channels[gyro + axis.upper()] for axis in AXES}
    columns |= {f"accel_{axis}": channels[accel[0] + axis.upper()] for axis in AXES}
    sizes = {name: accel[1] if name.startswith("accel") else 1.0 for name in columns}
    valid = tuple(f"{name}:valid" for name in columns.values() if f"{name}:valid" in names)
    return Layout("sensorconnect", columns, sizes, valid)


def _has_axes(channels: Mapping[str, str], key: str) -> bool:
    return all(key + axis.upper() in channels for axis in AXES)


_KINDS = {
    "gyro": r"gyro(?:scope)?|gyr|angular[ _]?(?:rate|velocity)|omega|g|w",
    "accel": r"accel(?:erometer|eration)?|acc|specific[ _]?force|a|f",
}
_AXIS = {
    kind: re.compile(rf"(?:{words})[ _.]?([xyz])(?![a-z])[ _]*(.*)", re.IGNORECASE)
    for kind, words in _KINDS.items()
}
_SINGLE = {
    "t": re.compile(r"(?:t|time|time ?stamp|timestamp)(?![a-z])[ _]*(.*)", re.IGNORECASE),
    "temperature": re.compile(r"(?:temp|temperature)(?![a-z])[ _]*(.*)", re.IGNORECASE),
}


def csv(names: Sequence[str]) -> Layout | None:
    """Any table whose columns say what they are and in which unit: `gyro_x_deg_s`, `Accel Y [g]`, `time_ms`.

    A name without a unit leaves it open: a flag says it, or it is SI. A word that is no unit makes the
    column another one.
    """
    columns: dict[str, str] = {}
    sizes: dict[str, float | None] = {}
    for name in names:
        found = _channel(name)
        if found is not None and found[0] not in columns:
            columns[found[0]], sizes[found[0]] = name, found[1]
    return Layout("csv", columns, sizes) if not missing(columns) else None


def _channel(name: str) -> tuple[str, float | None] | None:
    for kind, pattern in _AXIS.items():
        if match := pattern.fullmatch(name.strip()):
            size, known = _size(kind, match[2])
            return (f"{kind}_{match[1].lower()}", size) if known else None
    for kind, pattern in _SINGLE.items():
        if match := pattern.fullmatch(name.strip()):
            size, known = _size(kind, match[1])
            return (kind, size) if known else None
    return None


def _size(kind: str, text: str) -> tuple[float | None, bool]:
    text = text.strip("()[] _")
    if not text:
        return None, True
    size = unit_size(kind, text)
    return size, size is not None


# In the order in which they are tried: the strictest first.
LAYOUTS: Mapping[str, Callable[[Sequence[str]], Layout | None]] = {
    "footfall": footfall,
    "xio": xio,
    "sensorconnect": sensorconnect,
    "csv": csv,
}
