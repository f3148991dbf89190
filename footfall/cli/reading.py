"""What options say of a file that does not say it itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

from footfall.errors import InputError

if TYPE_CHECKING:
    from footfall.formats.options import Reading

MOST_GAP_S = 5.0


def reading_of(
    unit: list[str] | None,
    rate: float | None,
    columns: str | None = None,
    sensor: str | None = None,
    max_gap: float | None = None,
) -> Reading:
    """The options `--unit`, `--rate`, `--columns`, `--sensor` and `--max-gap` together.

    Raises
    ------
    InputError
        One of them cannot be.
    """
    from footfall.formats.condition import FILL_S
    from footfall.formats.options import Reading
    from footfall.formats.units import parse_units

    if rate is not None and rate <= 0:
        raise InputError(f"rate = {rate:g} Hz: expected a positive number")
    gap = FILL_S if max_gap is None else max_gap
    if not 0 <= gap <= MOST_GAP_S:
        raise InputError(f"--max-gap = {gap:g} s: expected 0 to {MOST_GAP_S:g}")
    names = tuple(name.strip() for name in columns.split(",")) if columns else ()
    return Reading(parse_units(unit or ()), rate, names, sensor, gap)
