"""What every room agrees on: gravity, T_bias, and how headings are read from attitudes and kept in range.

World: x forward at the start, y left, z up; heading counter-clockwise from x. Quaternions: Hamilton, scalar
first, body to world.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

GRAVITY = 9.80665  # m/s2, standard gravity
BIAS_TIME = 25.0  # s, T_bias: at rest before a walk, for the static bias (HDR paper, section 2)


def heading_of(quaternion: ArrayLike) -> np.ndarray:
    """Heading of the body's x axis (rad).

    Meaningful only where the x axis is far from vertical: on a shoe at stance, never in swing.

    Parameters
    ----------
    quaternion : (4,) or (n, 4)

    Returns
    -------
    A number from -pi to pi, or (n,) continuous along the rows, which are less than half a turn apart.
    """
    w, x, y, z = np.moveaxis(np.asarray(quaternion, dtype=float), -1, 0)
    heading = np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
    return np.unwrap(heading) if np.ndim(heading) else heading


def wrap(angle: ArrayLike) -> np.ndarray:
    """Angle (rad, any shape) in [-pi, pi)."""
    return (np.asarray(angle, dtype=float) + np.pi) % (2 * np.pi) - np.pi
