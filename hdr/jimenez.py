"""Two heading measurements of Jimenez, Seco, Prieto and Guevara for the filter: HDR (2010) and iHDE (2011).

Both are reconstructions: of the second only the abstract was read (straightness over five strides, and an
orientation error that is fed to the filter together with the confidence in it), of the first what others say.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from footfall.conventions import wrap
from footfall.hdr.directions import DirectionParams, Directions
from footfall.hdr.step_heading import HeadingSource, StepHeadings, require_source
from footfall.hdr.straightness import circular_mean
from footfall.pdr.filter.run import Step
from footfall.settings import require, setting


@dataclass(frozen=True)
class FilterHdrParams:
    """HDR in the filter: on a straight the heading stays what it was.

    Attributes
    ----------
    memory : footfalls before this one whose mean heading is compared with
    gate : rad, a larger difference is a turn and says nothing
    sigma : rad, standard deviation of the heading measurement, one a footfall
    """

    memory: int = setting(2, ge=1)
    gate: float = setting(math.radians(4.0), unit="rad", ge=0, le=math.inf)
    sigma: float = setting(0.1, unit="rad", gt=0)

    def __post_init__(self) -> None:
        require("hdr-filter", self)


class FilterHdrRow(NamedTuple):
    """What HDR saw and did at a footfall; NaN where there was nothing to say."""

    change: float = math.nan
    straight: float = 0.0
    innovation: float = math.nan


class FilterHdr:
    """HDR as a measurement of no turn, which the filter spreads over heading and gyro bias by itself.

    change = psi_s - mean(psi_{s-1}, psi_{s-2}); where |change| < gate, the innovation is -change.

    Attributes
    ----------
    params : its constants
    rows : evidence, a row a footfall; row 0 is the start, which is not asked for
    """

    units: Mapping[str, str] = {"change": "rad", "straight": "", "innovation": "rad"}

    def __init__(self, params: FilterHdrParams | None = None) -> None:
        self.params = params or FilterHdrParams()
        self.rows = [FilterHdrRow()]
        self._before: deque[float] = deque(maxlen=self.params.memory)

    def __call__(self, step: Step) -> tuple[float, float] | None:
        """Innovation (rad, truth - estimate) and its standard deviation (rad), or None."""
        row = FilterHdrRow()
        if len(self._before) == self.params.memory:
            change = float(wrap(step.heading - circular_mean(self._before)))
            straight = abs(change) < self.params.gate
            row = FilterHdrRow(change, float(straight), -change if straight else math.nan)
        self._before.append(step.heading)
        self.rows.append(row)
        return (row.innovation, self.params.sigma) if row.straight else None


@dataclass(frozen=True)
class JimenezParams:
    """iHDE: HDE on straights alone, trusted the less the further it has to turn.

    Attributes
    ----------
    heading : of a step: the foot's "yaw", the "course" of the stride, or "both"
        (`footfall.hdr.step_heading`)
    window : footfalls that are judged together
    gate : rad, all of them must lie this near to their mean heading for a straight
    sigma : rad, standard deviation of the heading measurement where mean heading and direction agree
    scale : rad, residual at which that standard deviation has doubled: sigma (1 + (residual / scale)^2)
    directions : the dominant directions
    """

    heading: HeadingSource = "course"
    window: int = setting(5, ge=2)
    gate: float = setting(math.radians(3.0), unit="rad", gt=0)
    sigma: float = setting(math.radians(4.0), unit="rad", gt=0)
    scale: float = setting(math.radians(5.0), unit="rad", gt=0)
    directions: DirectionParams = field(default_factory=DirectionParams)

    def __post_init__(self) -> None:
        require_source("ihde-jimenez", self.heading)
        require("ihde-jimenez", self)


class JimenezRow(NamedTuple):
    """What iHDE saw and did at a footfall; NaN where there was nothing to say."""

    spread: float = math.nan
    straight: float = 0.0
    reference: float = math.nan
    residual: float = math.nan
    innovation: float = math.nan
    innovation_sd: float = math.nan


class Jimenez:
    """iHDE as the filter asks it, footfall by footfall.

    Attributes
    ----------
    params : its constants
    rows : evidence, a row a footfall; row 0 is the start, which is not asked for
    """

    units: Mapping[str, str] = {
        "spread": "rad",
        "straight": "",
        "reference": "rad",
        "residual": "rad",
        "innovation": "rad",
        "innovation_sd": "rad",
    }

    def __init__(self, params: JimenezParams | None = None) -> None:
        self.params = params or JimenezParams()
        self.rows = [JimenezRow()]
        self._directions = Directions(self.params.directions)
        self._steps = StepHeadings(self.params.heading, self.params.window)

    def __call__(self, step: Step) -> tuple[float, float] | None:
        """Innovation (rad, truth - estimate) and its standard deviation (rad), or None."""
        row = self._judge(step)
        self.rows.append(row)
        return None if math.isnan(row.innovation) else (row.innovation, row.innovation_sd)

    def applied(self, turned: float) -> None:
        """The filter's heading was turned by `turned` (rad)."""
        self._steps.applied(turned)

    def _judge(self, step: Step) -> JimenezRow:
        params = self.params
        heading, recent = self._steps(step), self._steps.recent
        if heading is None or len(recent) < params.window:
            return JimenezRow()
        mean = circular_mean(recent)
        spread = max(abs(float(wrap(one - mean))) for one in recent)
        if spread >= params.gate:
            return JimenezRow(spread)
        self._directions.learn(mean)
        nearest = self._directions.nearest(mean)
        if nearest is None:
            return JimenezRow(spread, 1.0)
        residual = nearest - mean
        sd = params.sigma * (1 + (residual / params.scale) ** 2)
        return JimenezRow(spread, 1.0, nearest, residual, float(wrap(nearest - heading)), sd)
