"""The ground under a walker: its height and gradient, and the plane that each foot treads on.

A heightfield under the feet would make the physics half as slow again, and its triangles have edges. A foot
is short compared with the curves of any street, so it treads on the tangent plane of the ground below it.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from footfall.models import body
from footfall.models._ground_kernels import bilinear, lay
from footfall.models.route import Ground

GroundLookup = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]
N_PLANES = 14  # numbers that pose the planes of two feet: positions (2, 3), then quaternions (2, 4), w first


def ground_lookup(ground: Ground) -> GroundLookup:
    """(x, y) (n,) each -> height (n,) m and gradient (n, 2), bilinear in the grid."""
    heights = np.ascontiguousarray(ground.heights, dtype=float)
    x0, y0, cell = float(ground.x0), float(ground.y0), float(ground.cell)

    def lookup(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        height, gradient = bilinear(heights, x0, y0, cell, np.ascontiguousarray(x), np.ascontiguousarray(y))
        return height, gradient

    return lookup


def tread(planes: np.ndarray, sensor: np.ndarray, lookup: GroundLookup) -> None:
    """Lay the ground's tangent plane under every foot that carries no load; under the others it stays.

    Parameters
    ----------
    planes : (n, N_PLANES) changed in place
    sensor : (n, n_sensor) of `models.body`
    """
    feet = sensor[:, body.SENSOR_FOOT_POSITION].reshape(-1, 3)
    lay(planes, sensor, *lookup(feet[:, 0], feet[:, 1]))
