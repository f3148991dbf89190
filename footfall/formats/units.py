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
    "accel": {"m/s2": 1.0, "g": GRAVITY, "mg": 1e-3 * GRAVITY},
    "temperature": {"degC": 1.0},
}

_SPELLINGS = {
    "dps": "deg/s",
    "mdps": "mdeg/s",
    "°/s": "deg/s",
    "m/s²": "m/s2",
    "m/s^2": "m/s2",
    "m/s/s": "m/s2",
    "µs": "us",
    "sec": "s",
    "seconds": "s",
    "c": "degC",
    "°c": "degC",
    "degc": "degC",
}


def unit_size(quantity: str, text: str) -> float | None:
    """Size in SI of one `text` ("deg/s", "deg_s", "dps", "g", "m_s2", ...); None for no such unit."""
    name = re.sub(r"_+", "/", text.strip().strip("_").lower())
    name = _SPELLINGS.get(name, name)
    return UNITS[quantity].get(name)


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
