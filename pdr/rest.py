"""How long a recording rests before the walk."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from footfall.errors import InputError
from footfall.pdr.reckoning import REST_ACCEL, REST_BLOCK_S, REST_GYRO
from footfall.recording import Recording


def still_time(recording: Recording, most_s: float = 25.0) -> float:
    """Seconds at rest at the start, whole half seconds, over which the static bias can be averaged.

    Rest ends where the mean of half a second leaves that of the first by more than the limits of
    `static_bias`; the half second before is left out too, for people lean before they step.

    Parameters
    ----------
    most_s : s, T_bias: resting longer gives no longer time

    Raises
    ------
    InputError
        The recording does not rest for half a second.
    """
    t = recording.t - recording.t[0]
    whole = min(most_s, float(t[-1]))
    blocks = int((most_s + REST_BLOCK_S) / REST_BLOCK_S)
    edges = np.searchsorted(t, REST_BLOCK_S * np.arange(blocks + 1) + 1e-6)
    edges[0] = 1  # row 0 is the start: its sample belongs to time before the record
    first: list[np.ndarray] = []
    for block, (start, stop) in enumerate(pairwise(edges)):
        if stop <= start:
            if stop >= len(t):
                break
            continue
        means = [values[start:stop].mean(axis=0) for values in (recording.gyro, recording.accel)]
        first = first or means
        off = [float(np.linalg.norm(mean - now)) for mean, now in zip(first, means, strict=True)]
        if off[0] > REST_GYRO or off[1] > REST_ACCEL:
            whole = min(whole, REST_BLOCK_S * (block - 1))
            break
    if whole < REST_BLOCK_S:
        raise InputError(
            f"the IMU moves from the start, but dead reckoning needs {REST_BLOCK_S:g} s at rest", "recording"
        )
    return whole
