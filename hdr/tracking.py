"""From a file to a track: whole where it fits into memory, block by block where it does not."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

from footfall.errors import InputError
from footfall.formats.condition import Findings
from footfall.formats.reader import WHOLE_ROWS, Blocks, open_source, read_source
from footfall.hdr.method import Method
from footfall.hdr.methods import find_method, told_directions
from footfall.hdr.streamed import StreamedReckoning
from footfall.hdr.tracks import Reckoning, told
from footfall.pdr.detectors import require_detector
from footfall.pdr.filter.ins import FilterSettings
from footfall.pdr.footfalls import Footfalls
from footfall.pdr.reckoning import PdrParams, StartPose
from footfall.pdr.rest import still_time
from footfall.pdr.stream import dead_reckon_blocks
from footfall.pdr.track import Track
from footfall.settings import changed, did_you_mean


class Tracked(NamedTuple):
    """A track, what was wrong with its recording, and the T_bias (s) that the still start allowed."""

    track: Track
    findings: Findings
    bias_s: float


def track(
    path: str | os.PathLike[str],
    method: str | Method | Callable[..., Any],
    *,
    format: str = "auto",
    sizes: Mapping[str, float] | None = None,
    rate_hz: float | None = None,
    detector: str = "threshold",
    bias_s: float | None = None,
    start: StartPose | None = None,
    heading: float | None = None,
    directions: int | None = None,
    reference: float | None = None,
    values: Mapping[str, Any] | None = None,
) -> Tracked:
    """Navigate a recording of any known format.

    Parameters
    ----------
    method : as `footfall.hdr.methods.find_method` takes it: a name, or anybody's own
    detector : name in `DETECTORS`
    format, sizes, rate_hz : as of `footfall.formats.read`
    bias_s : s, T_bias; None for as long as the recording rests, at most 25
    start : where the IMU rests before the walk; None for what the recording says (`StartPose.of`)
    heading : rad, at the start, in place of the start's own
    directions, reference : dominant directions, for methods that go by them: how many (None for 4), and one
        of them (rad; None for that in which the walk sets out)
    values : address -> value of `pdr`, `filter` and the method's own parameters, as `--set` takes them

    Raises
    ------
    InputError
        No such method or address, or a value that it refuses; directions for a method that goes by none; what
        reading and navigating refuse; or a method that needs all samples, and too many of them.
    """
    chosen, params, guided = _settled(find_method(method), detector, values or {})
    params = params if bias_s is None else replace(params, bias_s=bias_s)
    rest = still_time if bias_s is None and "pdr.bias_s" not in (values or {}) else None
    source = open_source(path, format, sizes, rate_hz)
    start = start or StartPose.of(source.meta)
    start = start if heading is None else replace(start, heading=heading)
    counted = told_directions(chosen, directions, reference)
    used = params.bias_s

    def run_through() -> Footfalls:
        nonlocal used
        footfalls, used = dead_reckon_blocks(blocks, params, start, rest_time=rest)
        return footfalls

    try:
        if source.rows <= WHOLE_ROWS:
            recording, findings = read_source(source)
            if rest is not None:
                used = rest(recording, used)
            params = replace(params, bias_s=used)
            found = chosen.track(Reckoning(recording, start, params, counted, guided))
        else:
            blocks = Blocks(source)
            found = chosen.track(StreamedReckoning(run_through, start, counted))
            findings = blocks.findings
    except InputError as error:
        raise error.about(source.path, "recording") from None
    origin = {**source.meta, "read": findings.as_dict()}
    return Tracked(told(found, origin, replace(params, bias_s=used), start), findings, used)


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
