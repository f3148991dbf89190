"""Methods by name: ways from a recording to a track."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Literal

from footfall.errors import InputError
from footfall.hdr.directions import DirectionParams
from footfall.hdr.hde import Hde, Hde2010Params, HdeParams
from footfall.hdr.hdr import HdrParams
from footfall.hdr.ihde import Ihde, IhdeParams
from footfall.hdr.ihde_plus import IhdePlus, IhdePlusParams
from footfall.hdr.jimenez import FilterHdr, Jimenez, JimenezParams
from footfall.hdr.tracks import (
    UNTOLD,
    HeadingMethod,
    Reckoning,
    corrected_track,
    hde_2010_track,
    hdr_track,
    iez_track,
    pdr_track,
    told,
)
from footfall.pdr.detectors import Shoe
from footfall.pdr.filter.ins import FilterSettings
from footfall.pdr.reckoning import PdrParams, StartPose
from footfall.pdr.track import Track
from footfall.recording import Recording


@dataclass(frozen=True)
class Method:
    """A named way from recording to track.

    Attributes
    ----------
    name : as in `METHODS`
    description : one line for people
    run : makes the track; takes footfalls or samples from the `Reckoning`, whichever it needs
    directions : which of its dominant directions can be told: "none" goes by none, "count" learns where they
        are, "all" takes their number and one of them
    """

    name: str
    description: str
    run: Callable[[Reckoning], Track]
    directions: Literal["none", "count", "all"] = "none"


def _counted(reckoning: Reckoning) -> DirectionParams:
    """Dominant directions, counted from that in which the walk sets out unless they are told."""
    told = reckoning.directions
    return told if told.reference is not None else replace(told, reference=reckoning.setting_out)


def _hde(reckoning: Reckoning) -> Hde:
    return Hde(HdeParams(directions=_counted(reckoning)))


def _ihde(reckoning: Reckoning) -> Ihde:
    return Ihde(IhdeParams(directions=_counted(reckoning)))


def _learning(reckoning: Reckoning) -> Ihde:
    return Ihde(IhdeParams(fallback=False, directions=replace(reckoning.directions, reference=None)))


def _jimenez(reckoning: Reckoning) -> Jimenez:
    return Jimenez(JimenezParams(directions=_counted(reckoning)))


def _plus(reckoning: Reckoning) -> IhdePlus:
    return IhdePlus(IhdePlusParams(directions=_counted(reckoning)))


def on_papers_filter(reckoning: Reckoning) -> Reckoning:
    """The same recording with the paper's detector, the GLRT (Deng et al. 2018, Eq. 14 to 19)."""
    return replace(reckoning, pdr=replace(reckoning.pdr, detector=Shoe()))


def _by_paper(reckoning: Reckoning, method: Callable[[Reckoning], HeadingMethod], *, name: str) -> Track:
    given = on_papers_filter(reckoning)
    return corrected_track(given, method(given), FilterSettings.paper(), name=name)


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
                "IEZ as in Deng et al. (2018): zero velocity at every sample that is still by the GLRT",
                lambda r: iez_track(on_papers_filter(r), FilterSettings.paper(), name="iez-paper"),
            ),
            Method(
                "hdr-filter",
                "iez, and no turn where the heading hardly changes (Jimenez 2010)",
                lambda r: corrected_track(r, FilterHdr(), name="hdr-filter"),
            ),
            Method(
                "hde-2010",
                "Heuristic Drift Elimination (2010) after pdr: stepwise towards dominant directions",
                lambda r: hde_2010_track(r.footfalls, Hde2010Params(directions=_counted(r))),
                directions="all",
            ),
            Method(
                "hde",
                "iez, and always the nearest dominant direction for the heading",
                lambda r: corrected_track(r, _hde(r), name="hde"),
                directions="all",
            ),
            Method(
                "ihde",
                "iez, and IHDE (Deng et al. 2018): dominant directions or the mean heading, on straights",
                lambda r: corrected_track(r, _ihde(r), name="ihde"),
                directions="all",
            ),
            Method(
                "ihde-learned",
                "ihde with directions learned from the walk, and no mean heading",
                lambda r: corrected_track(r, _learning(r), name="ihde-learned"),
                directions="count",
            ),
            Method(
                "ihde-jimenez",
                "iez, and iHDE (Jimenez 2011): dominant directions on straights, trusted by their nearness",
                lambda r: corrected_track(r, _jimenez(r), name="ihde-jimenez"),
                directions="all",
            ),
            Method(
                "ihde-plus",
                "iez, and IHDE+: dominant directions as far as straight and direction are likely",
                lambda r: corrected_track(r, _plus(r), name="ihde-plus"),
                directions="all",
            ),
            Method(
                "hde-paper",
                "hde on the filter of iez-paper",
                lambda r: _by_paper(r, _hde, name="hde-paper"),
                directions="all",
            ),
            Method(
                "ihde-paper",
                "ihde on the filter of iez-paper",
                lambda r: _by_paper(r, _ihde, name="ihde-paper"),
                directions="all",
            ),
        )
    }
)


def require_methods(names: Iterable[str]) -> None:
    """Raise InputError when a method of any of these names does not exist."""
    for name in names:
        if name not in METHODS:
            raise InputError(f"method {name!r} is unknown, expected one of {', '.join(METHODS)}")


def told_directions(name: str, directions: int | None, reference: float | None) -> DirectionParams:
    """The dominant directions that a method is told: how many, and one of them (rad); None for untold.

    Raises
    ------
    InputError
        The method goes by none or learns what it is told; or there can be no such directions.
    """
    if directions is None and reference is None:
        return UNTOLD
    takes = METHODS[name].directions
    if takes == "none":
        able = ", ".join(method.name for method in METHODS.values() if method.directions != "none")
        raise InputError(f"method {name!r} goes by no dominant directions; these do: {able}")
    if takes == "count" and reference is not None:
        raise InputError(f"method {name!r} learns where its dominant directions are, and cannot be told one")
    return DirectionParams(UNTOLD.count if directions is None else directions, reference)


def tracks(reckoning: Reckoning, methods: Iterable[str]) -> dict[str, Track]:
    """Apply several methods to one recording, which is dead-reckoned once.

    Raises
    ------
    InputError
        No method of that name; or what `dead_reckon` refuses.
    """
    names = list(methods)
    require_methods(names)
    origin, pdr, start = reckoning.recording.meta, reckoning.pdr, reckoning.start
    return {name: told(METHODS[name].run(reckoning), origin, pdr, start) for name in names}


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
