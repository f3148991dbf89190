"""From samples as they were logged to a recording: lost, doubled, late and clipped ones found and handled."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, replace
from typing import Any

import numpy as np

from footfall.columns import ACCEL, GYRO
from footfall.errors import InputError
from footfall.formats.clipping import clipped_runs, restored
from footfall.formats.diagnosis import told_lag
from footfall.formats.holes import Hole, bridged
from footfall.formats.losses import Lost, without_lost
from footfall.formats.order import in_order
from footfall.formats.samples import Samples

FILL_S = 0.25  # the longest hole that is filled: dead reckoning refuses longer ones
JITTER = 0.1  # of an interval; stamps that scatter more are not evenly spaced
MOST_OFF = 5.0  # intervals by which a stamp may lie off an even spacing
DOUBLED = 0.9  # share of the rows with the stamp of the one before that must repeat it, or none is a double
SLOWER = 0.2  # share of rows without a sensor's sample above which it is a slower sensor
LARGEST = {"t": 1e19, "gyro": 1e10, "accel": 1e10}  # in any unit: beyond it arithmetic fails
LEAST_RANGE = {"gyro": np.radians(100.0), "accel": 15.0}  # rad/s, m/s2; no sensor has less
_SENSORS = {"gyro": "the gyros", "accel": "the accelerometers"}


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
    disordered : rows that were put back where their stamps say
    lost : rows that no sensor can have measured, left out
    slower : sensor -> Hz, of one that was put in between by straight lines
    filled : lost samples, put in on a straight line between their neighbours
    longest_gap_s : longest hole that was filled or left
    doubtful : holes (s, s) that were filled in which the foot may have moved: their strides are not known
    jitter_pct : scatter of the stamps' distances, % of an interval
    restamped : whether the stamps were replaced by evenly spaced ones
    clipped : channel -> samples held at its extreme; those of gyros were restored
    notes : what was wrong with the file itself
    misclosure_g : g, velocity that a stride leaves over its duration, median; None where it was not computed
    lag_s : s by which the gyros were later than the accelerometers, put right; 0 where they were not
    cause : what is probably wrong with a recording whose strides do not close; "" where nothing is known
    """

    format: str
    rows: int
    rate_hz: float
    empty: int = 0
    doubled: int = 0
    disordered: int = 0
    lost: Lost = field(default_factory=Lost)
    slower: tuple[tuple[str, float], ...] = ()
    filled: int = 0
    longest_gap_s: float = 0.0
    doubtful: tuple[Hole, ...] = ()
    jitter_pct: float = 0.0
    restamped: bool = False
    clipped: tuple[tuple[str, int], ...] = ()
    notes: tuple[str, ...] = ()
    misclosure_g: float | None = None
    lag_s: float = 0.0
    cause: str = ""

    def sentences(self) -> list[str]:
        """What a person should know; nothing for a clean recording."""
        said = list(self.notes)
        if self.empty:
            said.append(f"{self.empty} rows without samples left out")
        if self.doubled:
            said.append(f"{self.doubled} doubled rows left out")
        if self.disordered:
            said.append(f"{self.disordered} rows stood out of order: sorted by their stamps")
        said += self.lost_sentences()
        for name, rate in self.slower:
            said.append(f"{_SENSORS[name]} speak at {rate:.3g} Hz: put in between by straight lines")
        if self.filled:
            said.append(f"{self.filled} lost samples filled in (longest hole {self.longest_gap_s:.3g} s)")
        for first, last in self.doubtful:
            said.append(
                f"{last - first:.2g} s of a swing are lost after t = {first:.5g} s: that stride is doubtful"
            )
        if self.restamped:
            said.append(f"stamps jitter by {self.jitter_pct:.0f} % of an interval: spaced evenly")
        elif self.jitter_pct > 100 * JITTER:
            said.append(f"stamps jitter by {self.jitter_pct:.0f} % of an interval and were kept")
        for name, count in self.clipped:
            mended = ", which were restored" if name in GYRO else ""
            said.append(f"{name} is clipped in {count} samples{mended}")
        if self.lag_s:
            said.append(f"{told_lag(self.lag_s)}: put right")
        return said

    def lost_sentences(self) -> list[str]:
        """What was left out, as no sensor measured it."""
        lost, said = self.lost, []
        if lost.impossible:
            said.append(f"{lost.impossible} impossible rows left out")
        if lost.zeros:
            said.append(f"{lost.zeros} rows of zeros in every channel: lost samples")
        if lost.frozen:
            said.append(f"{lost.frozen} rows repeat the one before them, frozen: lost samples")
        for name, count in lost.dead:
            said.append(f"{name} stays as it is for {count} rows while the foot moves: lost samples")
        if len({rate for _, rate in lost.held}) == 1 and len(lost.held) == 2:
            said.append(f"samples at {lost.held[0][1]:.3g} Hz were logged more often: each is used once")
        else:
            said += [f"{_SENSORS[name]} were logged more often than at their {rate:.3g} Hz"
                     for name, rate in lost.held]  # fmt: skip
        return said

    def as_dict(self) -> dict[str, Any]:
        """For a file's metadata."""
        return asdict(self) | {"clipped": dict(self.clipped)}


@np.errstate(over="ignore", invalid="ignore")  # what overflows is refused, or left out as impossible
def condition(
    samples: Samples, format: str, *, whole: bool = True, gap_s: float = FILL_S, doubted: bool = True
) -> tuple[Samples, Findings]:
    """Mend what loggers do to samples.

    Rows without any value are left out, and so are rows that repeat the one before with its stamp, and
    samples that no sensor can have measured (`without_lost`). A sensor that is slower than the other is put
    in between by straight lines. Samples that share a stamp are spread to the next one. Stamps that scatter
    about an even spacing are replaced by it: samplers are regular, loggers are not. Holes are filled
    (`bridged`), longer ones are left for dead reckoning to refuse. Clipped samples are counted, and those of
    gyros restored (`restored`); a shock that clips an accelerometer is too short for that.

    Parameters
    ----------
    samples : (n,) rows
    whole : False for a block of a longer record, whose stamps are then never replaced
    gap_s : s, the longest hole in a swing that is filled
    doubted : False for samples that a sensor is known to have measured, all of them

    Raises
    ------
    InputError
        Too many stamps are none, stamps go back, or fewer than two samples are left.
    """
    rows = len(samples)
    samples, empty = _without_empty(samples)
    samples, disordered = in_order(samples)
    samples, doubled = _without_doubled(samples)
    samples = replace(samples, t=_spread(samples.t))
    lost = Lost()
    if doubted:
        gyro, accel, lost = without_lost(samples.t, samples.gyro, samples.accel)
        samples = replace(samples, gyro=gyro, accel=accel)
    samples, slower, single = _together(samples, gap_s)
    _require_size(samples)
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
    filled, doubtful = 0, tuple[Hole, ...]()
    if jitter <= JITTER or restamped:
        samples, filled, doubtful = bridged(samples, interval, gap_s)
    begin = float(samples.t[0])
    samples, clipped = _unclipped(samples, interval)
    return samples, Findings(
        format=format,
        rows=rows,
        rate_hz=1 / interval,
        empty=empty,
        doubled=doubled,
        disordered=disordered,
        lost=lost,
        slower=slower,
        filled=filled + single,
        longest_gap_s=gap if gap > 1.5 * interval else interval if single else 0.0,
        doubtful=tuple((first - begin, last - begin) for first, last in doubtful),
        jitter_pct=100 * jitter,
        restamped=restamped,
        clipped=clipped,
    )


def _without_empty(samples: Samples) -> tuple[Samples, int]:
    """Without rows that say nothing, or not when."""
    empty = np.isnan(samples.gyro).all(axis=1) & np.isnan(samples.accel).all(axis=1)
    empty |= ~np.isfinite(samples.t)
    if empty.all():
        raise InputError("no row has both a stamp and samples", "recording")
    if (~np.isfinite(samples.t)).mean() > 0.1:
        row = int(np.argmin(np.isfinite(samples.t)))
        raise InputError(f"t is not finite at row {samples.row + row}, nor in many others", "recording")
    return (samples.take(~empty) if empty.any() else samples), int(empty.sum())


def _require_size(samples: Samples) -> None:
    for name, largest in LARGEST.items():
        size = float(np.abs(getattr(samples, name)).max(initial=0.0))
        if size > largest:
            raise InputError(f"{name} is {size:.3g} somewhere, which no sensor says", "recording")


def _without_doubled(samples: Samples) -> tuple[Samples, int]:
    step = np.diff(samples.t)
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


def _together(samples: Samples, gap_s: float) -> tuple[Samples, tuple[tuple[str, float], ...], int]:
    """Both sensors in every row: at the times of the faster, the other put in between; holes are left out.

    Returns
    -------
    Samples without NaN, the rate of a slower sensor, and how many samples were put in for lost ones.
    """
    t = samples.t
    told = {name: np.isfinite(getattr(samples, name)).all(axis=1) for name in ("gyro", "accel")}
    if all(one.all() for one in told.values()):
        return samples, (), 0
    base, other = ("gyro", "accel") if told["gyro"].sum() >= told["accel"].sum() else ("accel", "gyro")
    if told[other].sum() < 2:
        raise InputError(f"{_SENSORS[other]} say nothing", "recording")
    rows, known = np.flatnonzero(told[base]), np.flatnonzero(told[other])
    after = np.clip(np.searchsorted(t[known], t[rows]), 0, len(known) - 1)
    exact = t[known][after] == t[rows]
    before = np.where(exact, after, np.maximum(after - 1, 0))
    hole = t[known][after] - t[known][before]
    usual = float(np.median(np.diff(t[known])))
    inside = (t[rows] >= t[known[0]]) & (t[rows] <= t[known[-1]])
    near = inside & (hole <= max(gap_s, 1.5 * usual))
    rows, put_in = rows[near], int((near & ~exact).sum())
    if len(rows) < 2:
        raise InputError("gyros and accelerometers have no time in common", "recording")
    values = {base: getattr(samples, base)[rows]}
    values[other] = np.column_stack(
        [np.interp(t[rows], t[known], axis) for axis in getattr(samples, other)[known].T]
    )
    warm = samples.temperature
    made = Samples(
        samples.row, t[rows], values["gyro"], values["accel"], None if warm is None else warm[rows]
    )
    if put_in > SLOWER * len(rows):
        return made, ((other, 1 / usual),), 0
    return made, (), put_in


def _evenly(t: np.ndarray) -> np.ndarray:
    k = np.arange(len(t))
    slope, offset = np.polynomial.polynomial.polyfit(k - k.mean(), t, 1)[::-1]
    return offset + slope * (k - k.mean())


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
