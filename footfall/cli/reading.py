"""What a file is, and what options say of one that does not say it itself."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from footfall.columns import ACCEL, GYRO, POSITION, TRACK
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


_WANTED = {"walk": "a walk that `footfall walk` wrote", "track": "a track, as `footfall track` writes it"}


def require_kind(path: Path, wanted: str, hint: str = "") -> None:
    """Refuse a table that is something else than what is wanted.

    Parameters
    ----------
    wanted : "walk" or "track"
    hint : what else to do with such a file

    Raises
    ------
    InputError
        Absent, unreadable, or of another kind, which is told where its columns show it.
    """
    from footfall.tables import column_names

    names = set(column_names(path))
    kinds = {"walk": {*POSITION}, "track": {*TRACK}, "recording": {*GYRO, *ACCEL}}
    kind = next((kind for kind, own in kinds.items() if own <= names), None)
    if kind == wanted:
        return
    if kind is not None:
        raise InputError(f"is a {kind}, expected {_WANTED[wanted]}{hint}", path)
    if not kinds[wanted] & names - {"t"}:
        shown = ", ".join(column_names(path)[:6])
        raise InputError(
            f"is not a {wanted}: its columns are {shown}; expected {_WANTED[wanted]}{hint}", path
        )
