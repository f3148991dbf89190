"""OpenShoe's text files: a MicroStrain 3DM-GX2, `0xcb ax ay az gx gy gz counter 0xchecksum Nr ...`."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import numpy as np

from footfall.conventions import GRAVITY
from footfall.errors import InputError
from footfall.formats.files import Content
from footfall.formats.samples import TORN, Samples, Source

TICKS = 19_660_800.0  # a second of the sensor's timer (3DM-GX2 communication protocol)
_FIELDS = {1: "a_x", 2: "a_y", 3: "a_z", 4: "ar_x", 5: "ar_y", 6: "ar_z", 7: "Counter", 9: "Nr"}
_LINES = 1 << 15


def is_openshoe(head: bytes) -> bool:
    """Whether a file's first bytes are those of OpenShoe's recorder."""
    return b"Inertial data." in head[:200] and b"a_x [g]" in head[:1000]


def open_openshoe(content: Content) -> Source:
    """Open a file of OpenShoe's recorder: g, rad/s, and the sensor's own clock.

    The computer's stamps jitter by samples; the sensor's do not. Its sample number times the median step
    of its timer is the time.
    """
    notes: list[str] = []
    blocks = _blocks(content.path, content, notes)
    return Source(content.path, "openshoe", content.size // 230, blocks, notes=notes)


def _blocks(path: Path, content: Content, notes: list[str]) -> Iterator[Samples]:
    start, interval, row, before = 0.0, 0.0, 0, -np.inf
    with open(content.at, encoding="ascii", errors="replace") as file:
        for line in file:
            if line.startswith("Header:"):
                break
        held: list[str] = []
        while lines := held + [line for line in islice(file, _LINES) if line.strip()]:
            # The last line may be half a one: it is judged when nothing follows it.
            lines, held = (lines[:-1], lines[-1:]) if len(lines) > 1 else (lines, [])
            values = _numbers(path, lines, row, last=not held)
            if row == 0 and len(values) > 1:
                start, interval = values[0, 7], _interval(path, values[:, 6])
            number = values[:, 7]
            if not held and len(number) and number[-1] <= before:
                values, number = values[:-1], number[:-1]  # its number was cut short
            if len(values) < len(lines):
                notes.append(TORN)
            if len(number):
                before = number[-1]
                yield Samples(row, (number - start) * interval, values[:, 3:6], values[:, :3] * GRAVITY)
            row += len(lines)


def _numbers(path: Path, lines: list[str], row: int, last: bool) -> np.ndarray:
    if last and len(lines[-1].split()) < max(_FIELDS) + 1:
        lines = lines[:-1]
    if not lines:
        return np.empty((0, len(_FIELDS)))
    try:
        return np.loadtxt(lines, usecols=tuple(_FIELDS), ndmin=2)
    except (ValueError, IndexError):
        for offset, line in enumerate(lines):
            fields = line.split()
            for place, name in _FIELDS.items():
                try:
                    float(fields[place])
                except (ValueError, IndexError):
                    raise InputError(
                        f"{name} is no number in row {row + offset} ({line.strip()[:40]!r})", path
                    ) from None
        raise


def _interval(path: Path, counter: np.ndarray) -> float:
    step = np.diff(counter)
    step = step[step > 0]  # the timer starts anew every second
    if not len(step):
        raise InputError("Counter never increases", path)
    return float(np.median(step)) / TICKS
