"""How the IMU is worn: an axis that stands upright has no heading, another one then tells it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from footfall.pdr.reckoning import MIN_LEVEL, PdrParams
from footfall.pdr.rest import Rest, static_bias
from footfall.recording import Recording

_TURNS = {"y": [1, 2, 0], "z": [2, 0, 1]}  # axis that becomes the first: the order of all, right-handed


def level_axis(
    recording: Recording, rest: Rest | None, params: PdrParams
) -> tuple[Recording, Rest | None, list[str]]:
    """A recording whose first axis has a heading, its rest alike, and what to tell.

    Where the x axis is upright at rest (within 10 deg), the axes are renamed in turn so that the most level
    one comes first; positions do not feel it.
    """
    force = (rest or static_bias(recording, params.bias_s)).force
    up = np.abs(force) / np.linalg.norm(force)
    if np.sqrt(1 - up[0] ** 2) >= MIN_LEVEL:
        return recording, rest, []
    name = "y" if up[1] <= up[2] else "z"
    order = _TURNS[name]
    turned = replace(recording, gyro=recording.gyro[:, order].copy(), accel=recording.accel[:, order].copy())
    if rest is not None:
        rest = replace(rest, gyro_bias=rest.gyro_bias[order], force=rest.force[order])
    return turned, rest, [f"the IMU's x axis is upright: headings are those of its {name} axis"]
