"""Compiled: how hypotheses branch at a footfall, and what each branch weighs (docs/hypotheses.md)."""

from __future__ import annotations

import math

from footfall.compiled import kernel
from footfall.hdr.hypotheses._linear import (
    ALIGNED,
    ANEW,
    CURVATURE,
    CURVE,
    FOOT,
    FOOT_BEFORE,
    GENTLE,
    PATH,
    REFERENCE,
    STAYS,
    STRAIGHT,
    TIGHT,
    TURN,
    log_normal,
    nearest,
)

MODE, HABIT, SCALE, WORLD, ENTRY, PARENT, CONTINUES = range(7)  # of a label
LABELS = 7
NOWHERE, ALONG = range(2)  # worlds without and with dominant directions
BRANCHES = 4  # of a hypothesis, beside straights: two for each habit
LEFT, SPREAD = range(2)  # of a view of the course: innovation, its variance


@kernel(error_model="numpy")
def fork(  # type: ignore[no-untyped-def]
    branch, chance, x, P, weights, labels, count, lost, length, h, gains, views, c
):
    """Note the branches of all hypotheses and their weights; returns how many there are.

    Of those that are too far below the best known so far to be kept, some are left out unseen.
    """
    n, best = 0, -math.inf
    wavy = c.meander * c.meander * length
    wavy_gentle, wavy_tight = wavy + (length * c.gentle) ** 2, wavy + (length * c.tight) ** 2
    sharpest_turn = math.log(math.sqrt(2.0 * math.pi) * c.turn)
    beside = c.beside * c.beside
    for j in range(count):
        first, label, weight = n, labels[j], weights[j]
        mode, habit = label[MODE], label[HABIT]
        k, left, s = gains[j], views[j, LEFT], views[j, SPREAD]
        chances = c.log_transitions[habit, lost]
        floor = best - c.sprout
        roof = weight - 0.5 * math.log(2.0 * math.pi * s)  # of a course as sure as a straight's
        # straight
        if mode != CURVE or roof + chances[mode, STRAIGHT] >= floor:
            to_straight = weight + chances[mode, STRAIGHT] + log_normal(left, s + wavy)
            if mode != TURN:
                n = put(branch, chance, n, label, j, STRAIGHT, habit, STAYS, to_straight)
            else:
                tried = label[WORLD] == ALONG  # curves end anywhere
                along = 0.0
                if tried:
                    along = c.log_along + along_one(x[j], P[j], k, left, s, wavy, c.directions, beside)
                for other in range(len(c.wander_m)):
                    lot = to_straight + (c.log_same_habit if other == habit else c.log_other_habit)
                    if tried:
                        n = put(branch, chance, n, label, j, STRAIGHT, other, STAYS, lot + c.log_anyhow)
                        n = put(branch, chance, n, label, j, STRAIGHT, other, ALIGNED, lot + along)
                        n = put(branch, chance, n, label, j, STRAIGHT, other, ANEW, lot + c.log_anew)
                    else:
                        n = put(branch, chance, n, label, j, STRAIGHT, other, STAYS, lot)
        # turn: of wander beside the new line nothing is known
        to_turn = weight + chances[mode, TURN]
        if mode == TURN or to_turn - sharpest_turn >= floor:
            fresh = c.wander_m[habit] ** 2 + c.place_m * c.place_m
            wide = turning_spread(P[j], h, k, s, fresh) + c.turn * c.turn
            off = left + h[FOOT] * x[j, FOOT] + h[FOOT_BEFORE] * x[j, FOOT_BEFORE]
            n = put(branch, chance, n, label, j, TURN, habit, STAYS, to_turn + log_normal(off, wide))
        # curve
        to_curve = chances[mode, CURVE]
        if mode == CURVE:
            wider = s + wavy + length * (2.0 * k[CURVATURE] + length * P[j, CURVATURE, CURVATURE])
            value = weight + c.log_goes_on[habit, lost] + log_normal(left - length * x[j, CURVATURE], wider)
            n = put(branch, chance, n, label, j, CURVE, habit, STAYS, value)
            to_curve = c.log_bends
        if roof + to_curve >= floor:
            value = weight + to_curve + c.log_gentle + log_normal(left, s + wavy_gentle)
            n = put(branch, chance, n, label, j, CURVE, habit, GENTLE, value)
            value = weight + to_curve + c.log_tight + log_normal(left, s + wavy_tight)
            n = put(branch, chance, n, label, j, CURVE, habit, TIGHT, value)
        for i in range(first, n):
            best = max(best, chance[i])
    return n


@kernel(error_model="numpy")
def turning_spread(P, h, k, s, fresh):  # type: ignore[no-untyped-def]
    """Variance of the course beside a new line, whose lateral places have the variance `fresh`.

    s and k = P h are those of the old one.
    """
    old = h[FOOT] * h[FOOT] * P[FOOT, FOOT] + h[FOOT_BEFORE] * h[FOOT_BEFORE] * P[FOOT_BEFORE, FOOT_BEFORE]
    old += 2.0 * h[FOOT] * h[FOOT_BEFORE] * P[FOOT, FOOT_BEFORE]
    old -= 2.0 * (h[FOOT] * k[FOOT] + h[FOOT_BEFORE] * k[FOOT_BEFORE])
    return s + old + h[FOOT] * h[FOOT] * fresh


@kernel(error_model="numpy")
def along_one(x, P, k, left, s, wavy, directions, beside):  # type: ignore[no-untyped-def]
    """Logarithm of the density of a new straight's angle beside the nearest dominant direction.

    Of the angle between path and reference once the course is taken in; beside : variance
    """
    spread = s + wavy
    pull = (k[PATH] + wavy - k[REFERENCE]) / spread
    angle = x[PATH] - x[REFERENCE] + pull * left
    loose = P[PATH, PATH] + wavy + P[REFERENCE, REFERENCE] - 2.0 * P[PATH, REFERENCE] - pull * pull * spread
    return log_normal(angle - nearest(angle, directions), loose + beside)


@kernel(error_model="numpy")
def put(branch, chance, n, label, parent, mode, habit, entry, value):  # type: ignore[no-untyped-def]
    """Note a branch and its weight; returns how many there are."""
    branch[n, MODE], branch[n, HABIT], branch[n, ENTRY], branch[n, PARENT] = mode, habit, entry, parent
    branch[n, SCALE], branch[n, WORLD] = label[SCALE], label[WORLD]
    branch[n, CONTINUES] = 1 if mode == label[MODE] and entry == STAYS else 0
    chance[n] = value
    return n + 1
