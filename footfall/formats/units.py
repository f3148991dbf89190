"""Units of measured quantities: what a column's name or a flag may call them, and how much SI one is."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping

from footfall.conventions import GRAVITY
from footfall.errors import InputError

DEG = math.pi / 180

# Quantity -> unit as people write it -> its size in s, rad/s, m/s2 or degC. The first is the default.
UNITS: Mapping[str, Mapping[str, float]] = {
    "t": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9},
    "gyro": {"rad/s": 1.0, "deg/s": DEG, "mdeg/s": 1e-3 * DEG, "mrad/s": 1e-3},
    "accel": {"m/s2": 1.0, "g": GRAVITY, "mg": 1e-3 * GRAVITY, "cm/s2": 1e-2, "mm/s2": 1e-3, "ft/s2": 0.3048},
    "temperature": {"degC": 1.0},
}
# Of increments over a sampling interval, in place of rates and forces.
INCREMENTS: Mapping[str, Mapping[str, float]] = {
    "gyro": {"rad": 1.0, "deg": DEG},
    "accel": {"m/s": 1.0},
}

_SPELLINGS = {
    "deg": ("°", "º", "degree", "degrees", "degs"),
    "rad": ("radian", "radians", "rads"),
    "s": ("sec", "secs", "second", "seconds"),
    "ms": ("msec", "msecs", "millis", "millisecond", "milliseconds"),
    "us": ("µs", "μs", "usec", "usecs", "micros", "microsecond", "microseconds"),
    "ns": ("nsec", "nsecs", "nanos", "nanosec", "nanosecs", "nanosecond", "nanoseconds"),
    "m": ("meter", "meters", "metre", "metres"),
    "g": ("gs", "g's", "gee", "gees", "gn"),
    "mg": ("millig", "mgs", "milligs"),
    "deg/s": ("dps",),
    "mdeg/s": ("mdps",),
    "degc": ("c", "°c", "celsius", "degrees celsius"),
}
_MEANS = {spelling: unit for unit, spellings in _SPELLINGS.items() for spelling in spellings}
_RAISED = str.maketrans({"â": "", "²": "2", "⁻": "-", "¹": "1"})
_FACTOR = re.compile(r"([a-zµμ°º']+)(-?\d)?")


def unit_size(quantity: str, text: str, units: Mapping[str, Mapping[str, float]] = UNITS) -> float | None:
    """Size in SI of one `text` ("deg/s", "deg_s", "dps", "rad s^-1", "m/(s^2)"); None for no such unit."""
    name = canonical(text)
    return units.get(quantity, {}).get({"degc": "degC"}.get(name, name))


def canonical(text: str) -> str:
    """A unit in one spelling: "m s^-2", "m/sec^2", "m_s2" and "m/s/s" are all "m/s2"; "" for no unit."""
    # What another encoding makes of a degree sign is no ASCII either.
    text = text.strip().lower().translate(_RAISED).replace("**", "")
    text = re.sub(r"[^\x00-\x7fµμ°º]+(?=/)", "°", text)
    text = _MEANS.get(text, text)
    text = re.sub(r"[()\[\]^]", "", text.replace(" per ", "/").replace("·", " ").replace("*", " "))
    parts, powers = re.split(r"([/_\s]+)", text.strip(" _")), []
    below = False
    for place, part in enumerate(parts):
        if place % 2:
            below = below or "/" in part or "_" in part
            continue
        match = _FACTOR.fullmatch(part)
        if match is None:
            return ""
        power = int(match[2] or 1) * (-1 if below else 1)
        powers.append((_MEANS.get(match[1], match[1]), power))
    if len(powers) > 1 and not any(power < 0 for _, power in powers):
        powers[1:] = [(name, -power) for name, power in powers[1:]]  # "deg s"
    above = [name for name, power in powers if power > 0]
    under: dict[str, int] = {}
    for name, power in powers:
        if power < 0:
            under[name] = under.get(name, 0) - power
    if len(above) != 1 or len(under) > 1:
        return ""
    name, power = next(iter(under.items()), ("", 0))
    return above[0] + (f"/{name}" if name else "") + (str(power) if power > 1 else "")


def parse_units(flags: Iterable[str]) -> dict[str, float]:
    """Sizes from flags like `gyro=deg/s`, `accel=g`, `t=ms`.

    Raises
    ------
    InputError
        No such quantity or unit, or a flag of another form.
    """
    sizes: dict[str, float] = {}
    for flag in flags:
        quantity, _, text = flag.partition("=")
        if quantity not in UNITS:
            raise InputError(f"unit {flag!r}: expected QUANTITY=UNIT with one of {', '.join(UNITS)}")
        size = unit_size(quantity, text)
        if size is None:
            raise InputError(
                f"unit {flag!r}: {text!r} is no unit of {quantity}, expected one of "
                f"{', '.join(UNITS[quantity])}"
            )
        sizes[quantity] = size
    return sizes
