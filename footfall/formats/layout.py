"""Which columns of a table are the sensor's axes, and in which units: one function a format."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from footfall.columns import ACCEL, GYRO
from footfall.conventions import GRAVITY
from footfall.errors import InputError
from footfall.formats.names import AXES, ID_WORDS, Named, understood
from footfall.formats.units import DEG, INCREMENTS, unit_size

CHANNELS = ("t", *GYRO, *ACCEL, "temperature")
TICK = 1e-4  # s, of Xsens's SampleTimeFine


@dataclass(frozen=True)
class Header:
    """What stands above a table's numbers.

    Attributes
    ----------
    names : of the columns
    units : as written below the names, "" for none; as many, or empty
    preamble : lines above
    """

    names: Sequence[str]
    units: Sequence[str] = ()
    preamble: Sequence[str] = ()

    def unit(self, place: int) -> str:
        """What is written below a name."""
        return self.units[place].strip("()[] ") if self.units else ""


@dataclass(frozen=True)
class Layout:
    """Where a table holds what.

    Attributes
    ----------
    format : name in `LAYOUTS`
    columns : channel ("t", "gyro_x", ..., "temperature") -> the column's name in the file
    sizes : channel -> how much SI one unit of that column is; None where the file does not say
    valid : columns that are 0 where the sensor distrusts itself
    sensor : which of several in a file this is
    id : column that tells whose row it is, where there is one
    finer : column with nanoseconds of t, where seconds stand alone
    mirrored : whether its accelerometers say -f
    increments : channels that hold what a rate or force adds up to over an interval
    rate_hz : as the preamble states it
    """

    format: str
    columns: Mapping[str, str]
    sizes: Mapping[str, float | None]
    valid: tuple[str, ...] = ()
    sensor: str = ""
    id: str = ""
    finer: str = ""
    mirrored: bool = False
    increments: frozenset[str] = frozenset()
    rate_hz: float | None = None


@dataclass
class _Group:
    """Columns of one sensor, the best of each channel."""

    columns: dict[str, str] = field(default_factory=dict)
    named: dict[str, Named] = field(default_factory=dict)

    def offer(self, column: str, named: Named) -> None:
        now = self.named.get(named.channel)
        if now is None or (named.increment, named.rank) < (now.increment, now.rank):
            self.columns[named.channel], self.named[named.channel] = column, named


def missing(columns: Mapping[str, str]) -> list[str]:
    """Channels of a gyro and an accelerometer that `columns` lacks."""
    return [name for name in (*GYRO, *ACCEL) if name not in columns]


def footfall(header: Header) -> list[Layout]:
    """Footfall's own recordings: SI, by exact names."""
    names = header.names
    if not {"t", *GYRO, *ACCEL} <= set(names) or header.units:
        return []
    columns = {name: name for name in CHANNELS if name in names}
    return [Layout("footfall", columns, dict.fromkeys(columns, 1.0), id=_id(names))]


def xio(header: Header) -> list[Layout]:
    """x-io (NGIMU, x-IMU3): `Time (s), Gyroscope X (deg/s), ..., Accelerometer X (g), ...`."""
    columns = {"t": "Time (s)"}
    columns |= {f"gyro_{axis}": f"Gyroscope {axis.upper()} (deg/s)" for axis in AXES}
    columns |= {f"accel_{axis}": f"Accelerometer {axis.upper()} (g)" for axis in AXES}
    if not set(columns.values()) <= set(header.names):
        return []
    sizes = {name: {"t": 1.0, "gyro": DEG, "accel": GRAVITY}[name.split("_")[0]] for name in columns}
    return [Layout("xio", columns, sizes)]


# MicroStrain's columns: raw ones in g, those of the on-board filter (less its bias estimates) in m/s2.
_SENSORCONNECT = (("scaledAccel", GRAVITY), ("estCompensatedAccel", 1.0))
_SENSORCONNECT_GYRO = ("scaledGyro", "estAngularRate")


def sensorconnect(header: Header) -> list[Layout]:
    """MicroStrain SensorConnect: `Time, inertial-NODE:scaledAccelX, ...`, columns chosen by name.

    The scaled (raw) quantities where they are all there, else those that the on-board filter compensated.
    """
    names, found = header.names, []
    nodes = {name.partition(":")[0]: None for name in names if name.startswith("inertial")}
    for node in nodes if "Time" in names else ():
        channels = {name.partition(":")[2]: name for name in names if name.partition(":")[0] == node}
        accel = next(((key, size) for key, size in _SENSORCONNECT if _has_axes(channels, key)), None)
        gyro = next((key for key in _SENSORCONNECT_GYRO if _has_axes(channels, key)), None)
        if accel is None or gyro is None:
            continue
        columns = {"t": "Time"}
        columns |= {f"gyro_{axis}": channels[gyro + axis.upper()] for axis in AXES}
        columns |= {f"accel_{axis}": channels[accel[0] + axis.upper()] for axis in AXES}
        sizes = {name: accel[1] if name.startswith("accel") else 1.0 for name in columns}
        valid = tuple(f"{name}:valid" for name in columns.values() if f"{name}:valid" in names)
        found.append(Layout("sensorconnect", columns, sizes, valid, sensor=node.partition("-")[2]))
    return found


def _has_axes(channels: Mapping[str, str], key: str) -> bool:
    return all(key + axis.upper() in channels for axis in AXES)


def csv(header: Header) -> list[Layout]:
    """Any table whose columns say what they are and in which unit: `gyro_x_deg_s`, `Accel Y [g]`, `time_ms`.

    What a name does not say of its unit, the line below it may; else a flag says it, or it is SI. A word that
    is no unit makes the column another one. Columns of several sensors are told apart by the other words.
    """
    names = header.names
    numbered = {match[1] for name in names if (match := re.search(r"\[(\d)\]$", name.strip()))}
    numbered |= {
        match[2]
        for name in names
        if (match := re.fullmatch(r"([A-Za-z]+)_?(\d)", name.strip())) and understood(f"{match[1]}_x")
    }
    first = 1 if "3" in numbered and "0" not in numbered else 0
    groups: dict[str, _Group] = {}
    times: dict[str, tuple[str, Named]] = {}
    for place, name in enumerate(names):
        named = understood(name, first)
        named = named and _with_unit(named, header.unit(place))
        if named is None:
            continue
        if named.channel == "t":
            if named.sensor not in times or named.rank < times[named.sensor][1].rank:
                times[named.sensor] = (name, named)
        else:
            groups.setdefault(named.sensor, _Group()).offer(name, named)
    found = []
    for sensor, group in _whole(groups).items():
        chosen = times.get(sensor) or times.get("") or next(iter(times.values()), None)
        if chosen is not None and "t" not in group.columns:
            group.offer(*chosen)
        found.append(_layout("csv", sensor, group, header))
    return found


def _with_unit(named: Named, unit: str) -> Named | None:
    """With the unit below the name, where the name has none; None for one of another quantity."""
    if named.size is not None or not unit or unit.lower() in ("-", "n/a", "none", "unitless"):
        return named
    kind = named.channel.split("_")[0]
    size = unit_size(kind, unit, INCREMENTS) if named.increment else unit_size(kind, unit)
    return replace(named, size=size) if size is not None or kind == "t" else None


def _whole(groups: dict[str, _Group]) -> dict[str, _Group]:
    """Those with every axis; gyro and accelerometer that stand alone under different names make one."""
    found = {name: group for name, group in groups.items() if not missing(group.columns)}
    if "" in found and len(found) > 1 and _twins(found):
        return {"": found[""]}
    if found:
        return found
    gyros = [group for group in groups.values() if set(GYRO) <= set(group.columns)]
    accels = [group for group in groups.values() if set(ACCEL) <= set(group.columns)]
    if len(gyros) != 1 or not accels:
        return {}
    accel = min(accels, key=lambda group: group.named[ACCEL[0]].rank)
    both = _Group()
    for group, names in ((gyros[0], GYRO), (accel, ACCEL)):
        for name in names:
            both.offer(group.columns[name], group.named[name])
    return {"": both}


def _twins(groups: Mapping[str, _Group]) -> bool:
    """Whether a sensor without a name stands beside what is made of it, such as a filter's estimate."""
    return any({"est", "filter", "filtered", "estimated"} & set(name.split("_")) for name in groups)


def _layout(format: str, sensor: str, group: _Group, header: Header) -> Layout:
    sizes = {channel: named.size for channel, named in group.named.items()}
    time = group.columns.get("t", "")
    finer = ""
    if match := re.fullmatch(r"(.*?)(secs?)", time):
        finer = next(
            (name for name in header.names if name in (match[1] + "nsecs", match[1] + "nanosec")), ""
        )
        sizes["t"] = 1.0 if finer else sizes["t"]
    columns = {name: group.columns[name] for name in CHANNELS if name in group.columns}
    return Layout(
        format,
        columns,
        {name: sizes[name] for name in columns},
        sensor=sensor,
        id=_id(header.names),
        finer=finer,
        increments=frozenset(name for name, named in group.named.items() if named.increment),
        rate_hz=_stated_rate(header.preamble),
    )


def _id(names: Sequence[str]) -> str:
    """A column that may tell whose row it is."""
    plain = {name: re.sub(r"[^a-z]", "", name.lower()) for name in names}
    return next((name for name, text in plain.items() if text in ID_WORDS), "")


def _stated_rate(preamble: Sequence[str]) -> float | None:
    for line in preamble:
        if match := re.search(r"(?:rate|frequency)\W+(\d+(?:\.\d+)?)\s*Hz", line, re.IGNORECASE):
            return float(match[1])
    return None


def _named(
    name: str,
    marks: Sequence[str],
    sizes: Mapping[str, float],
    preamble: str = "",
    mirrored: bool = False,
) -> Callable[[Header], list[Layout]]:
    """A format that `csv` reads, told by its columns' names, which leave units open that its makers state."""

    def layouts(header: Header) -> list[Layout]:
        text = "\n".join(header.names)
        above = "\n".join(header.preamble)
        if not all(re.search(mark, text) for mark in marks) or not re.search(preamble, above):
            return []
        return [
            replace(
                one,
                format=name,
                mirrored=mirrored,
                sizes={
                    channel: sizes.get(channel.partition("_")[0]) if size is None else size
                    for channel, size in one.sizes.items()
                },
            )
            for one in csv(header)
        ]

    layouts.__doc__ = f"{name}, by its names."
    return layouts


_SI = {"gyro": 1.0, "accel": 1.0}

# In the order in which they are tried: the strictest first. Units are those of the formats' documents.
LAYOUTS: Mapping[str, Callable[[Header], list[Layout]]] = {
    "footfall": footfall,
    "xio": xio,
    "sensorconnect": sensorconnect,
    "xsens": _named("xsens", ["SampleTimeFine", "(?i)acc_x|dv"], {"t": TICK, **_SI}, r"(?m)^\s*//"),
    "movella": _named("movella", ["SampleTimeFine"], {"t": 1e-6, "gyro": DEG, "accel": 1.0}),
    "euroc": _named("euroc", ["w_RS_S_x", "a_RS_S_x"], {"t": 1e-9, **_SI}),
    "ros": _named("ros", ["angular_velocity", "linear_acceleration"], _SI),
    "px4": _named("px4", [r"gyro_rad\[0\]", r"accelerometer_m_s2\[0\]"], {"t": 1e-6, **_SI}),
    "shimmer": _named("shimmer", ["Timestamp_.*CAL", "Gyro_X_CAL"], {"t": 1e-3, "gyro": DEG, "accel": 1.0}),
    "gaitmap": _named("gaitmap", ["(?:left|right)_sensor.*gyr_x"], {"gyro": DEG, "accel": 1.0}),
    # Of iPhones, as they have it.
    "sensorlog": _named(
        "sensorlog",
        ["(?:motionRotationRate|gyroRotation)X", "accelerometerAccelerationX"],
        {"gyro": 1.0, "accel": GRAVITY},
        mirrored=True,
    ),
    "csv": csv,
}


def find_layouts(path: Path, header: Header, name: str) -> list[Layout]:
    """Where a table holds what: one for each sensor, none where it is not understood.

    Parameters
    ----------
    name : a key of `LAYOUTS`, or "auto"

    Raises
    ------
    InputError
        A column that is needed has a namesake.
    """
    tried = LAYOUTS.values() if name == "auto" else [LAYOUTS[name]]
    for layouts in tried:
        if found := layouts(header):
            for one in found:
                twice = [column for column in one.columns.values() if list(header.names).count(column) > 1]
                if twice:
                    raise InputError(f"two columns are called {twice[0]!r}", path)
            return found
    return []
