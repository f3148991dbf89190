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
            help="How to navigate: a name (see `footfall list`), or your own as FILE.py:FUNCTION "
            "(docs/methods.md); if left out, iez of a real recording, hdr of a simulated one.",
            show_default=False,
        ),
    ] = None,
    detector: Annotated[
        str | None,
        typer.Option(
            help="What tells that the foot is at rest (see `footfall list`); if left out, patient of a real "
            "recording, threshold of a simulated one.",
            show_default=False,
        ),
    ] = None,
    bias_time: Annotated[
        float | None,
        typer.Option(
            help="Seconds at rest at the start, over which gyro bias is averaged; if left out, all rests "
            "that there are, at most 25 s of the start.",
            callback=finite,
        ),
    ] = None,
    heading: Annotated[
        float | None,
        typer.Option(
            help="Heading of the IMU at rest before the walk, deg, counter-clockwise from x; if left out, "
            "what a simulated recording says of it, else 0.",
            callback=finite,
            show_default=False,
        ),
    ] = None,
    directions: Annotated[
        int | None,
        typer.Option(
            min=1,
            help="How many dominant directions there are, evenly spaced, for a method that goes by them: 4 "
            "if left out, 8 with diagonals.",
            show_default=False,
        ),
    ] = None,
    reference: Annotated[
        float | None,
        typer.Option(
            help="One of them, deg, counter-clockwise from x; if left out, that in which the walk sets out.",
            callback=finite,
            show_default=False,
        ),
    ] = None,
    settings: SetOption = None,
    max_gap: Annotated[
        float | None,
        typer.Option(
            help="Longest hole in a swing, s, that is bridged; its stride is doubtful. If left out, 0.25.",
            callback=finite,
            show_default=False,
        ),
    ] = None,
    strict: Annotated[
        bool, typer.Option("--strict", help="Refuse a track that is beyond the usual, in place of a warning.")
    ] = False,
    format: FormatOption = "auto",
    columns: ColumnsOption = None,
    sensor: SensorOption = None,
    unit: UnitOption = None,
    rate: RateOption = None,
) -> None:
    """Navigate: from a recording, simulated or real, to a track with one row a footfall.

    The recording is judged by physics first; lost, doubled and clipped samples are told and handled. The
    track says how plausible it is.
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
