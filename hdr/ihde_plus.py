"""IHDE+: how likely is this a straight, and how likely along a dominant direction? Our own, after IHDE.

IHDE (`footfall.hdr.ihde`) answers with two thresholds, the scatter of five headings and 5 deg to a direction:
a heading that has drifted by more before its first correction is never corrected again, and the first strides
of a curve pass for a straight's. Here both answers are probabilities, from as many headings as there are.

z_1 .. z_n are the headings of the steps (`footfall.hdr.step_heading`) since the last turn and its settling; i
counts the steps of a window from its middle; N(x; v) is the density of a normal distribution of variance v.

    line        slope k = sum i z_i / sum i^2, of variance s^2 = scatter^2 / sum i^2
    turn        the next heading lies `turn` standard deviations beside the line of the last 10: n = 0. The
                first one is dropped where it lies as far beside the line of those after it
    straight    L_m = ln p / (1 - p) + ln N(k; s^2 + straight^2) - ln mean_q N(k; s^2 + q^2), q the slopes of
                curves, over the last m = 10 and 20 headings; p_s = 1 / (1 + exp(-min L_m))
    direction   off = mean of the last 10 less the nearest direction, t = time since the last correction,
                v = fixed^2 + (drift t)^2 + scatter^2 / 10;
                p_d = r N(off; v) / (r N(off; v) + (1 - r) / sector)
    innovation  from n = 5 on, where w = p_s p_d > 1/2: z_{n-1} lies along that direction, to sigma / sqrt(w)

The last heading says nothing yet: it may be the first of a curve. What is remembered turns with the filter's
heading.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from footfall.errors import InputError
from footfall.hdr.directions import DirectionParams, Directions
from footfall.hdr.step_heading import HeadingSource, StepHeadings, require_source
from footfall.pdr.filter.run import Step
from footfall.settings import require, setting

SHORT, LONG = 10, 20  # windows, in steps
LEAST = 5  # headings before anything is said
WITHHELD = 1  # of them say nothing yet


@dataclass(frozen=True)
class IhdePlusParams:
    """IHDE+'s constants.

    Attributes
    ----------
    heading : of a step: the foot's "yaw", the "course" of the stride, or "both"
        (`footfall.hdr.step_heading`)
    scatter : rad, standard deviation of the heading of a step about a straight
    straight_slope : rad a step, by which a straight turns: drift that is not known yet, corridors that bend
    curve_slopes : rad a step, by which curves turn
    straight_share : p, of steps that belong to straights
    direction_share : r, of straights that lie along a dominant direction
    fixed_sd : rad, standard deviation of the heading after a correction
    drift : rad/s, by which it grows from then on
    turn : standard deviations, beside its line, of a heading that is none of the straight's
    settle : steps that belong to a turn, and to setting out, from the first that shows it
    sigma : rad, standard deviation of one heading measurement of a sure straight along a sure direction
    directions : the dominant directions
    """

    heading: HeadingSource = "course"
    scatter: float = setting(math.radians(2.0), unit="rad", gt=0)
    straight_slope: float = setting(math.radians(0.1), unit="rad/step", ge=0)
    curve_slopes: tuple[float, ...] = setting((math.radians(0.6), math.radians(2.5)), unit="rad/step", gt=0)
    straight_share: float = setting(0.8, gt=0, lt=1)
    direction_share: float = setting(0.7, gt=0, lt=1)
    fixed_sd: float = setting(math.radians(2.0), unit="rad", gt=0)
    drift: float = setting(math.radians(0.05), unit="rad/s", ge=0)
    turn: float = setting(3.0, gt=0)
    settle: int = setting(3, ge=0)
    sigma: float = setting(math.radians(3.0), unit="rad", gt=0)
    directions: DirectionParams = field(default_factory=DirectionParams)

    def __post_init__(self) -> None:
        require_source("ihde-plus", self.heading)
        require("ihde-plus", self)
        if not self.curve_slopes:
            raise InputError("ihde-plus: curve_slopes = (), expected positive numbers")


class IhdePlusRow(NamedTuple):
    """What IHDE+ saw and did at a footfall; NaN where there was nothing to say.

    headings : n; straight, along : p_s, p_d; reference : rad, the nearest direction; innovation,
    innovation_sd : rad; toe_out : rad, by which the foot points to the left of its course
    """

    headings: float = 0.0
    straight: float = math.nan
    along: float = math.nan
    reference: float = math.nan
    innovation: float = math.nan
    innovation_sd: float = math.nan
    toe_out: float = math.nan


def line(headings: Sequence[float]) -> tuple[float, float, float]:
    """Mean (rad) and slope (rad a step) of headings (rad), and the sum of i^2 that the slope stands on."""
    n = len(headings)
    mean = sum(headings) / n
    weight = n * (n * n - 1) / 12
    moment = sum((i - (n - 1) / 2) * (heading - mean) for i, heading in enumerate(headings))
    return mean, moment / weight if weight else 0.0, weight


def beside(headings: Sequence[float], heading: float, params: IhdePlusParams) -> bool:
    """Whether `heading` (rad) does not continue the line through others (rad, at least one, nearest last).

    The slope is believed as far as the steepest curve and the number of headings make it likely.
    """
    n = len(headings)
    mean, slope, weight = line(headings)
    noise, steepest = params.scatter**2, max(params.curve_slopes) ** 2
    believed = weight * steepest / (weight * steepest + noise)
    ahead = (n + 1) / 2
    variance = noise * (1 + 1 / n) + (1 - believed) * steepest * ahead**2
    return abs(heading - mean - believed * slope * ahead) > params.turn * math.sqrt(variance)


def straight_probability(headings: Sequence[float], params: IhdePlusParams) -> float:
    """p_s: that these headings (rad, at least two) are those of a straight."""
    odds = math.log(params.straight_share / (1 - params.straight_share))
    return _logistic(odds + min(_straight_evidence(headings[-window:], params) for window in (SHORT, LONG)))


def _straight_evidence(headings: Sequence[float], params: IhdePlusParams) -> float:
    _, slope, weight = line(headings)
    own = params.scatter**2 / weight
    straight = _log_normal(slope, own + params.straight_slope**2)
    curves = [_log_normal(slope, own + curve**2) for curve in params.curve_slopes]
    highest = max(curves)
    curve = highest + math.log(sum(math.exp(one - highest) for one in curves) / len(curves))
    return straight - curve


def direction_probability(off: float, since: float, n: int, params: IhdePlusParams) -> float:
    """p_d: that a straight runs along a direction, whose last `n` headings lie `off` (rad) beside it.

    `since` : s since the heading was corrected last
    """
    variance = params.fixed_sd**2 + (params.drift * since) ** 2 + params.scatter**2 / n
    sector = 2 * math.pi / params.directions.count
    odds = math.log(params.direction_share / (1 - params.direction_share) * sector)
    return _logistic(odds + _log_normal(off, variance))


def _log_normal(x: float, variance: float) -> float:
    return -0.5 * (x * x / variance + math.log(2 * math.pi * variance))


def _logistic(x: float) -> float:
    return 0.5 * (1 + math.tanh(0.5 * x))


class IhdePlus:
    """IHDE+ as the filter asks it, footfall by footfall.

    Attributes
    ----------
    params : its constants
    rows : evidence, a row a footfall; row 0 is the start, which is not asked for
    """

    units: Mapping[str, str] = {
        "headings": "",
        "straight": "",
        "along": "",
        "reference": "rad",
        "innovation": "rad",
        "innovation_sd": "rad",
        "toe_out": "rad",
    }

    def __init__(self, params: IhdePlusParams | None = None) -> None:
        self.params = params or IhdePlusParams()
        self.rows = [IhdePlusRow()]
        self._directions = Directions(self.params.directions)
        self._steps = StepHeadings(self.params.heading, LONG)
        self._settling = self.params.settle
        self._corrected: float | None = None  # s

    def __call__(self, step: Step) -> tuple[float, float] | None:
        """Innovation (rad, truth - estimate) and its standard deviation (rad), or None."""
        if self._corrected is None:
            self._corrected = step.t - step.stride_time  # the heading at the start is known
        row = self._judge(step)
        toe_out = self._steps.toe_out
        self.rows.append(row if toe_out is None else row._replace(toe_out=toe_out))
        return None if math.isnan(row.innovation) else (row.innovation, row.innovation_sd)

    def applied(self, turned: float) -> None:
        """The filter's heading was turned by `turned` (rad)."""
        self._steps.applied(turned)

    def _judge(self, step: Step) -> IhdePlusRow:
        assert self._corrected is not None
        params, headings = self.params, self._straight_so_far(step)
        n = len(headings)
        if n < LEAST:
            return IhdePlusRow(n)
        straight = straight_probability(headings, params)
        recent = headings[-SHORT:]
        mean, _, _ = line(recent)
        self._directions.learn(mean, straight)
        nearest = self._directions.nearest(mean)
        if nearest is None:
            return IhdePlusRow(n, straight)
        along = direction_probability(mean - nearest, step.t - self._corrected, len(recent), params)
        row, sure = IhdePlusRow(n, straight, along, nearest), straight * along
        if sure <= 0.5:
            return row
        self._corrected = step.t
        innovation = nearest - headings[-1 - WITHHELD]
        return row._replace(innovation=innovation, innovation_sd=params.sigma / math.sqrt(sure))

    def _straight_so_far(self, step: Step) -> list[float]:
        """Headings since the last turn and its settling, with this step's if it has one."""
        recent = self._steps.recent
        before = list(recent)[-SHORT:]
        heading = self._steps(step)
        if heading is None:
            return []
        if before and beside(before, heading, self.params):  # a turn
            self._settling = self.params.settle
        if self._settling:
            self._settling -= 1
            recent.clear()
        while len(recent) > LEAST and beside(list(recent)[SHORT:0:-1], recent[0], self.params):
            recent.popleft()  # it belonged to the turn before
        return list(recent)
