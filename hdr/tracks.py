"""From a recording to a track: what the methods are made of."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from footfall import __version__
from footfall.hdr.correct import paper_positions as eq_12
from footfall.hdr.correct import turned_positions
from footfall.hdr.directions import DirectionParams
from footfall.hdr.filtered import filter_track
from footfall.hdr.hde import HDE_2010_UNITS, Hde2010Params, hde_2010
from footfall.hdr.hdr import HdrParams, trace
from footfall.identity import plain
from footfall.pdr.filter.ins import FilterSettings
from footfall.pdr.filter.run import Corrector, Filtered, Step, run_filter
from footfall.pdr.footfalls import Footfalls
from footfall.pdr.reckoning import Detected, PdrParams, StartPose, dead_reckon, detect
from footfall.pdr.track import Track
from footfall.recording import Recording

SETTING_OUT = 5.0  # m; sooner, the first strides' swaying counts, later the drift
UNTOLD = DirectionParams(reference=None)

# A plain dict: tracks travel between processes, and a mapping proxy cannot be pickled.
HDR_UNITS: Mapping[str, str] = {
    "raw_rate": "rad/s",
    "rate_once": "rad/s",
    "rate_twice": "rad/s",
    "attenuator": "",
    "integrator": "rad/s",
}


@dataclass(frozen=True)
class Reckoning:
    """A recording, where it starts, and its footfalls, computed once for all the methods that ask.

    Attributes
    ----------
    directions : dominant directions, for methods that use them; without a reference, one of them is that in
        which the walk sets out
    guided : settings of the filter under a heading method that names no filter of its own
    """

    recording: Recording
    start: StartPose = field(default_factory=StartPose)
    pdr: PdrParams = field(default_factory=PdrParams)
    directions: DirectionParams = UNTOLD
    guided: FilterSettings = field(default_factory=FilterSettings)

    @cached_property
    def footfalls(self) -> Footfalls:
        """Dead reckoning of the recording."""
        return dead_reckon(self.recording, self.pdr, self.start, self.detected)

    @cached_property
    def setting_out(self) -> float:
        """Direction in which the first 5 m of the walk lead (rad)."""
        x, y = (self.footfalls.position[:, :2] - self.footfalls.position[0, :2]).T
        far = np.hypot(x, y) >= SETTING_OUT
        row = int(np.argmax(far)) if far.any() else -1
        return math.atan2(y[row], x[row])

    @cached_property
    def detected(self) -> Detected:
        """When the foot is at rest."""
        return detect(self.recording, self.pdr)

    def filtered(self, settings: FilterSettings, corrector: Corrector | None = None) -> Filtered:
        """The error-state filter over the recording, with a heading method or without."""
        return run_filter(self.recording, settings, self.pdr, self.start, corrector, found=self.detected)


def told(track: Track, origin: Mapping[str, Any], pdr: PdrParams, start: StartPose) -> Track:
    """`track`, which tells what it was made of and how.

    Parameters
    ----------
    origin : the recording's own metadata: which walk, unit, noise
    pdr, start : as of `Reckoning`
    """
    settings, detector = plain(pdr), {"kind": type(pdr.detector).__name__}
    if isinstance(settings["detector"], dict):
        detector |= settings["detector"]
    made = {"pdr": settings | {"detector": detector}, "start": start.as_dict()}
    return replace(track, meta={**origin, **track.meta, **made})


def pdr_track(footfalls: Footfalls) -> Track:
    """Dead reckoning as it is: position and heading without any heading correction."""
    return Track(
        t=footfalls.t,
        position=footfalls.position,
        heading=footfalls.heading,
        meta={"method": "pdr", "version": __version__},
    )


def hdr_track(
    footfalls: Footfalls, params: HdrParams | None = None, *, name: str = "hdr", paper_positions: bool = False
) -> Track:
    """HDR's heading and the track turned by it.

    Parameters
    ----------
    params : `HdrParams.basic()` for the controller of the paper's section 2
    name : of the method, for the track's provenance
    paper_positions : positions by the paper's Eq. 12 instead of turned displacements

    Returns
    -------
    Track
        Evidence: raw rate, the rate filtered once and twice, attenuator A and integrator I.
    """
    params = params or HdrParams()
    found = trace(footfalls, params)
    columns = (found.raw, found.once, found.twice, found.attenuator, found.integrator)
    return Track(
        t=footfalls.t,
        position=(eq_12 if paper_positions else turned_positions)(footfalls, found.heading),
        heading=found.heading,
        evidence=dict(zip(HDR_UNITS, columns, strict=True)),
        units=HDR_UNITS,
        meta={
            "method": name,
            "version": __version__,
            "params": plain(params),
            "paper_positions": paper_positions,
        },
    )


def iez_track(reckoning: Reckoning, settings: FilterSettings, *, name: str) -> Track:
    """The error-state filter by itself: zero-velocity updates, no heading correction."""
    return filter_track(reckoning.filtered(settings), settings, name=name)


def hde_2010_track(footfalls: Footfalls, params: Hde2010Params | None = None) -> Track:
    """HDE's controller of 2010 on dead reckoning's headings, and the track turned by it.

    Returns
    -------
    Track
        Evidence: deviation from the nearest direction, attenuator A and correction C.
    """
    params = params or Hde2010Params()
    found = hde_2010(footfalls, params)
    return Track(
        t=footfalls.t,
        position=turned_positions(footfalls, found.heading),
        heading=found.heading,
        evidence=dict(zip(HDE_2010_UNITS, found[:3], strict=True)),
        units=HDE_2010_UNITS,
        meta={"method": "hde-2010", "version": __version__, "params": plain(params)},
    )


class HeadingMethod(Protocol):
    """A corrector of the filter that keeps a record: one row of evidence a footfall, named as in `units`."""

    params: Any
    units: Mapping[str, str]
    rows: list[Any]

    def __call__(self, step: Step) -> tuple[float, float] | None: ...


def corrected_track(
    reckoning: Reckoning, corrector: HeadingMethod, settings: FilterSettings | None = None, *, name: str
) -> Track:
    """The error-state filter with a heading method in it, which is asked once a footfall.

    Parameters
    ----------
    corrector : a new one; it remembers what it was asked
    settings : of the filter; None for `reckoning.guided`
    name : of the method, for the track's provenance

    Returns
    -------
    Track
        Evidence: the filter's and, in the method's own `units`, what it saw and did.
    """
    settings = settings or reckoning.guided
    filtered = reckoning.filtered(settings, corrector)
    evidence = dict(zip(corrector.units, np.array(corrector.rows, dtype=float).T, strict=True))
    track = filter_track(filtered, settings, name=name, evidence=evidence, units=corrector.units)
    return replace(track, meta={**track.meta, "params": plain(corrector.params)})
