"""Compiled error-state filter. The face that explains and checks is ins.py, the numpy twin _plain.py.

State x and error dx are laid out in layout.py; the names below are where each part of them begins. A filter
without g-sensitivity has an error that ends before it.

The transition is I but for nine rows, so that F P F' costs nine rows and then nine columns of a 9 x 9 block,
not two products of matrices.
"""

from __future__ import annotations

import math

import numpy as np

from footfall.compiled import kernel
from footfall.conventions import GRAVITY
from footfall.pdr._kernels import exponential, multiply
from footfall.pdr.filter.layout import ERROR, HEADING, STATE, Measurement

# Of the error: position, velocity, attitude, accelerometer bias, gyro bias, g-sensitivity (row by row).
_P, _V, _A, _B, _W, _G = (part.start for part in ERROR.values())
# Of the state: quaternion, and the others in its order.
_XQ, _XV, _XP, _XB, _XW, _XG = (part.start for part in STATE.values())


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
    wide = a.shape[0] > _G
    for k in range(n):
        for i in range(3):
            a[_P + i, k] += dt * a[_V + i, k]
        px, py, pz = a[_A, k], a[_A + 1, k], a[_A + 2, k]
        bx, by, bz = a[_B, k], a[_B + 1, k], a[_B + 2, k]
        a[_V, k] -= f[1] * pz - f[2] * py + c[0] * bx + c[1] * by + c[2] * bz
        a[_V + 1, k] -= f[2] * px - f[0] * pz + c[3] * bx + c[4] * by + c[5] * bz
        a[_V + 2, k] -= f[0] * py - f[1] * px + c[6] * bx + c[7] * by + c[8] * bz
        wx, wy, wz = a[_W, k], a[_W + 1, k], a[_W + 2, k]
        if wide:
            wx += s[0] * a[_G, k] + s[1] * a[_G + 1, k] + s[2] * a[_G + 2, k]
            wy += s[0] * a[_G + 3, k] + s[1] * a[_G + 4, k] + s[2] * a[_G + 5, k]
            wz += s[0] * a[_G + 6, k] + s[1] * a[_G + 7, k] + s[2] * a[_G + 8, k]
        a[_A, k] -= c[0] * wx + c[1] * wy + c[2] * wz
        a[_A + 1, k] -= c[3] * wx + c[4] * wy + c[5] * wz
        a[_A + 2, k] -= c[6] * wx + c[7] * wy + c[8] * wz


@kernel(nogil=True)
def _advance_covariance(p, c, f, s, dt):  # type: ignore[no-untyped-def]
    """p <- F p F' (Deng Eq. 12)."""
    _advance_rows(p, c, f, s, dt)
    n = p.shape[0]
    wide = n > _G
    # Columns from the biases on are not changed by F', and rows from there on are those columns once more.
    for i in range(_B):
        for k in range(3):
            p[i, _P + k] += dt * p[i, _V + k]
        px, py, pz = p[i, _A], p[i, _A + 1], p[i, _A + 2]
        bx, by, bz = p[i, _B], p[i, _B + 1], p[i, _B + 2]
        p[i, _V] -= f[1] * pz - f[2] * py + c[0] * bx + c[1] * by + c[2] * bz
        p[i, _V + 1] -= f[2] * px - f[0] * pz + c[3] * bx + c[4] * by + c[5] * bz
        p[i, _V + 2] -= f[0] * py - f[1] * px + c[6] * bx + c[7] * by + c[8] * bz
        wx, wy, wz = p[i, _W], p[i, _W + 1], p[i, _W + 2]
        if wide:
            wx += s[0] * p[i, _G] + s[1] * p[i, _G + 1] + s[2] * p[i, _G + 2]
            wy += s[0] * p[i, _G + 3] + s[1] * p[i, _G + 4] + s[2] * p[i, _G + 5]
            wz += s[0] * p[i, _G + 6] + s[1] * p[i, _G + 7] + s[2] * p[i, _G + 8]
        p[i, _A] -= c[0] * wx + c[1] * wy + c[2] * wz
        p[i, _A + 1] -= c[3] * wx + c[4] * wy + c[5] * wz
        p[i, _A + 2] -= c[6] * wx + c[7] * wy + c[8] * wz
    for i in range(_B):
        for k in range(i + 1, n):
            p[k, i] = p[i, k]


@kernel(nogil=True)
def corrected(x, gyro, accel):  # type: ignore[no-untyped-def]
    """Force and rate that the state makes of a sample: without biases and g-sensitivity."""
    f = (accel[0] - x[_XB], accel[1] - x[_XB + 1], accel[2] - x[_XB + 2])
    return f, (
        gyro[0] - x[_XW] - (x[_XG] * f[0] + x[_XG + 1] * f[1] + x[_XG + 2] * f[2]),
        gyro[1] - x[_XW + 1] - (x[_XG + 3] * f[0] + x[_XG + 4] * f[1] + x[_XG + 5] * f[2]),
        gyro[2] - x[_XW + 2] - (x[_XG + 6] * f[0] + x[_XG + 7] * f[1] + x[_XG + 8] * f[2]),
    )


@kernel(nogil=True)
def propagate(x, p, phi, gyro, accel, dt, noise, gap):  # type: ignore[no-untyped-def]
    """One sample of strapdown and covariance; `phi` (n, n or 0) gathers the transition.

    noise : (4,) power of accelerometer and gyro noise and of the walks of their biases
    gap : (3,) longest interval that is no gap, and the deviations of force and rate in a gap
    """
    s, w = corrected(x, gyro, accel)
    q = (x[_XQ], x[_XQ + 1], x[_XQ + 2], x[_XQ + 3])
    half = exponential(0.5 * dt * w[0], 0.5 * dt * w[1], 0.5 * dt * w[2])
    middle = multiply(q, half)
    m = matrix(middle)
    c = (m[0] * dt, m[1] * dt, m[2] * dt, m[3] * dt, m[4] * dt, m[5] * dt, m[6] * dt, m[7] * dt, m[8] * dt)
    f = (
        c[0] * s[0] + c[1] * s[1] + c[2] * s[2],
        c[3] * s[0] + c[4] * s[1] + c[5] * s[2],
        c[6] * s[0] + c[7] * s[1] + c[8] * s[2],
    )
    vx, vy, vz = x[_XV] + f[0], x[_XV + 1] + f[1], x[_XV + 2] + f[2] - GRAVITY * dt
    x[_XP] += 0.5 * dt * (x[_XV] + vx)
    x[_XP + 1] += 0.5 * dt * (x[_XV + 1] + vy)
    x[_XP + 2] += 0.5 * dt * (x[_XV + 2] + vz)
    x[_XV], x[_XV + 1], x[_XV + 2] = vx, vy, vz
    q = multiply(middle, half)
    mend = 1.5 - 0.5 * (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    x[_XQ], x[_XQ + 1], x[_XQ + 2], x[_XQ + 3] = mend * q[0], mend * q[1], mend * q[2], mend * q[3]

    _advance_covariance(p, c, f, s, dt)
    if phi.shape[0] > 0:
        _advance_rows(phi, c, f, s, dt)
    # White noise is the same in every frame, so that G Q G' of Eq. 12 is diagonal.
    force, rate = noise[0] * dt, noise[1] * dt
    if dt > gap[0]:
        force += (gap[1] * dt) ** 2
        rate += (gap[2] * dt) ** 2
    for i in range(3):
        p[_V + i, _V + i] += force
        p[_A + i, _A + i] += rate
        p[_B + i, _B + i] += noise[2] * dt
        p[_W + i, _W + i] += noise[3] * dt


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
def _span(h):  # type: ignore[no-untyped-def]
    """First and one past the last of a row that is not zero."""
    first, last = 0, h.shape[0]
    while first < last and h[first] == 0.0:
        first += 1
    while last > first and h[last - 1] == 0.0:
        last -= 1
    return first, last


@kernel(nogil=True)
def _take_in(p, known, dx, measurement, apart):  # type: ignore[no-untyped-def]
    """Take a measurement in, row by row: what it says into dx, what it leaves uncertain into p.

    known : the covariance that the gain goes by: p itself, or (`apart`) another, which follows
    """
    gain = np.empty(p.shape[0])
    for m in range(measurement.z.shape[0]):
        h, z, variance = measurement.h[m], measurement.z[m], measurement.r[m]
        first, last = _span(h)
        _gain(known, h, first, last, variance, gain)
        for k in range(first, last):
            z -= h[k] * dx[k]
        for i in range(dx.shape[0]):
            dx[i] += gain[i] * z
        _joseph(p, h, first, last, variance, gain)
        if apart:
            _joseph(known, h, first, last, variance, gain)


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
def _with_known_turn(p, up):  # type: ignore[no-untyped-def]
    """p if the heading was known, and whatever the gyro's errors turn about `up`, a direction of the body."""
    n = p.shape[0]
    known, row = p.copy(), np.zeros(n)
    row[HEADING] = 1.0
    _with_known(known, row)
    row[HEADING] = 0.0
    row[_W], row[_W + 1], row[_W + 2] = up
    _with_known(known, row)
    if n > _G:
        for k in range(3):
            row[:] = 0.0
            row[_G + k], row[_G + 3 + k], row[_G + 6 + k] = up
            _with_known(known, row)
    return known


@kernel(nogil=True)
def inject(x, dx):  # type: ignore[no-untyped-def]
    """Add the error to the state; the attitude by C <- exp[dphi x] C (delta = truth - estimate)."""
    for i in range(3):
        x[_XP + i] += dx[_P + i]
        x[_XV + i] += dx[_V + i]
        x[_XB + i] += dx[_B + i]
        x[_XW + i] += dx[_W + i]
    q = multiply(exponential(dx[_A], dx[_A + 1], dx[_A + 2]), (x[_XQ], x[_XQ + 1], x[_XQ + 2], x[_XQ + 3]))
    length = math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    for i in range(4):
        x[_XQ + i] = q[i] / length
    for i in range(dx.shape[0] - _G):
        x[_XG + i] += dx[_G + i]


@kernel(nogil=True)
def update(x, p, measurement):  # type: ignore[no-untyped-def]
    """Take a measurement in and put right what it says; returns the error injected."""
    dx = np.zeros(p.shape[0])
    _take_in(p, p, dx, measurement, False)
    _symmetrise(p)
    inject(x, dx)
    return dx


@kernel(nogil=True)
def zero_velocity(x, n, variance):  # type: ignore[no-untyped-def]
    """The foot stands (Eq. 6, 11)."""
    z, h, r = np.empty(3), np.zeros((3, n)), np.empty(3)
    for i in range(3):
        z[i], h[i, _V + i], r[i] = -x[_XV + i], 1.0, variance
    return Measurement(z, h, r)


@kernel(nogil=True)
def zero_rate(x, n, gyro, accel, variance):  # type: ignore[no-untyped-def]
    """The foot does not turn: what the gyros say is their bias and their g-sensitivity."""
    z, h, r = np.empty(3), np.zeros((3, n)), np.empty(3)
    force, rate = corrected(x, gyro, accel)
    for i in range(3):
        z[i], h[i, _W + i], r[i] = rate[i], 1.0, variance
        if n > _G:
            for k in range(3):
                h[i, _G + 3 * i + k] = force[k]
    return Measurement(z, h, r)


@kernel(nogil=True)
def heading_off(x, n, innovation, variance):  # type: ignore[no-untyped-def]
    """The heading is off by `innovation`, truth - estimate (Eq. 27, 28)."""
    z, h, r = np.empty(1), np.zeros((1, n)), np.empty(1)
    z[0], r[0] = innovation, variance
    h[0, _A], h[0, _A + 1], h[0, _A + 2] = heading_row(x)
    return Measurement(z, h, r)


@kernel(nogil=True)
def rest(x, p, gyro, accel, velocity_variance, rate_variance, turns, up):  # type: ignore[no-untyped-def]
    """Zero velocity, and zero rate where `rate_variance` > 0; returns the error injected.

    turns : whether the velocity may correct the heading and the gyro's errors about the vertical. If not, the
    gain is that of a filter which knows them, so that they neither change nor let anything else change
    up : (3,) the body's direction that counts as the vertical. It must not change from update to update: the
    corrections of a bias would each be level, but their sum would not
    """
    n = p.shape[0]
    dx = np.zeros(n)
    known = p if turns else _with_known_turn(p, up)
    _take_in(p, known, dx, zero_velocity(x, n, velocity_variance), not turns)
    if rate_variance > 0.0:
        _take_in(p, p, dx, zero_rate(x, n, gyro, accel, rate_variance), False)
    _symmetrise(p)
    inject(x, dx)
    return dx


@kernel(nogil=True)
def heading_row(x):  # type: ignore[no-untyped-def]
    """d heading / d attitude error: the body's x axis e turns by phi x e, so [-ez ex, -ez ey, h^2] / h^2."""
    m = matrix((x[_XQ], x[_XQ + 1], x[_XQ + 2], x[_XQ + 3]))
    level = m[0] * m[0] + m[3] * m[3]
    return -m[6] * m[0] / level, -m[6] * m[3] / level, 1.0


@kernel(nogil=True)
def heading_variance(x, p):  # type: ignore[no-untyped-def]
    """Variance of the heading (rad^2)."""
    row = heading_row(x)
    total = 0.0
    for i in range(3):
        for k in range(3):
            total += row[i] * p[_A + i, _A + k] * row[k]
    return total


@kernel(nogil=True)
def run(x, p, phi, before, t, gyro, accel, still, noise, gap, variances, turns, up, stops, kept, kept_p):  # type: ignore[no-untyped-def]
    """All samples in order, each over the interval since the one before; `before` is the state's stamp.

    still : (n,) 1 for zero velocity, 2 for zero rate too
    variances : of zero velocity and of zero rate
    stops : (k,) increasing, samples after which x and p are written into `kept` and `kept_p` (k, ...); -1 is
    before the first
    """
    stop = 0
    for k in range(-1, len(t)):
        if k >= 0:
            propagate(x, p, phi, gyro[k], accel[k], t[k] - before, noise, gap)
            before = t[k]
            if still[k] > 0:
                rate = variances[1] if still[k] > 1 else 0.0
                rest(x, p, gyro[k], accel[k], variances[0], rate, turns, up)
        if stop < len(stops) and stops[stop] == k:
            kept[stop] = x
            kept_p[stop] = p
            stop += 1
