"""What phones' apps pack into one archive: tables of gyro and accelerometer (phyphox, Sensor Logger)."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from footfall.errors import InputError
from footfall.formats.files import Content
from footfall.formats.names import AXES, understood
from footfall.formats.options import Reading
from footfall.formats.samples import MIRRORED, Samples, Source
from footfall.formats.stamps import likely_unit
from footfall.formats.table import Opened, open_header, open_table
from footfall.formats.text import TextTable
from footfall.formats.units import UNITS


def open_phone(path: Path, contents: Sequence[Content], reading: Reading) -> Source:
    """Open an archive of several tables: one that holds a whole IMU, or a gyro's and an accelerometer's.

    Raises
    ------
    InputError
        Neither is there, or several whole ones and none chosen (`reading.sensor`, a table's name).
    """
    opened = []
    for content in contents:
        try:
            opened.append(open_header(content, reading.columns))
        except InputError:
            continue  # notes, pictures, another sensor's list
    whole = [one for one in opened if _axes(one, "gyro") and _axes(one, "accel")]
    named = {one.content.name: one.content for one in whole}
    if len(named) == 1:
        return open_table(next(iter(named.values())), "auto", reading)
    if named:
        if reading.sensor in named:
            return open_table(named[reading.sensor], "auto", replace(reading, sensor=None))
        raise InputError(
            f"an archive of {len(named)} recordings, choose one with --sensor: {', '.join(named)}", path
        )
    gyros = [one for one in opened if _axes(one, "gyro")]
    forces = [one for one in opened if _axes(one, "accel")]
    if not gyros or not forces:
        names = ", ".join(one.content.name for one in opened) or "nothing"
        raise InputError(f"an archive without a gyro's and an accelerometer's table (it holds {names})", path)
    notes: list[str] = []
    gyro = _table(_best(gyros), "gyro", reading, notes)
    best = _best(forces)
    force = _table(best, "accel", reading, notes)
    gravity = next((one for one in opened if _stem(one).lower() == "gravity"), None)
    if gravity is not None and _stem(best).lower() in ("accelerometer", "linearacceleration"):
        # Sensor Logger takes gravity out of it, and writes it beside.
        added = _table(gravity, "accel", reading, notes, {})
        force = (force[0], force[1] + _at(force[0], added))
    if _is_mirrored(contents):
        force = (force[0], -force[1])
        notes.append(MIRRORED)
    t = np.union1d(gyro[0], force[0])
    values = [np.full((len(t), 3), np.nan) for _ in range(2)]
    for made, (stamps, rows) in zip(values, (gyro, force), strict=True):
        made[np.searchsorted(t, stamps)] = rows
    unstated = frozenset({"gyro", "accel"} - set(reading.sizes))
    return Source(path, "phone", len(t), iter([Samples(0, t, *values)]), notes=notes, unstated=unstated)


def _is_mirrored(contents: Sequence[Content]) -> bool:
    """Whether Sensor Logger wrote -f, as iPhones have it unless units and frames are standardised."""
    for content in contents:
        if content.name.rsplit("/", 1)[-1].lower() == "metadata.csv":
            lines = content.head.decode("utf-8", errors="replace").splitlines()[:2]
            told = dict(zip(*csv.reader(lines), strict=False)) if len(lines) == 2 else {}
            standard = told.get("standardisation", "").strip().lower() in ("true", "1", "yes")
            return told.get("platform", "").strip().lower() == "ios" and not standard
    return False


def _stem(one: Opened) -> str:
    return re.sub(r"\.\w+$", "", one.content.name.rsplit("/", 1)[-1])


def _full(one: Opened) -> list[str]:
    """Its columns' names, with the table's own before those that name an axis alone."""
    names = []
    for name in one.header.names:
        axis = re.fullmatch(r"\s*([xyzXYZ])(?:[- _]?axis)?(\s*[\[(].*[\])])?\s*", name)
        names.append(f"{_stem(one)} {axis[1]}{axis[2] or ''}" if axis else name)
    return names


def _axes(one: Opened, kind: str) -> dict[str, str] | None:
    """Axis -> column, where all three of that sensor are there."""
    found: dict[str, str] = {}
    for full, name in zip(_full(one), one.header.names, strict=True):
        named = understood(full)
        if named is not None and named.channel.startswith(kind):
            found.setdefault(named.channel[-1], name)
    return found if set(found) == set(AXES) else None


def _best(tables: Sequence[Opened]) -> Opened:
    """The one with gravity in it, and as little else done to it as can be."""

    def rank(one: Opened) -> tuple[int, int]:
        stem = _stem(one).lower()
        return "linear" in stem or "user" in stem, ("uncalibrated" in stem) - ("total" in stem)

    return min(tables, key=rank)


def _table(
    one: Opened, kind: str, reading: Reading, notes: list[str], axes: dict[str, str] | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Stamps (n,) s, and (n, 3) in SI."""
    found = axes or _axes(one, kind) or {axis: axis for axis in AXES}
    columns = [found[axis] for axis in AXES]
    time = _time(one)
    assert one.dialect is not None
    if not set(columns) <= set(one.header.names) or time is None:
        raise InputError(f"its table {one.content.name!r} has no stamps or axes", one.content.path)
    parts = list(TextTable(one.content, one.dialect, one.header.names, [time, *columns], (), notes))
    t = np.concatenate([part[time] for part in parts])
    values = np.column_stack([np.concatenate([part[name] for part in parts]) for name in columns])
    sizes = [understood(full) for full, name in zip(_full(one), one.header.names, strict=True)
             if name == columns[0]]  # fmt: skip
    stated = sizes[0].size if sizes and sizes[0] is not None else None
    size = reading.sizes.get(kind, stated or 1.0)
    told = understood(time)
    unit = reading.sizes.get("t") or (told.size if told is not None else None)
    t = t * (unit or UNITS["t"][likely_unit(t)])
    order = np.argsort(t, kind="stable")
    keep = order[np.isfinite(t[order])]
    keep = keep[np.diff(t[keep], prepend=-np.inf) > 0]
    return t[keep], values[keep] * size


def _time(one: Opened) -> str | None:
    found = [(named.rank, name) for name in one.header.names if (named := understood(name)) and
             named.channel == "t"]  # fmt: skip
    return min(found)[1] if found else None


def _at(t: np.ndarray, table: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    return np.column_stack([np.interp(t, table[0], axis) for axis in table[1].T])
