"""What happens on the way: pauses and changes of pace."""

from __future__ import annotations

from itertools import pairwise

from pydantic import Field

from footfall.errors import InputError
from footfall.simulate.plan import Pace, Stop
from footfall.toml import Strict


class StopTable(Strict):
    """A pause on the way."""

    at_m: float = Field(gt=0)
    for_s: float = Field(gt=0, le=3600)


class PaceTable(Strict):
    """A change of pace on the way."""

    at_m: float = Field(gt=0)
    m_s: float = Field(ge=0.7, le=1.7)


def stops_of(tables: tuple[StopTable, ...], length: float) -> tuple[Stop, ...]:
    """In walking order; 3 m apart and from the ends, or there is no walking between them."""
    at = [0.0, *(table.at_m for table in tables), length]
    for i, (before, after) in enumerate(pairwise(at)):
        if after - before < 3.0:
            number, value = (i + 1, after) if i < len(tables) else (i, before)
            raise InputError(
                f"stops no. {number}, at_m = {value:g}: expected at least 3 m beyond the stop "
                f"(or the start) before it and before the path's end at {length:g} m"
            )
    return tuple(Stop(**table.model_dump()) for table in tables)


def paces_of(tables: tuple[PaceTable, ...], length: float) -> tuple[Pace, ...]:
    """In walking order, and on the path."""
    at = [0.0, *(table.at_m for table in tables)]
    for i, (before, after) in enumerate(pairwise(at)):
        if not before < after < length:
            raise InputError(
                f"paces no. {i + 1}, at_m = {after:g}: expected beyond the change (or the start) "
                f"before it at {before:g} m and before the path's end at {length:g} m"
            )
    return tuple(Pace(**table.model_dump()) for table in tables)
