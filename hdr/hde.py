"""Heuristic Drift Elimination (Borenstein and Ojeda 2010): people in buildings walk along few directions.

Two forms: a binary I-controller on dead reckoning's headings, as in 2010, and a measurement that is fed to
the filter at every footfall, as Deng et al. (2018) compare it with theirs.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from footfall.errors import InputError
from footfall.hdr.directions import DirectionParams, Directions, deviation
from footfall.hdr.step_heading import HeadingSource, StepHeadings, require_source
from footfall.pdr.filter.run import Step
from footfall.pdr.footfalls import Footfalls
from footfall.settings import require, setting


@dataclass(frozen=True)
class Hde2010Params:
    """The controller of 2010, on the angle.

    Attributes
    ----------
    i_c : rad, fixed increment of the correction per footfall; i_c over the stride time is the largest drift
        that it can keep up with
    theta_w : rad/s, rate of turn over a stride above which it rests, and below which it slows down; infinite
        for a controller that never does
    directions : the dominant directions; one of them must be known
    """

    i_c: float = setting(math.radians(0.3), unit="rad", ge=0)
    theta_w: float = setting(math.radians(15.0), unit="rad/s", gt=0, le=math.inf)
    directions: DirectionParams = field(default_factory=DirectionParams)

    def __post_init__(self) -> None:
        require("hde-2010", self)


class Hde2010Trace(NamedTuple):
    """The controller over a walk, each (n,).

    deviation : rad, from the nearest direction, before the footfall's own correction; attenuator : A;
    correction : C, rad; heading : rad
    """

    deviation: np.ndarray
    attenuator: np.ndarray
    correction: np.ndarray
    heading: np.ndarray


HDE_2010_UNITS: Mapping[str, str] = {"deviation": "rad", "attenuator": "", "correction": "rad"}


def hde_2010(footfalls: Footfalls, params: Hde2010Params | None = None) -> Hde2010Trace:
    """HDE on dead reckoning's headings, without a filter.

    C_i = C_{i-1} - A_i sign(dev(c_i + C_{i-1})) i_c and psi_i = psi_raw,i + C_i, where c is the course of the
    stride, dev its deviation from the nearest dominant direction, and sign(0) = 0. The original was not at
    hand: this is its controller as others describe it, with HDR's attenuator A_i = max(0, 1 - |raw_i| /
    theta_w).

    Raises
    ------
    InputError
        None of the dominant directions is known.
    """
    params = params or Hde2010Params()
    count, base = params.directions.count, params.directions.reference
    if base is None:
        raise InputError("directions.reference is missing; only filters learn directions", "hde-2010")
    n = len(footfalls)
    attenuator = np.maximum(0.0, 1.0 - np.abs(footfalls.rate) / params.theta_w)
    stride = np.diff(footfalls.position, axis=0)
    course = np.arctan2(stride[:, 1], stride[:, 0])
    off, correction = np.zeros(n), np.zeros(n)
    now = 0.0
    for i in range(1, n):
        off[i] = deviation(float(course[i - 1]) + now, base, count)
        now -= float(attenuator[i] * np.sign(off[i])) * params.i_c
        correction[i] = now
    return Hde2010Trace(off, attenuator, correction, footfalls.heading + correction)


@dataclass(frozen=True)
class HdeParams:
    """HDE as a measurement in the filter.

    Attributes
    ----------
    heading : of a step, which is compared with the directions: the foot's "yaw", the "course" of the stride,
        or "both" (`footfall.hdr.step_heading`)
    sigma : rad, standard deviation of the heading measurement, one a footfall
    directions : the dominant directions
    """

    heading: HeadingSource = "course"
    sigma: float = setting(math.radians(12.0), unit="rad", gt=0)
    directions: DirectionParams = field(default_factory=DirectionParams)

    def __post_init__(self) -> None:
        require_source("hde", self.heading)
        require("hde", self)


class HdeRow(NamedTuple):
    """What HDE did at a footfall; NaN where there was nothing to say."""

    reference: float = math.nan
    innovation: float = math.nan


class Hde:
    """HDE as the filter asks it: always the nearest dominant direction, whatever the path.

    Attributes
    ----------
    params : its constants
    rows : evidence, a row a footfall; row 0 is the start, which is not asked for
    """

    units: Mapping[str, str] = {"reference": "rad", "innovation": "rad"}

    def __init__(self, params: HdeParams | None = None) -> None:
        self.params = params or HdeParams()
        self.rows = [HdeRow()]
        self._directions = Directions(self.params.directions)
        self._steps = StepHeadings(self.params.heading)

    def __call__(self, step: Step) -> tuple[float, float] | None:
        """Innovation (rad, truth - estimate) and its standard deviation (rad), or None."""
        row = self._judge(step)
        self.rows.append(row)
        return None if math.isnan(row.innovation) else (row.innovation, self.params.sigma)

    def applied(self, turned: float) -> None:
        """The filter's heading was turned by `turned` (rad)."""
        self._steps.applied(turned)

    def _judge(self, step: Step) -> HdeRow:
        heading = self._steps(step)
        if heading is None:
            return HdeRow()
        self._directions.learn(heading)
        nearest = self._directions.nearest(heading)
        return HdeRow() if nearest is None else HdeRow(nearest, nearest - heading)
