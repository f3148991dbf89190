"""Methods with a mistake in them, which a gate must find."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from types import SimpleNamespace
from typing import Any

import numpy as np

from footfall.hdr.hdr import HdrParams
from footfall.hdr.method import Method
from footfall.hdr.methods import METHODS
from footfall.hdr.tracks import Reckoning, hdr_track
from footfall.pdr.track import Track

AT_REST = HdrParams(i_c=0.0)  # a controller that does nothing


@dataclass(frozen=True)
class Defect:
    """A mistake.

    Attributes
    ----------
    methods : by the names that the gates of the closed loop know, with the mistake in them
    found_by : which of those gates fails
    paired : keys of a gate that finds it against the sound method of the same name, in few cases
    """

    name: str
    methods: Mapping[str, Method]
    found_by: str
    paired: Mapping[str, str] = field(default_factory=dict)


def long_strides(reckoning: Reckoning, params: HdrParams) -> Track:
    """HDR that takes each stride's time for 2 % longer than it is."""
    feet = reckoning.footfalls
    return hdr_track(replace(feet, interval=1.02 * feet.interval), params)


def wrong_sign(reckoning: Reckoning, params: HdrParams) -> Track:
    """HDR with the sign of A changed in Eq. 8: the integrator drives the drift on."""
    turned: Any = SimpleNamespace(tau_s=params.tau_s, i_c=-params.i_c, theta_w=params.theta_w)
    return hdr_track(reckoning.footfalls, turned)


def kept_bias(reckoning: Reckoning) -> Reckoning:
    """Dead reckoning that does not remove the static bias."""
    rest = replace(reckoning.detected.rest, gyro_bias=np.zeros(3))
    spoilt = replace(reckoning)
    vars(spoilt)["detected"] = replace(reckoning.detected, rest=rest)  # in place of what it would find
    return spoilt


def no_tilt_gain(reckoning: Reckoning) -> Reckoning:
    """Dead reckoning that corrects no tilt."""
    return replace(reckoning, pdr=replace(reckoning.pdr, tilt_gain=0.0))


def _of_spoilt(
    method: Method, spoil: Callable[[Reckoning], Reckoning], reckoning: Reckoning, params: Any
) -> Track:
    return method.run(spoil(reckoning), params)


def _dead_reckoning(spoil: Callable[[Reckoning], Reckoning]) -> dict[str, Method]:
    """A mistake in dead reckoning is one in all that stands on it."""
    sound = {name: METHODS[name] for name in ("pdr", "hdr")}
    sound["hdr-at-rest"] = replace(METHODS["hdr"], params=AT_REST)
    return {
        name: replace(method, run=partial(_of_spoilt, method, spoil), needs="samples")
        for name, method in sound.items()
    }


def _hdr(run: Callable[[Reckoning, Any], Track]) -> dict[str, Method]:
    hdr = replace(METHODS["hdr"], run=run)
    return {"hdr": hdr, "hdr-at-rest": replace(hdr, params=AT_REST)}


DEFECTS = (
    Defect(
        "a stride time 2 % too long",
        _hdr(long_strides),
        "HDR at rest is dead reckoning",
        {"method": "hdr-at-rest", "statistic": "same"},
    ),
    Defect("the sign of A", _hdr(wrong_sign), "HDR keeps half of the units under 18 deg", {"method": "hdr"}),
    Defect(
        "a bias that is not removed",
        _dead_reckoning(kept_bias),
        "dead reckoning drifts no more than its sheet explains",
        {"method": "pdr"},
    ),
    Defect(
        "tilt_gain 0",
        _dead_reckoning(no_tilt_gain),
        "dead reckoning knows its distance",
        {"method": "pdr", "metric": "distance_error_pct"},
    ),
)
