"""From a file to a track: whole where it fits into memory, block by block where it does not."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from footfall.errors import InputError
from footfall.formats.condition import Findings
from footfall.formats.options import Reading
from footfall.formats.reader import WHOLE_ROWS, Blocks, is_simulated, open_source, read_source
from footfall.formats.samples import Source
from footfall.hdr.method import Method
from footfall.hdr.methods import find_method, told_directions
from footfall.hdr.mount import level_axis
from footfall.hdr.streamed import StreamedReckoning
from footfall.hdr.tracks import Reckoning, told
from footfall.pdr.detectors import require_detector
from footfall.pdr.filter.ins import FilterSettings
from footfall.pdr.filter.run import Corrector, Filtered, run_filter
from footfall.pdr.footfalls import Footfalls
from footfall.pdr.plausibility import (
    Plausibility,
    doubtful_rows,
    judge_track,
    longest_movement,
    spoilt_share,
    velocity_left,
)
from footfall.pdr.reckoning import Detected, PdrParams, StartPose, detect
from footfall.pdr.rest import Rest, still_time
from footfall.pdr.rests import find_rest
from footfall.pdr.stream import dead_reckon_blocks
from footfall.pdr.track import Track
from footfall.settings import changed, did_you_mean

SIMULATED = ("hdr", "threshold")  # method and detector unless others are asked for
REAL = ("iez", "patient")
TOO_LONG = "hdr"  # iez needs all samples


class Tracked(NamedTuple):
    """What navigating a file made of it.

    Attributes
    ----------
    track : the track
    findings : what was wrong with its recording
    bias_s : s, the T_bias that the still start allowed
    plausibility : what the track looks like beside a foot; None of a recording too long to be held
    notes : what a person should know of how it was navigated
    warnings : what is beyond the usual
    """

    track: Track
    findings: Findings
    bias_s: float
    plausibility: Plausibility | None = None
    notes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True)
class RealReckoning(Reckoning):
    """Of a real recording: from the rest that there is, the filter as unsure of the bias as that leaves it.

    Attributes
    ----------
    rest : where the walk begins; None for the still start of `pdr.bias_s`
    """

    rest: Rest | None = None

    @cached_property
    def detected(self) -> Detected:
        """When the foot is at rest."""
        return detect(self.recording, self.pdr, self.rest)

    def filtered(self, settings: FilterSettings, corrector: Corrector | None = None) -> Filtered:
        """The error-state filter over the recording, with a heading method or without."""
        if self.rest is not None and not self.rest.source:
            sd = max(settings.gyro_bias_sd, self.rest.bias_sd)
            settings = replace(settings, gyro_bias_sd=sd)
        return run_filter(self.recording, settings, self.pdr, self.start, corrector, found=self.detected)


def track(
    path: str | os.PathLike[str],
    method: str | Method | Callable[..., Any] | None = None,
    *,
    format: str = "auto",
    sizes: Mapping[str, float] | None = None,
    rate_hz: float | None = None,
    detector: str | None = None,
    bias_s: float | None = None,
    start: StartPose | None = None,
    heading: float | None = None,
    directions: int | None = None,
    reference: float | None = None,
    values: Mapping[str, Any] | None = None,
    reading: Reading | None = None,
) -> Tracked:
    """Navigate a recording of any known format.

    Parameters
    ----------
    path : of the recording, as its logger wrote it
    method : as `footfall.hdr.methods.find_method` takes it: a name, or your own method; None for `hdr` of a
        simulated recording and `iez` of a real one
    format, sizes, rate_hz : as of `footfall.formats.read`
    detector : name in `DETECTORS`; None for `threshold` of a simulated recording and `patient` of a real one
    bias_s : s, T_bias; None for all rests of the recording (`footfall.pdr.rests.find_rest`); of a simulated
        one for as long as it rests at the start, at most 25
    start : where the IMU rests before the walk; None for what the recording says (`StartPose.of`)
    heading : rad, at the start, in place of the start's own
    directions, reference : dominant directions, for methods that use them: how many (None for 4), and one
        of them (rad; None for that in which the walk sets out)
    values : address -> value of `pdr`, `filter` and the method's own parameters, as ``--set`` takes them
    reading : as of `footfall.formats.read`

    Returns
    -------
    Tracked
        `track` is the track, `findings` what was found in the file, `bias_s` the time of the static bias (s),
        `plausibility` that of the track; `notes` and `warnings` are sentences for people.

    Raises
    ------
    InputError
        No such method or address, or a value that it refuses; directions for a method that uses none; what
        reading and navigating refuse; a method that needs all samples, and too many of them; or a track that
        no legs can make.
    """
    reading = reading or Reading()
    values = dict(values or {})
    if method is not None:  # a name that means nothing is said before the file is opened
        method = find_method(method)
    source = open_source(path, format, sizes, rate_hz, reading=reading)
    simulated, long = is_simulated(source.meta), source.rows > WHOLE_ROWS
    usual, finds = SIMULATED if simulated else REAL
    notes: list[str] = []
    if method is None and long:
        usual = TOO_LONG
    chosen, params, guided = _settled(find_method(method or usual), detector or finds, values)
    params = params if bias_s is None else replace(params, bias_s=bias_s)
    if "pdr.max_gap_s" not in values and reading.gap_s > params.max_gap_s:
        params = replace(params, max_gap_s=reading.gap_s)
    free = bias_s is None and "pdr.bias_s" not in values
    start = start or StartPose.of(source.meta)
    start = start if heading is None else replace(start, heading=heading)
    counted = told_directions(chosen, directions, reference)
    if long:
        return _long(
            source, chosen, params, start, counted, free, reading.gap_s, usual if method is None else ""
        )
    try:
        recording, findings = read_source(source, gap_s=reading.gap_s)
        rest = None
        if free and simulated:
            params = replace(params, bias_s=still_time(recording, params.bias_s))
        elif free:
            rest = find_rest(recording, params)
            params = replace(params, bias_s=float(recording.t[rest.last] - recording.t[0]))
            notes.append(rest_told(rest, params.bias_s))
        if not simulated:
            recording, rest, said = level_axis(recording, rest, params)
            notes += said
        given = RealReckoning(recording, start, params, counted, guided, rest)
        found = told(chosen.track(given), {**source.meta, "read": findings.as_dict()}, params, start)
        likely, found = _judged(found, given, findings)
    except InputError as error:
        raise _with_losses(error.about(source.path, "recording"), locals().get("findings")) from None
    warnings = () if simulated else tuple(warned(likely, findings, rest))
    if not simulated and likely.impossible():
        raise _with_losses(InputError(likely.impossible(), source.path), findings)
    return Tracked(found, findings, params.bias_s, likely, tuple(notes), warnings)


def _long(
    source: Source,
    chosen: Method,
    params: PdrParams,
    start: StartPose,
    counted: Any,
    free: bool,
    gap_s: float,
    usual: str,
) -> Tracked:
    """Block by block."""
    blocks, used = Blocks(source, gap_s), params.bias_s

    def run_through() -> Footfalls:
        nonlocal used
        rest = still_time if free else None
        footfalls, used = dead_reckon_blocks(blocks, params, start, rest_time=rest)
        return footfalls

    given = StreamedReckoning(run_through, start, counted)
    try:
        found = chosen.track(given)
    except InputError as error:
        raise error.about(source.path, "recording") from None
    findings = blocks.findings
    likely = _likely(given.footfalls, findings)
    simulated = is_simulated(source.meta)
    if not simulated and likely.impossible():
        raise _with_losses(InputError(likely.impossible(), source.path), findings)
    origin = {**source.meta, "read": findings.as_dict()}
    found = told(found, origin, replace(params, bias_s=used), start)
    found = replace(found, meta={**found.meta, "plausibility": likely.as_dict()})
    notes = (f"too long to be held at once: navigated by {usual}",) if usual else ()
    return Tracked(found, findings, used, likely, notes, () if simulated else tuple(warned(likely, findings)))


def _likely(footfalls: Footfalls, findings: Findings) -> Plausibility:
    """Of a recording that is not held at once, by its footfalls: what velocity is left is not known."""
    strides = footfalls.strides
    movement = np.diff(footfalls.t) if strides is None else strides.moving[1:]
    spoilt = spoilt_share(findings.as_dict())
    return judge_track(footfalls.t, footfalls.position, None, float(movement.max(initial=0.0)), spoilt)


def _judged(track: Track, given: Reckoning, findings: Findings) -> tuple[Plausibility, Track]:
    """The track's plausibility, and the track that tells it and which of its strides are doubtful.

    By dead reckoning, whatever the method makes of it: it tells what the samples say.
    """
    doubtful = doubtful_rows(track.t - given.recording.t[0], findings.doubtful)
    reckoned = given.footfalls
    likely = judge_track(
        reckoned.t,
        reckoned.position,
        velocity_left(given.recording, given.detected, given.pdr),
        longest_movement(given.recording.t, given.detected.score),
        spoilt_share(findings.as_dict()),
        int(doubtful.sum()),
    )
    told: dict[str, Any] = {}
    if given.detected.rest.bias_sd:
        rest = given.detected.rest
        told["rest"] = {
            "from": rest.source or "none",
            "gyro_bias_rad_s": rest.gyro_bias.tolist(),
            "gyro_bias_sd_rad_s": rest.bias_sd,
        }
    likely = replace(likely, height_m=float(track.position[-1, 2] - track.position[0, 2]))
    told["plausibility"] = likely.as_dict()
    track = replace(track, meta={**track.meta, **told})
    if not doubtful.any():
        return likely, track
    return likely, replace(
        track,
        evidence={**track.evidence, "doubtful": doubtful.astype(float)},
        units={**track.units, "doubtful": ""},
    )


def warned(likely: Plausibility, findings: Findings, rest: Rest | None = None) -> list[str]:
    """What is beyond the usual of a track, its recording, and its rests."""
    said = likely.warnings()
    if rest is not None and rest.changed:
        said.append(
            f"the gyros' bias changes by {np.degrees(rest.changed):.2g} deg/s between rests: "
            "headings are as uncertain"
        )
    off = findings.misclosure_g
    if findings.cause:
        said.append(f"turned by its gyros, gravity does not stay vertical: probably {findings.cause}")
    elif off is not None and off > USUAL_MISCLOSURE:
        said.append(
            f"turned by its gyros, gravity stays vertical to {off:.2g} g only, usual are at most "
            f"{USUAL_MISCLOSURE:g}: a unit or an axis may be wrong, samples spoilt, or the mount slips"
        )
    if likely.doubtful:
        said.append(f"{likely.doubtful} strides are doubtful: samples are lost in their swings")
    return said


USUAL_MISCLOSURE = 0.055  # g; right recordings have .01 to .04


def rest_told(rest: Rest, begins_s: float) -> str:
    """Where the static bias comes from and how sure it is, in words."""
    sure = f"known to {np.degrees(rest.bias_sd):.2g} deg/s"
    if not rest.source:
        return (
            "rests nowhere for long enough: no static bias is taken off, "
            f"navigated from t = {begins_s:.3g} s (--bias-time)"
        )
    return f"static bias from {rest.source}, {sure}; navigated from t = {begins_s:.3g} s"


def _with_losses(error: InputError, findings: Findings | None) -> InputError:
    """The same mistake, with what was found lost in the file, which may be its cause."""
    said = [] if findings is None else findings.lost_sentences()
    if not said or "no samples for" not in error.message:
        return error
    return InputError(f"{error.message} ({'; '.join(said)})", error.subject)


def _settled(
    method: Method, detector: str, values: Mapping[str, Any]
) -> tuple[Method, PdrParams, FilterSettings]:
    """The method, dead reckoning's settings and the filter's, with values by address."""
    areas: dict[str, dict[str, Any]] = {"pdr": {}, "filter": {}, method.name: {}}
    for address, value in values.items():
        area, _, path = address.partition(".")
        if area not in areas:
            raise InputError(f"unknown area{did_you_mean(area, areas)}", address)
        areas[area][path] = value
    params = PdrParams(detector=require_detector(str(areas["pdr"].pop("detector", detector))))
    area = "pdr"
    try:
        params = changed(params, areas[area])
        area = "filter"
        guided = changed(FilterSettings(), areas[area])
        area = method.name
        return method.with_params(areas[area]) if areas[area] else method, params, guided
    except InputError as error:
        raise InputError(f"{area}.{error}") from None
