"""From footfalls to a track by the filter over hypotheses."""

from __future__ import annotations

from collections.abc import Mapping

from footfall import __version__
from footfall.hdr.correct import turned_positions
from footfall.hdr.hypotheses.filter import Beliefs, beliefs
from footfall.hdr.hypotheses.params import HypothesesParams
from footfall.hdr.hypotheses.smoother import smoothed
from footfall.identity import plain
from footfall.pdr.footfalls import Footfalls
from footfall.pdr.track import Track

UNITS: Mapping[str, str] = {
    "heading_sd": "rad",
    "straight": "",
    "curve": "",
    "turn": "",
    "drift_rate": "rad/s",
    "second_heading": "rad",
    "second_weight": "",
}


def hypotheses_track(footfalls: Footfalls, params: HypothesesParams | None = None) -> Track:
    """The heading of every footfall as it was known then, and the track turned by it.

    Returns
    -------
    Track
        Evidence: the heading's standard deviation, chances of the modes, the drift's rate, and heading and
        weight of the second opinion (`footfall.hdr.hypotheses.filter.Belief`).
    """
    params = params or HypothesesParams()
    return _track(footfalls, beliefs(footfalls, params), params, "hypotheses")


def smoothed_track(footfalls: Footfalls, params: HypothesesParams | None = None) -> Track:
    """The same with hindsight: every heading as the whole walk tells it.

    Returns
    -------
    Track
        Evidence as of `hypotheses_track`.
    """
    params = params or HypothesesParams()
    return _track(footfalls, smoothed(footfalls, params), params, "hypotheses-smooth")


def _track(footfalls: Footfalls, found: Beliefs, params: HypothesesParams, name: str) -> Track:
    return Track(
        t=footfalls.t,
        position=turned_positions(footfalls, found.heading),
        heading=found.heading,
        evidence={column: getattr(found, column) for column in UNITS},
        units=UNITS,
        meta={"method": name, "version": __version__, "params": plain(params)},
    )
