"""Dead reckoning of a recording that comes in blocks: memory holds minutes of it, however long it is."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from footfall.errors import InputError
from footfall.late import late
from footfall.pdr.footfalls import Footfalls
from footfall.pdr.reckoning import (
    PdrParams,
    StartPose,
    level_attitude,
    placed,
    refuse_gaps,
    scores,
    start_temperature,
)
from footfall.pdr.rest import Rest, static_bias
from footfall.pdr.stance import compact, find_stances
from footfall.pdr.strides import Sums, integrals, strides_of
from footfall.recording import Recording
from footfall.runs import runs

_kernels = late("footfall.pdr._kernels")

WORK_ROWS = 1 << 16  # samples that are worth looking at anew
MOST_ROWS = 1 << 19  # samples that may wait for a stance
CONTEXT_S = 4.0  # s before a cut that are looked at again: more than any detector's window
SETTLED_S = 2.0  # s before the newest sample, nearer to which no stance is taken for complete


def dead_reckon_blocks(
    blocks: Iterable[Recording],
    params: PdrParams | None = None,
    start: StartPose | None = None,
    *,
    rest_time: Callable[[Recording], float] | None = None,
) -> tuple[Footfalls, float]:
    """`dead_reckon` of a recording that is given piece by piece.

    Cut in a swing, between stances that cannot influence one another, it gives what `dead_reckon` gives of
    the whole, to rounding. Two things may differ: where a still period of more than `MOST_ROWS` samples is
    divided, and the adaptive detector's lowest level, which is a share of the highest it has met.

    Parameters
    ----------
    blocks : in order; every stamp is later than the one before
    params, start : as of `dead_reckon`
    rest_time : finds T_bias (s) from the recording's beginning; `params.bias_s` is then the most it may be

    Returns
    -------
    The footfalls, and the T_bias that was used.

    Raises
    ------
    InputError
        As `dead_reckon`; or no stance within `MOST_ROWS` samples.
    """
    params, start = params or PdrParams(), start or StartPose()
    waiting = iter(blocks)
    held = _beginning(waiting, params.bias_s)
    if rest_time is not None:
        params = replace(params, bias_s=rest_time(held))
    rest = static_bias(held, params.bias_s)
    warm = start_temperature(held, rest)
    reckoner = _Reckoner(params, rest, level_attitude(rest.force))
    for block in waiting:
        held = _joined(held, block)
        if len(held.t) - reckoner.seen > WORK_ROWS:
            held = reckoner.take(held, last=False)
    reckoner.take(held, last=True)
    t, quaternion, position = map(np.concatenate, zip(*reckoner.made, strict=True))
    if len(t) < 2:
        raise InputError(f"no stride found after the {params.bias_s:g} s at rest", "recording")
    made, footfalls = reckoner.summed()
    strides = strides_of(made, footfalls, rest.force, warm)
    return placed(t, quaternion, position, start, strides), params.bias_s


def _beginning(waiting: Iterator[Recording], bias_s: float) -> Recording:
    held = next(waiting, None)
    if held is None:
        raise InputError("no rows of samples", "recording")
    while held.t[-1] - held.t[0] < bias_s + SETTLED_S:
        block = next(waiting, None)
        if block is None:
            break
        held = _joined(held, block)
    return held


def _joined(first: Recording, second: Recording) -> Recording:
    return Recording(
        t=np.concatenate([first.t, second.t]),
        gyro=np.concatenate([first.gyro, second.gyro]),
        accel=np.concatenate([first.accel, second.accel]),
        temperature=None
        if first.temperature is None or second.temperature is None
        else np.concatenate([first.temperature, second.temperature]),
    )


@dataclass
class _Reckoner:
    """Where the walk has come to: attitude and position at the reset `carry` of the samples held.

    `made` are the footfalls: time, attitude and position, part by part. `parts` are the sums over the
    resets of each part, and the places of the footfalls among them. A part begins with the last reset of the
    one before.
    """

    params: PdrParams
    rest: Rest
    quaternion: np.ndarray
    position: np.ndarray = field(default_factory=lambda: np.zeros(3))
    told: bool = False  # whether the reset at `carry` was a footfall, which is told once
    seen: int = 0
    begun: bool = False
    made: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = field(default_factory=list)
    parts: list[tuple[Sums, np.ndarray]] = field(default_factory=list)

    def summed(self) -> tuple[Sums, np.ndarray]:
        """Sums between all resets, and the places of footfalls among them."""
        sums: list[tuple[np.ndarray, ...]] = []
        at, ahead = [], 0
        for made, footfalls in self.parts:
            rows = slice(1 if sums else 0, None)
            sums.append((made.t[rows], made.sums[rows], made.temperature[rows]))
            at.append(footfalls + ahead)
            ahead += len(made.t) - 1
        return Sums(*map(np.concatenate, zip(*sums, strict=True))), np.concatenate(at)

    def take(self, held: Recording, last: bool) -> Recording:
        """Reckon as far as stances are certain; returns the samples that are still needed."""
        self.seen = len(held.t)
        rest, params, t = self.rest, self.params, held.t
        carry = rest.last
        score = scores(held, rest, params.detector, still=0 if self.begun else carry)[1:]
        found = find_stances(t[1:], score, params.stance)
        resets, footfalls = found.resets + 1, found.footfalls
        later = resets > carry
        # Places in [carry, later resets]; 0 where the stance's last reset is `carry` itself or before it.
        footfalls = np.unique(np.maximum(footfalls - int(np.count_nonzero(~later)) + 1, 0))
        resets = np.concatenate([[carry], resets[later]])
        keep = 0
        if not last:
            stop, keep = self._cut(t, score)
            if stop is None:
                if len(t) > MOST_ROWS:
                    raise InputError(
                        f"no stance in the {t[-1] - t[carry]:.4g} s after t = {t[carry]:.6g} s", "recording"
                    )
                return held
            known = int(np.searchsorted(resets, stop, side="right"))
            footfalls, resets = footfalls[footfalls < known], resets[:known]
        if self.told:
            footfalls = footfalls[footfalls > 0]
        self._reckon(held, resets, footfalls)
        if last:
            return held
        self.told = bool(len(footfalls) and footfalls[-1] == len(resets) - 1) or (
            self.told and len(resets) == 1
        )
        first = min(keep, int(resets[-1]))
        self.rest = replace(rest, last=int(resets[-1]) - first)
        self.seen, self.begun = len(t) - first, True
        warm = None if held.temperature is None else held.temperature[first:]
        return Recording(t[first:], held.gyro[first:], held.accel[first:], warm)

    def _cut(self, t: np.ndarray, score: np.ndarray) -> tuple[int | None, int]:
        """Last sample up to which stances are certain, and the first that is still needed.

        Certain is a stance with swings of more than a shortest stride on either side of it: whatever comes
        later, `find_stances` finds it again and nothing before it matters.
        """
        stance = self.params.stance
        rests = runs(score < 1.0) + np.array([1, 0])  # first row and last
        rests = rests[t[rests[:, 1]] - t[rests[:, 0]] >= stance.min_stance_s]
        if not len(rests):
            return None, 0
        gap = t[rests[1:, 0]] - t[rests[:-1, 1]]
        settled = t[rests[1:, 1]] < t[-1] - SETTLED_S
        free = (gap >= stance.min_stride_s) & settled
        alone = np.flatnonzero(free[1:] & free[:-1]) + 1
        if len(alone) and rests[alone[-1], 0] > self.rest.last:
            j = alone[-1]
            return int(rests[j, 1]), self._context(t, int(rests[j, 0]))
        long = rests[t[rests[:, 1]] - t[rests[:, 0]] > 4 * SETTLED_S]
        if len(t) > MOST_ROWS and len(long):
            stop = int(np.searchsorted(t, t[long[-1, 1]] - SETTLED_S))
            if stop > self.rest.last:
                return stop, self._context(t, stop)
        return None, 0

    def _context(self, t: np.ndarray, row: int) -> int:
        """First sample that a detector may want to see to judge `row`."""
        return int(np.searchsorted(t, t[row] - CONTEXT_S))

    def _reckon(self, held: Recording, resets: np.ndarray, footfalls: np.ndarray) -> None:
        if len(resets) > 1:
            refuse_gaps(held.t, int(resets[0]), int(resets[-1]), self.params.max_gap_s)
        quaternion, position, sums = _kernels.reckon(
            compact(held.t),
            compact(held.gyro),
            compact(held.accel),
            self.rest.gyro_bias,
            np.asarray(self.quaternion, dtype=float),
            resets,
            self.params.tilt_gain,
        )
        position = position + self.position
        self.made.append((held.t[resets[footfalls]], quaternion[footfalls], position[footfalls]))
        warm = integrals(held.t, held.temperature, resets)
        self.parts.append((Sums(held.t[resets], sums, warm), footfalls))
        self.quaternion, self.position = quaternion[-1].copy(), position[-1].copy()
