"""Stamps as loggers write them: dates and clocks as text, epochs in any unit, counters that start anew."""

from __future__ import annotations

import re
from collections.abc import Sequence
from datetime import date
from typing import Any

import numpy as np

DAY = 86_400.0
# Where a clock starts anew, in its own units: counters of so many bits, and clocks of so many units.
_ROUNDS = (
    *(float(1 << bits) for bits in (8, 16, 24, 32)),
    60.0,
    1e3,
    3600.0,
    6e4,
    DAY,
    1e6,
    3.6e6,
    1e3 * DAY,
)
_PLAUSIBLE_S = (2e-4, 0.05)  # between samples of a walking foot
_UNITS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}

_STAMP = re.compile(
    r"(?:(?P<year>\d{4})[-/.](?P<month>\d{1,2})[-/.](?P<day>\d{1,2})"
    r"|(?P<first>\d{1,2})[-/.](?P<second>\d{1,2})[-/.](?P<last>\d{4}))?[T ,_]*"
    r"(?P<hour>\d{1,2})[:h-](?P<minute>\d{1,2})[:m-](?P<sec>\d{1,2})(?:(?P<mark>[.,:_])(?P<part>\d{1,9}))?"
    r"\s*(?P<half>[AaPp])?\.?[Mm]?\.?\s*(?:Z|UTC|GMT|[+-]\d{2}:?\d{2})?"
)


def is_stamp(cell: str) -> bool:
    """Whether a cell holds a date and time, or a time of day."""
    return _STAMP.fullmatch(cell.strip()) is not None


def ordinal(cell: str) -> int:
    """Number of the day of a stamp; 0 of a time of day."""
    match = _STAMP.fullmatch(cell.strip())
    return 0 if match is None else _day(match)


def seconds(cells: Sequence[str | None]) -> np.ndarray:
    """(n,) s, from the day of the first stamp, of dates and times or times of day; NaN for what is neither.

    Loggers write all stamps alike: those written as the first one is are read all at once.
    """
    first = next((cell for cell in cells if cell and is_stamp(cell)), None)
    if first is None:
        return np.full(len(cells), np.nan)
    day = _day(_STAMP.fullmatch(first.strip()))  # type: ignore[arg-type]
    text = np.array([cell or "" for cell in cells], dtype=np.str_)
    width = text.dtype.itemsize // 4
    letters = text.view(np.uint32).reshape(len(text), width)
    found = np.full(len(text), np.nan)
    alike = np.zeros(len(text), dtype=bool)
    match = _STAMP.fullmatch(first)
    if match is not None and len(first) == width:
        found, alike = _alike(letters, match, day)
    for row in np.flatnonzero(~alike):
        match = _STAMP.fullmatch(str(text[row]).strip())
        found[row] = np.nan if match is None else _one(match, day)
    return found


def _alike(letters: np.ndarray, first: re.Match[str], day: int) -> tuple[np.ndarray, np.ndarray]:
    """Seconds of stamps whose letters (n, width) stand where those of the first do, and which do."""
    digits = letters - ord("0")
    isdigit = digits < 10  # unsigned: what is before "0" is large
    pattern = np.array([ord(letter) for letter in first.string], dtype=np.uint32)
    numeric = (pattern >= ord("0")) & (pattern <= ord("9"))
    # The clock may change; everything else, the day too, is that of the first.
    clock = {name: first.span(name) for name in ("hour", "minute", "sec", "part") if first[name]}
    free = np.zeros(len(pattern), dtype=bool)
    for start, stop in clock.values():
        free[start:stop] = True
    same = letters == pattern
    alike: np.ndarray = np.asarray(np.where(free & numeric, isdigit, same).all(axis=1))

    def number(name: str) -> np.ndarray:
        start, stop = clock[name]
        return digits[:, start:stop].astype(float) @ 10.0 ** np.arange(stop - start)[::-1]

    hour = _hour(number("hour"), first["half"])
    part = number("part") * _share(first) if "part" in clock else 0.0
    total = 3600 * hour + 60 * number("minute") + number("sec") + part
    return np.where(alike, total + DAY * (_day(first) - day), np.nan), alike


def _one(match: re.Match[str], day: int) -> float:
    part = float(match["part"]) * _share(match) if match["part"] else 0.0
    hour = float(_hour(np.array(float(match["hour"])), match["half"]))
    return DAY * (_day(match) - day) + 3600 * hour + 60 * float(match["minute"]) + float(match["sec"]) + part


def _share(match: re.Match[str]) -> float:
    """What one is worth behind the seconds: after a colon it counts milliseconds, in however many digits."""
    digits = len(match["part"])
    return 1e-3 if match["mark"] == ":" and digits <= 3 else 10.0**-digits


def _hour(hour: np.ndarray, half: str | None) -> np.ndarray:
    return hour if half is None else hour % 12 + 12 * (half in "Pp")


def _day(match: re.Match[str]) -> int:
    """Number of the day; days and months that may be either are told apart where only one can be."""
    if match["year"]:
        year, month, day = (int(match[name]) for name in ("year", "month", "day"))
    elif match["last"]:
        year, month, day = (int(match[name]) for name in ("last", "second", "first"))
        if month > 12:
            month, day = day, month
    else:
        return 0
    try:
        return date(year, month, day).toordinal()
    except ValueError:
        return 0


def likely_unit(t: np.ndarray) -> str:
    """The unit in which stamps (n,) of a walking foot can be; "s" where none is likelier."""
    t = t[np.isfinite(t)]
    if len(t) < 2:
        return "s"
    step = np.median(np.abs(np.diff(t)))
    step = step if step > 0 else abs(t[-1] - t[0]) / (len(t) - 1)
    low, high = _PLAUSIBLE_S
    return next((name for name, size in _UNITS.items() if low <= step * size <= high), "s")


class Clock:
    """Stamps that start anew at a round number, made to go on; block by block.

    A step back is such a start where the round's length, added to it, leaves a step forward as the others.
    """

    def __init__(self) -> None:
        self.rounds = 0
        self._last: float | None = None
        self._added = 0.0
        self._step = 0.0

    @np.errstate(invalid="ignore")  # stamps may be infinite
    def __call__(self, t: np.ndarray) -> np.ndarray:
        """Stamps (n,) of the next block, in any unit."""
        before = np.array([] if self._last is None else [self._last])
        raw = np.concatenate([before, t])
        step = np.diff(raw)
        forward = step[step > 0]
        self._step = float(np.median(forward)) if len(forward) else self._step
        if len(t) and np.isfinite(t[-1]):
            self._last = float(t[-1])
        added = np.zeros(len(step))
        for place in np.flatnonzero(step < 0):
            lengths = [round for round in _ROUNDS if 0 <= round + step[place] <= 20.5 * self._step]
            if lengths and self._fits(raw, place, lengths[0]):
                added[place] = lengths[0]
                self.rounds += 1
        total = self._added + np.cumsum(added)
        self._added = float(total[-1]) if len(total) else self._added
        return (
            t + total[len(total) - len(t) :] if len(before) else t + np.concatenate([[0.0], total])[: len(t)]
        )

    def _fits(self, raw: np.ndarray, place: Any, length: float) -> bool:
        """Whether the clock stood near the end of its round, and stands near its beginning."""
        return bool(0 <= raw[place + 1] % length <= 20.5 * self._step or raw[place] < length)
