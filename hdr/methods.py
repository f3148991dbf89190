"""Methods by name: built in, and those of others."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Any

from footfall.errors import InputError
from footfall.hdr.command import command_method
from footfall.hdr.directions import DirectionParams
from footfall.hdr.hde import Hde, Hde2010Params, HdeParams
from footfall.hdr.hdr import HdrParams
from footfall.hdr.hypotheses.params import HypothesesParams
from footfall.hdr.hypotheses.track import hypotheses_track, smoothed_track
from footfall.hdr.ihde import Ihde, IhdeParams
from footfall.hdr.ihde_plus import IhdePlus, IhdePlusParams
from footfall.hdr.jimenez import FilterHdr, FilterHdrParams, Jimenez, JimenezParams
from footfall.hdr.method import Method, Needs
from footfall.hdr.others import FORMS, adapted, entry_point_names, load
from footfall.hdr.tracks import (
    UNTOLD,
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
from footfall.settings import did_you_mean


def _learned(reckoning: Reckoning, own: DirectionParams) -> DirectionParams:
    """The method's own dominant directions; as many as it is told, where it says nothing else."""
    count = own.count if own.count != UNTOLD.count else reckoning.directions.count
    return replace(own, count=count)


def _counted(reckoning: Reckoning, own: DirectionParams) -> DirectionParams:
    """The same, with one of them: its own, or that it is told, or that in which the walk sets out."""
    known = (own.reference, reckoning.directions.reference)
    reference = next((one for one in known if one is not None), None)
    reference = reckoning.setting_out if reference is None else reference
    return replace(_learned(reckoning, own), reference=reference)


def _with(params: Any, reckoning: Reckoning) -> Any:
    return replace(params, directions=_counted(reckoning, params.directions))


def on_papers_filter(reckoning: Reckoning) -> Reckoning:
    """The same recording with the paper's detector, the GLRT (Deng et al. 2018, Eq. 14 to 19)."""
    return replace(reckoning, pdr=replace(reckoning.pdr, detector=Shoe()))


def _pdr(reckoning: Reckoning, _: None) -> Track:
    return pdr_track(reckoning.footfalls)


def _hdr(reckoning: Reckoning, params: HdrParams) -> Track:
    return hdr_track(reckoning.footfalls, params)


def _hypotheses(reckoning: Reckoning, params: HypothesesParams) -> Track:
    return hypotheses_track(reckoning.footfalls, params)


def _hypotheses_smooth(reckoning: Reckoning, params: HypothesesParams) -> Track:
    return smoothed_track(reckoning.footfalls, params)


def _iez(reckoning: Reckoning, settings: FilterSettings) -> Track:
    return iez_track(reckoning, settings, name="iez")


def _iez_paper(reckoning: Reckoning, settings: FilterSettings) -> Track:
    return iez_track(on_papers_filter(reckoning), settings, name="iez-paper")


def _hdr_filter(reckoning: Reckoning, params: FilterHdrParams) -> Track:
    return corrected_track(reckoning, FilterHdr(params), name="hdr-filter")


def _hde_2010(reckoning: Reckoning, params: Hde2010Params) -> Track:
    return hde_2010_track(reckoning.footfalls, _with(params, reckoning))


def _hde(reckoning: Reckoning, params: HdeParams) -> Track:
    return corrected_track(reckoning, Hde(_with(params, reckoning)), name="hde")


def _ihde(reckoning: Reckoning, params: IhdeParams) -> Track:
    return corrected_track(reckoning, Ihde(_with(params, reckoning)), name="ihde")


def _ihde_learned(reckoning: Reckoning, params: IhdeParams) -> Track:
    learning = replace(params, directions=_learned(reckoning, params.directions))
    return corrected_track(reckoning, Ihde(learning), name="ihde-learned")


def _jimenez(reckoning: Reckoning, params: JimenezParams) -> Track:
    return corrected_track(reckoning, Jimenez(_with(params, reckoning)), name="ihde-jimenez")


def _ihde_plus(reckoning: Reckoning, params: IhdePlusParams) -> Track:
    return corrected_track(reckoning, IhdePlus(_with(params, reckoning)), name="ihde-plus")


def _hde_paper(reckoning: Reckoning, params: HdeParams) -> Track:
    given = on_papers_filter(reckoning)
    return corrected_track(given, Hde(_with(params, given)), FilterSettings.paper(), name="hde-paper")


def _ihde_paper(reckoning: Reckoning, params: IhdeParams) -> Track:
    given = on_papers_filter(reckoning)
    return corrected_track(given, Ihde(_with(params, given)), FilterSettings.paper(), name="ihde-paper")


METHODS: Mapping[str, Method] = MappingProxyType(
    {
        method.name: method
        for method in (
            Method("pdr", "dead reckoning; heading from the gyro alone", _pdr, needs="footfalls"),
            Method(
                "hdr", "Heuristic Drift Reduction (2008), section 3", _hdr, HdrParams(), needs="footfalls"
            ),
            Method(
                "hdr-basic",
                "Heuristic Drift Reduction, the basic controller of section 2",
                _hdr,
                HdrParams.basic(),
                needs="footfalls",
            ),
            Method(
                "hypotheses",
                "straight, curve or turn, with a physical drift: a filter over hypotheses",
                _hypotheses,
                HypothesesParams(),
                needs="footfalls",
            ),
            Method(
                "hypotheses-smooth",
                "hypotheses with hindsight: what the whole walk says of every footfall",
                _hypotheses_smooth,
                HypothesesParams(),
                needs="footfalls",
            ),
            Method(
                "iez",
                "error-state filter, zero velocity once a stance; heading from the gyro alone",
                _iez,
                FilterSettings(),
            ),
            Method(
                "iez-paper",
                "IEZ as in Deng et al. (2018): zero velocity at every sample that is still by the GLRT",
                _iez_paper,
                FilterSettings.paper(),
            ),
            Method(
                "hdr-filter",
                "iez, and no turn where the heading hardly changes (Jimenez 2010)",
                _hdr_filter,
                FilterHdrParams(),
            ),
            Method(
                "hde-2010",
                "Heuristic Drift Elimination (2010) after pdr: stepwise towards dominant directions",
                _hde_2010,
                Hde2010Params(directions=UNTOLD),
                needs="footfalls",
                directions="all",
            ),
            Method(
                "hde",
                "iez, and always the nearest dominant direction for the heading",
                _hde,
                HdeParams(directions=UNTOLD),
                directions="all",
            ),
            Method(
                "ihde",
                "iez, and IHDE (Deng et al. 2018): dominant directions or the mean heading, on straights",
                _ihde,
                IhdeParams(directions=UNTOLD),
                directions="all",
            ),
            Method(
                "ihde-learned",
                "ihde with directions learned from the walk, and no mean heading",
                _ihde_learned,
                IhdeParams(fallback=False, directions=UNTOLD),
                directions="count",
            ),
            Method(
                "ihde-jimenez",
                "iez, and iHDE (Jimenez 2011): dominant directions on straights, trusted by their nearness",
                _jimenez,
                JimenezParams(directions=UNTOLD),
                directions="all",
            ),
            Method(
                "ihde-plus",
                "iez, and IHDE+: dominant directions as far as straight and direction are likely",
                _ihde_plus,
                IhdePlusParams(directions=UNTOLD),
                directions="all",
            ),
            Method(
                "hde-paper",
                "hde on the filter of iez-paper",
                _hde_paper,
                HdeParams(directions=UNTOLD),
                directions="all",
            ),
            Method(
                "ihde-paper",
                "ihde on the filter of iez-paper",
                _ihde_paper,
                IhdeParams(directions=UNTOLD),
                directions="all",
            ),
        )
    }
)


def find_method(
    use: str | Method | Callable[..., Any] | None = None,
    *,
    name: str | None = None,
    params: Any = None,
    command: Sequence[str] | None = None,
    format: str = "f64",
    timeout_s: float = 60.0,
    needs: Needs | None = None,
) -> Method:
    """A method, built in or of others.

    Parameters
    ----------
    use : the name of one that is built in or of an entry point of the group `footfall.methods`;
        `package.module:NAME` or `file.py:NAME`; a `Method`; or a callable, a dataclass with `__call__` or
        its class (`footfall.hdr.others`)
    name : what it is called; None for its own
    params : values by name, or the dataclass itself, in place of its defaults
    command, format, timeout_s : in place of `use`, a program (`footfall.hdr.command.Command`)
    needs : what a callable is given first; None for its attribute `needs`, or "samples"

    Raises
    ------
    InputError
        No such method, one that cannot be loaded, or that is none; parameters that it refuses.
    """
    if command is not None:
        if use is not None:
            raise InputError("a method has either a command or a use, not both", name)
        found = command_method(command, name=name, format=format, timeout_s=timeout_s)
    elif isinstance(use, str) and use in METHODS:
        found = METHODS[use]
    elif isinstance(use, str):
        _require_findable(use)
        found = adapted(load(use), use=use, name=name, needs=needs)
    elif isinstance(use, Method):
        found = use
    else:
        found = adapted(use, name=name, needs=needs)
    found = found if name is None or found.name == name else found.renamed(name)
    if found.version and found.name in METHODS:
        raise InputError(
            f"method name {found.name!r} is that of a built-in one: call yours otherwise", found.use or None
        )
    if params is None:
        return found
    return found.with_params(params) if isinstance(params, Mapping) else replace(found, params=params)


def _require_findable(use: str) -> None:
    """Refuse a text that means nothing, before anything is loaded."""
    if ":" in use or use in entry_point_names():
        return
    if use.endswith(".py"):
        raise InputError(f"say which of its names: {use}:NAME", use)
    known = [*METHODS, *entry_point_names()]
    raise InputError(f"method {use!r} is unknown{did_you_mean(use, [*known, FORMS])}")


def told_directions(method: str | Method, directions: int | None, reference: float | None) -> DirectionParams:
    """The dominant directions that a method is told: how many, and one of them (rad); None for untold.

    Raises
    ------
    InputError
        The method goes by none or learns what it is told; or there can be no such directions.
    """
    if directions is None and reference is None:
        return UNTOLD
    found = find_method(method)
    if found.directions == "none":
        able = ", ".join(method.name for method in METHODS.values() if method.directions != "none")
        raise InputError(f"method {found.name!r} goes by no dominant directions; these do: {able}")
    if found.directions == "count" and reference is not None:
        raise InputError(
            f"method {found.name!r} learns where its dominant directions are, and cannot be told one"
        )
    return DirectionParams(UNTOLD.count if directions is None else directions, reference)


def tracks(reckoning: Reckoning, methods: Iterable[str | Method]) -> dict[str, Track]:
    """Apply several methods to one recording, which is dead-reckoned once.

    Raises
    ------
    InputError
        No method of that name; or what `dead_reckon` refuses.
    """
    found = [find_method(method) for method in methods]
    origin, pdr, start = reckoning.recording.meta, reckoning.pdr, reckoning.start
    return {method.name: told(method.track(reckoning), origin, pdr, start) for method in found}


def track(
    recording: Recording, method: str | Method, start: StartPose | None = None, pdr: PdrParams | None = None
) -> Track:
    """Apply one method to a recording.

    Raises
    ------
    InputError
        No method of that name; or what `dead_reckon` refuses.
    """
    reckoning = Reckoning(recording, start or StartPose(), pdr or PdrParams())
    (made,) = tracks(reckoning, [method]).values()
    return made
