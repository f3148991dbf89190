"""What the filter over hypotheses takes for granted of people, their paths and their gyros."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Any, NamedTuple

import numpy as np

from footfall.errors import InputError
from footfall.settings import require, setting

DEG = math.radians(1.0)
HABITS = (
    "wander_m",
    "wander_s",
    "straight_curve",
    "straight_turn",
    "turn_straight",
)


@dataclass(frozen=True)
class HypothesesParams:
    """Constants of the model in docs/hypotheses.md, in whose symbols and order they stand here.

    A chance is one a footfall. Sensor priors are standard deviations over units.

    Attributes
    ----------
    random_walk : rad/rt-s, of the angle (arw)
    bias : rad/s, what the rest leaves of the static bias (sb); bias_unloaded : where no loads are told
    bias_walk : rad/s/rt-s (qb); bias_walk_blind : the same where no temperature is reported
    flicker, flicker_s : rad/s and its correlation time (so, to)
    warmth : rad/s/K, per change of temperature since the rest (sc)
    g_sensitivity : rad/s per m/s2; scale : of gyro scale and misalignment; g_squared : rad/s per (m/s2)^2
    scales : by which all sensor priors are multiplied: how good the gyro is, is learned among these
    wander_m, wander_s, straight_curve : habits of walking, learned among these: lateral wander, its standard
        deviation and time (sl, tl), and the chance that a straight becomes a curve; straight_turn and
        turn_straight are a habit's, too
    place_m : scatter of where a foot lands beside it (seta)
    course : rad, scatter of a stride's direction (sv)
    meander : rad/rt-m, by which a straight is none (qs)
    turn : rad, of one stride of a turn (qt)
    gentle, tight : rad/m, curvature of the two kinds of curves (sk1, sk2); gentle_chance : of the first
    bending : rad/m/rt-m, by which a curve changes its curvature (qk)
    straight_turn, curve_straight, curve_turn, curve_curve, turn_straight, turn_curve : chances
    habit_change : chance of another habit after a turn
    straight_first : chance that the walk begins with a straight
    turn_after_short : chance of a turn after strides too short to have a direction
    shortest_m : m, a stride that has a direction
    directions : evenly spaced dominant directions, of which none need exist; reference : rad, one of them,
        where that is known; along_first : chance that they exist; along : chance that a straight after a turn
        then lies along one; along_anew : chance that one that does not is the first along others
    beside : rad, by which a straight is not quite along a dominant direction
    hypotheses : most that are kept; prune : nats below the best at which one is dropped; sprout : the same of
        one whose mode is new
    merge : standard deviations within which two of the same kind are one
    """

    random_walk: float = setting(0.102 * DEG, unit="rad/rt-s", gt=0)
    bias: float = setting(0.03 * DEG, unit="rad/s", ge=0)
    bias_unloaded: float = setting(0.11 * DEG, unit="rad/s", ge=0)
    bias_walk: float = setting(0.0009 * DEG, unit="rad/s/rt-s", ge=0)
    bias_walk_blind: float = setting(0.004 * DEG, unit="rad/s/rt-s", ge=0)
    flicker: float = setting(0.017 * DEG, unit="rad/s", ge=0)
    flicker_s: float = setting(100.0, unit="s", gt=0)
    warmth: float = setting(0.0097 * DEG, unit="rad/s/K", ge=0)
    g_sensitivity: float = setting(0.15 * DEG / 9.80665, unit="rad/s per m/s2", ge=0)
    scale: float = setting(0.003, ge=0)
    g_squared: float = setting(5e-4 * DEG / 9.80665**2, unit="rad/s per (m/s2)2", ge=0)
    scales: tuple[float, ...] = setting((1.0, 0.1), gt=0)
    wander_m: tuple[float, ...] = setting((0.1, 0.1, 0.4, 0.5, 0.1), unit="m", gt=0)
    wander_s: tuple[float, ...] = setting((1.7, 1.7, 3.0, 1.8, 1.7), unit="s", gt=0)
    straight_curve: tuple[float, ...] = setting((0.0004, 0.06, 0.0004, 0.0004, 0.0004), gt=0, lt=0.5)
    place_m: float = setting(0.012, unit="m", gt=0)
    course: float = setting(0.5 * DEG, unit="rad", gt=0)
    meander: float = setting(0.02 * DEG, unit="rad/rt-m", ge=0)
    turn: float = setting(50.0 * DEG, unit="rad", gt=0)
    gentle: float = setting(0.3 * DEG, unit="rad/m", gt=0)
    tight: float = setting(2.5 * DEG, unit="rad/m", gt=0)
    gentle_chance: float = setting(0.6, gt=0, lt=1)
    bending: float = setting(0.0003 * DEG, unit="rad/m/rt-m", ge=0)
    straight_turn: tuple[float, ...] = setting((0.01, 0.01, 0.01, 0.01, 0.04), gt=0, lt=0.5)
    curve_straight: float = setting(0.006, gt=0, lt=0.3)
    curve_turn: float = setting(0.01, gt=0, lt=0.3)
    curve_curve: float = setting(0.0025, gt=0, lt=0.3)
    turn_straight: tuple[float, ...] = setting((0.6, 0.6, 0.6, 0.6, 0.3), gt=0, lt=0.8)
    turn_curve: float = setting(0.1, gt=0, lt=0.2)
    straight_first: float = setting(0.9, gt=0, lt=1)
    habit_change: float = setting(0.05, gt=0, lt=1)
    turn_after_short: float = setting(0.3, gt=0, lt=1)
    shortest_m: float = setting(0.45, unit="m", gt=0)
    directions: int = setting(4, ge=1, le=36)
    reference: float | None = setting(None, unit="rad")
    along_first: float = setting(0.2, ge=0, lt=1)
    along: float = setting(0.9, gt=0, lt=1)
    along_anew: float = setting(0.4, gt=0, lt=1)
    beside: float = setting(1.0 * DEG, unit="rad", gt=0)
    hypotheses: int = setting(64, ge=4, le=1024)
    prune: float = setting(25.0, gt=0)
    sprout: float = setting(12.0, gt=0)
    merge: float = setting(0.4, ge=0)

    def __post_init__(self) -> None:
        require("hypotheses", self)
        habits = {len(getattr(self, name)) for name in HABITS}
        if len(habits) > 1 or 0 in habits:
            raise InputError(f"{', '.join(HABITS)}: expected as many of each, one a habit", "hypotheses")
        least = 4 * len(self.wander_m) * len(self.scales)
        if least > self.hypotheses:
            raise InputError(
                f"hypotheses = {self.hypotheses}: expected {least} or more, four for each habit and scale",
                "hypotheses",
            )
        if not self.scales:
            raise InputError("scales: expected at least one", "hypotheses")

    @property
    def constants(self) -> Constants:
        """The same as the kernels take it."""
        own: dict[str, Any] = {item.name: getattr(self, item.name) for item in fields(self)}
        own["reference"] = math.nan if self.reference is None else self.reference
        for name, value in own.items():
            own[name] = np.array(value, dtype=float) if isinstance(value, tuple) else float(value)
        own["hypotheses"] = self.hypotheses
        load = np.repeat([self.g_sensitivity, self.scale, self.g_squared], 9)
        return Constants(**own, load_sd=load, **self._logarithms())

    def _logarithms(self) -> dict[str, Any]:
        """Of chances, for branches."""
        transitions = self._transitions()
        stays = np.exp(transitions[:, :, 1, 1])  # of a curve
        others = len(self.wander_m) - 1
        off = 1 - self.along
        return {
            "log_transitions": transitions,
            "log_goes_on": np.log(stays - self.curve_curve),
            "log_bends": math.log(self.curve_curve),
            "log_gentle": math.log(self.gentle_chance),
            "log_tight": math.log(1 - self.gentle_chance),
            "log_same_habit": math.log(1 - self.habit_change) if others else 0.0,
            "log_other_habit": math.log(self.habit_change / max(others, 1)),
            "log_along": math.log(self.along * 2 * math.pi / self.directions),
            "log_anyhow": math.log(off * (1 - self.along_anew)),
            "log_anew": math.log(off * self.along_anew),
        }

    def _transitions(self) -> np.ndarray:
        """Logarithms of chances (habits, 2, 3, 3): mode to mode, second after strides of no direction."""
        ways = zip(self.straight_curve, self.straight_turn, self.turn_straight, strict=True)
        return np.log(np.array([self._chances(*way) for way in ways]))

    def _chances(self, straight_curve: float, straight_turn: float, turn_straight: float) -> np.ndarray:
        table = np.array(
            [
                [0.0, straight_curve, straight_turn],
                [self.curve_straight, 0.0, self.curve_turn],
                [turn_straight, self.turn_curve, 0.0],
            ]
        )
        lost = table.copy()
        lost[:2, 2] = np.maximum(table[:2, 2], self.turn_after_short)
        for each in (table, lost):
            np.fill_diagonal(each, 1.0 - each.sum(axis=1))
        return np.array([table, lost])


class Constants(NamedTuple):
    """`HypothesesParams` for compiled code; load_sd (27,) of the errors that loads act on.

    Logarithms of chances: log_transitions (habits, 2, 3, 3); log_goes_on (habits, 2) that a curve keeps its
    radius, log_bends that it takes another; log_gentle and log_tight of such; of the same habit after a turn
    and of another; of a straight then along a dominant direction, over evenly spread angles, along none, and
    along a new one.
    """

    random_walk: float
    bias: float
    bias_unloaded: float
    bias_walk: float
    bias_walk_blind: float
    flicker: float
    flicker_s: float
    warmth: float
    g_sensitivity: float
    scale: float
    g_squared: float
    scales: np.ndarray
    wander_m: np.ndarray
    wander_s: np.ndarray
    place_m: float
    course: float
    meander: float
    turn: float
    gentle: float
    tight: float
    gentle_chance: float
    bending: float
    straight_curve: np.ndarray
    straight_turn: np.ndarray
    curve_straight: float
    curve_turn: float
    curve_curve: float
    turn_straight: np.ndarray
    turn_curve: float
    straight_first: float
    habit_change: float
    turn_after_short: float
    shortest_m: float
    directions: float
    reference: float
    along_first: float
    along: float
    along_anew: float
    beside: float
    hypotheses: int
    prune: float
    sprout: float
    merge: float
    load_sd: np.ndarray
    log_transitions: np.ndarray
    log_goes_on: np.ndarray
    log_bends: float
    log_gentle: float
    log_tight: float
    log_same_habit: float
    log_other_habit: float
    log_along: float
    log_anyhow: float
    log_anew: float

    def beside_start(self, heading: float) -> Constants:
        """The same for a walk that begins at this heading (rad), from which courses are told."""
        return self._replace(reference=self.reference - heading)
