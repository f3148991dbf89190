"""Methods with a mistake in them, which a gate must find."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np

from footfall.hdr.hdr import HdrParams
from footfall.hdr.method import Method
from footfall.hdr.tracks import Reckoning, hdr_track, pdr_track
from footfall.pdr.reckoning import dead_reckon
from footfall.pdr.track import Track


def long_strides(reckoning: Reckoning, params: HdrParams) -> Track:
    """HDR that takes each stride's time for 2 % longer than it is."""
    feet = reckoning.footfalls
    return hdr_track(replace(feet, interval=1.02 * feet.interval), params)


def wrong_sign(reckoning: Reckoning, params: HdrParams) -> Track:
    """HDR with the sign of A changed in Eq. 8: the integrator drives the drift on."""
    turned: Any = SimpleNamespace(tau_s=params.tau_s, i_c=-params.i_c, theta_w=params.theta_w)
    return hdr_track(reckoning.footfalls, turned)


def kept_bias(reckoning: Reckoning, _: None) -> Track:
    """Dead reckoning that does not remove the static bias."""
    rest = replace(reckoning.detected.rest, gyro_bias=np.zeros(3))
    found = replace(reckoning.detected, rest=rest)
    return pdr_track(dead_reckon(reckoning.recording, reckoning.pdr, reckoning.start, found))


def no_tilt_gain(reckoning: Reckoning, _: None) -> Track:
    """Dead reckoning that corrects no tilt."""
    return pdr_track(replace(reckoning, pdr=replace(reckoning.pdr, tilt_gain=0.0)).footfalls)


def _defective(run: Callable[[Reckoning, Any], Track], params: Any = None) -> Method:
    return Method(run.__name__.replace("_", "-"), str(run.__doc__), run, params)


# Each with the sound method that it is gated against.
DEFECTS = (
    (_defective(long_strides, HdrParams()), "hdr"),
    (_defective(wrong_sign, HdrParams()), "hdr"),
    (_defective(kept_bias), "pdr"),
    (_defective(no_tilt_gain), "pdr"),
)
