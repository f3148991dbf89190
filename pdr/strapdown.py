"""Strapdown integration of an IMU's samples."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from footfall.errors import InputError
from footfall.late import late

_kernels = late("footfall.pdr._kernels")

ORIGIN = (0.0, 0.0, 0.0)


class Trajectory(NamedTuple):
    """position (n, 3) m, quaternion (n, 4) body to world and scalar first, velocity (n, 3) m/s."""

    position: np.ndarray
    quaternion: np.ndarray
    velocity: np.ndarray


def integrate(
    t: np.ndarray,
    gyro: np.ndarray,
    accel: np.ndarray,
    *,
    quaternion: ArrayLike = (1.0, 0.0, 0.0, 0.0),
    velocity: ArrayLike = ORIGIN,
    position: ArrayLike = ORIGIN,
) -> Trajectory:
    """Integrate rates and specific forces into poses, with no correction of any kind.

    Each sample is the mean over the interval that ends at its stamp, the force resolved in the frame
    at the middle of the interval; with that reading the integration is exact:

        v+ = v + R(q Exp(dth/2)) dv + g T;   p+ = p + T (v + v+)/2;   q+ = q Exp(dth)

    Parameters
    ----------
    t : (n,) s; row 0 is the start, samples 1.. are integrated, each over its own interval
    gyro : (n, 3) rad/s
    accel : (n, 3) m/s2, specific force
    quaternion, velocity, position : the pose at row 0 (body to world and scalar first; m/s; m)

    Raises
    ------
    InputError
        The start quaternion is not of length 1.
    """
    start = np.asarray(quaternion, dtype=float)
    if start.shape != (4,) or abs(np.linalg.norm(start) - 1.0) > 1e-6:
        raise InputError(f"strapdown: start quaternion {start.tolist()}, expected four numbers of length 1")
    q, v, p = _kernels.integrate(
        np.asarray(t, dtype=float),
        np.ascontiguousarray(gyro, dtype=float),
        np.ascontiguousarray(accel, dtype=float),
        start / np.linalg.norm(start),
        np.asarray(velocity, dtype=float),
        np.asarray(position, dtype=float),
    )
    return Trajectory(position=p, quaternion=q, velocity=v)
