"""The filter over hypotheses, footfall by footfall or over a whole walk, with the same numbers."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from footfall.errors import InputError
from footfall.hdr.hypotheses.params import Constants, HypothesesParams
from footfall.late import late
from footfall.pdr.footfalls import Footfalls

_beam, _sight = late("footfall.hdr.hypotheses._beam"), late("footfall.hdr.hypotheses._sight")

APART = 3.0  # standard deviations, of a second opinion
_NO_LOADS = np.zeros(27)


class Given(NamedTuple):
    """What the filter is given of a footfall; `footfall.pdr.strides.Strides` explains the last seven.

    interval : s, since the footfall before; x, y : m, dead-reckoned; heading : rad, unwrapped
    moving : s, of the interval; temperature : degC or NaN; rest_s : s, 0 where there was none;
    rest_rate : rad/s; rest_temperature : degC; loads : (27,)
    """

    interval: float
    x: float
    y: float
    heading: float
    moving: float
    temperature: float = math.nan
    rest_s: float = 0.0
    rest_rate: float = 0.0
    rest_temperature: float = math.nan
    loads: np.ndarray = _NO_LOADS


class Belief(NamedTuple):
    """What the filter believes after a footfall.

    heading : rad, corrected, of the IMU's x axis; heading_sd : rad
    straight, curve, turn : chances of the modes
    drift_rate : rad/s, of the gyro's heading
    second_heading : rad, of the best hypothesis that is 3 standard deviations from the best of all, or the
        heading itself; second_weight : its weight and that of all near it
    evidence : logarithm of the density of what was seen, given what was seen before
    """

    heading: float
    heading_sd: float
    straight: float
    curve: float
    turn: float
    drift_rate: float
    second_heading: float
    second_weight: float
    evidence: float


class Beliefs(NamedTuple):
    """The columns of `Belief` for a whole walk, each (n,)."""

    heading: np.ndarray
    heading_sd: np.ndarray
    straight: np.ndarray
    curve: np.ndarray
    turn: np.ndarray
    drift_rate: np.ndarray
    second_heading: np.ndarray
    second_weight: np.ndarray
    evidence: np.ndarray


def given(footfalls: Footfalls) -> tuple[np.ndarray, np.ndarray]:
    """What the filter is given: numbers (n, 9) in the order of `Given`, and loads (n, 27).

    Footfalls without `strides` tell no loads, temperature and rests.
    """
    n, strides = len(footfalls), footfalls.strides
    empty = np.full(n, math.nan)
    rest = [footfalls.interval, empty, np.zeros(n), np.zeros(n), empty]
    loads = np.zeros((n, 27))
    if strides is not None:
        rest = [
            strides.moving,
            strides.temperature,
            strides.rest_s,
            strides.rest_rate,
            strides.rest_temperature,
        ]
        loads = np.ascontiguousarray(strides.loads)
    seen = [footfalls.interval, footfalls.position[:, 0], footfalls.position[:, 1], footfalls.heading, *rest]
    return np.ascontiguousarray(np.column_stack(seen)), loads


def fitting(params: HypothesesParams, footfalls: Footfalls) -> Constants:
    """The constants for these footfalls: without loads the static bias is less sure."""
    if footfalls.strides is None:
        params = replace(params, bias=params.bias_unloaded)
    return params.constants.beside_start(float(footfalls.heading[0]))


class Hypotheses:
    """The filter as it runs on a walking person.

    Parameters
    ----------
    params : of the model

    The first footfall is where the walk starts; from the second on there are strides.
    """

    def __init__(self, params: HypothesesParams | None = None) -> None:
        self.params = params or HypothesesParams()
        self._c = self.params.constants
        self._memory = _sight.remembered()
        self._state = _beam.nothing_yet(self._c.hypotheses)
        self._begun = False

    def update(self, footfall: Given) -> Belief:
        """Take in the next footfall.

        Raises
        ------
        InputError
            After the first, an interval that is not positive; a number that is not finite.
        """
        *numbers, loads = footfall
        if not all(map(math.isfinite, (*numbers[:5], *numbers[6:8]))) or not np.isfinite(loads).all():
            raise InputError(f"a footfall that is not finite: {footfall}", "hypotheses")
        if self._begun and not footfall.interval > 0:
            raise InputError(
                f"interval of {footfall.interval} s between two footfalls, expected a positive one",
                "hypotheses",
            )
        row, told = np.zeros(_sight.SIGHT), np.zeros(_beam.TOLD_ROW)
        _sight.sight(
            np.array(numbers), np.asarray(loads), *self._memory, self._c.load_sd, self._c.shortest_m, row
        )
        if not self._begun:
            self._c = self._c.beside_start(footfall.heading)
        if self._begun:
            _beam.step(*self._state, row, self._c, told)
        else:
            _beam.at_start(told, self._c)
        self._begun = True
        return Belief(*_believed(told, footfall.heading))


def beliefs(footfalls: Footfalls, params: HypothesesParams | None = None) -> Beliefs:
    """The filter over a whole walk: the same numbers as `Hypotheses.update` gives one by one.

    Raises
    ------
    InputError
        An interval between two footfalls is not positive.
    """
    c = fitting(params or HypothesesParams(), footfalls)
    told, _, _ = _beam.beam(rows_of(footfalls, c), c, False)
    return Beliefs(*_believed(told.T, footfalls.heading))


def rows_of(footfalls: Footfalls, c: Constants) -> np.ndarray:
    """What the filter is shown of a walk (n, SIGHT)."""
    if not (footfalls.interval[1:] > 0).all():
        raise InputError("an interval between two footfalls is not positive", "hypotheses")
    numbers, loads = given(footfalls)
    return np.asarray(_sight.sights(numbers, loads, c.load_sd, c.shortest_m))


def _believed(told: np.ndarray, heading: Any) -> list[Any]:
    """Rows of what the kernel tells, drifts turned into headings."""
    rows = list(told)
    rows[_beam.MEAN], rows[_beam.SECOND] = heading - told[_beam.MEAN], heading - told[_beam.SECOND]
    return rows
