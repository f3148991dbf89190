"""Compiled kernels of the error effects and of the die. effects.py explains them, _plain.py checks them.

Each changes its samples in place, row by row: a recording needs no memory but its own.
"""

from __future__ import annotations

import numpy as np

from footfall.compiled import kernel


@kernel()
def add_linear(x, matrix, of):  # type: ignore[no-untyped-def]
    """x += matrix @ of, for each row."""
    for k in range(len(x)):
        a, b, c = of[k, 0], of[k, 1], of[k, 2]
        for i in range(3):
            x[k, i] += matrix[i, 0] * a + matrix[i, 1] * b + matrix[i, 2] * c


@kernel()
def add_quadratic(x, matrix, of):  # type: ignore[no-untyped-def]
    """x += matrix @ of^2, for each row."""
    for k in range(len(x)):
        a, b, c = of[k, 0] * of[k, 0], of[k, 1] * of[k, 1], of[k, 2] * of[k, 2]
        for i in range(3):
            x[k, i] += matrix[i, 0] * a + matrix[i, 1] * b + matrix[i, 2] * c


@kernel()
def add_cubic(x, largest, full_scale, of):  # type: ignore[no-untyped-def]
    """x += largest T3(of / full_scale), for each axis; beyond full scale as at it."""
    for k in range(len(x)):
        for i in range(3):
            u = min(max(of[k, i] / full_scale, -1.0), 1.0)
            x[k, i] += largest[i] * (4.0 * (u * u * u) - 3.0 * u)


@kernel()
def add_parabola(x, linear, quadratic, of):  # type: ignore[no-untyped-def]
    """x += linear of + quadratic of^2, for each row."""
    for k in range(len(x)):
        for i in range(3):
            x[k, i] += linear[i] * of[k] + quadratic[i] * (of[k] * of[k])


@kernel()
def add_noise(x, sigma, first, decay, drive, generator):  # type: ignore[no-untyped-def]
    """x += sigma b, with b+ = decay b + drive n on each axis, begun with b = first n.

    The process is drawn at unit size and scaled afterwards. Its normals are those that
    `generator.standard_normal(x.shape)` gives, bit for bit, at half the cost.
    """
    b = np.zeros(3)
    for i in range(3):
        b[i] = first * generator.standard_normal()
        x[0, i] += sigma * b[i]
    for k in range(1, len(x)):
        for i in range(3):
            b[i] = decay * b[i] + drive * generator.standard_normal()
            x[k, i] += sigma * b[i]


@kernel()
def low_pass(x, b0, b1, b2, a1, a2):  # type: ignore[no-untyped-def]
    """Second-order section of gain 1 at rest, started settled on the first row (transposed form II)."""
    s, r = np.zeros(3), np.zeros(3)
    for i in range(3):
        s[i], r[i] = (1.0 - b0) * x[0, i], (b2 - a2) * x[0, i]
    for k in range(len(x)):
        for i in range(3):
            u = x[k, i]
            y = b0 * u + s[i]
            s[i] = b1 * u - a1 * y + r[i]
            r[i] = b2 * u - a2 * y
            x[k, i] = y


@kernel()
def add_lag(air, lag, decay, mean):  # type: ignore[no-untyped-def]
    """air += e, with e+ = decay e - mean (air+ - air), begun with e = lag."""
    before = air[0]
    air[0] += lag
    for k in range(1, len(air)):
        lag = decay * lag - mean * (air[k] - before)
        before = air[k]
        air[k] += lag
