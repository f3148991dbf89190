"""Compiled kernel of the IMU truth."""

from __future__ import annotations

import math

import numpy as np

from footfall.compiled import kernel


@kernel()
def _product(a, b):  # type: ignore[no-untyped-def]
    """Hamilton product, scalar first."""
    return (
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    )


@kernel()
def _unit(quaternion):  # type: ignore[no-untyped-def]
    w, x, y, z = quaternion[0], quaternion[1], quaternion[2], quaternion[3]
    norm = math.sqrt(w * w + x * x + y * y + z * z)
    return w / norm, x / norm, y / norm, z / norm


@kernel(nogil=True)
def increments(quaternion, gained):  # type: ignore[no-untyped-def]
    """Rotation vectors between attitudes, and the velocity gained resolved half-way.

    Parameters
    ----------
    quaternion : (n + 1, 4) body to world, scalar first
    gained : (n, 3) m/s in the world, gravity taken off, over the interval between two attitudes

    Returns
    -------
    turn (n, 3) = Log(conj(q_k) q_{k+1}), and R(q_k Exp(turn / 2))^T gained (n, 3)
    """
    turn, force = np.empty(gained.shape), np.empty(gained.shape)
    before = _unit(quaternion[0])
    for k in range(len(gained)):
        after = _unit(quaternion[k + 1])
        w, x, y, z = _product((before[0], -before[1], -before[2], -before[3]), after)
        if w < 0:
            w, x, y, z = -w, -x, -y, -z
        length = math.sqrt(x * x + y * y + z * z)
        angle = 2 * math.atan2(length, w)
        scale = angle / length if length > 1e-12 else 2.0
        turn[k, 0], turn[k, 1], turn[k, 2] = scale * x, scale * y, scale * z
        part = math.sin(angle / 4) / length if length > 1e-12 else 0.5
        half = math.cos(angle / 4), part * x, part * y, part * z
        w, x, y, z = _product(before, half)
        # Of R^T v = conj(q) v q, by v + 2 w (v x u) + 2 (v x u) x u with u the vector part.
        a, b, c = gained[k, 0], gained[k, 1], gained[k, 2]
        tx, ty, tz = 2 * (b * z - c * y), 2 * (c * x - a * z), 2 * (a * y - b * x)
        force[k, 0] = a + w * tx + ty * z - tz * y
        force[k, 1] = b + w * ty + tz * x - tx * z
        force[k, 2] = c + w * tz + tx * y - ty * x
        before = after
    return turn, force
