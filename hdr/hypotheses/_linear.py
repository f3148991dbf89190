"""Compiled: one hypothesis's state, how it moves and what a footfall says of it (docs/hypotheses.md).

Every step is a few row and column operations on a symmetric covariance, which is cheaper than its matrix.
"""

from __future__ import annotations

import math

from footfall.compiled import kernel
from footfall.hdr.hypotheses._sight import (
    ACTIVE,
    COURSE,
    DIRECTIONS,
    DISTANCE,
    INTERVAL,
    JUMP,
    LOAD,
    MOVING,
    REST,
    REST_RATE,
    REST_WARMTH,
    TOLD,
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
STATES = LOADED + DIRECTIONS

STRAIGHT, CURVE, TURN = range(3)
STAYS, GENTLE, TIGHT, ALIGNED = range(4)  # how a mode is entered: two kinds of curves, a dominant direction


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
    for k in range(LOADED, STATES):
        P[k, k] = scale * scale


@kernel(error_model="numpy")
def set_out(x, course, told, c):  # type: ignore[no-untyped-def]
    """The direction in which the walk begins, and the dominant one: known, or the same."""
    x[PATH] = x[REFERENCE] = course - x[DRIFT]
    if told:
        x[REFERENCE] = c.reference
        x[PATH] = c.reference + nearest(x[PATH] - c.reference, c)


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
def decay(x, P, i, share):  # type: ignore[no-untyped-def]
    """x_i *= share."""
    x[i] *= share
    for k in range(len(x)):
        P[i, k] *= share
        P[k, i] = P[i, k]
    P[i, i] *= share


@kernel(error_model="numpy")
def swaying(time, interval):  # type: ignore[no-untyped-def]
    """Transition of wander and its rate over an interval: critically damped, of time constant `time`."""
    r = 1.0 / time
    e = math.exp(-interval * r)
    return e * (1.0 + interval * r), e * interval, -e * r * r * interval, e * (1.0 - interval * r)


@kernel(error_model="numpy")
def drifting(a, row):  # type: ignore[no-untyped-def]
    """Fill the coefficients with which the drift grows by the states."""
    a[:] = 0.0
    a[BIAS] = a[FLICKER] = row[ACTIVE]
    a[WARM] = row[ACTIVE] * row[WARMTH]
    for k in range(DIRECTIONS):
        a[LOADED + k] = row[ACTIVE] * row[LOAD + k] + row[JUMP + k]


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


@kernel(error_model="numpy")
def drift(x, P, row, scale, c, a, g):  # type: ignore[no-untyped-def]
    """What an interval adds to the heading's drift, a rest in it what it told; a, g for work."""
    drifting(a, row)
    add_to(x, P, DRIFT, a, g)
    x[DRIFT] += row[REST] * row[REST_RATE]
    P[DRIFT, DRIFT] += scale * scale * c.random_walk * c.random_walk * row[ACTIVE]
    if turning_back(a, row):
        add_to(x, P, PATH, a, g)


@kernel(error_model="numpy")
def age(x, P, row, habit, scale, c):  # type: ignore[no-untyped-def]
    """What an interval does to the gyro's errors and to the wander, whatever the path is."""
    interval = row[INTERVAL]
    kept = math.exp(-interval / c.flicker_s)
    decay(x, P, FLICKER, kept)
    P[FLICKER, FLICKER] += (scale * c.flicker) ** 2 * (1.0 - kept * kept)
    walk = c.bias_walk if row[TOLD] > 0.0 else c.bias_walk_blind
    P[BIAS, BIAS] += scale * scale * walk * walk * interval
    become(x, P, FOOT_BEFORE, FOOT)
    sway(x, P, c.wander_m[habit], c.wander_s[habit], interval)
    become(x, P, FOOT, ASIDE)
    P[FOOT, FOOT] += c.place_m * c.place_m


@kernel(error_model="numpy")
def sway(x, P, aside, time, interval):  # type: ignore[no-untyped-def]
    """Wander over an interval, of stationary variance aside^2 and (aside/time)^2."""
    n = len(x)
    f00, f01, f10, f11 = swaying(time, interval)
    x[ASIDE], x[SLIDE] = f00 * x[ASIDE] + f01 * x[SLIDE], f10 * x[ASIDE] + f11 * x[SLIDE]
    for k in range(n):
        p, q = P[ASIDE, k], P[SLIDE, k]
        P[ASIDE, k], P[SLIDE, k] = f00 * p + f01 * q, f10 * p + f11 * q
    for k in range(n):
        p, q = P[k, ASIDE], P[k, SLIDE]
        P[k, ASIDE], P[k, SLIDE] = f00 * p + f01 * q, f10 * p + f11 * q
    s, v = aside * aside, (aside / time) ** 2
    P[ASIDE, ASIDE] += s - f00 * f00 * s - f01 * f01 * v
    P[SLIDE, SLIDE] += v - f10 * f10 * s - f11 * f11 * v
    cross = -f00 * f10 * s - f01 * f11 * v
    P[ASIDE, SLIDE] += cross
    P[SLIDE, ASIDE] += cross


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
    if mode == CURVE:
        if entry != STAYS:
            entered = c.gentle if entry == GENTLE else c.tight
            P[CURVATURE, CURVATURE] = entered * entered
        a[:] = 0.0
        a[CURVATURE] = length
        add_to(x, P, PATH, a, g)
        P[CURVATURE, CURVATURE] += c.bending * c.bending * length


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
def nearest(angle, c):  # type: ignore[no-untyped-def]
    """The multiple of the angle between dominant directions that is nearest."""
    sector = 2.0 * math.pi / c.directions
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
