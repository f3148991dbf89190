"""What several commands understand alike: names of methods, sensor effects, dominant directions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from footfall.errors import InputError
from footfall.hdr.method import Method
from footfall.hdr.methods import find_method
from footfall.models.imu import EFFECTS, require_effects


def methods_of(text: str) -> list[Method]:
    """Methods by comma: a name, what `find_method` understands, or NAME=USE to call it by another name.

    Raises
    ------
    InputError
        A method that cannot be found.
    """
    found = []
    for part in dict.fromkeys(part.strip() for part in text.split(",")):
        name, equals, use = part.partition("=")
        found.append(find_method(use, name=name) if equals else find_method(part))
    return found


def dropped_effects(without: Sequence[str] | None, only: Sequence[str] | None) -> tuple[str, ...]:
    """The effects that are switched off.

    Raises
    ------
    InputError
        Both are given, or an effect that does not exist.
    """
    if without and only:
        raise InputError("--without and --only: expected one of them")
    require_effects([*(without or ()), *(only or ())])
    return tuple(name for name in EFFECTS if name not in only) if only else tuple(without or ())


def told_directions(
    methods: Sequence[Method], count: int | None, reference_deg: float | None
) -> dict[str, Any]:
    """Dominant directions as values by address, for those methods that go by them.

    Raises
    ------
    InputError
        None of them does.
    """
    values: dict[str, Any] = {}
    for method in methods:
        if count is not None and method.directions != "none":
            values[f"{method.name}.directions.count"] = count
        if reference_deg is not None and method.directions == "all":
            values[f"{method.name}.directions.reference_deg"] = reference_deg
    if not values and (count is not None or reference_deg is not None):
        names = ", ".join(method.name for method in methods)
        raise InputError(f"--directions and --reference: none of {names} goes by dominant directions")
    return values


def number_range(text: str) -> tuple[float, float]:
    """`FROM..TO` as numbers.

    Raises
    ------
    InputError
        It is not written so, or is no range.
    """
    low, dots, high = text.partition("..")
    try:
        found = float(low), float(high)
    except ValueError:
        found = (math.nan, math.nan)
    if not dots or not all(map(math.isfinite, found)) or found[0] >= found[1]:
        raise InputError(f"{text!r}: expected FROM..TO, as 0.1..1.0")
    return found


def unit_range(text: str) -> tuple[int, int]:
    """`FROM..TO` as the first unit's seed and how many units there are.

    Raises
    ------
    InputError
        It is not written so, or is no range.
    """
    first, dots, last = text.partition("..")
    if not (dots and first.isdecimal() and last.isdecimal() and int(first) <= int(last)):
        raise InputError(f"{text!r}: expected the seeds of units FROM..TO, as 1000..1044")
    return int(first), int(last) - int(first) + 1
