"""Compiled: smoothing of the drift along one sequence of modes. Explained in docs/hypotheses.md.

The modified Bryson-Frazier form (Bierman 1977): the adjoint `y` and its matrix `L` run backwards through the
transposed operations of `_linear`, and nothing is inverted. Of a footfall only what this needs is kept: the
row of the covariance that belongs to the drift, and the gains.
"""

from __future__ import annotations

import numpy as np

from footfall.compiled import kernel
from footfall.hdr.hypotheses._interval import SWAYING, drifting, fading, noises, swaying, turning_back
from footfall.hdr.hypotheses._linear import (
    ALIGNED,
    ANEW,
    ASIDE,
    CELLS,
    CURVATURE,
    CURVE,
    DRIFT,
    FLICKER,
    FOOT,
    FOOT_BEFORE,
    PATH,
    REFERENCE,
    SLIDE,
    STATES,
    STAYS,
    TURN,
    age,
    aligning,
    begin,
    drift,
    move,
    nearest,
    resting,
    seeing,
    seen,
    update,
)
from footfall.hdr.hypotheses._sight import COURSE, DISTANCE, INTERVAL, REST, REST_RATE


@kernel(error_model="numpy")
def pull_add(y, L, i, a, g):  # type: ignore[no-untyped-def]
    """Back through x_i += a x; g for work."""
    n = len(y)
    for j in range(n):
        g[j] = L[i, j]
    own = L[i, i]
    for j in range(n):
        y[j] += a[j] * y[i]
        for k in range(n):
            L[j, k] += a[j] * g[k] + g[j] * a[k] + a[j] * a[k] * own


@kernel(error_model="numpy")
def pull_become(y, L, i, j):  # type: ignore[no-untyped-def]
    """Back through x_i = x_j."""
    n = len(y)
    y[j] += y[i]
    for k in range(n):
        L[j, k] += L[i, k]
    for k in range(n):
        L[k, j] += L[k, i]
    pull_empty(y, L, i)


@kernel(error_model="numpy")
def pull_empty(y, L, i):  # type: ignore[no-untyped-def]
    """Back through x_i = 0."""
    y[i] = 0.0
    for k in range(len(y)):
        L[i, k] = L[k, i] = 0.0


@kernel(error_model="numpy")
def pull_sway(y, L, f00, f01, f10, f11):  # type: ignore[no-untyped-def]
    """Back through the transition of wander and its rate."""
    y[ASIDE], y[SLIDE] = f00 * y[ASIDE] + f10 * y[SLIDE], f01 * y[ASIDE] + f11 * y[SLIDE]
    for k in range(len(y)):
        p, q = L[ASIDE, k], L[SLIDE, k]
        L[ASIDE, k], L[SLIDE, k] = f00 * p + f10 * q, f01 * p + f11 * q
    for k in range(len(y)):
        p, q = L[k, ASIDE], L[k, SLIDE]
        L[k, ASIDE], L[k, SLIDE] = f00 * p + f10 * q, f01 * p + f11 * q


@kernel(error_model="numpy")
def pull_update(y, L, h, gained, left, s, g):  # type: ignore[no-untyped-def]
    """Back through a measurement of row h, gain, innovation and its variance; g for work."""
    n = len(y)
    along, twice = left / s, 1.0 / s
    for i in range(n):
        g[i] = 0.0
        for j in range(n):
            g[i] += L[i, j] * gained[j]
        along += gained[i] * y[i]
    for i in range(n):
        twice += gained[i] * g[i]
    for i in range(n):
        y[i] -= h[i] * along
    for i in range(n):
        for j in range(n):
            L[i, j] += h[i] * h[j] * twice - h[i] * g[j] - g[i] * h[j]


@kernel(error_model="numpy")
def smooth(rows, c, modes, habits, entries, scale, first_mode, first_habit, told):  # type: ignore[no-untyped-def]
    """Drift and its variance, each (n,), given all rows (n, SIGHT) and one sequence of labels (n,).

    scale : of the sensor's priors; first_mode, first_habit : before the first stride
    told : as of `_linear.begin`
    """
    n, m = len(rows), STATES
    kept, mean = np.zeros((n, m)), np.zeros(n)
    length, taken = np.zeros(n), np.zeros((n, 3), dtype=np.bool_)
    gains, lefts, spreads = np.zeros((n, 3, m)), np.zeros((n, 3)), np.ones((n, 3))
    x, P = np.zeros(m), np.zeros((m, m))
    a, g, h, k = np.zeros(m), np.zeros(m), np.zeros(m), np.zeros(m)
    back, f, p = np.zeros(m), np.zeros(SWAYING), P.reshape(CELLS)
    course, last, size = 0.0, 0.0, scale * scale
    for i in range(n - 1, 0, -1):
        if rows[i, DISTANCE] >= c.shortest_m:
            course = rows[i, COURSE]
    begin(x, P, course, first_mode, first_habit, scale, told, c)
    for i in range(1, n):
        row = rows[i]
        habit = habits[i - 1] if i > 1 else first_habit
        drifting(a, row)
        new, told_here = turning_back(back, row), row[REST] * row[REST_RATE]
        drifted, biased, flickered = noises(row, c)
        drift(x, P, p, told_here, size * drifted, a, back, new, g)
        if row[REST] > 0.0:
            resting(h, row)
            noise = size * c.random_walk * c.random_walk / row[REST]
            lefts[i, 0], spreads[i, 0] = update(x, P, h, row[REST_RATE], noise, k)
            gains[i, 0], taken[i, 0] = k, True
        swaying(f, habit, row[INTERVAL], c)
        kept_share = fading(row[INTERVAL], c)
        age(x, P, p, kept_share, f, size * biased, size * flickered, c.place_m * c.place_m)
        if row[DISTANCE] >= c.shortest_m:
            length[i] = 0.5 * (row[DISTANCE] + last) if last > 0.0 else row[DISTANCE]
            last = row[DISTANCE]
            move(x, P, modes[i], entries[i], habits[i], length[i], c, a, g)
            seeing(h, row)
            lefts[i, 1], spreads[i, 1] = update(x, P, h, seen(row), c.course * c.course, k)
            gains[i, 1], taken[i, 1] = k, True
            if entries[i] == ALIGNED:
                aligning(h)
                along = nearest(x[PATH] - x[REFERENCE], c.directions)
                lefts[i, 2], spreads[i, 2] = update(x, P, h, along, c.beside * c.beside, k)
                gains[i, 2], taken[i, 2] = k, True
        kept[i], mean[i] = P[DRIFT], x[DRIFT]
    return backwards(
        rows, c, modes, habits, entries, first_habit, kept, mean, length, taken, gains, lefts, spreads
    )


@kernel(error_model="numpy")
def backwards(  # type: ignore[no-untyped-def]
    rows, c, modes, habits, entries, first_habit, kept, mean, length, taken, gains, lefts, spreads
):
    """What later footfalls say of the drift at each."""
    n, m = len(rows), STATES
    found, variance = np.zeros(n), np.zeros(n)
    y, L = np.zeros(m), np.zeros((m, m))
    a, g, h, f = np.zeros(m), np.zeros(m), np.zeros(m), np.zeros(SWAYING)
    for i in range(n - 1, 0, -1):
        row = rows[i]
        found[i], variance[i] = mean[i], kept[i, DRIFT]
        for j in range(m):
            found[i] -= kept[i, j] * y[j]
            for q in range(m):
                variance[i] -= kept[i, j] * L[j, q] * kept[i, q]
        if taken[i, 2]:
            aligning(h)
            pull_update(y, L, h, gains[i, 2], lefts[i, 2], spreads[i, 2], g)
        if taken[i, 1]:
            seeing(h, row)
            pull_update(y, L, h, gains[i, 1], lefts[i, 1], spreads[i, 1], g)
            if modes[i] == TURN:
                for j in (ASIDE, SLIDE, FOOT, FOOT_BEFORE):
                    pull_empty(y, L, j)
            if modes[i] == CURVE:
                a[:] = 0.0
                a[CURVATURE] = length[i]
                pull_add(y, L, PATH, a, g)
            if entries[i] == ANEW:
                pull_become(y, L, REFERENCE, PATH)
            if modes[i] != CURVE or entries[i] != STAYS:
                pull_empty(y, L, CURVATURE)
        habit = habits[i - 1] if i > 1 else first_habit
        pull_become(y, L, FOOT, ASIDE)
        swaying(f, habit, row[INTERVAL], c)
        pull_sway(y, L, f[0], f[1], f[2], f[3])
        pull_become(y, L, FOOT_BEFORE, FOOT)
        kept_share = fading(row[INTERVAL], c)
        y[FLICKER] *= kept_share
        for j in range(m):
            L[FLICKER, j] *= kept_share
        for j in range(m):
            L[j, FLICKER] *= kept_share
        if taken[i, 0]:
            resting(h, row)
            pull_update(y, L, h, gains[i, 0], lefts[i, 0], spreads[i, 0], g)
        if turning_back(a, row):
            pull_add(y, L, PATH, a, g)
        drifting(a, row)
        pull_add(y, L, DRIFT, a, g)
    return found, variance
