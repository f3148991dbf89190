"""Compiled: what an interval between footfalls does to every hypothesis alike (docs/hypotheses.md)."""

from __future__ import annotations

import math

from footfall.compiled import kernel
from footfall.hdr.hypotheses._linear import BIAS, FLICKER, LOADED, WARM
from footfall.hdr.hypotheses._sight import ACTIVE, DIRECTIONS, INTERVAL, JUMP, LOAD, TOLD, WARMTH

SWAYING = 7  # numbers of `swaying`


@kernel(error_model="numpy")
def swaying(f, habit, interval, c):  # type: ignore[no-untyped-def]
    """Fill f (SWAYING,) with what an interval does to wander and its rate: a critically damped process.

    Its transition by rows, and what is added to the two variances and between them, so that they stay
    wander_m^2 and (wander_m / wander_s)^2.
    """
    r = 1.0 / c.wander_s[habit]
    e = math.exp(-interval * r)
    f[0], f[1] = e * (1.0 + interval * r), e * interval
    f[2], f[3] = -e * r * r * interval, e * (1.0 - interval * r)
    s, v = c.wander_m[habit] ** 2, (c.wander_m[habit] / c.wander_s[habit]) ** 2
    f[4] = s - f[0] * f[0] * s - f[1] * f[1] * v
    f[5] = v - f[2] * f[2] * s - f[3] * f[3] * v
    f[6] = -f[0] * f[2] * s - f[1] * f[3] * v


@kernel(error_model="numpy")
def fading(interval, c):  # type: ignore[no-untyped-def]
    """What is left of flicker after an interval."""
    return math.exp(-interval / c.flicker_s)


@kernel(error_model="numpy")
def drifting(a, row):  # type: ignore[no-untyped-def]
    """Fill the coefficients with which the drift grows by the states."""
    a[:] = 0.0
    a[BIAS] = a[FLICKER] = row[ACTIVE]
    a[WARM] = row[ACTIVE] * row[WARMTH]
    for k in range(DIRECTIONS):
        a[LOADED + k] = row[ACTIVE] * row[LOAD + k] + row[JUMP + k]


@kernel(error_model="numpy")
def noises(row, c):  # type: ignore[no-untyped-def]
    """Variances that an interval adds to the drift, bias and flicker, for sensor priors of scale 1."""
    walk = c.bias_walk if row[TOLD] > 0.0 else c.bias_walk_blind
    kept = fading(row[INTERVAL], c)
    drifted = c.random_walk * c.random_walk * row[ACTIVE]
    return drifted, walk * walk * row[INTERVAL], c.flicker * c.flicker * (1.0 - kept * kept)


@kernel(error_model="numpy")
def turning_back(a, row):  # type: ignore[no-untyped-def]
    """Fill the coefficients by which the path gives back what a new direction adds; whether one is new."""
    a[:] = 0.0
    new = False
    for k in range(DIRECTIONS):
        if row[JUMP + k] != 0.0:
            a[LOADED + k] = -row[JUMP + k]
            new = True
    return new
