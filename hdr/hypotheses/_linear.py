"""Compiled: one hypothesis's state, how it moves and what a footfall says of it (docs/hypotheses.md).

Every step is a few row and column operations on a symmetric covariance, which is cheaper than its matrix.
The steps of every footfall, which decide how long the filter takes, see it flat (p is P row by row): the
compiler then knows where rows lie, and works on several of their numbers at once. They take numbers rather
than all constants c, whose arrays every call would have to count as used.
"""

from __future__ import annotations

import math

from footfall.compiled import kernel
from footfall.hdr.hypotheses._sight import (
    ACTIVE,
    COURSE,
    DIRECTIONS,
    DISTANCE,
    LOAD,
    MOVING,
    REST,
    REST_RATE,
    REST_WARMTH,
    WARMTH,
)

# The state.
PATH = 0  # rad, direction of the path (theta)
CURVATURE = 1  # rad/m (kappa)
ASIDE, SLIDE = 2, 3  # m, m/s: lateral wander and its rate (l, v)
FOOT, FOOT_BEFORE = 4, 5  # m, lateral places of this footfall and the one before (u)
DRIFT = 6  # rad, of the heading (B)
BIAS, FLICKER = 7, 8  # rad/s (b, o)
WARM = 9  # rad/s/K (c)
REFERENCE = 10  # rad, one of the dominant directions (r)
LOADED = 11  # standard normal, of each direction of loads (z)
STATES = 16  # with a last that is always 0: a row fills the processor's vectors
CELLS = STATES * STATES  # of a covariance

STRAIGHT, CURVE, TURN = range(3)
# How a mode is entered: two kinds of curves; a straight along a dominant direction, or the first of new ones.
STAYS, GENTLE, TIGHT, ALIGNED, ANEW = range(5)


@kernel(error_model="numpy")
def begin(x, P, course, mode, habit, scale, told, c):  # type: ignore[no-untyped-def]
    """The state before the first stride, whose direction is `course`.

    told : the walk sets out on a straight along one of the dominant directions, which are known
    """
    x[:] = 0.0
    P[:] = 0.0
    P[PATH, PATH] = c.beside * c.beside if told else 0.25
    become(x, P, REFERENCE, PATH)
    if told:
        P[PATH, PATH] += c.beside * c.beside
    else:
        P[REFERENCE, REFERENCE] += c.beside * c.beside
    set_out(x, course, told, c)
    aside = c.wander_m[habit]
    fresh(P, aside, c.wander_s[habit], c.place_m)
    P[FOOT_BEFORE, FOOT_BEFORE] = aside * aside + c.place_m * c.place_m
    if mode == CURVE:
        P[CURVATURE, CURVATURE] = c.gentle * c.gentle
    P[BIAS, BIAS] = (scale * c.bias) ** 2
    P[FLICKER, FLICKER] = (scale * c.flicker) ** 2
    P[WARM, WARM] = (scale * c.warmth) ** 2
    for k in range(DIRECTIONS):
        P[LOADED + k, LOADED + k] = scale * scale


@kernel(error_model="numpy")
def set_out(x, course, told, c):  # type: ignore[no-untyped-def]
    """The direction in which the walk begins, and the dominant one: known, or the same."""
    x[PATH] = x[REFERENCE] = course - x[DRIFT]
    if told:
        x[REFERENCE] = c.reference
        x[PATH] = c.reference + nearest(x[PATH] - c.reference, c.directions)


@kernel(error_model="numpy")
def fresh(P, aside, time, place):  # type: ignore[no-untyped-def]
    """Wander as it is where nothing is known of it; its rows are empty."""
    P[ASIDE, ASIDE] = aside * aside
    P[SLIDE, SLIDE] = (aside / time) ** 2
    P[FOOT, FOOT] = aside * aside + place * place
    P[FOOT, ASIDE] = P[ASIDE, FOOT] = aside * aside


@kernel(error_model="numpy")
def add_to(x, P, i, a, g):  # type: ignore[no-untyped-def]
    """x_i += a x, with g for work; a_i is 0."""
    n = len(x)
    g[:] = 0.0
    moved = 0.0
    for k in range(n):
        if a[k] != 0.0:
            moved += a[k] * x[k]
            for j in range(n):
                g[j] += a[k] * P[k, j]
    x[i] += moved
    own = P[i, i] + 2.0 * g[i]
    for k in range(n):
        own += a[k] * g[k]
    for j in range(n):
        P[i, j] += g[j]
        P[j, i] = P[i, j]
    P[i, i] = own


@kernel(error_model="numpy")
def become(x, P, i, j):  # type: ignore[no-untyped-def]
    """x_i = x_j."""
    n = len(x)
    x[i] = x[j]
    for k in range(n):
        P[i, k] = P[j, k]
    P[i, i] = P[j, j]
    for k in range(n):
        P[k, i] = P[i, k]


@kernel(error_model="numpy")
def empty(x, P, i):  # type: ignore[no-untyped-def]
    """x_i = 0, known."""
    x[i] = 0.0
    for k in range(len(x)):
        P[i, k] = P[k, i] = 0.0


@kernel(error_model="numpy")
def drift(x, P, p, told, noise, a, back, new, g):  # type: ignore[no-untyped-def]
    """What an interval adds to the heading's drift, and a rest in it, which told its share; g for work.

    noise : its variance; a : of `drifting`; back, new : of `turning_back`
    """
    n = len(x)
    for j in range(n):
        more = a[BIAS] * p[BIAS * STATES + j] + a[FLICKER] * p[FLICKER * STATES + j]
        more += a[WARM] * p[WARM * STATES + j]
        for d in range(DIRECTIONS):
            more += a[LOADED + d] * p[(LOADED + d) * STATES + j]
        g[j] = more
    own = g[DRIFT]
    for j in range(n):
        x[DRIFT] += a[j] * x[j]
        own += a[j] * g[j]
        p[DRIFT * STATES + j] += g[j]
    for j in range(n):
        p[j * STATES + DRIFT] = p[DRIFT * STATES + j]
    x[DRIFT] += told
    P[DRIFT, DRIFT] += own + noise
    if new:
        add_to(x, P, PATH, back, g)


@kernel(error_model="numpy")
def age(x, P, p, kept, f, bias, flicker, place):  # type: ignore[no-untyped-def]
    """What an interval does to the gyro's errors and to the wander, whatever the path is.

    kept : of `fading`; f : of `swaying`, for the habit; the others are added variances: of the two rates and
    of where a foot lands
    """
    n = len(x)
    f00, f01, f10, f11 = f[0], f[1], f[2], f[3]
    x[FOOT_BEFORE] = x[FOOT]
    x[ASIDE], x[SLIDE] = f00 * x[ASIDE] + f01 * x[SLIDE], f10 * x[ASIDE] + f11 * x[SLIDE]
    x[FOOT] = x[ASIDE]
    x[FLICKER] *= kept
    for j in range(n):  # rows
        aside, slide = p[ASIDE * STATES + j], p[SLIDE * STATES + j]
        p[FOOT_BEFORE * STATES + j] = p[FOOT * STATES + j]
        p[ASIDE * STATES + j] = p[FOOT * STATES + j] = f00 * aside + f01 * slide
        p[SLIDE * STATES + j] = f10 * aside + f11 * slide
        p[FLICKER * STATES + j] *= kept
    for i in (ASIDE, SLIDE, FOOT, FOOT_BEFORE, FLICKER):  # columns of these rows
        aside, slide = P[i, ASIDE], P[i, SLIDE]
        P[i, FOOT_BEFORE] = P[i, FOOT]
        P[i, ASIDE] = P[i, FOOT] = f00 * aside + f01 * slide
        P[i, SLIDE] = f10 * aside + f11 * slide
        P[i, FLICKER] *= kept
    P[BIAS, BIAS] += bias
    P[FLICKER, FLICKER] += flicker
    P[SLIDE, SLIDE] += f[5]
    for i in (ASIDE, FOOT):
        P[i, ASIDE] += f[4]
        P[i, FOOT] += f[4]
        P[i, SLIDE] += f[6]
        P[SLIDE, i] += f[6]
    P[FOOT, FOOT] += place
    for j in range(n):  # the same columns of the others
        at = j * STATES
        p[at + ASIDE], p[at + SLIDE] = p[ASIDE * STATES + j], p[SLIDE * STATES + j]
        p[at + FOOT], p[at + FOOT_BEFORE] = p[FOOT * STATES + j], p[FOOT_BEFORE * STATES + j]
        p[at + FLICKER] = p[FLICKER * STATES + j]


@kernel(error_model="numpy")
def sight_of(p, h, variance, k):  # type: ignore[no-untyped-def]
    """As `gain` for the row of `seeing`."""
    n = len(k)
    for j in range(n):
        more = h[PATH] * p[PATH * STATES + j] + h[FOOT] * p[FOOT * STATES + j]
        more += h[FOOT_BEFORE] * p[FOOT_BEFORE * STATES + j] + h[DRIFT] * p[DRIFT * STATES + j]
        more += h[BIAS] * p[BIAS * STATES + j] + h[FLICKER] * p[FLICKER * STATES + j]
        more += h[WARM] * p[WARM * STATES + j]
        for d in range(DIRECTIONS):
            more += h[LOADED + d] * p[(LOADED + d) * STATES + j]
        k[j] = more
    s = variance
    for j in range(n):
        s += h[j] * k[j]
    return s


@kernel(error_model="numpy")
def move(x, P, mode, entry, habit, length, c, a, g):  # type: ignore[no-untyped-def]
    """What the path does over `length` (m) in a mode."""
    if mode != CURVE or entry != STAYS:
        empty(x, P, CURVATURE)
    if mode == TURN:
        for i in (ASIDE, SLIDE, FOOT, FOOT_BEFORE):  # of a new line
            empty(x, P, i)
        fresh(P, c.wander_m[habit], c.wander_s[habit], c.place_m)
        P[PATH, PATH] += c.turn * c.turn
        return
    P[PATH, PATH] += c.meander * c.meander * length
    if entry == ANEW:
        # Alike, the nearest to the old reference is taken.
        turns = nearest(x[PATH] - x[REFERENCE], c.directions)
        become(x, P, REFERENCE, PATH)
        x[REFERENCE] -= turns
        P[REFERENCE, REFERENCE] += c.beside * c.beside
    if mode == CURVE:
        if entry != STAYS:
            entered = c.gentle if entry == GENTLE else c.tight
            P[CURVATURE, CURVATURE] = entered * entered
        a[:] = 0.0
        a[CURVATURE] = length
        add_to(x, P, PATH, a, g)
        P[CURVATURE, CURVATURE] += c.bending * c.bending * length


@kernel(error_model="numpy")
def go_on(y, Q, x, P, k, s, left, mode, length, wavy, bent, g):  # type: ignore[no-untyped-def]
    """Fill y and Q with x and P after another stride of the same path: `move` and `update` at once.

    k, s, left : of the course, seen from x and P; wavy, bent : variances that path and curvature gain; g for
    work. CURVATURE is 0 unless the mode is CURVE.
    """
    n = len(x)
    for j in range(n):
        g[j] = k[j]
    if mode == CURVE:
        for j in range(n):
            g[j] += length * P[CURVATURE, j]
        g[PATH] += length * g[CURVATURE]
        s += length * (k[CURVATURE] + g[CURVATURE])
        left -= length * x[CURVATURE]
    g[PATH] += wavy
    s += wavy
    for i in range(n):
        share = g[i] / s
        y[i] = x[i] + share * left
        for j in range(n):
            Q[i, j] = P[i, j] - share * g[j]
    Q[PATH, PATH] += wavy
    if mode == CURVE:
        y[PATH] += length * x[CURVATURE]
        own = Q[PATH, PATH] + length * (2.0 * P[PATH, CURVATURE] + length * P[CURVATURE, CURVATURE])
        for j in range(n):
            Q[PATH, j] += length * P[CURVATURE, j]
            Q[j, PATH] = Q[PATH, j]
        Q[PATH, PATH] = own
        Q[CURVATURE, CURVATURE] += bent


@kernel(error_model="numpy")
def seeing(h, row):  # type: ignore[no-untyped-def]
    """Fill the row of the course: phi = theta + drift in the middle of the stride + lateral places."""
    h[:] = 0.0
    back = row[ACTIVE] - 0.5 * row[MOVING]
    h[PATH] = h[DRIFT] = 1.0
    h[FOOT] = 1.0 / row[DISTANCE]
    h[FOOT_BEFORE] = -1.0 / row[DISTANCE]
    h[BIAS] = h[FLICKER] = -back
    h[WARM] = -back * row[WARMTH]
    for k in range(DIRECTIONS):
        h[LOADED + k] = -back * row[LOAD + k]


@kernel(error_model="numpy")
def seen(row):  # type: ignore[no-untyped-def]
    """The course, as the heading is after the stride's rest."""
    return row[COURSE] + row[REST] * row[REST_RATE]


@kernel(error_model="numpy")
def aligning(h):  # type: ignore[no-untyped-def]
    """Fill the row of a straight along a dominant direction: theta - r."""
    h[:] = 0.0
    h[PATH], h[REFERENCE] = 1.0, -1.0


@kernel(error_model="numpy")
def nearest(angle, directions):  # type: ignore[no-untyped-def]
    """The multiple of the angle between dominant directions that is nearest."""
    sector = 2.0 * math.pi / directions
    return sector * math.floor(angle / sector + 0.5)


@kernel(error_model="numpy")
def resting(h, row):  # type: ignore[no-untyped-def]
    """Fill the row of a rest's rate: b + o + c dTemp."""
    h[:] = 0.0
    h[BIAS] = h[FLICKER] = 1.0
    h[WARM] = row[REST_WARMTH]


@kernel(error_model="numpy")
def gain(P, h, variance, k):  # type: ignore[no-untyped-def]
    """Fill k with P h; returns h P h + variance."""
    n = len(h)
    k[:] = 0.0
    for i in range(n):
        if h[i] != 0.0:
            for j in range(n):
                k[j] += h[i] * P[i, j]
    s = variance
    for i in range(n):
        s += h[i] * k[i]
    return s


@kernel(error_model="numpy")
def update(x, P, h, z, variance, k):  # type: ignore[no-untyped-def]
    """Take in z = h x + noise; k is left as the gain. Returns the innovation and its variance."""
    n = len(x)
    s = gain(P, h, variance, k)
    left = z
    for i in range(n):
        left -= h[i] * x[i]
    for i in range(n):
        g = k[i] / s
        x[i] += g * left
        for j in range(n):
            P[i, j] -= g * k[j]
    for i in range(n):
        k[i] /= s
    return left, s


@kernel(error_model="numpy")
def log_normal(left, s):  # type: ignore[no-untyped-def]
    """Logarithm of the normal density of an innovation of variance s."""
    return -0.5 * (math.log(2.0 * math.pi * s) + left * left / s)
