"""Improved Heuristic Drift Elimination (Deng, Cao, Wang and Wang 2018, section 2.4): Eq. 20 to 27.

Where the headings of the last footfalls show a straight, the filter is told that the heading is that of the
nearest dominant direction, if one is near, or else the mean of those headings. The text of the
paper at hand lost minus signs and the 1 / (W - 1) of Eq. 20; here they are as the words need them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from footfall.conventions import wrap
from footfall.hdr.directions import DirectionParams, Directions
from footfall.hdr.step_heading import HeadingSource, StepHeadings, require_source
from footfall.hdr.straightness import bell_membership, circular_mean, circular_std, z_membership
from footfall.pdr.filter.run import Step
from footfall.settings import require, setting


@dataclass(frozen=True)
class IhdeParams:
    """IHDE's constants. The paper states W, gamma_T's range and `match`; the others are ours.

    Attributes
    ----------
    heading : of a step: the foot's "yaw", the "course" of the stride, or "both"
        (`footfall.hdr.step_heading`)
    window : W, footfalls that are judged together
    k1, a : 1/rad and 1, of the Z membership (Eq. 21): a walk whose headings scatter by a / k1 is taken for
        half straight. That must lie above the scatter of the foot's yaw on straights, and below a curve's
    b, c, gamma_t : s^-(2c), 1 and s, of the bell membership in the stride time (Eq. 22)
    w1, w2 : weights of the two in E (Eq. 23)
    gamma2 : threshold of E (Eq. 24)
    match : rad, a dominant direction this near to the mean heading is the one that is walked (Eq. 26)
    fallback : where none is that near, take the mean heading itself for the truth, as the paper does, or
        nothing. The mean heading drifts with the gyro: it corrects no drift, and holds back in curves
    sigma : rad, standard deviation of the heading measurement, one a footfall
    directions : the dominant directions
    """

    heading: HeadingSource = "course"
    window: int = setting(5, ge=2)
    k1: float = setting(math.degrees(4.0), unit="1/rad", gt=0)
    a: float = setting(7.0, gt=0)
    b: float = setting(500.0, unit="s^-2c", gt=0)
    c: float = setting(2.0, gt=0)
    gamma_t: float = setting(1.1, unit="s", gt=0)
    w1: float = setting(0.8, ge=0)
    w2: float = setting(0.2, ge=0)
    gamma2: float = setting(0.6, ge=0)
    match: float = setting(math.radians(5.0), unit="rad", ge=0)
    fallback: bool = True
    sigma: float = setting(math.radians(4.0), unit="rad", gt=0)
    directions: DirectionParams = field(default_factory=DirectionParams)

    def __post_init__(self) -> None:
        require_source("ihde", self.heading)
        require("ihde", self)


class Evaluation(NamedTuple):
    """Whether the walk is straight: std (rad), mu1, mu2, E and En of Eq. 20 to 24."""

    std: float
    straight: float
    rhythm: float
    evaluation: float
    enabled: bool


class IhdeRow(NamedTuple):
    """What IHDE saw and did at a footfall; NaN where there was nothing to say.

    scatter : std of Eq. 20, rad; straight, rhythm : mu1, mu2; evaluation : E; enabled : En;
    reference : rad, the heading that the filter was told; dominant : whether it is a dominant direction;
    innovation : rad, Eq. 27
    """

    scatter: float = math.nan
    straight: float = 0.0
    rhythm: float = 0.0
    evaluation: float = 0.0
    enabled: float = 0.0
    reference: float = math.nan
    dominant: float = 0.0
    innovation: float = math.nan


def evaluate(headings: Sequence[float], stride_time: float, params: IhdeParams) -> Evaluation:
    """Eq. 20 to 24 on the headings (rad) of the last W footfalls and the last stride's time (s)."""
    std = circular_std(headings)  # Eq. 20
    mu1 = z_membership(std, params.k1, params.a)  # Eq. 21
    mu2 = bell_membership(stride_time, params.b, params.c, params.gamma_t)  # Eq. 22
    e = params.w1 * mu1 + params.w2 * mu2  # Eq. 23
    return Evaluation(std, mu1, mu2, e, e > params.gamma2)  # Eq. 24


def reference(mean: float, directions: Directions, params: IhdeParams) -> tuple[float, bool] | None:
    """Eq. 26: the dominant direction within `match` of the mean heading (rad), or the mean heading itself.

    Returns
    -------
    reference (rad) and whether it is a dominant direction; None without either
    """
    nearest = directions.nearest(mean)
    if nearest is not None and abs(nearest - mean) < params.match:
        return nearest, True
    return (mean, False) if params.fallback else None


class Ihde:
    """IHDE as the filter asks it, footfall by footfall.

    Attributes
    ----------
    params : its constants
    rows : evidence, a row a footfall; row 0 is the start, which is not asked for
    """

    units: Mapping[str, str] = {
        "scatter": "rad",
        "straight": "",
        "rhythm": "",
        "evaluation": "",
        "enabled": "",
        "reference": "rad",
        "dominant": "",
        "innovation": "rad",
    }

    def __init__(self, params: IhdeParams | None = None) -> None:
        self.params = params or IhdeParams()
        self.rows = [IhdeRow()]
        self._directions = Directions(self.params.directions)
        self._steps = StepHeadings(self.params.heading, self.params.window)

    def __call__(self, step: Step) -> tuple[float, float] | None:
        """Innovation (rad, truth - estimate) and its standard deviation (rad), or None."""
        row = self._judge(step)
        self.rows.append(row)
        return None if math.isnan(row.innovation) else (row.innovation, self.params.sigma)

    def applied(self, turned: float) -> None:
        """The filter's heading was turned by `turned` (rad)."""
        self._steps.applied(turned)

    def _judge(self, step: Step) -> IhdeRow:
        heading, recent = self._steps(step), self._steps.recent
        if heading is None or len(recent) < self.params.window:
            return IhdeRow()
        found = evaluate(recent, step.stride_time, self.params)
        row = IhdeRow(*found[:4], enabled=float(found.enabled))
        if not found.enabled:
            return row  # the paper feeds an error of 0 here, which would claim that the heading is right
        mean = circular_mean(recent)
        self._directions.learn(mean)
        chosen = reference(mean, self._directions, self.params)
        if chosen is None:
            return row
        innovation = float(wrap(chosen[0] - heading))  # Eq. 27
        return row._replace(reference=chosen[0], dominant=float(chosen[1]), innovation=innovation)
