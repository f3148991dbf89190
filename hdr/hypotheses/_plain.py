"""What the compiled beam and smoother compute, in matrices: for tests and benchmarks."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from footfall.hdr.hypotheses import _beam, _branches, _linear, _sight
from footfall.hdr.hypotheses._linear import (
    ALIGNED,
    ANEW,
    ASIDE,
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
    SLIDE,
    STATES,
    STAYS,
    STRAIGHT,
    TIGHT,
    TURN,
    WARM,
)
from footfall.hdr.hypotheses.params import Constants

LOADS = slice(LOADED, LOADED + _sight.DIRECTIONS)


@dataclass(frozen=True)
class Hypothesis:
    """Labels as of `_beam`, logarithm of the weight, and the state."""

    mode: int
    habit: int
    scale: int
    world: int
    entry: int
    parent: int
    goes_on: bool
    weight: float
    mean: np.ndarray
    cov: np.ndarray


def first(c: Constants, course: float) -> list[Hypothesis]:
    """Hypotheses before the first stride."""
    found = []
    ways = len(c.wander_m) * len(c.scales)
    for world, mode in product((_branches.NOWHERE, _branches.ALONG), (STRAIGHT, CURVE)):
        chance = c.along_first if world == _branches.ALONG else 1 - c.along_first
        chance *= c.straight_first if mode == STRAIGHT else 1 - c.straight_first
        for habit, (scale, size) in product(range(len(c.wander_m)), enumerate(c.scales)):
            mean = np.zeros(STATES)
            mean[[PATH, REFERENCE]] = course
            sd = np.zeros(STATES)
            sd[PATH], sd[CURVATURE] = 0.5, c.gentle if mode == CURVE else 0.0
            sd[[BIAS, FLICKER, WARM]] = size * np.array([c.bias, c.flicker, c.warmth])
            sd[LOADS] = size
            sd[FOOT_BEFORE] = math.hypot(c.wander_m[habit], c.place_m)
            cov = np.diag(sd**2) + new_line(c, habit)
            cov[REFERENCE, PATH] = cov[PATH, REFERENCE] = cov[PATH, PATH]
            cov[REFERENCE, REFERENCE] = cov[PATH, PATH] + c.beside**2
            if world == _branches.ALONG and mode == STRAIGHT and not math.isnan(c.reference):
                mean[REFERENCE] = c.reference
                sector = 2 * math.pi / c.directions
                mean[PATH] = c.reference + sector * math.floor((course - c.reference) / sector + 0.5)
                lines = c.beside**2 * np.array([[2, 1], [1, 1]])
                cov[np.ix_([PATH, REFERENCE], [PATH, REFERENCE])] = lines
            weight = math.log(chance / ways)
            found.append(Hypothesis(mode, habit, scale, world, STAYS, 0, False, weight, mean, cov))
    return found


def new_line(c: Constants, habit: int) -> np.ndarray:
    """Covariance of wander beside a line of which nothing is known."""
    cov = np.zeros((STATES, STATES))
    cov[np.ix_([ASIDE, FOOT], [ASIDE, FOOT])] = c.wander_m[habit] ** 2
    cov[FOOT, FOOT] += c.place_m**2
    cov[SLIDE, SLIDE] = (c.wander_m[habit] / c.wander_s[habit]) ** 2
    return cov


def rates(row: np.ndarray) -> np.ndarray:
    """By which states the heading drifts (STATES,)."""
    a = np.zeros(STATES)
    a[[BIAS, FLICKER]] = 1.0
    a[WARM] = row[_sight.WARMTH]
    a[LOADS] = row[_sight.LOAD : _sight.JUMP]
    return a


def drift_model(row: np.ndarray, size: float, c: Constants) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Transition, noise and known input of the drift over an interval."""
    jump, told = np.zeros(STATES), np.zeros(STATES)
    jump[LOADS] = row[_sight.JUMP : _sight.SIGHT]
    F, Q = np.eye(STATES), np.zeros((STATES, STATES))
    F[DRIFT] += row[_sight.ACTIVE] * rates(row) + jump
    F[PATH] -= jump
    Q[DRIFT, DRIFT] = (size * c.random_walk) ** 2 * row[_sight.ACTIVE]
    told[DRIFT] = row[_sight.REST] * row[_sight.REST_RATE]
    return F, Q, told


def age_model(row: np.ndarray, habit: int, size: float, c: Constants) -> tuple[np.ndarray, np.ndarray]:
    """Transition and noise of errors and wander over an interval."""
    T = row[_sight.INTERVAL]
    F, Q = np.eye(STATES), np.zeros((STATES, STATES))
    F[FLICKER, FLICKER] = kept = math.exp(-T / c.flicker_s)
    F[FOOT_BEFORE] = np.eye(STATES)[FOOT]
    r = 1 / c.wander_s[habit]
    block = math.exp(-r * T) * np.array([[1 + r * T, T], [-r * r * T, 1 - r * T]])
    still = np.diag([c.wander_m[habit] ** 2, (c.wander_m[habit] * r) ** 2])
    lateral = [ASIDE, SLIDE]
    F[np.ix_(lateral, lateral)] = block
    F[FOOT] = F[ASIDE]
    noise = still - block @ still @ block.T
    Q[np.ix_(lateral, lateral)] = noise
    Q[FOOT, lateral] = Q[lateral, FOOT] = noise[0]
    Q[FOOT, FOOT] = noise[0, 0] + c.place_m**2
    Q[FLICKER, FLICKER] = (size * c.flicker) ** 2 * (1 - kept**2)
    walk = c.bias_walk if row[_sight.TOLD] > 0 else c.bias_walk_blind
    Q[BIAS, BIAS] = (size * walk) ** 2 * T
    return F, Q


def mode_model(
    mode: int, entry: int, habit: int, length: float, c: Constants
) -> tuple[np.ndarray, np.ndarray]:
    """Transition and noise of the path over a stride."""
    keep, Q = np.ones(STATES), np.zeros((STATES, STATES))
    if mode != CURVE or entry != STAYS:
        keep[CURVATURE] = 0
    F = np.eye(STATES)
    if mode == TURN:
        keep[[ASIDE, SLIDE, FOOT, FOOT_BEFORE]] = 0
        Q = new_line(c, habit)
        Q[PATH, PATH] = c.turn**2
    else:
        Q[PATH, PATH] = c.meander**2 * length
    if mode == CURVE:
        F[PATH, CURVATURE] = length
        new = 0.0 if entry == STAYS else (c.gentle if entry == GENTLE else c.tight)
        entered = np.zeros((STATES, STATES))
        entered[CURVATURE, CURVATURE] = new**2
        Q = Q + F @ entered @ F.T
        Q[CURVATURE, CURVATURE] += c.bending**2 * length
    F = F @ np.diag(keep)
    if entry == ANEW:
        same = np.eye(STATES)
        same[REFERENCE] = same[PATH]
        F, Q = same @ F, same @ Q @ same.T
        Q[REFERENCE, REFERENCE] += c.beside**2
    return F, Q


def quarter_turns(mean: np.ndarray, c: Constants) -> float:
    """From the reference to the dominant direction nearest to the path; quarters if there are four."""
    sector = 2 * math.pi / c.directions
    return sector * math.floor((mean[PATH] - mean[REFERENCE]) / sector + 0.5)


def course_row(row: np.ndarray) -> np.ndarray:
    """What the course sees of the state."""
    h = -(row[_sight.ACTIVE] - row[_sight.MOVING] / 2) * rates(row)
    h[[PATH, DRIFT]] = 1.0
    h[FOOT], h[FOOT_BEFORE] = 1 / row[_sight.DISTANCE], -1 / row[_sight.DISTANCE]
    return h


def course_seen(row: np.ndarray) -> float:
    """The course, as the heading is after the stride's rest."""
    return float(row[_sight.COURSE] + row[_sight.REST] * row[_sight.REST_RATE])


def along_row() -> np.ndarray:
    """Path less reference."""
    return np.eye(STATES)[PATH] - np.eye(STATES)[REFERENCE]


def rest_row(row: np.ndarray) -> np.ndarray:
    """What a rest sees of the state."""
    h = np.zeros(STATES)
    h[[BIAS, FLICKER]], h[WARM] = 1.0, row[_sight.REST_WARMTH]
    return h


def updated(
    mean: np.ndarray, cov: np.ndarray, h: np.ndarray, z: float, noise: float
) -> tuple[np.ndarray, np.ndarray, float]:
    """Kalman's update by a number, and the logarithm of its density."""
    left, s = z - h @ mean, h @ cov @ h + noise
    gain = cov @ h / s
    return mean + gain * left, cov - np.outer(gain, cov @ h), _linear.log_normal(left, s)


class PlainBeam:
    """Twin of `_beam.step`, footfall by footfall. `told` is its row."""

    def __init__(self, c: Constants) -> None:
        self.c = c
        self.found: list[Hypothesis] = []
        self.lost = False
        self.last = 0.0
        self.told: dict[str, Any] = {}

    def step(self, row: np.ndarray) -> None:
        """Take in a row of sight; the first must be of a stride that has a direction."""
        c, good = self.c, row[_sight.DISTANCE] >= self.c.shortest_m
        self.found = self.found or first(c, row[_sight.COURSE])
        length = 0.5 * (row[_sight.DISTANCE] + (self.last or row[_sight.DISTANCE]))
        moved = [self._moved(each, row) for each in self.found]
        made: list[Hypothesis] = []
        for parent, before in enumerate(moved):
            for mode, habit, entry, chance in self._branches(before, good):
                child = replace(before, mode=mode, habit=habit, entry=entry, parent=parent)
                goes_on = mode == before.mode and entry == STAYS
                child = replace(child, weight=before.weight + chance, goes_on=goes_on)
                made.append(self._seen(child, row, length) if good else child)
        self._select(made, row)
        self.last = row[_sight.DISTANCE] if good else self.last
        self.lost = not good

    def _seen(self, child: Hypothesis, row: np.ndarray, length: float) -> Hypothesis:
        """The stride's mode and course taken in."""
        c = self.c
        F, Q = mode_model(child.mode, child.entry, child.habit, length, c)
        mean, cov = F @ child.mean, F @ child.cov @ F.T + Q
        if child.entry == ANEW:
            mean[REFERENCE] -= quarter_turns(child.mean, c)
        mean, cov, seen = updated(mean, cov, course_row(row), course_seen(row), c.course**2)
        weight = child.weight + seen
        if child.entry == ALIGNED:
            along = quarter_turns(mean, c)
            mean, cov, seen = updated(mean, cov, along_row(), along, c.beside**2)
            weight += seen + math.log(2 * math.pi / c.directions)
        return replace(child, mean=mean, cov=cov, weight=weight)

    def _moved(self, each: Hypothesis, row: np.ndarray) -> Hypothesis:
        size = self.c.scales[each.scale]
        F, Q, told = drift_model(row, size, self.c)
        mean, cov, weight = F @ each.mean + told, F @ each.cov @ F.T + Q, each.weight
        if row[_sight.REST] > 0:
            noise = (size * self.c.random_walk) ** 2 / row[_sight.REST]
            mean, cov, seen = updated(mean, cov, rest_row(row), row[_sight.REST_RATE], noise)
            weight += seen
        F, Q = age_model(row, each.habit, size, self.c)
        return replace(each, mean=F @ mean, cov=F @ cov @ F.T + Q, weight=weight)

    def _branches(self, of: Hypothesis, good: bool) -> list[tuple[int, int, int, float]]:
        """Mode, habit, entry and the logarithm of the chance of each."""
        c = self.c
        if not good:
            return [(of.mode, of.habit, STAYS, 0.0)]
        chances = c.log_transitions[of.habit, int(self.lost)]
        found = []
        others = len(c.wander_m) - 1
        for habit in range(len(c.wander_m)) if of.mode == TURN else [of.habit]:
            lot = 0.0
            if of.mode == TURN and others:
                lot = math.log(1 - c.habit_change if habit == of.habit else c.habit_change / others)
            lot += chances[of.mode, STRAIGHT]
            new = of.world == _branches.ALONG and of.mode == TURN
            bare = math.log((1 - c.along) * (1 - c.along_anew)) if new else 0.0
            found.append((STRAIGHT, habit, STAYS, lot + bare))
            if new:
                found.append((STRAIGHT, habit, ALIGNED, lot + math.log(c.along)))
                found.append((STRAIGHT, habit, ANEW, lot + math.log((1 - c.along) * c.along_anew)))
        found.append((TURN, of.habit, STAYS, chances[of.mode, TURN]))
        to_curve = chances[of.mode, CURVE]
        if of.mode == CURVE:
            found.append((CURVE, of.habit, STAYS, math.log(math.exp(to_curve) - c.curve_curve)))
            to_curve = math.log(c.curve_curve)
        found.append((CURVE, of.habit, GENTLE, to_curve + math.log(c.gentle_chance)))
        found.append((CURVE, of.habit, TIGHT, to_curve + math.log(1 - c.gentle_chance)))
        return found

    def _select(self, made: list[Hypothesis], row: np.ndarray) -> None:
        c = self.c
        best = max(each.weight for each in made)
        kept: list[Hypothesis] = []
        for each in sorted(made, key=lambda one: -one.weight):
            if len(kept) == c.hypotheses:
                break
            if each.weight < best - (c.prune if each.goes_on else c.sprout):
                continue
            at = next((i for i, other in enumerate(kept) if self._alike(each, other, row)), None)
            if at is None:
                kept.append(each)
                continue
            other = kept[at]
            weight = float(np.logaddexp(other.weight, each.weight))
            p, q = math.exp(other.weight - weight), math.exp(each.weight - weight)
            mean = p * other.mean + q * each.mean
            cov = sum(
                share * (one.cov + np.outer(one.mean - mean, one.mean - mean))
                for share, one in ((p, other), (q, each))
            )
            kept[at] = replace(other, weight=weight, mean=mean, cov=np.asarray(cov))
        total = float(np.logaddexp.reduce([each.weight for each in kept]))
        self.found = [replace(each, weight=each.weight - total) for each in kept]
        drift = np.array([each.mean[DRIFT] for each in self.found])
        spread = np.array([each.cov[DRIFT, DRIFT] for each in self.found])
        share = np.exp([each.weight for each in self.found])
        middle = float(share @ drift)
        modes = np.array([each.mode for each in self.found])
        self.told = {
            "mean": middle,
            "sd": math.sqrt(share @ (spread + (drift - middle) ** 2)),
            "chances": [float(share[modes == mode].sum()) for mode in (STRAIGHT, CURVE, TURN)],
            "rate": float(
                sum(w * (rates(row) @ each.mean) for w, each in zip(share, self.found, strict=True))
            ),
            "evidence": total,
        }
        limit = _beam.APART * math.sqrt(spread[0])
        far = np.flatnonzero(np.abs(drift - drift[0]) > limit)
        second = drift[far[np.argmax(share[far])]] if len(far) else drift[0]
        near = far[np.abs(drift[far] - second) <= limit]
        self.told |= {"second": float(second), "second_weight": float(share[near].sum())}

    def _alike(self, one: Hypothesis, other: Hypothesis, row: np.ndarray) -> bool:
        if (one.mode, one.habit, one.scale, one.world) != (other.mode, other.habit, other.scale, other.world):
            return False
        apart = np.abs(one.mean - other.mean)
        near = apart <= self.c.merge * np.sqrt(np.maximum(np.diag(other.cov), 0.0))
        judged = [DRIFT, PATH, WARM] + ([CURVATURE] if one.mode == CURVE else [])
        if one.world == _branches.ALONG and apart[REFERENCE] > self.c.beside:
            return False
        a = rates(row)
        a[[FLICKER, WARM]] = 0.0
        spread = float(np.sum(a**2 * np.diag(other.cov)))
        return bool(near[judged].all()) and abs(a @ (one.mean - other.mean)) <= self.c.merge * math.sqrt(
            spread
        )
