"""From samples as they were logged to a recording: doubled, lost, late and clipped ones found and handled."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from footfall.columns import ACCEL, GYRO
from footfall.errors import InputError
from footfall.formats.clipping import clipped_runs, restored
from footfall.formats.samples import Samples

FILL_S = 0.25  # the longest hole that is filled: dead reckoning refuses longer ones
JITTER = 0.1  # of an interval; stamps that scatter more are not evenly spaced
MOST_OFF = 5.0  # intervals by which a stamp may lie off an even spacing
DOUBLED = 0.9  # share of the rows with the stamp of the one before that must repeat it, or none is a double
LARGEST = {"t": 1e19, "gyro": 1e10, "accel": 1e10}  # in any unit: beyond it arithmetic fails
LEAST_RANGE = {"gyro": np.radians(100.0), "accel": 15.0}  # rad/s, m/s2; no sensor has less


@dataclass(frozen=True)
class Findings:
    """What was found wrong with the samples, and mended.

    Attributes
    ----------
    format : of the file
    rows : in the file
    rate_hz : of the samples, median
    empty : rows without samples, left out
    doubled : rows that say again what the one before said at the same time, left out
    filled : lost samples, put in on a straight line between their neighbours
    longest_gap_s : longest hole that was filled or left
    jitter_pct : scatter of the stamps' distances, % of an interval
    restamped : whether the stamps were replaced by evenly spaced ones
    clipped : channel -> samples held at its extreme; those of gyros were restored
    notes : what was wrong with the file itself
    """

    format: str
    rows: int
    rate_hz: float
    empty: int = 0
    doubled: int = 0
    filled: int = 0
    longest_gap_s: float = 0.0
    jitter_pct: float = 0.0
    restamped: bool = False
    clipped: tuple[tuple[str, int], ...] = ()
    notes: tuple[str, ...] = ()

    def sentences(self) -> list[str]:
        """What a person should know; nothing for a clean recording."""
        said = list(self.notes)
        if self.empty:
            said.append(f"{self.empty} rows without samples left out")
        if self.doubled:
            said.append(f"{self.doubled} doubled rows left out")
        if self.filled:
            said.append(f"{self.filled} lost samples filled in (longest hole {self.longest_gap_s:.3g} s)")
        if self.restamped:
            said.append(f"stamps jitter by {self.jitter_pct:.0f} % of an interval: spaced evenly")
        elif self.jitter_pct > 100 * JITTER:
            said.append(f"stamps jitter by {self.jitter_pct:.0f} % of an interval and were kept")
        for name, count in self.clipped:
            mended = ", which were restored" if name in GYRO else ""
            said.append(f"{name} is clipped in {count} samples{mended}")
        return said

    def as_dict(self) -> dict[str, Any]:
        """For a file's metadata."""
        return asdict(self) | {"clipped": dict(self.clipped)}


def condition(samples: Samples, format: str, *, whole: bool = True) -> tuple[Samples, Findings]:
    """Mend what loggers do to samples.

    Rows without any value are left out, and so are rows that repeat the one before with its stamp. Samples
    that share a stamp are spread to the next one. Stamps that scatter about an even spacing are replaced by
    it: samplers are regular, loggers are not. Holes up to `FILL_S` are filled by straight lines, longer ones
    are left for dead reckoning to refuse. Clipped samples are counted, and those of gyros restored
    (`restored`); a shock that clips an accelerometer is too short for that.

    Parameters
    ----------
    samples : (n,) rows
    whole : False for a block of a longer record, whose stamps are then never replaced

    Raises
    ------
    InputError
        A value is not finite, a stamp lies before the one before it, or fewer than two samples are left.
    """
    rows = len(samples)
    samples, empty = _without_empty(samples)
    samples, doubled = _without_doubled(samples)
    samples = replace(samples, t=_spread(samples.t))
    if len(samples) < 2:
        raise InputError(f"{len(samples)} samples, expected at least 2", "recording")
    step = np.diff(samples.t)
    interval = float(np.median(step))
    low, high = np.percentile(step, [16, 84])
    jitter, restamped = float(high - low) / 2 / interval, False
    if jitter > JITTER and whole:
        even = _evenly(samples.t)
        if np.abs(even - samples.t).max() < MOST_OFF * interval:
            samples, restamped = replace(samples, t=even), True
            interval = float(np.median(np.diff(even)))
    gap = float(np.diff(samples.t).max())
    if jitter <= JITTER or restamped:
        before = len(samples)
        samples = _filled(samples, interval)
        filled = len(samples) - before
    else:
        filled = 0
    samples, clipped = _unclipped(samples, interval)
    return samples, Findings(
        format=format,
        rows=rows,
        rate_hz=1 / interval,
        empty=empty,
        doubled=doubled,
        filled=filled,
        longest_gap_s=gap if gap > 1.5 * interval else 0.0,
        jitter_pct=100 * jitter,
        restamped=restamped,
        clipped=clipped,
    )


def _without_empty(samples: Samples) -> tuple[Samples, int]:
    values = np.column_stack([samples.gyro, samples.accel])
    finite = np.isfinite(values)
    empty = np.isnan(values).all(axis=1) | np.isnan(samples.t)
    bad = ~empty & ~(finite.all(axis=1) & np.isfinite(samples.t))
    if bad.any() or empty.all():
        row = int(np.argmax(bad)) if bad.any() else 0
        axis = int(np.argmin(finite[row])) if not finite[row].all() else -1
        name = "t" if axis < 0 else ("gyro" if axis < 3 else "accel")
        raise InputError(f"{name} is not finite at row {samples.row + row}", "recording")
    samples = samples.take(~empty) if empty.any() else samples
    for name, largest in LARGEST.items():
        size = np.abs(getattr(samples, name)).reshape(len(samples), -1).max(axis=1)
        if size.max() > largest:
            raise InputError(f"{name} is {size.max():.3g} somewhere, which no sensor says", "recording")
    return samples, int(empty.sum())


def _without_doubled(samples: Samples) -> tuple[Samples, int]:
    step = np.diff(samples.t)
    if (step < 0).any():
        row = int(np.argmax(step < 0)) + 1
        raise InputError(
            f"t does not increase at row {samples.row + row} (t = {samples.t[row]:.6g} s)", "recording"
        )
    shared = np.flatnonzero(step == 0) + 1
    same = shared
    for values in (samples.gyro, samples.accel):
        same = same[(values[same] == values[same - 1]).all(axis=1)]
    # Stamps that different samples share too are coarse: a still sensor says the same twice.
    if len(same) < DOUBLED * len(shared) or not len(same):
        return samples, 0
    return samples.take(np.setdiff1d(np.arange(len(samples)), same)), len(same)


def _spread(t: np.ndarray) -> np.ndarray:
    """Stamps that several samples share, spread evenly until the next."""
    first = np.flatnonzero(np.diff(t, prepend=-np.inf) > 0)
    if len(first) == len(t) or len(first) < 2:
        if len(first) < 2 <= len(t):
            raise InputError(f"every row has the same time, t = {t[0]:.6g} s", "recording")
        return t
    # The last stamp's samples follow each other as those before did.
    interval = (t[first[-1]] - t[first[0]]) / (first[-1] - first[0])
    knots = np.append(first, len(t))
    values = np.append(t[first], t[first[-1]] + interval * (len(t) - first[-1]))
    return np.interp(np.arange(len(t)), knots, values)


def _evenly(t: np.ndarray) -> np.ndarray:
    k = np.arange(len(t))
    slope, offset = np.polynomial.polynomial.polyfit(k - k.mean(), t, 1)[::-1]
    return offset + slope * (k - k.mean())


def _filled(samples: Samples, interval: float) -> Samples:
    step = np.diff(samples.t)
    lost = np.where((step > 1.5 * interval) & (step <= FILL_S), np.round(step / interval) - 1, 0)
    if not lost.any():
        return samples
    place = np.concatenate([[0], np.cumsum(lost + 1)])
    every = np.arange(place[-1] + 1)

    def fill(values: np.ndarray) -> np.ndarray:
        return np.interp(every, place, values)

    warm = samples.temperature
    return Samples(
        row=samples.row,
        t=fill(samples.t),
        gyro=np.column_stack([fill(axis) for axis in samples.gyro.T]),
        accel=np.column_stack([fill(axis) for axis in samples.accel.T]),
        temperature=None if warm is None else fill(warm),
    )


def _unclipped(samples: Samples, interval: float) -> tuple[Samples, tuple[tuple[str, int], ...]]:
    gyro, found = samples.gyro, []
    for axis in range(3):
        runs = clipped_runs(samples.gyro[:, axis], interval, LEAST_RANGE["gyro"])
        if len(runs):
            if gyro is samples.gyro:
                gyro = gyro.copy()
            gyro[:, axis] = restored(samples.gyro[:, axis], runs)
            found.append((GYRO[axis], int(np.diff(runs).sum())))
    for axis in range(3):
        runs = clipped_runs(samples.accel[:, axis], interval, LEAST_RANGE["accel"])
        if len(runs):
            found.append((ACCEL[axis], int(np.diff(runs).sum())))
    return replace(samples, gyro=gyro), tuple(found)
