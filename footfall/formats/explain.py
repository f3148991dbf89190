"""A file that is not understood: what it holds, what each column was taken for, and what would do."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from footfall.columns import ACCEL, GYRO
from footfall.conventions import GRAVITY
from footfall.errors import InputError
from footfall.formats.dialect import is_number
from footfall.formats.layout import Header, csv
from footfall.formats.names import understood
from footfall.formats.stamps import is_stamp

SHOWN = 40  # columns at most


def not_understood(
    path: Path, header: Header, rows: Sequence[Sequence[str]], format: str = "auto"
) -> InputError:
    """The mistake to raise: a sentence, and a table with the line that would do."""
    names = [name for name in header.names if name]
    if not names:
        told = f"no line of names above its {len(header.names)} columns of numbers: name them with --columns"
    elif format not in ("auto", "csv", "footfall"):
        told = f"not the columns of format {format!r} (found {', '.join(names[:8])})"
    else:
        lacking = [name for name in (*GYRO, *ACCEL) if name not in _taken(header).values()]
        wanted = ", ".join(("t", *GYRO, *ACCEL))
        name = lacking[0] if lacking else "t"
        told = f"column {name!r} is missing (expected {wanted}, or the like): name yours with --columns"
    table = "\n".join([*described(header, rows), "", suggestion(header, rows)])
    return InputError(told, path, table)


def _taken(header: Header) -> dict[int, str]:
    found = {place: understood(name) for place, name in enumerate(header.names)}
    return {place: named.channel for place, named in found.items() if named is not None}


def described(header: Header, rows: Sequence[Sequence[str]]) -> list[str]:
    """Lines of a table: each column, its first cells, what it was taken for, and why not."""
    taken = _taken(header)
    used = {column for layout in csv(header) for column in layout.columns.values()}
    cells = [["column", "first rows", "taken for", "because"]]
    for place, name in enumerate(header.names[:SHOWN]):
        first = [row[place] for row in rows[:3] if place < len(row)]
        named = understood(name) if name else None
        if not name:
            why = "has no name"
        elif named is None:
            why = "no word for a quantity of an IMU" if all(map(is_number, first)) else "holds no numbers"
        elif name in used:
            why = "its unit is stated" if named.size else "its name"
        elif list(taken.values()).count(named.channel) > 1 and name not in used:
            why = "another column says the same better"
        else:
            why = "not all axes of that sensor are there"
        unit = header.unit(place)
        label = (name or f"({place + 1})") + (f" [{unit}]" if unit else "")
        cells.append([label, " ".join(first), named.channel if named else "-", why])
    widths = [max(len(row[j]) for row in cells) for j in range(4)]
    lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in cells]
    more = len(header.names) - SHOWN
    return [line.rstrip() for line in lines] + ([f"and {more} more"] if more > 0 else [])


def suggestion(header: Header, rows: Sequence[Sequence[str]]) -> str:
    """The options with which it may be read, by its numbers: stamps increase, a force at rest is gravity."""
    values = _numbers(rows, len(header.names))
    names = ["-"] * len(header.names)
    taken = _taken(header)
    for place, channel in taken.items():
        names[place] = channel
    free = [
        place for place in range(len(names)) if place not in taken and np.isfinite(values[:, place]).all()
    ]
    if "t" not in names:
        step = np.diff(values, axis=0)
        rising = [place for place in free if len(step) and (step[:, place] > 0).all()]
        stamps = [p for p in range(len(names)) if rows and p < len(rows[0]) and is_stamp(rows[0][p])]
        for place in (*stamps, *rising)[:1]:
            names[place] = "t"
            free = [other for other in free if other != place]
    units = _name_triples(names, free, values)
    told = ["--columns " + ",".join(names)]
    told += [f"--unit {quantity}={unit}" for quantity, unit in units.items()]
    if "t" not in names:
        told.append("--rate HZ")
    if {*GYRO, *ACCEL} <= set(names):
        return "By its numbers this may do: " + " ".join(told)
    return "Name its columns in order, - for those that are none: --columns t,gx,gy,gz,ax,ay,az"


def _numbers(rows: Sequence[Sequence[str]], width: int) -> np.ndarray:
    values = np.full((len(rows), width), np.nan)
    for i, row in enumerate(rows):
        for j, cell in enumerate(row[:width]):
            if is_number(cell):
                values[i, j] = float(cell.replace(",", "."))
    return values


def _name_triples(names: list[str], free: list[int], values: np.ndarray) -> dict[str, str]:
    """Name accelerometers and gyros among the free columns; returns the units that are not SI."""
    units: dict[str, str] = {}
    if not len(values):
        return units
    triples = [place for place in free if {place + 1, place + 2} <= set(free)]
    size = {
        place: float(np.median(np.linalg.norm(values[:, place : place + 3], axis=1))) for place in triples
    }
    if "accel_x" not in names:
        for unit, one in (("m/s2", GRAVITY), ("g", 1.0), ("mg", 1000.0)):
            near = [place for place in triples if abs(size[place] / one - 1) < 0.1]
            if near:
                names[near[0] : near[0] + 3] = ACCEL
                triples = [place for place in triples if abs(place - near[0]) > 2]
                units |= {} if unit == "m/s2" else {"accel": unit}
                break
    if "gyro_x" not in names and triples:
        names[triples[0] : triples[0] + 3] = GYRO
    return units
