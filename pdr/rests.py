"""Rest wherever there is some: the start, later, the end, or only the stances of a walk already under way.

A foot that stands still turns by small angles all the same, as people sway: a rest of T seconds knows the
gyro bias to `SWAY` / T, and several rests count by their squared durations.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from footfall.conventions import BIAS_TIME, GRAVITY
from footfall.errors import InputError
from footfall.pdr.reckoning import PdrParams
from footfall.pdr.rest import REST_GRAVITY, Rest, static_bias, still_time
from footfall.pdr.stance import find_stances
from footfall.pdr.strapdown import integrate
from footfall.recording import Recording
from footfall.runs import runs

BLOCK_S = 0.1
BLOCK_GYRO = math.radians(2.0)  # scatter within a block, and from one to the next
BLOCK_ACCEL = 0.3  # m/s2, scatter within a block
MOST_BIAS = math.radians(25.0)  # rad/s, of any gyro
LEVEL_S = 0.3  # at rest for so long the force says which way is up
BIAS_S = 0.45  # at rest for so long the rate says the bias
LATER_S = 1.5  # a later rest is shorter only where a foot is put down slowly
SETTLING_S = 0.5  # s after a foot is put down, and before it is lifted, in which it is not at rest yet
SWAY = math.radians(0.3)
CHANGED, SWAYS = math.radians(0.5), 3.0  # rad/s, and standard errors of sway, by which rests may differ
UNKNOWN_SD = math.radians(0.5)  # rad/s, of a bias that nothing tells
STANCE_S = 0.1  # about a stance's quietest instant


@dataclass(frozen=True)
class Still:
    """A stretch at rest.

    Attributes
    ----------
    first, stop : rows
    duration : s
    gyro : (3,) rad/s, mean
    """

    first: int
    stop: int
    duration: float
    gyro: np.ndarray


def find_rest(recording: Recording, params: PdrParams) -> Rest:
    """Where a recording of any kind can be navigated from, and its gyro bias.

    From the still start, if there is one of `LEVEL_S`; else from the quietest instant of the first stance.
    The bias is that of all rests together; 0 where there is none.

    Parameters
    ----------
    params : `bias_s` is the most of the start that is averaged; detector and stances of a start in mid-walk

    Raises
    ------
    InputError
        No rest and no stance, or accelerometers that do not measure gravity.
    """
    begun = _still_start(recording, params.bias_s)
    stills = still_stretches(recording)
    later = [one for one in stills if one.first > (1 if begun is None else begun.last)]
    known = [] if begun is None or _length(recording, begun) < BIAS_S - 1e-6 else [begun]
    durations = [_length(recording, one) for one in known] + [one.duration for one in later]
    rates = [one.gyro_bias for one in known] + [one.gyro for one in later]
    bias, sd = np.zeros(3), UNKNOWN_SD
    if durations:
        weight = np.square(durations)
        bias = np.average(rates, axis=0, weights=weight)
        sd = SWAY / math.sqrt(weight.sum())
    rest = begun or _first_stance(recording, bias, params)
    return replace(
        rest,
        gyro_bias=bias,
        bias_sd=sd,
        source=_told(recording, known, later, stills),
        changed=_changed(rates, durations),
    )


def _changed(rates: Sequence[np.ndarray], durations: Sequence[float]) -> float:
    """The largest difference (rad/s) between two rests that is beyond `CHANGED` and what sway explains."""
    most = 0.0
    for (one, first), (other, second) in combinations(zip(rates, durations, strict=True), 2):
        off = float(np.linalg.norm(one - other))
        if off > CHANGED + SWAYS * SWAY * math.hypot(1 / first, 1 / second):
            most = max(most, off)
    return most


def still_stretches(recording: Recording) -> list[Still]:
    """Stretches at rest of `LATER_S` at least, without the time in which the foot settles."""
    t, edges = _blocks(recording)
    if len(edges) < 2:
        return []
    gyro, scatter = _statistics(recording.gyro, edges)
    _, shake = _statistics(recording.accel, edges)
    still = (scatter < BLOCK_GYRO) & (shake < BLOCK_ACCEL) & (np.linalg.norm(gyro, axis=1) < MOST_BIAS)
    steady = np.linalg.norm(np.diff(gyro, axis=0), axis=1) < BLOCK_GYRO
    still[1:] &= steady | ~still[:-1]
    settling, found = round(SETTLING_S / BLOCK_S), []
    for first, stop in runs(still):
        first = first if first == 0 else first + settling
        stop = stop if stop == len(still) else stop - settling
        if (stop - first) * BLOCK_S >= LATER_S - 1e-6:
            rows = slice(max(1, int(edges[first])), int(edges[stop]))
            mean = recording.gyro[rows].mean(axis=0)
            found.append(Still(rows.start, rows.stop, float(t[rows.stop - 1] - t[rows.start]), mean))
    return found


def _blocks(recording: Recording) -> tuple[np.ndarray, np.ndarray]:
    """Stamps from 0, and the first row of each block and the one after the last."""
    t = recording.t - recording.t[0]
    edges = np.searchsorted(t, BLOCK_S * np.arange(int(t[-1] / BLOCK_S + 1e-6) + 1) - 1e-6)
    return t, edges[np.concatenate([[True], np.diff(edges) > 0])]


def _statistics(values: np.ndarray, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Means (k, 3) of the blocks, and scatter (k,) within them, all axes together."""
    count = np.diff(edges)[:, None]
    mean = np.add.reduceat(values[: edges[-1]], edges[:-1], axis=0) / count
    square = np.add.reduceat(np.square(values[: edges[-1]]), edges[:-1], axis=0) / count
    return mean, np.sqrt(np.maximum(square - mean**2, 0).sum(axis=1))


def _still_start(recording: Recording, most_s: float) -> Rest | None:
    """The still start, as long as it is; None where there is none."""
    try:
        return static_bias(recording, still_time(recording, min(most_s, BIAS_TIME)))
    except InputError as error:
        if "expected" in error.message:  # what it measures at rest is no gravity
            raise
    _, edges = _blocks(recording)
    if len(edges) < 4:
        return None
    gyro, scatter = _statistics(recording.gyro, edges)
    _, shake = _statistics(recording.accel, edges)
    off = np.linalg.norm(gyro - gyro[0], axis=1)
    moved = (scatter >= BLOCK_GYRO) | (shake >= BLOCK_ACCEL) | (off >= BLOCK_GYRO)
    blocks = int(np.argmax(moved)) if moved.any() else len(moved)
    blocks -= bool(moved.any())  # people lean before they step
    if blocks * BLOCK_S < LEVEL_S - 1e-6:
        return None
    rows = slice(1, int(edges[blocks]))
    force = recording.accel[rows].mean(axis=0)
    if abs(np.linalg.norm(force) - GRAVITY) > REST_GRAVITY:
        return None
    return Rest(recording.gyro[rows].mean(axis=0), force, rows.stop - 1)


def _length(recording: Recording, rest: Rest) -> float:
    return float(recording.t[rest.last] - recording.t[0])


def _first_stance(recording: Recording, bias: np.ndarray, params: PdrParams) -> Rest:
    """The quietest instant of the first stance, and which way is up there."""
    t = recording.t
    score = params.detector(t[1:], recording.gyro[1:] - bias, recording.accel[1:])
    found = find_stances(t[1:], score, params.stance)
    if not len(found.resets):
        raise InputError("neither rests nor has a stance: a foot that walks comes to rest", "recording")
    row = int(found.resets[0]) + 1
    if len(found.resets) < 2:
        return Rest(bias, recording.accel[np.abs(t - t[row]) <= STANCE_S / 2].mean(axis=0), row)
    # In a stance the foot rolls on, but over a stride from rest to rest the mean force points up.
    rows = slice(row, int(found.resets[1]) + 2)
    _, _, velocity = integrate(t[rows], recording.gyro[rows] - bias, recording.accel[rows])
    return Rest(bias, velocity[-1] / (t[rows.stop - 1] - t[row]) + [0.0, 0.0, GRAVITY], row)


def _told(recording: Recording, known: list[Rest], later: list[Still], stills: list[Still]) -> str:
    end = float(recording.t[-1] - recording.t[0])
    parts = [f"the {_length(recording, one):.3g} s at rest at the start" for one in known]
    for one in later:
        at = float(recording.t[one.first] - recording.t[0])
        ends = float(recording.t[min(one.stop, len(recording.t) - 1)] - recording.t[0]) > end - 1.0
        parts.append(f"{one.duration:.2g} s at rest " + ("at the end" if ends else f"after t = {at:.3g} s"))
    return " and ".join(parts)
