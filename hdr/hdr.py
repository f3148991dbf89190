"""Heuristic Drift Reduction (Borenstein, Ojeda, Kwanmuang 2008): equations 1-12, exactly.

People walk straight much of the time. A controller that sees only whether the filtered rate is positive
or negative therefore settles where it cancels the drift; an attenuator suspends it in curves.
Two typos of the paper are mended: Eq. 11 adds psi_0 at every footfall, Eq. 12 adds to x_0 instead of x_{i-1}.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from footfall.errors import InputError
from footfall.late import late
from footfall.pdr.footfalls import Footfalls
from footfall.settings import require, setting

_kernels = late("footfall.hdr._kernels")


@dataclass(frozen=True)
class HdrParams:
    """The controller's three constants; they are tuned for one walking speed.

    What decides whether a curve of radius R walked at speed v counts as straight is v/R against theta_w,
    so theta_w means nothing without v: see `erased_radius`. theta_w must also exceed the largest drift that
    the gyro ever has, or HDR locks itself out (A = 0).

    Attributes
    ----------
    tau_s : s, time constant of each of the two low-pass filters (Eq. 6)
    i_c : rad/s, fixed increment of the integrator per footfall (Eq. 4, 8)
    theta_w : rad/s, rate above which the controller rests (Eq. 7); infinite for a controller that never does
    """

    tau_s: float = setting(8.0, unit="s", ge=0)
    i_c: float = setting(math.radians(0.007), unit="rad/s", ge=0)
    theta_w: float = setting(math.radians(0.25), unit="rad/s", gt=0, le=math.inf)

    def __post_init__(self) -> None:
        require("hdr", self)

    @classmethod
    def from_degrees(
        cls, *, tau_s: float = 8.0, i_c_deg_s: float = 0.007, theta_w_deg_s: float = 0.25
    ) -> HdrParams:
        """The same from i_c and theta_w in deg/s."""
        return cls(tau_s=tau_s, i_c=math.radians(i_c_deg_s), theta_w=math.radians(theta_w_deg_s))

    @classmethod
    def basic(cls, i_c: float = math.radians(0.007)) -> HdrParams:
        """The basic controller of section 2 (Eq. 4 and 5): no filters and no attenuator."""
        return cls(tau_s=0.0, i_c=i_c, theta_w=math.inf)

    def erased_radius(self, speed: float) -> float:
        """Radius (m) beyond which an arc walked at `speed` (m/s) is taken for drift and straightened."""
        return speed / self.theta_w


NOTHING = HdrParams(tau_s=0.0, i_c=0.0, theta_w=math.inf)  # leaves every heading as it is


class HdrSets(NamedTuple):
    """Many parameter sets as columns, each (s,), as in `HdrParams`."""

    tau_s: np.ndarray
    i_c: np.ndarray
    theta_w: np.ndarray

    @classmethod
    def of(cls, params: Sequence[HdrParams]) -> HdrSets:
        """The columns of parameter sets."""
        return cls(*np.array([(one.tau_s, one.i_c, one.theta_w) for one in params], dtype=float).T)


class Footfall(NamedTuple):
    """What one update needs: T_i (s) and the raw rate raw_i (rad/s)."""

    interval: float
    rate: float


class HdrStep(NamedTuple):
    """HDR's state after a footfall, in the order of the equations. Rates in rad/s.

    raw : Eq. 2; once, twice : Eq. 6a, 6b; attenuator : A, Eq. 7; integrator : I, Eq. 8;
    rate : w, Eq. 9, which is fed back; partly, delagged : Eq. 10a, 10b; heading : Eq. 11, rad
    """

    raw: float = 0.0
    once: float = 0.0
    twice: float = 0.0
    attenuator: float = 1.0
    integrator: float = 0.0
    rate: float = 0.0
    partly: float = 0.0
    delagged: float = 0.0
    heading: float = 0.0


class HdrTrace(NamedTuple):
    """The columns of `HdrStep` for a whole walk, each (n,); row 0 is the start."""

    raw: np.ndarray
    once: np.ndarray
    twice: np.ndarray
    attenuator: np.ndarray
    integrator: np.ndarray
    rate: np.ndarray
    partly: np.ndarray
    delagged: np.ndarray
    heading: np.ndarray


def step(before: HdrStep, footfall: Footfall, params: HdrParams) -> HdrStep:
    """One footfall of HDR, Eq. 6-11.

    Raises
    ------
    InputError
        The interval is not positive.
    """
    interval, raw = footfall
    if not interval > 0:
        raise InputError(f"hdr: interval of {interval} s between two footfalls, expected a positive one")
    tau = params.tau_s
    once = (raw * interval + tau * before.once) / (interval + tau)  # Eq. 6a
    twice = (once * interval + tau * before.twice) / (interval + tau)  # Eq. 6b
    attenuator = max(0.0, 1.0 - abs(before.rate) / params.theta_w)  # Eq. 7
    sign = 1.0 if before.rate > 0 else (-1.0 if before.rate < 0 else 0.0)
    integrator = before.integrator - attenuator * sign * params.i_c  # Eq. 8
    rate = twice + integrator  # Eq. 9
    lag = tau / interval
    partly = rate + lag * (rate - before.rate)  # Eq. 10a
    delagged = partly + lag * (partly - before.partly)  # Eq. 10b
    heading = before.heading + delagged * interval  # Eq. 11, without the paper's psi_0
    return HdrStep(raw, once, twice, attenuator, integrator, rate, partly, delagged, heading)


class Hdr:
    """HDR footfall by footfall, as it would run on a walking person.

    Attributes
    ----------
    params : the controller's constants
    state : after the latest footfall
    """

    def __init__(self, params: HdrParams | None = None, heading: float = 0.0) -> None:
        """Start at `heading` (rad) with every filter at zero."""
        self.params = params or HdrParams()
        self.state = HdrStep(heading=heading)

    def update(self, footfall: Footfall) -> HdrStep:
        """Take the next footfall and return the new state."""
        self.state = step(self.state, footfall, self.params)
        return self.state


def trace(footfalls: Footfalls, params: HdrParams | None = None) -> HdrTrace:
    """HDR over a whole walk, with everything that it computed on the way."""
    controller = Hdr(params, float(footfalls.heading[0]))
    strides = zip(footfalls.interval[1:].tolist(), footfalls.rate[1:].tolist(), strict=True)
    steps = [controller.state] + [controller.update(Footfall(*stride)) for stride in strides]
    return HdrTrace(*np.array(steps).T)


def headings(walks: Sequence[Footfalls], params: Sequence[HdrParams]) -> list[np.ndarray]:
    """HDR's headings for every walk and every parameter set, compiled.

    The same numbers as `trace(walk, set).heading`; the walks may differ in length.

    Parameters
    ----------
    walks : w walks of n_1 .. n_w footfalls
    params : s parameter sets; those that share tau_s share the filters

    Returns
    -------
    list of w arrays (s, n_i) rad
    """
    i_c = np.array([p.i_c for p in params])
    theta_w = np.array([p.theta_w for p in params])
    tau = np.array([p.tau_s for p in params])
    groups = [(float(value), np.flatnonzero(tau == value)) for value in np.unique(tau)]
    result = []
    for walk in walks:
        if not (walk.interval[1:] > 0).all():
            raise InputError("hdr: an interval between two footfalls is not positive")
        raw, interval = np.ascontiguousarray(walk.rate), np.ascontiguousarray(walk.interval)
        out = np.empty((len(params), len(walk)))
        for value, members in groups:
            twice = _kernels.filter_twice(raw, interval, value)
            psi = _kernels.control(
                twice, interval, float(walk.heading[0]), value, i_c[members], theta_w[members]
            )
            out[members] = psi.T
        result.append(out)
    return result


def heading_errors(
    rest: np.ndarray,
    interval: np.ndarray,
    true: np.ndarray,
    start: float,
    sets: HdrSets,
    causes: np.ndarray | None = None,
    weights: np.ndarray | None = None,
) -> np.ndarray:
    """How far HDR's headings are off the truth, for many raw rates and parameter sets at once, compiled.

    Without causes these are the errors of `headings`; `NOTHING` gives those of dead reckoning.

    Parameters
    ----------
    rest, interval, true : (n,) rad/s, s and rad: of each footfall the raw rate, T_i and the true heading
    start : rad, the first heading
    sets : s parameter sets
    causes : (c, n) rad/s, parts of the raw rate that are added to `rest`, each with its own weight
    weights : (c, s) of each cause under each set

    Returns
    -------
    (s, 2) rad, the absolute heading error: mean over the footfalls, and at the last one
    """
    if not (interval[1:] > 0).all():
        raise InputError("hdr: an interval between two footfalls is not positive")
    if causes is None or weights is None:
        causes, weights = np.empty((0, len(rest))), np.empty((0, len(sets.tau_s)))
    arrays = (rest, causes, weights, interval, true)
    columns = (np.ascontiguousarray(column, dtype=float) for column in sets)
    made: np.ndarray = _kernels.heading_errors(*map(np.ascontiguousarray, arrays), float(start), *columns)
    return made
