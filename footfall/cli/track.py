"""`footfall track`: from a recording to a track."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

import typer

from footfall.cli.options import (
    ColumnsOption,
    FormatOption,
    OutputOption,
    RateOption,
    SensorOption,
    SetOption,
    UnitOption,
)
from footfall.cli.reading import reading_of
from footfall.cli.terminal import ERR, TABLES, blaming, finite, require_output, say
from footfall.errors import InputError


def track(
    recording: Annotated[
        Path,
        typer.Argument(
            help="A recording, simulated or real, as its logger wrote it (docs/real_recordings.md)."
        ),
    ],
    output: OutputOption,
    method: Annotated[
        str | None,
        typer.Option(
            help="Method: a name (see `footfall list`), or your own as FILE.py:FUNCTION "
            "(docs/methods.md). Default: iez for a real recording, hdr for a simulated one.",
            show_default=False,
        ),
    ] = None,
    detector: Annotated[
        str | None,
        typer.Option(
            help="Detector of rest (see `footfall list`). Default: patient for a real recording, threshold "
            "for a simulated one.",
            show_default=False,
        ),
    ] = None,
    bias_time: Annotated[
        float | None,
        typer.Option(
            help="Time at rest at the start over which the gyro bias is averaged, s. Default: all rests of "
            "the recording, at most 25 s of the start.",
            callback=finite,
        ),
    ] = None,
    heading: Annotated[
        float | None,
        typer.Option(
            help="Heading of the IMU at rest before the walk, deg, counter-clockwise from x. Default: that "
            "of a simulated recording, else 0.",
            callback=finite,
            show_default=False,
        ),
    ] = None,
    directions: Annotated[
        int | None,
        typer.Option(
            min=1,
            help="Number of dominant directions, evenly spaced, for methods that use them: 8 with diagonals. "
            "Default: 4.",
            show_default=False,
        ),
    ] = None,
    reference: Annotated[
        float | None,
        typer.Option(
            help="One of the dominant directions, deg, counter-clockwise from x. Default: that in which the "
            "walk sets out.",
            callback=finite,
            show_default=False,
        ),
    ] = None,
    settings: SetOption = None,
    max_gap: Annotated[
        float | None,
        typer.Option(
            help="Longest hole in a swing that is bridged, s. Its stride is marked doubtful. Default: 0.25.",
            callback=finite,
            show_default=False,
        ),
    ] = None,
    strict: Annotated[
        bool, typer.Option("--strict", help="Refuse an implausible track instead of a warning.")
    ] = False,
    format: FormatOption = "auto",
    columns: ColumnsOption = None,
    sensor: SensorOption = None,
    unit: UnitOption = None,
    rate: RateOption = None,
) -> None:
    """Navigate a recording, simulated or real: the track has one row a footfall.

    The recording is checked against physics first. Lost, doubled and clipped samples are mended and reported,
    and so is how plausible the track is.
    """
    from footfall.hdr.tracking import track as navigate
    from footfall.pdr.reckoning import PdrParams
    from footfall.pdr.track import write_track

    require_output(output, TABLES, recording)
    if bias_time is not None:
        with blaming("--bias-time", "pdr"):
            PdrParams(bias_s=bias_time)
    values = {}
    if settings:
        from footfall.scenarios.parameters import parsed

        values = parsed(settings)
    with ERR.status("navigating"):
        result = navigate(
            recording,
            method,
            format=format,
            reading=reading_of(unit, rate, columns, sensor, max_gap),
            detector=detector,
            bias_s=bias_time,
            heading=None if heading is None else math.radians(heading),
            directions=directions,
            reference=None if reference is None else math.radians(reference),
            values=values,
        )
        if strict and result.warnings:
            raise InputError(f"{'; '.join(result.warnings)} (--strict)", recording)
        write_track(result.track, output)
    for sentence in result.findings.sentences():
        say(f"{recording}: {sentence}")
    for sentence in result.notes:
        say(f"{recording}: {sentence}")
    asked = bias_time is not None or "pdr.bias_s" in values
    if not result.notes and not asked and result.bias_s < PdrParams().bias_s:
        say(f"{recording}: static bias averaged over the {result.bias_s:g} s that it rests")
    for sentence in result.warnings:
        say(f"{recording}: warning: {sentence}")
    if result.plausibility is not None:
        say(f"{recording}: {result.plausibility.line()}")
    say(f"{len(result.track)} footfalls: {output}")
