"""Methods by name: ways from a recording to a track."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass, field
from functools import cached_property
from types import MappingProxyType

from footfall import __version__
from footfall.errors import InputError
from footfall.hdr.correct import paper_positions as eq_12
from footfall.hdr.correct import turned_positions
from footfall.hdr.filtered import filter_track
from footfall.hdr.hdr import HdrParams, trace
from footfall.pdr.filtering import Corrector, Filtered, run_filter
from footfall.pdr.footfalls import Footfalls
from footfall.pdr.ins import FilterSettings
from footfall.pdr.pdr import Detected, PdrParams, StartPose, dead_reckon, detect
from footfall.pdr.track import Track
from footfall.recording import Recording

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
    """A recording, where it starts, and its footfalls, computed once for all the methods that ask."""

    recording: Recording
    start: StartPose = field(default_factory=StartPose)
    pdr: PdrParams = field(default_factory=PdrParams)

    @cached_property
    def footfalls(self) -> Footfalls:
        """Dead reckoning of the recording."""
        return dead_reckon(self.recording, self.pdr, self.start, self.detected)

    @cached_property
    def detected(self) -> Detected:
        """When the foot is at rest."""
        return detect(self.recording, self.pdr)

    def filtered(self, settings: FilterSettings, corrector: Corrector | None = None) -> Filtered:
        """The error-state filter over the recording, with a heading method or without."""
        return run_filter(self.recording, settings, self.pdr, self.start, corrector, found=self.detected)


@dataclass(frozen=True)
class Method:
    """A named way from recording to track.

    Attributes
    ----------
    name : as in `METHODS`
    description : one line for people
    run : makes the track; takes footfalls or samples from the `Reckoning`, whichever it needs
    """

    name: str
    description: str
    run: Callable[[Reckoning], Track]


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
    settings = {key: value for key, value in asdict(params).items() if math.isfinite(value)}
    return Track(
        t=footfalls.t,
        position=(eq_12 if paper_positions else turned_positions)(footfalls, found.heading),
        heading=found.heading,
        evidence=dict(zip(HDR_UNITS, columns, strict=True)),
        units=HDR_UNITS,
        meta={"method": name, "version": __version__, "params": settings, "paper_positions": paper_positions},
    )


def iez_track(reckoning: Reckoning, settings: FilterSettings, *, name: str) -> Track:
    """The error-state filter by itself: zero-velocity updates, no heading correction."""
    return filter_track(reckoning.filtered(settings), settings, name=name)


METHODS: Mapping[str, Method] = MappingProxyType(
    {
        method.name: method
        for method in (
            Method("pdr", "dead reckoning; heading from the gyro alone", lambda r: pdr_track(r.footfalls)),
            Method("hdr", "Heuristic Drift Reduction (2008), section 3", lambda r: hdr_track(r.footfalls)),
            Method(
                "hdr-basic",
                "Heuristic Drift Reduction, the basic controller of section 2",
                lambda r: hdr_track(r.footfalls, HdrParams.basic(), name="hdr-basic"),
            ),
            Method(
                "iez",
                "error-state filter, zero velocity once a stance; heading from the gyro alone",
                lambda r: iez_track(r, FilterSettings(), name="iez"),
            ),
            Method(
                "iez-paper",
                "IEZ as in Deng et al. (2018): zero velocity at every still sample",
                lambda r: iez_track(r, FilterSettings.paper(), name="iez-paper"),
            ),
        )
    }
)


def require_methods(names: Iterable[str]) -> None:
    """Raise InputError when a method of any of these names does not exist."""
    for name in names:
        if name not in METHODS:
            raise InputError(f"method {name!r} is unknown, expected one of {', '.join(METHODS)}")


def tracks(reckoning: Reckoning, methods: Iterable[str]) -> dict[str, Track]:
    """Apply several methods to one recording, which is dead-reckoned once.

    Raises
    ------
    InputError
        No method of that name; or what `dead_reckon` refuses.
    """
    names = list(methods)
    require_methods(names)
    return {name: METHODS[name].run(reckoning) for name in names}


def track(
    recording: Recording, method: str, start: StartPose | None = None, pdr: PdrParams | None = None
) -> Track:
    """Apply one method to a recording.

    Raises
    ------
    InputError
        No method of that name; or what `dead_reckon` refuses.
    """
    reckoning = Reckoning(recording, start or StartPose(), pdr or PdrParams())
    return tracks(reckoning, [method])[method]
