"""The still start: for how long a recording rests before the walk, and what that says of its sensors."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from footfall.conventions import BIAS_TIME, GRAVITY
from footfall.errors import InputError
from footfall.recording import Recording

REST_BLOCK_S = 0.5
REST_GYRO = math.radians(2.0)
REST_ACCEL = 0.4
REST_GRAVITY = 1.0
REST_NOISE = 3.0  # standard errors by which noise alone may move the mean of a block


@dataclass(frozen=True)
class Rest:
    """What the still start says.

    Attributes
    ----------
    gyro_bias : (3,) rad/s, the static bias eps0 as a vector in the body (HDR Eq. 1)
    force : (3,) m/s2, mean specific force: which way is up
    last : index of the last sample that was averaged
    bias_sd : rad/s, how well the bias is known; 0 where it was not asked for
    source : what the bias was taken from, in words
    changed : rad/s, by which rests differ at most, beyond what sway explains; 0 where they agree
    """

    gyro_bias: np.ndarray
    force: np.ndarray
    last: int
    bias_sd: float = 0.0
    source: str = ""
    changed: float = 0.0


def static_bias(recording: Recording, bias_s: float) -> Rest:
    """Average the first `bias_s` seconds, which must be motionless (HDR paper, section 2, T_bias).

    Means of half a second tell: sensor noise averages out, a foot that is put down does not. It moves where
    such a mean leaves that of the first by 2 deg/s or 0.4 m/s2, and that of all before it by more than the
    noise of its samples explains.

    Raises
    ------
    InputError
        The recording is shorter, moves within that time, or does not measure gravity in m/s2.
    """
    length = recording.t[-1] - recording.t[0]
    if length < bias_s - 1e-6:
        raise InputError(
            f"lasts {length:.4g} s, shorter than the {bias_s:g} s at rest for the static bias (--bias-time)",
            "recording",
        )
    # Row 0 is the start: its sample belongs to time before the record.
    rows = slice(1, int(np.searchsorted(recording.t - recording.t[0], bias_s + 1e-6)))
    t, gyro, accel = recording.t[rows] - recording.t[0], recording.gyro[rows], recording.accel[rows]
    if len(gyro) == 0:
        raise InputError(f"no sample within the first {bias_s:g} s", "recording")
    # What is left beyond whole blocks belongs to the last of them.
    block = np.minimum(t // REST_BLOCK_S, max(int(bias_s / REST_BLOCK_S) - 1, 0))
    edges = np.concatenate([[0], np.flatnonzero(np.diff(block)) + 1, [len(t)]])
    for name, values, limit in (("gyro", gyro, REST_GYRO), ("accel", accel, REST_ACCEL)):
        moved = _first_moved(values, edges, limit)
        if moved is not None:
            raise InputError(
                f"the IMU moves at t = {block[edges[moved]] * REST_BLOCK_S:g} s ({name}), "
                f"but the static bias needs the first {bias_s:g} s at rest (--bias-time)",
                "recording",
            )
    rest = Rest(gyro_bias=gyro.mean(axis=0), force=accel.mean(axis=0), last=rows.stop - 1)
    if abs(np.linalg.norm(rest.force) - GRAVITY) > REST_GRAVITY:
        raise InputError(
            f"the accelerometers measure {np.linalg.norm(rest.force):.3g} at rest, "
            f"expected {GRAVITY:.3g} +- {REST_GRAVITY:g} m/s2",
            "recording",
        )
    return rest


def still_time(recording: Recording, most_s: float = BIAS_TIME) -> float:
    """Seconds at rest at the start, whole half seconds, over which the static bias can be averaged.

    Rest ends where `static_bias` sees a movement; the half second before is left out too, for people lean
    before they step.

    Parameters
    ----------
    most_s : s, T_bias: resting longer gives no longer time

    Raises
    ------
    InputError
        The recording does not rest for half a second.
    """
    t = recording.t - recording.t[0]
    grid = REST_BLOCK_S * np.arange(int((most_s + REST_BLOCK_S) / REST_BLOCK_S) + 1)
    edges = np.searchsorted(t, grid + 1e-6)
    edges[0] = 1  # row 0 is the start: its sample belongs to time before the record
    used = np.flatnonzero(np.diff(edges) > 0)
    rows = np.append(edges[used], edges[-1])
    moved = [
        found
        for values, limit in ((recording.gyro, REST_GYRO), (recording.accel, REST_ACCEL))
        if (found := _first_moved(values, rows, limit)) is not None
    ]
    whole = min(most_s, float(t[-1]), *(REST_BLOCK_S * (used[found] - 1) for found in moved))
    if whole < REST_BLOCK_S:
        raise InputError(
            f"the IMU moves from the start, but dead reckoning needs {REST_BLOCK_S:g} s at rest "
            "(--bias-time)",
            "recording",
        )
    return float(whole)


def _first_moved(values: np.ndarray, edges: np.ndarray, limit: float) -> int | None:
    """The first of the blocks of rows between `edges` in which the IMU moves; None where it rests.

    Where a block's mean leaves that of the first by more than `limit`, noise may be the cause: the scatter of
    the samples before it, which rest, says by how much.
    """
    if len(edges) < 2:
        return None
    counts = np.diff(edges)
    blocks = np.add.reduceat(values[: edges[-1]], edges[:-1], axis=0) / counts[:, None]
    for place in np.flatnonzero(np.linalg.norm(blocks - blocks[0], axis=1) > limit):
        before = values[edges[0] : edges[place]]
        error = _noise(before) * math.sqrt(1 / counts[place] + 1 / len(before))
        if np.linalg.norm(blocks[place] - before.mean(axis=0)) > REST_NOISE * error:
            return int(place)
    return None


def _noise(values: np.ndarray) -> float:
    """Standard deviation of the samples' white noise, all axes together, from steps between neighbours.

    By the median, for which a jolt is a step like any: half of a normal law's are below .6745 sqrt(2) sigma.
    """
    step = np.median(np.abs(np.diff(values, axis=0)), axis=0) if len(values) > 1 else np.zeros(3)
    return float(np.linalg.norm(step) / (0.6745 * math.sqrt(2)))
