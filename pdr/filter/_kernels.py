"""Compiled error-state filter. The face that explains and checks is ins.py, the numpy twin _plain_ins.py.

Layout of the state x (25,): quaternion 0:4, velocity 4:7, position 7:10, accelerometer bias 10:13, gyro bias
13:16, g-sensitivity 16:25 (row by row). Layout of the error dx (n,), delta = truth - estimate: position 0:3,
velocity 3:6, attitude 6:9 (navigation frame), accelerometer bias 9:12, gyro bias 12:15, and for n = 24
g-sensitivity 15:24.

The transition is I but for nine rows, so that F P F' costs nine rows and then nine columns of a 9 x 9 block,
not two products of matrices.
"""

from __future__ import annotations

import math

import numpy as np

from footfall.compiled import kernel
from footfall.conventions import GRAVITY
from footfall.pdr._kernels import exponential, multiply


@kernel(nogil=True)
def matrix(q):  # type: ignore[no-untyped-def]
    """The rotation of a quaternion, row by row."""
    w, x, y, z = q
    return (
        1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y),
        2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x),
        2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y),
    )  # fmt: skip


@kernel(nogil=True)
def _advance_rows(a, c, f, s, dt):  # type: ignore[no-untyped-def]
    """a <- F a (Deng Eq. 9), row by row: each uses rows below it that are still old.

    c : attitude row by row, times dt; f : force in the navigation frame times dt; s : force in the body.
    """
    n = a.shape[1]
    wide = a.shape[0] > 15
    for k in range(n):
        for i in range(3):
            a[i, k] += dt * a[3 + i, k]
        px, py, pz = a[6, k], a[7, k], a[8, k]
        bx, by, bz = a[9, k], a[10, k], a[11, k]
        a[3, k] -= f[1] * pz - f[2] * py + c[0] * bx + c[1] * by + c[2] * bz
        a[4, k] -= f[2] * px - f[0] * pz + c[3] * bx + c[4] * by + c[5] * bz
        a[5, k] -= f[0] * py - f[1] * px + c[6] * bx + c[7] * by + c[8] * bz
        wx, wy, wz = a[12, k], a[13, k], a[14, k]
        if wide:
            wx += s[0] * a[15, k] + s[1] * a[16, k] + s[2] * a[17, k]
            wy += s[0] * a[18, k] + s[1] * a[19, k] + s[2] * a[20, k]
            wz += s[0] * a[21, k] + s[1] * a[22, k] + s[2] * a[23, k]
        a[6, k] -= c[0] * wx + c[1] * wy + c[2] * wz
        a[7, k] -= c[3] * wx + c[4] * wy + c[5] * wz
        a[8, k] -= c[6] * wx + c[7] * wy + c[8] * wz


@kernel(nogil=True)
def _advance_covariance(p, c, f, s, dt):  # type: ignore[no-untyped-def]
    """p <- F p F' (Deng Eq. 12)."""
    _advance_rows(p, c, f, s, dt)
    n = p.shape[0]
    wide = n > 15
    # Columns from 9 on are not changed by F', and rows from 9 on are those columns once more.
    for i in range(9):
        for k in range(3):
            p[i, k] += dt * p[i, 3 + k]
        px, py, pz = p[i, 6], p[i, 7], p[i, 8]
        bx, by, bz = p[i, 9], p[i, 10], p[i, 11]
        p[i, 3] -= f[1] * pz - f[2] * py + c[0] * bx + c[1] * by + c[2] * bz
        p[i, 4] -= f[2] * px - f[0] * pz + c[3] * bx + c[4] * by + c[5] * bz
        p[i, 5] -= f[0] * py - f[1] * px + c[6] * bx + c[7] * by + c[8] * bz
        wx, wy, wz = p[i, 12], p[i, 13], p[i, 14]
        if wide:
            wx += s[0] * p[i, 15] + s[1] * p[i, 16] + s[2] * p[i, 17]
            wy += s[0] * p[i, 18] + s[1] * p[i, 19] + s[2] * p[i, 20]
            wz += s[0] * p[i, 21] + s[1] * p[i, 22] + s[2] * p[i, 23]
        p[i, 6] -= c[0] * wx + c[1] * wy + c[2] * wz
        p[i, 7] -= c[3] * wx + c[4] * wy + c[5] * wz
        p[i, 8] -= c[6] * wx + c[7] * wy + c[8] * wz
    for i in range(9):
        for k in range(i + 1, n):
            p[k, i] = p[i, k]


@kernel(nogil=True)
def corrected(x, gyro, accel):  # type: ignore[no-untyped-def]
    """Force and rate that the state makes of a sample: without biases and g-sensitivity."""
    f = (accel[0] - x[10], accel[1] - x[11], accel[2] - x[12])
    return f, (
        gyro[0] - x[13] - (x[16] * f[0] + x[17] * f[1] + x[18] * f[2]),
        gyro[1] - x[14] - (x[19] * f[0] + x[20] * f[1] + x[21] * f[2]),
        gyro[2] - x[15] - (x[22] * f[0] + x[23] * f[1] + x[24] * f[2]),
    )


@kernel(nogil=True)
def propagate(x, p, phi, gyro, accel, dt, noise, gap):  # type: ignore[no-untyped-def]
    """One sample of strapdown and covariance; `phi` (n, n or 0) gathers the transition.

    noise : (4,) power of accelerometer and gyro noise and of the walks of their biases
    gap : (3,) longest interval that is no gap, and the deviations of force and rate in a gap
    """
    s, w = corrected(x, gyro, accel)
    q = (x[0], x[1], x[2], x[3])
    half = exponential(0.5 * dt * w[0], 0.5 * dt * w[1], 0.5 * dt * w[2])
    middle = multiply(q, half)
    m = matrix(middle)
    c = (m[0] * dt, m[1] * dt, m[2] * dt, m[3] * dt, m[4] * dt, m[5] * dt, m[6] * dt, m[7] * dt, m[8] * dt)
    f = (
        c[0] * s[0] + c[1] * s[1] + c[2] * s[2],
        c[3] * s[0] + c[4] * s[1] + c[5] * s[2],
        c[6] * s[0] + c[7] * s[1] + c[8] * s[2],
    )
    vx, vy, vz = x[4] + f[0], x[5] + f[1], x[6] + f[2] - GRAVITY * dt
    x[7] += 0.5 * dt * (x[4] + vx)
    x[8] += 0.5 * dt * (x[5] + vy)
    x[9] += 0.5 * dt * (x[6] + vz)
    x[4], x[5], x[6] = vx, vy, vz
    q = multiply(middle, half)
    mend = 1.5 - 0.5 * (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    x[0], x[1], x[2], x[3] = mend * q[0], mend * q[1], mend * q[2], mend * q[3]

    _advance_covariance(p, c, f, s, dt)
    if phi.shape[0] > 0:
        _advance_rows(phi, c, f, s, dt)
    # White noise is the same in every frame, so that G Q G' of Eq. 12 is diagonal.
    force, rate = noise[0] * dt, noise[1] * dt
    if dt > gap[0]:
        force += (gap[1] * dt) ** 2
        rate += (gap[2] * dt) ** 2
    for i in range(3):
        p[3 + i, 3 + i] += force
        p[6 + i, 6 + i] += rate
        p[9 + i, 9 + i] += noise[2] * dt
        p[12 + i, 12 + i] += noise[3] * dt


@kernel(nogil=True)
def _gain(p, h, first, last, variance, gain):  # type: ignore[no-untyped-def]
    """Kalman gain of the scalar measurement h (zero outside first..last-1), into `gain`."""
    n = p.shape[0]
    gain[:] = 0.0
    for k in range(first, last):
        for i in range(n):
            gain[i] += h[k] * p[k, i]
    s = variance
    for k in range(first, last):
        s += h[k] * gain[k]
    for i in range(n):
        gain[i] /= s


@kernel(nogil=True)
def _joseph(p, h, first, last, variance, gain):  # type: ignore[no-untyped-def]
    """p <- (I - gain h) p (I - gain h)' + gain variance gain': right for any gain."""
    n = p.shape[0]
    row = np.zeros(n)
    for k in range(first, last):
        for i in range(n):
            row[i] += h[k] * p[k, i]
    for i in range(n):
        # Row i of (I - gain h) p, then its share of the columns.
        left = -variance * gain[i]
        for k in range(first, last):
            left += (p[i, k] - gain[i] * row[k]) * h[k]
        for k in range(n):
            p[i, k] -= gain[i] * row[k] + left * gain[k]


@kernel(nogil=True)
def _symmetrise(p):  # type: ignore[no-untyped-def]
    for i in range(p.shape[0]):
        for k in range(i):
            mean = 0.5 * (p[i, k] + p[k, i])
            p[i, k], p[k, i] = mean, mean


@kernel(nogil=True)
def _take_in(dx, h, first, last, z, gain):  # type: ignore[no-untyped-def]
    """Add to dx what the measurement z = h dx says."""
    for k in range(first, last):
        z -= h[k] * dx[k]
    for i in range(dx.shape[0]):
        dx[i] += gain[i] * z


@kernel(nogil=True)
def _with_known(p, row):  # type: ignore[no-untyped-def]
    """p <- what it were if row dx was known."""
    n = p.shape[0]
    pr = np.zeros(n)
    for k in range(n):
        if row[k] != 0.0:
            for i in range(n):
                pr[i] += row[k] * p[k, i]
    s, scale = 0.0, 0.0
    for k in range(n):
        s += row[k] * pr[k]
        scale += row[k] * row[k] * p[k, k]
    if s > 1e-12 * scale:
        for i in range(n):
            for k in range(n):
                p[i, k] -= pr[i] * pr[k] / s


@kernel(nogil=True)
def _with_known_turn(x, p):  # type: ignore[no-untyped-def]
    """p if the heading was known, and whatever the gyro's errors turn about the vertical."""
    n = p.shape[0]
    m = matrix((x[0], x[1], x[2], x[3]))
    known, row = p.copy(), np.zeros(n)
    row[8] = 1.0
    _with_known(known, row)
    row[8] = 0.0
    row[12], row[13], row[14] = m[6], m[7], m[8]
    _with_known(known, row)
    if n > 15:
        for k in range(3):
            row[:] = 0.0
            row[15 + k], row[18 + k], row[21 + k] = m[6], m[7], m[8]
            _with_known(known, row)
    return known


@kernel(nogil=True)
def inject(x, dx):  # type: ignore[no-untyped-def]
    """Add the error to the state; the attitude by C <- exp[dphi x] C (delta = truth - estimate)."""
    for i in range(3):
        x[7 + i] += dx[i]
        x[4 + i] += dx[3 + i]
        x[10 + i] += dx[9 + i]
        x[13 + i] += dx[12 + i]
    q = multiply(exponential(dx[6], dx[7], dx[8]), (x[0], x[1], x[2], x[3]))
    length = math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    x[0], x[1], x[2], x[3] = q[0] / length, q[1] / length, q[2] / length, q[3] / length
    for i in range(15, dx.shape[0]):
        x[1 + i] += dx[i]


@kernel(nogil=True)
def rest(x, p, gyro, accel, velocity_variance, rate_variance, turns):  # type: ignore[no-untyped-def]
    """Zero velocity (Eq. 6, 11), and zero rate where `rate_variance` > 0; returns the error injected.

    turns : whether the velocity may correct the heading and the gyro's errors about the vertical. If not, the
    gain is that of a filter which knows them, so that they neither change nor let anything else change
    """
    n = p.shape[0]
    dx, h, gain = np.zeros(n), np.zeros(n), np.empty(n)
    known = p if turns else _with_known_turn(x, p)
    for i in range(3):
        h[3 + i] = 1.0
        _gain(known, h, 3 + i, 4 + i, velocity_variance, gain)
        _take_in(dx, h, 3 + i, 4 + i, -x[4 + i], gain)
        _joseph(p, h, 3 + i, 4 + i, velocity_variance, gain)
        if not turns:
            _joseph(known, h, 3 + i, 4 + i, velocity_variance, gain)
        h[3 + i] = 0.0
    if rate_variance > 0.0:
        f, w = corrected(x, gyro, accel)
        for i in range(3):
            h[12 + i] = 1.0
            last = 13 + i
            if n > 15:
                for k in range(3):
                    h[15 + 3 * i + k] = f[k]
                last = 18 + 3 * i
            _gain(p, h, 12 + i, last, rate_variance, gain)
            _take_in(dx, h, 12 + i, last, w[i], gain)
            _joseph(p, h, 12 + i, last, rate_variance, gain)
            h[:] = 0.0
    _symmetrise(p)
    inject(x, dx)
    return dx


@kernel(nogil=True)
def heading_row(x):  # type: ignore[no-untyped-def]
    """d heading / d attitude error: the body's x axis e turns by phi x e, so [-ez ex, -ez ey, h^2] / h^2."""
    m = matrix((x[0], x[1], x[2], x[3]))
    level = m[0] * m[0] + m[3] * m[3]
    return -m[6] * m[0] / level, -m[6] * m[3] / level, 1.0


@kernel(nogil=True)
def heading(x, p, innovation, variance):  # type: ignore[no-untyped-def]
    """The heading is off by `innovation`, truth - estimate (Eq. 27, 28); returns the error injected."""
    n = p.shape[0]
    dx, h, gain = np.zeros(n), np.zeros(n), np.empty(n)
    h[6], h[7], h[8] = heading_row(x)
    _gain(p, h, 6, 9, variance, gain)
    _take_in(dx, h, 6, 9, innovation, gain)
    _joseph(p, h, 6, 9, variance, gain)
    _symmetrise(p)
    inject(x, dx)
    return dx


@kernel(nogil=True)
def run(x, p, phi, before, t, gyro, accel, still, noise, gap, velocity_variance, rate_variance, turns):  # type: ignore[no-untyped-def]
    """All samples in order, each over the interval since the one before; `before` is the state's stamp.

    still : (n,) 1 for zero velocity, 2 for zero rate too
    """
    for k in range(len(t)):
        propagate(x, p, phi, gyro[k], accel[k], t[k] - before, noise, gap)
        before = t[k]
        if still[k] > 0:
            rest(x, p, gyro[k], accel[k], velocity_variance, rate_variance if still[k] > 1 else 0.0, turns)
