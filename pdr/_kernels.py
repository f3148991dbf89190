"""Compiled strapdown. The faces that explain and check are strapdown.py and reckoning.py.

Quaternions and vectors are tuples of floats here: small, and never allocated.
"""

from __future__ import annotations

import math

import numpy as np

from footfall.compiled import kernel
from footfall.conventions import GRAVITY


@kernel()
def multiply(a, b):  # type: ignore[no-untyped-def]
    """Hamilton product of two quaternions, scalar first."""
    return (
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    )


@kernel()
def exponential(x, y, z):  # type: ignore[no-untyped-def]
    """Quaternion of the rotation vector (x, y, z)."""
    half = 0.5 * math.sqrt(x * x + y * y + z * z)
    scale = 0.5 * math.sin(half) / half if half > 1e-5 else 0.5 - half * half / 12.0
    return math.cos(half), scale * x, scale * y, scale * z


@kernel()
def rotate(q, x, y, z):  # type: ignore[no-untyped-def]
    """R(q) (x, y, z)."""
    w, a, b, c = q
    tx, ty, tz = 2.0 * (b * z - c * y), 2.0 * (c * x - a * z), 2.0 * (a * y - b * x)
    return x + w * tx + b * tz - c * ty, y + w * ty + c * tx - a * tz, z + w * tz + a * ty - b * tx


@kernel()
def vertical(q):  # type: ignore[no-untyped-def]
    """The vertical in the body's axes: third row of R(q)."""
    w, x, y, z = q
    return 2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)


@kernel()
def advance(q, v, p, gyro, accel, dt):  # type: ignore[no-untyped-def]
    """One sample of the pose-increment consumer: v+ = v + R(q Exp(dth/2)) dv + g T, and so on."""
    half = exponential(0.5 * dt * gyro[0], 0.5 * dt * gyro[1], 0.5 * dt * gyro[2])
    middle = multiply(q, half)
    fx, fy, fz = rotate(middle, accel[0], accel[1], accel[2])
    w = (v[0] + dt * fx, v[1] + dt * fy, v[2] + dt * (fz - GRAVITY))
    p = (p[0] + 0.5 * dt * (v[0] + w[0]), p[1] + 0.5 * dt * (v[1] + w[1]), p[2] + 0.5 * dt * (v[2] + w[2]))
    q = multiply(middle, half)
    # One Newton step keeps the length at 1 against rounding; it never has more than that to mend.
    mend = 1.5 - 0.5 * (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    return (mend * q[0], mend * q[1], mend * q[2], mend * q[3]), w, p


@kernel()
def integrate(t, gyro, accel, q0, v0, p0):  # type: ignore[no-untyped-def]
    """Strapdown of samples 1.. from the pose at row 0; returns quaternions, velocities, positions."""
    n = len(t)
    quaternion, velocity, position = np.empty((n, 4)), np.empty((n, 3)), np.empty((n, 3))
    q = (q0[0], q0[1], q0[2], q0[3])
    v = (v0[0], v0[1], v0[2])
    p = (p0[0], p0[1], p0[2])
    for k in range(n):
        if k > 0:
            q, v, p = advance(q, v, p, gyro[k], accel[k], t[k] - t[k - 1])
        for i in range(3):
            quaternion[k, i], velocity[k, i], position[k, i] = q[i], v[i], p[i]
        quaternion[k, 3] = q[3]
    return quaternion, velocity, position


@kernel()
def reckon(t, gyro, accel, bias, q0, resets, tilt_gain):  # type: ignore[no-untyped-def]
    """Attitude and position at each of `resets`, where the velocity is zero. Explained in reckoning.py.

    bias : (3,) rad/s, is taken off the gyro
    resets[0] is the sample that the pose (q0, origin) belongs to.
    Third come the sums of `footfall.pdr.strides.Sums`, on which no pose depends.
    """
    m = len(resets)
    quaternion, position, sums = np.empty((m, 4)), np.zeros((m, 3)), np.zeros((m, 30))
    q = (q0[0], q0[1], q0[2], q0[3])
    for i in range(4):  # to assign the slice would compile numba's words on shapes that differ
        quaternion[0, i] = q[i]
    zero = (0.0, 0.0, 0.0)
    for j in range(1, m):
        first, last = resets[j - 1], resets[j]
        v, p = zero, zero
        up = vertical(q)
        for k in range(first + 1, last + 1):
            rate = (gyro[k, 0] - bias[0], gyro[k, 1] - bias[1], gyro[k, 2] - bias[2])
            dt = t[k] - t[k - 1]
            q, v, p = advance(q, v, p, rate, accel[k], dt)
            below, up = up, vertical(q)
            for i in range(3):
                c = 0.5 * dt * (below[i] + up[i])  # the vertical at the middle of the sample, nearly
                sums[j, i] += c
                for a in range(3):
                    sums[j, 3 + 3 * i + a] += c * accel[k, a]
                    sums[j, 12 + 3 * i + a] += c * rate[a]
                    sums[j, 21 + 3 * i + a] += c * accel[k, a] * accel[k, a]
        duration = t[last] - t[first]
        for i in range(3):
            position[j, i] = position[j - 1, i] + p[i] - 0.5 * duration * v[i]
        tilt = tilt_gain / (GRAVITY * duration)
        q = multiply(exponential(tilt * v[1], -tilt * v[0], 0.0), q)
        for i in range(4):
            quaternion[j, i] = q[i]
    return quaternion, position, sums
