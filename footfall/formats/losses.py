"""Samples that a sensor never measured: impossible ones, zeros, frozen and held ones. All become NaN.

Gyro and accelerometer are looked at apart: either may be lost, or slower than the other.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from footfall.runs import runs

SPIKE = 4.0  # times the largest bend elsewhere: heel strikes, which are sharp too, are alike to a factor of 2
SPIKES = 1e-3  # share of the rows that may be impossible; more, and it is how that sensor speaks
LEAST_BEND = (3.0, 60.0)  # rad/s, m/s2 (in SI); a smaller bend does no harm
BEYOND = 30.0  # times the 90th percentile: no foot does that, nor a sensor
FROZEN_S = 0.04
FROZEN_ROWS = 5
REPEATS = 0.02  # share of rows that a fine sensor may repeat by chance
RESTS = 5  # so many rests at which it repeats itself, and it is so coarse
DEAD_S = 0.1  # one channel
MOVING = 1.0  # rad/s: with this rate a foot's samples differ


@dataclass(frozen=True)
class Lost:
    """How many rows were left out, and why; rates are those of a slower sensor."""

    impossible: int = 0
    zeros: int = 0
    frozen: int = 0
    dead: tuple[tuple[str, int], ...] = ()
    held: tuple[tuple[str, float], ...] = ()

    def and_also(self, other: Lost) -> Lost:
        """Of two blocks of one file."""
        dead = dict(self.dead)
        for name, count in other.dead:
            dead[name] = dead.get(name, 0) + count
        return Lost(
            impossible=self.impossible + other.impossible,
            zeros=self.zeros + other.zeros,
            frozen=self.frozen + other.frozen,
            dead=tuple(dead.items()),
            held=self.held or other.held,
        )

    @property
    def rows(self) -> int:
        """Rows left out."""
        return self.impossible + self.zeros + self.frozen + sum(count for _, count in self.dead)


def without_lost(t: np.ndarray, gyro: np.ndarray, accel: np.ndarray) -> tuple[np.ndarray, np.ndarray, Lost]:
    """Copies of gyro and accel (n, 3) with NaN where the sensor did not measure, and what was found.

    The same arrays where nothing was.
    """
    interval = float(np.median(np.diff(t))) if len(t) > 1 else 1.0
    bad = [~np.isfinite(values).all(axis=1) for values in (gyro, accel)]
    none = _zeros(gyro, accel)
    impossible = [
        _impossible(values, least, one | none)
        for values, least, one in zip((gyro, accel), LEAST_BEND, bad, strict=True)
    ]
    spikes = impossible[0] | impossible[1]
    for one in bad:
        one |= none | spikes
    held = []
    frozen, stuck = np.zeros(len(t), dtype=bool), []
    same = [_repeats(values) for values in (gyro, accel)]
    for place, name in enumerate(("gyro", "accel")):
        times = _held_times(same[place])
        if times is not None:
            bad[place] |= same[place]
            held.append((name, 1 / (times * interval)))
    if not held:
        frozen = _frozen(t, gyro, same[0] & same[1] & ~none, interval)
        for one in bad:
            one |= frozen
        dead = [_stuck(values, gyro, bad[place], interval) for place, values in enumerate((gyro, accel))]
        for place, name in enumerate(("gyro", "accel")):
            for axis, rows in enumerate(dead[place]):
                if rows.any():
                    bad[place] |= rows
                    stuck.append((f"{name}_{'xyz'[axis]}", int(rows.sum())))
    lost = Lost(
        impossible=int(spikes.sum()),
        zeros=int(none.sum()),
        frozen=int(frozen.sum()),
        dead=tuple(stuck),
        held=tuple(held),
    )
    made = []
    for values, one in zip((gyro, accel), bad, strict=True):
        if one.any():
            values = values.copy()
            values[one] = np.nan
        made.append(values)
    return made[0], made[1], lost


def _zeros(gyro: np.ndarray, accel: np.ndarray) -> np.ndarray:
    """Rows without any force: even in free fall an accelerometer has noise."""
    none = (accel == 0).all(axis=1) & ((gyro == 0).all(axis=1) | ~np.isfinite(gyro).all(axis=1))
    return none if none.mean() < 0.5 else np.zeros_like(none)


def _impossible(values: np.ndarray, least: float, known: np.ndarray) -> np.ndarray:
    """Rows (n,) that stand out of both neighbours, alone, further than any other by far."""
    size = np.abs(values).max(axis=1)
    infinite = np.isinf(size)
    found = infinite.copy()
    usual = size[~known & ~infinite]
    if len(usual) < 100:
        return found
    most = max(1, int(SPIKES * len(values)))
    far = ~known & (size > BEYOND * np.quantile(usual, 0.9)) & (size > least)
    if far.sum() <= max(3, 10 * most):
        found |= far
    some = np.where((found | known)[:, None], np.nan, values)
    bend = np.zeros(len(values))
    with np.errstate(invalid="ignore"):
        inside = np.abs(some[1:-1] - (some[:-2] + some[2:]) / 2).max(axis=1)
    bend[1:-1] = np.nan_to_num(inside, nan=0.0)
    # Largest first; a row beside a spike bends by half as much, and is none.
    order = np.argsort(bend)[::-1][: 3 * most + 3]
    spikes: list[int] = []
    for row in order:
        if any(abs(row - one) <= 1 for one in spikes):
            continue
        spikes.append(int(row))
    sizes = bend[spikes]
    for count in range(min(most, len(spikes) - 1), 0, -1):
        if sizes[count - 1] > SPIKE * sizes[count] and sizes[count - 1] > least:
            found[spikes[:count]] = True
            break
    return found


def _repeats(values: np.ndarray) -> np.ndarray:
    same = np.zeros(len(values), dtype=bool)
    same[1:] = (values[1:] == values[:-1]).all(axis=1)
    return same


def _held_times(same: np.ndarray) -> float | None:
    """How many rows each sample stands for, where a slower sensor's are repeated; None where none are."""
    fresh = np.flatnonzero(~same)
    if len(fresh) < 20 or len(fresh) > 0.8 * len(same):
        return None
    gaps = np.diff(fresh)
    times = float(np.median(gaps)) if np.median(gaps) > 1 else float(gaps.mean())
    low, high = np.floor(times), np.ceil(times)
    alike = (gaps >= low) & (gaps <= high)
    # A coarse sensor at rest repeats itself now and then, and for any time.
    return times if alike.mean() > 0.8 and gaps[gaps > high + 1].sum() < 0.05 * gaps.sum() else None


def _frozen(t: np.ndarray, gyro: np.ndarray, same: np.ndarray, interval: float) -> np.ndarray:
    """Rows that repeat the one before for longer than a fine sensor does, or while the foot moves."""
    found = runs(same)
    long = found[found[:, 1] - found[:, 0] >= max(FROZEN_ROWS, FROZEN_S / interval) - 1]
    frozen = np.zeros(len(t), dtype=bool)
    if not len(long):
        return frozen
    rows = np.zeros(len(t), dtype=bool)
    for start, stop in long:
        rows[start:stop] = True
    moving = np.linalg.norm(gyro[long[:, 0]], axis=1) > MOVING
    # A coarse sensor repeats itself at every rest, a freeze is rare; one that nothing follows hides nothing.
    coarse = (same & ~rows).sum() > REPEATS * (~rows).sum() or (~moving).sum() >= RESTS
    inside = (long[:, 0] > FROZEN_ROWS) & (long[:, 1] < len(t) - FROZEN_ROWS)
    for start, stop in long[moving | (inside & (not coarse))]:
        frozen[start:stop] = True
    return frozen if frozen.mean() < 0.5 else np.zeros_like(frozen)


def _stuck(values: np.ndarray, gyro: np.ndarray, bad: np.ndarray, interval: float) -> list[np.ndarray]:
    """For each axis the rows (n,) in which it alone stays as it is while the foot turns."""
    turning = np.linalg.norm(np.nan_to_num(gyro, posinf=0.0, neginf=0.0), axis=1) > MOVING
    made = []
    for axis in range(3):
        channel = values[:, axis]
        same = np.zeros(len(channel), dtype=bool)
        same[1:] = (channel[1:] == channel[:-1]) & ~bad[1:]
        rows = np.zeros(len(channel), dtype=bool)
        ends = (np.nanmin(channel), np.nanmax(channel)) if not np.isnan(channel).all() else (0.0, 0.0)
        for start, stop in runs(same):
            at_end = channel[start] in ends and channel[start] != 0
            if stop - start + 1 < max(10, DEAD_S / interval) or at_end:
                continue
            if turning[start:stop].mean() > 0.5:
                rows[start - 1 if channel[start] == 0 else start : stop] = True
        made.append(rows if rows.mean() < 0.5 else np.zeros_like(rows))
    return made
