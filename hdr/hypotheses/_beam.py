"""Compiled: the hypotheses of a walk. Explained in docs/hypotheses.md; the plain twin is _plain.py.

A hypothesis is a mode, a habit of walking, a scale of the priors, a world with dominant directions or
without, and the state of `_linear`.
"""

from __future__ import annotations

import math

import numpy as np

from footfall.compiled import kernel
from footfall.hdr.hypotheses._linear import (
    ALIGNED,
    BIAS,
    CURVATURE,
    CURVE,
    DRIFT,
    FLICKER,
    FOOT,
    FOOT_BEFORE,
    GENTLE,
    LOADED,
    PATH,
    REFERENCE,
    STATES,
    STAYS,
    STRAIGHT,
    TIGHT,
    TURN,
    WARM,
    age,
    aligning,
    begin,
    drift,
    gain,
    log_normal,
    move,
    nearest,
    resting,
    seeing,
    seen,
    set_out,
    update,
)
from footfall.hdr.hypotheses._sight import (
    COURSE,
    DIRECTIONS,
    DISTANCE,
    LOAD,
    REST,
    REST_RATE,
    WARMTH,
)

MODE, HABIT, SCALE, WORLD, ENTRY, PARENT, CONTINUES = range(7)  # of a label
LABELS = 7
NOWHERE, ALONG = range(2)  # worlds without and with dominant directions
COUNT, BEGUN, LOST = range(3)  # of the counters: hypotheses, first stride seen, strides of no direction since
COUNTERS = 3
LAST = 0  # of the lengths: the stride before

# What is told of a footfall.
MEAN, SD, P_STRAIGHT, P_CURVE, P_TURN, RATE, SECOND, SECOND_WEIGHT, EVIDENCE = range(9)  # as `filter.Belief`
TOLD_ROW = 9
APART = 3.0  # standard deviations between modes
BRANCHES = 4  # of a hypothesis, beside straights: two for each habit


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
def step(x, P, weights, labels, counters, lengths, x2, P2, row, c, out):  # type: ignore[no-untyped-def]
    """Take in a footfall: hypotheses branch, are weighed, pruned and joined; x2, P2 for work.

    labels[:, PARENT] afterwards tells which each came from.
    """
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
    variance = c.course * c.course
    lost = 1 if counters[LOST] > 0 else 0
    habits = len(c.wander_m)
    change = c.habit_change if habits > 1 else 0.0
    stays, changes = math.log(1.0 - change), math.log(c.habit_change / max(habits - 1, 1))
    h, k, a, g = np.zeros(STATES), np.zeros(STATES), np.zeros(STATES), np.zeros(STATES)
    at_rest = np.zeros(STATES)
    resting(at_rest, row)
    if good:
        seeing(h, row)
    room = count * (BRANCHES + 2 * habits)
    chance = np.empty(room)
    branch = np.empty((room, LABELS), dtype=np.int64)
    n = 0
    lot_gentle, lot_tight = math.log(c.gentle_chance), math.log(1.0 - c.gentle_chance)
    log_bends, wavy = math.log(c.curve_curve), c.meander * c.meander * length
    bare = math.log(1.0 - c.along)
    for j in range(count):
        mode, habit, size = labels[j, MODE], labels[j, HABIT], c.scales[labels[j, SCALE]]
        drift(x[j], P[j], row, size, c, a, g)
        weight = weights[j]
        chances = c.log_transitions[habit, lost]
        if row[REST] > 0.0:
            noise = (size * c.random_walk) ** 2 / row[REST]
            left, s = update(x[j], P[j], at_rest, row[REST_RATE], noise, k)
            weight += log_normal(left, s)
        age(x[j], P[j], row, habit, size, c)
        if not good:
            n = put(branch, chance, n, labels[j], j, mode, habit, STAYS, weight)
            continue
        s = gain(P[j], h, variance, k)
        left = seen(row)
        for i in range(STATES):
            left -= h[i] * x[j, i]
        # straight
        to_straight = weight + chances[mode, STRAIGHT]
        to_straight += log_normal(left, s + wavy)
        tried = labels[j, WORLD] == ALONG and mode == TURN  # curves end anywhere
        along = along_one(x[j], P[j], k, left, s, wavy, c) if tried else 0.0
        for other in range(habits):
            if other != habit and mode != TURN:
                continue
            lot = 0.0 if mode != TURN else (stays if other == habit else changes)
            lone = lot + bare if tried else lot
            n = put(branch, chance, n, labels[j], j, STRAIGHT, other, STAYS, to_straight + lone)
            if tried:
                n = put(branch, chance, n, labels[j], j, STRAIGHT, other, ALIGNED, to_straight + lot + along)
        # turn: of wander beside the new line nothing is known
        wide = turning_spread(P[j], h, k, s, habit, c)
        off = left + h[FOOT] * x[j, FOOT] + h[FOOT_BEFORE] * x[j, FOOT_BEFORE]
        value = weight + chances[mode, TURN] + log_normal(off, wide)
        n = put(branch, chance, n, labels[j], j, TURN, habit, STAYS, value)
        # curve
        to_curve = weight + chances[mode, CURVE]
        if mode == CURVE:
            wider = s + wavy + 2.0 * length * k[CURVATURE] + length * length * P[j, CURVATURE, CURVATURE]
            goes_on = math.log(math.exp(chances[CURVE, CURVE]) - c.curve_curve)
            value = weight + goes_on + log_normal(left - length * x[j, CURVATURE], wider)
            n = put(branch, chance, n, labels[j], j, CURVE, habit, STAYS, value)
            to_curve = weight + log_bends
        value = to_curve + lot_gentle + log_normal(left, s + wavy + (length * c.gentle) ** 2)
        n = put(branch, chance, n, labels[j], j, CURVE, habit, GENTLE, value)
        value = to_curve + lot_tight + log_normal(left, s + wavy + (length * c.tight) ** 2)
        n = put(branch, chance, n, labels[j], j, CURVE, habit, TIGHT, value)
    if good:
        lengths[LAST] = row[DISTANCE]
    counters[LOST] = 0 if good else counters[LOST] + 1
    select(x, P, weights, labels, counters, x2, P2, row, c, out, chance[:n], branch[:n], good, length, h)


@kernel(error_model="numpy")
def turning_spread(P, h, k, s, habit, c):  # type: ignore[no-untyped-def]
    """Variance of the course in a turn, whose line is a new one; s and k = P h are those of the old one."""
    old = h[FOOT] * h[FOOT] * P[FOOT, FOOT] + h[FOOT_BEFORE] * h[FOOT_BEFORE] * P[FOOT_BEFORE, FOOT_BEFORE]
    old += 2.0 * h[FOOT] * h[FOOT_BEFORE] * P[FOOT, FOOT_BEFORE]
    old -= 2.0 * (h[FOOT] * k[FOOT] + h[FOOT_BEFORE] * k[FOOT_BEFORE])
    new = c.wander_m[habit] ** 2 + c.place_m * c.place_m
    return s + old + h[FOOT] * h[FOOT] * new + c.turn * c.turn


@kernel(error_model="numpy")
def along_one(x, P, k, left, s, wavy, c):  # type: ignore[no-untyped-def]
    """Logarithm of how much likelier a new straight lies along a dominant direction than anyhow.

    Of the angle between path and reference once the course is taken in; against evenly spread angles.
    """
    spread = s + wavy
    pull = (k[PATH] + wavy - k[REFERENCE]) / spread
    angle = x[PATH] - x[REFERENCE] + pull * left
    loose = P[PATH, PATH] + wavy + P[REFERENCE, REFERENCE] - 2.0 * P[PATH, REFERENCE] - pull * pull * spread
    off = angle - nearest(angle, c)
    return math.log(c.along * 2.0 * math.pi / c.directions) + log_normal(off, loose + c.beside * c.beside)


@kernel(error_model="numpy")
def put(branch, chance, n, label, parent, mode, habit, entry, value):  # type: ignore[no-untyped-def]
    """Note a branch and its weight; returns how many there are."""
    branch[n, MODE], branch[n, HABIT], branch[n, ENTRY], branch[n, PARENT] = mode, habit, entry, parent
    branch[n, SCALE], branch[n, WORLD] = label[SCALE], label[WORLD]
    branch[n, CONTINUES] = 1 if mode == label[MODE] and entry == STAYS else 0
    chance[n] = value
    return n + 1


@kernel(error_model="numpy")
def select(  # type: ignore[no-untyped-def]
    x, P, weights, labels, counters, x2, P2, row, c, out, chance, branch, good, length, h
):
    """Make the best branches, join those that are alike, and tell what they say."""
    k, a, g, abreast = np.zeros(STATES), np.zeros(STATES), np.zeros(STATES), np.zeros(STATES)
    aligning(abreast)
    best = chance.max()
    goes_on = branch[:, CONTINUES] == 1
    able = np.flatnonzero((chance >= best - c.sprout) | (goes_on & (chance >= best - c.prune)))
    order = able[np.argsort(-chance[able], kind="mergesort")]
    kept = 0
    made = np.empty(c.hypotheses)
    variance = c.course * c.course
    for at in order:
        if kept == c.hypotheses:
            break
        parent = branch[at, PARENT]
        y, Q = x2[kept], P2[kept]
        y[:] = x[parent]
        Q[:] = P[parent]
        if good:
            move(y, Q, branch[at, MODE], branch[at, ENTRY], branch[at, HABIT], length, c, a, g)
            update(y, Q, h, seen(row), variance, k)
            if branch[at, ENTRY] == ALIGNED:
                along = nearest(y[PATH] - y[REFERENCE], c)
                update(y, Q, abreast, along, c.beside * c.beside, k)
        twin = alike(x2, P2, labels, kept, branch[at], row, c)
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
        x[j] = x2[j]
        P[j] = P2[j]
    counters[COUNT] = kept
    tell(x, P, weights, labels, kept, row, out)
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
def alike(x2, P2, labels, kept, label, row, c):  # type: ignore[no-untyped-def]
    """Which of those made is the same as the one made last; -1 for none."""
    y = x2[kept]
    for j in range(kept):
        if (
            labels[j, MODE] != label[MODE]
            or labels[j, HABIT] != label[HABIT]
            or labels[j, SCALE] != label[SCALE]
            or labels[j, WORLD] != label[WORLD]
        ):
            continue
        z, Q = x2[j], P2[j]
        if not near(y, z, Q, DRIFT, c.merge) or not near(y, z, Q, PATH, c.merge):
            continue
        if label[MODE] == CURVE and not near(y, z, Q, CURVATURE, c.merge):
            continue
        if not near(y, z, Q, WARM, c.merge):
            continue
        apart, spread = y[BIAS] - z[BIAS], Q[BIAS, BIAS]
        for d in range(DIRECTIONS):
            apart += (y[LOADED + d] - z[LOADED + d]) * row[LOAD + d]
            spread += Q[LOADED + d, LOADED + d] * row[LOAD + d] ** 2
        if abs(apart) <= c.merge * math.sqrt(spread):
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
    """Room for m hypotheses: means, covariances, weights, labels, counters, lengths; and room for work."""
    return (
        np.zeros((m, STATES)),
        np.zeros((m, STATES, STATES)),
        np.zeros(m),
        np.zeros((m, LABELS), dtype=np.int64),
        np.zeros(COUNTERS, dtype=np.int64),
        np.zeros(1),
        np.zeros((m, STATES)),
        np.zeros((m, STATES, STATES)),
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
    x, P, weights, labels, counters, lengths, x2, P2 = nothing_yet(m)
    told = np.zeros((n, TOLD_ROW))
    at_start(told[0], c)
    history = np.zeros((n if keep else 0, m, LABELS), dtype=np.int16)
    for i in range(1, n):
        step(x, P, weights, labels, counters, lengths, x2, P2, rows[i], c, told[i])
        if keep:
            for j in range(counters[COUNT]):
                for q in range(LABELS):
                    history[i, j, q] = labels[j, q]
    last = np.empty((counters[COUNT], 3))
    for j in range(counters[COUNT]):
        last[j, 0], last[j, 1], last[j, 2] = weights[j], x[j, DRIFT], P[j, DRIFT, DRIFT]
    return told, history, last
