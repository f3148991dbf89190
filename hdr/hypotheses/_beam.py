"""Compiled: the hypotheses of a walk. Explained in docs/hypotheses.md; the plain twin is _plain.py.

A hypothesis is a mode, a habit of walking, a scale of the priors, a world with dominant directions or
without, and the state of `_linear`.
"""

from __future__ import annotations

import math

import numpy as np

from footfall.compiled import kernel
from footfall.hdr.hypotheses._branches import (
    ALONG,
    BRANCHES,
    CONTINUES,
    ENTRY,
    HABIT,
    LABELS,
    LEFT,
    MODE,
    NOWHERE,
    PARENT,
    SCALE,
    SPREAD,
    WORLD,
    fork,
    put,
)
from footfall.hdr.hypotheses._interval import SWAYING, drifting, fading, noises, swaying, turning_back
from footfall.hdr.hypotheses._linear import (
    ALIGNED,
    ANEW,
    BIAS,
    CELLS,
    CURVATURE,
    CURVE,
    DRIFT,
    FLICKER,
    LOADED,
    PATH,
    REFERENCE,
    STATES,
    STAYS,
    STRAIGHT,
    WARM,
    age,
    aligning,
    begin,
    drift,
    go_on,
    log_normal,
    move,
    nearest,
    resting,
    seeing,
    seen,
    set_out,
    sight_of,
    update,
)
from footfall.hdr.hypotheses._sight import (
    COURSE,
    DIRECTIONS,
    DISTANCE,
    INTERVAL,
    LOAD,
    REST,
    REST_RATE,
    WARMTH,
)

# Of the counters: hypotheses, first stride seen, strides of no direction since, side of what is.
COUNT, BEGUN, LOST, SIDE = range(4)
COUNTERS = 4
LAST = 0  # of the lengths: the stride before

# What is told of a footfall.
MEAN, SD, P_STRAIGHT, P_CURVE, P_TURN, RATE, SECOND, SECOND_WEIGHT, EVIDENCE = range(9)  # as `filter.Belief`
TOLD_ROW = 9
APART = 3.0  # standard deviations between modes


@kernel(error_model="numpy")
def tells(world, mode, c):  # type: ignore[no-untyped-def]
    """Whether a known dominant direction tells that in which a hypothesis sets out."""
    return world == ALONG and mode == STRAIGHT and not math.isnan(c.reference)


@kernel(error_model="numpy")
def begin_all(x, P, weights, labels, counters, course, c):  # type: ignore[no-untyped-def]
    """Hypotheses before the first stride: each mode, habit and scale."""
    n = 0
    ways = len(c.wander_m) * len(c.scales)
    for world in (NOWHERE, ALONG):
        exists = c.along_first if world == ALONG else 1.0 - c.along_first
        if exists == 0.0:
            continue
        for mode in (STRAIGHT, CURVE):
            chance = exists * (c.straight_first if mode == STRAIGHT else 1.0 - c.straight_first)
            for habit in range(len(c.wander_m)):
                for scale in range(len(c.scales)):
                    told = tells(world, mode, c)
                    begin(x[n], P[n], course, mode, habit, c.scales[scale], told, c)
                    weights[n] = math.log(chance / ways)
                    labels[n, MODE], labels[n, HABIT], labels[n, SCALE] = mode, habit, scale
                    labels[n, WORLD] = world
                    n += 1
    counters[COUNT], counters[BEGUN] = n, 1


@kernel(error_model="numpy")
def step(xs, Ps, weights, labels, counters, lengths, row, c, out):  # type: ignore[no-untyped-def]
    """Take in a footfall: hypotheses branch, are weighed, pruned and joined.

    xs, Ps : two sides each, of which counters[SIDE] holds the hypotheses and the other takes the next ones
    labels[:, PARENT] afterwards tells which each came from.
    """
    x, P = xs[counters[SIDE]], Ps[counters[SIDE]]
    good = row[DISTANCE] >= c.shortest_m
    if counters[BEGUN] == 0:
        begin_all(x, P, weights, labels, counters, row[COURSE] if good else 0.0, c)
        if not good:
            counters[BEGUN] = 2  # begun before any direction
    if good and counters[BEGUN] == 2:
        for j in range(counters[COUNT]):
            set_out(x[j], row[COURSE], tells(labels[j, WORLD], labels[j, MODE], c), c)
        counters[BEGUN] = 1
    count = counters[COUNT]
    length = 0.5 * (row[DISTANCE] + lengths[LAST]) if lengths[LAST] > 0.0 else row[DISTANCE]
    lost = 1 if counters[LOST] > 0 else 0
    h, gains, views = np.zeros(STATES), np.empty((count, STATES)), np.empty((count, 2))
    if good:
        seeing(h, row)
    pass_time(x, P, weights, labels, count, row, good, h, gains, views, c)
    room = count * (BRANCHES + 3 * len(c.wander_m))
    chance = np.empty(room)
    branch = np.empty((room, LABELS), dtype=np.int64)
    n = 0
    if good:
        n = fork(branch, chance, x, P, weights, labels, count, lost, length, h, gains, views, c)
        lengths[LAST] = row[DISTANCE]
    else:
        for j in range(count):
            n = put(branch, chance, n, labels[j], j, labels[j, MODE], labels[j, HABIT], STAYS, weights[j])
    counters[LOST] = 0 if good else counters[LOST] + 1
    made = chance[:n], branch[:n]
    select(xs, Ps, weights, labels, counters, row, c, out, made, good, length, h, gains, views)


@kernel(error_model="numpy")
def pass_time(x, P, weights, labels, count, row, good, h, gains, views, c):  # type: ignore[no-untyped-def]
    """Drift, rest and age of every hypothesis; where there is a course (row h), how each sees it.

    gains, views : filled with P h, the innovation and its variance
    """
    a, back, g = np.zeros(STATES), np.zeros(STATES), np.zeros(STATES)
    k, at_rest = np.zeros(STATES), np.zeros(STATES)
    sways = np.zeros((len(c.wander_m), SWAYING))
    drifting(a, row)
    new = turning_back(back, row)
    resting(at_rest, row)
    told, course = row[REST] * row[REST_RATE], seen(row)
    drifted, biased, flickered = noises(row, c)
    kept, flat = fading(row[INTERVAL], c), P.reshape((len(P), CELLS))
    variance, place = c.course * c.course, c.place_m * c.place_m
    for habit in range(len(c.wander_m)):
        swaying(sways[habit], habit, row[INTERVAL], c)
    for j in range(count):
        y, Q, q = x[j], P[j], flat[j]
        size = c.scales[labels[j, SCALE]] ** 2
        drift(y, Q, q, told, size * drifted, a, back, new, g)
        if row[REST] > 0.0:
            noise = size * c.random_walk * c.random_walk / row[REST]
            left, s = update(y, Q, at_rest, row[REST_RATE], noise, k)
            weights[j] += log_normal(left, s)
        age(y, Q, q, kept, sways[labels[j, HABIT]], size * biased, size * flickered, place)
        if good:
            views[j, SPREAD] = sight_of(q, h, variance, gains[j])
            left = course
            for i in range(STATES):
                left -= h[i] * y[i]
            views[j, LEFT] = left


@kernel(error_model="numpy")
def select(  # type: ignore[no-untyped-def]
    xs, Ps, weights, labels, counters, row, c, out, branches, good, length, h, gains, views
):
    """Make the best branches on the other side, join those that are alike, and tell what they say."""
    chance, branch = branches
    side, best = counters[SIDE], chance.max()
    x, P, x2, P2 = xs[side], Ps[side], xs[1 - side], Ps[1 - side]
    goes_on = branch[:, CONTINUES] == 1
    able = np.flatnonzero((chance >= best - c.sprout) | (goes_on & (chance >= best - c.prune)))
    order = able[np.argsort(-chance[able], kind="mergesort")]
    kept = 0
    made, kinds = np.empty(c.hypotheses), np.empty(c.hypotheses, dtype=np.int64)
    k, a, g, abreast = np.zeros(STATES), np.zeros(STATES), np.zeros(STATES), np.zeros(STATES)
    aligning(abreast)
    wavy, bent = c.meander * c.meander * length, c.bending * c.bending * length
    for at in order:
        if kept == c.hypotheses:
            break
        parent, mode, entry = branch[at, PARENT], branch[at, MODE], branch[at, ENTRY]
        y, Q = x2[kept], P2[kept]
        straight_on = mode == STRAIGHT and entry != ANEW and P[parent, CURVATURE, CURVATURE] == 0.0
        if good and (straight_on or (mode == CURVE and entry == STAYS)):
            left, s = views[parent, LEFT], views[parent, SPREAD]
            go_on(y, Q, x[parent], P[parent], gains[parent], s, left, mode, length, wavy, bent, g)
        else:
            y[:] = x[parent]
            Q[:] = P[parent]
            if good:
                move(y, Q, mode, entry, branch[at, HABIT], length, c, a, g)
                update(y, Q, h, seen(row), c.course * c.course, k)
        if entry == ALIGNED:
            update(y, Q, abreast, nearest(y[PATH] - y[REFERENCE], c.directions), c.beside * c.beside, k)
        kinds[kept] = kind(branch[at], len(c.wander_m), len(c.scales))
        beside = c.beside if branch[at, WORLD] == ALONG else math.inf
        twin = alike(x2, P2, kinds, kept, mode == CURVE, beside, row, c.merge)
        if twin >= 0:
            joined = made[twin] + math.log1p(math.exp(chance[at] - made[twin]))
            join(x2[twin], P2[twin], y, Q, math.exp(chance[at] - joined))
            made[twin] = joined
        else:
            made[kept] = chance[at]
            labels[kept] = branch[at]
            kept += 1
    total = 0.0
    for j in range(kept):
        total += math.exp(made[j] - best)
    total = best + math.log(total)
    for j in range(kept):
        weights[j] = made[j] - total
    counters[COUNT], counters[SIDE] = kept, 1 - side
    tell(x2, P2, weights, labels, kept, row, out)
    out[EVIDENCE] = total


@kernel(error_model="numpy")
def join(x, P, y, Q, share):  # type: ignore[no-untyped-def]
    """Two hypotheses as one of the same mean and covariance; `share` is the second's."""
    n = len(x)
    for i in range(n):
        y[i] -= x[i]
    for i in range(n):
        for j in range(n):
            P[i, j] += share * (Q[i, j] - P[i, j] + (1.0 - share) * y[i] * y[j])
    for i in range(n):
        x[i] += share * y[i]


@kernel(error_model="numpy")
def kind(label, habits, scales):  # type: ignore[no-untyped-def]
    """One number for mode, habit, scale and world."""
    return ((label[MODE] * habits + label[HABIT]) * scales + label[SCALE]) * 2 + label[WORLD]


@kernel(error_model="numpy")
def alike(x2, P2, kinds, kept, curve, beside, row, merge):  # type: ignore[no-untyped-def]
    """Which of those made is the same as the one made last; -1 for none.

    beside : rad, most between their references
    """
    y = x2[kept]
    for j in range(kept):
        if kinds[j] != kinds[kept]:
            continue
        z, Q = x2[j], P2[j]
        if not near(y, z, Q, DRIFT, merge) or not near(y, z, Q, PATH, merge):
            continue
        if curve and not near(y, z, Q, CURVATURE, merge):
            continue
        if not near(y, z, Q, WARM, merge):
            continue
        if abs(y[REFERENCE] - z[REFERENCE]) > beside:
            continue
        apart, spread = y[BIAS] - z[BIAS], Q[BIAS, BIAS]
        for d in range(DIRECTIONS):
            apart += (y[LOADED + d] - z[LOADED + d]) * row[LOAD + d]
            spread += Q[LOADED + d, LOADED + d] * row[LOAD + d] ** 2
        if abs(apart) <= merge * math.sqrt(spread):
            return j
    return -1


@kernel(error_model="numpy")
def near(y, z, Q, i, merge):  # type: ignore[no-untyped-def]
    """Whether two states agree in one of their numbers."""
    return abs(y[i] - z[i]) <= merge * math.sqrt(max(Q[i, i], 0.0))


@kernel(error_model="numpy")
def tell(x, P, weights, labels, count, row, out):  # type: ignore[no-untyped-def]
    """Mean and standard deviation of the drift, chances of the modes, rate, and the second opinion."""
    out[:] = 0.0
    square = 0.0
    for j in range(count):
        share = math.exp(weights[j])
        out[MEAN] += share * x[j, DRIFT]
        out[P_STRAIGHT + labels[j, MODE]] += share
        rate = x[j, BIAS] + x[j, FLICKER] + x[j, WARM] * row[WARMTH]
        for d in range(DIRECTIONS):
            rate += x[j, LOADED + d] * row[LOAD + d]
        out[RATE] += share * rate
    for j in range(count):
        square += math.exp(weights[j]) * (P[j, DRIFT, DRIFT] + (x[j, DRIFT] - out[MEAN]) ** 2)
    out[SD] = math.sqrt(max(square, 0.0))
    first = x[0, DRIFT]
    far = APART * math.sqrt(max(P[0, DRIFT, DRIFT], 0.0))
    out[SECOND] = first
    second = -1
    for j in range(count):
        if abs(x[j, DRIFT] - first) > far and (second < 0 or weights[j] > weights[second]):
            second = j
    if second >= 0:
        out[SECOND] = x[second, DRIFT]
        for j in range(count):
            if abs(x[j, DRIFT] - first) > far and abs(x[j, DRIFT] - out[SECOND]) <= far:
                out[SECOND_WEIGHT] += math.exp(weights[j])


@kernel(error_model="numpy")
def nothing_yet(m):  # type: ignore[no-untyped-def]
    """Room for m hypotheses: means and covariances on two sides, weights, labels, counters, lengths."""
    return (
        np.zeros((2, m, STATES)),
        np.zeros((2, m, STATES, STATES)),
        np.zeros(m),
        np.zeros((m, LABELS), dtype=np.int64),
        np.zeros(COUNTERS, dtype=np.int64),
        np.zeros(1),
    )


@kernel(error_model="numpy")
def at_start(told, c):  # type: ignore[no-untyped-def]
    """What is told before the first stride."""
    told[:] = 0.0
    told[P_STRAIGHT], told[P_CURVE] = c.straight_first, 1.0 - c.straight_first


@kernel(error_model="numpy")
def beam(rows, c, keep):  # type: ignore[no-untyped-def]
    """A whole walk from rows (n, SIGHT) of sight; row 0, the start, tells nothing.

    Returns
    -------
    told (n, TOLD_ROW); history (n, hypotheses, LABELS) of labels, empty unless `keep`; of the last hypotheses
    (m, 3) weight, drift and its variance
    """
    m, n = c.hypotheses, len(rows)
    xs, Ps, weights, labels, counters, lengths = nothing_yet(m)
    told = np.zeros((n, TOLD_ROW))
    at_start(told[0], c)
    history = np.zeros((n if keep else 0, m, LABELS), dtype=np.int16)
    for i in range(1, n):
        step(xs, Ps, weights, labels, counters, lengths, rows[i], c, told[i])
        if keep:
            for j in range(counters[COUNT]):
                for q in range(LABELS):
                    history[i, j, q] = labels[j, q]
    x, P = xs[counters[SIDE]], Ps[counters[SIDE]]
    last = np.empty((counters[COUNT], 3))
    for j in range(counters[COUNT]):
        last[j, 0], last[j, 1], last[j, 2] = weights[j], x[j, DRIFT], P[j, DRIFT, DRIFT]
    return told, history, last
