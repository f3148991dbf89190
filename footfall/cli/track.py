"""`footfall track`: from a recording to a track."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

import typer

from footfall.cli.options import FormatOption, OutputOption, RateOption, SetOption, UnitOption
from footfall.cli.terminal import ERR, TABLES, blaming, finite, require_output, say


def track(
    recording: Annotated[
        Path,
        typer.Argument(
            help="A recording, simulated or real: Parquet or CSV with t (s), gyro_x, gyro_y, gyro_z (rad/s), "
            "accel_x, accel_y, accel_z (m/s2), or a file of another --format."
        ),
    ],
    output: OutputOption,
    method: Annotated[
        str,
        typer.Option(
            help="How to navigate: a name (see `footfall list`), or your own as FILE.py:FUNCTION "
            "(docs/methods.md)."
        ),
    ] = "hdr",
    detector: Annotated[
        str, typer.Option(help="What tells that the foot is at rest (see `footfall list`).")
    ] = "threshold",
    bias_time: Annotated[
        float | None,
        typer.Option(
            help="Seconds at rest at the start, over which gyro bias is averaged; if left out, as long as it "
            "rests, at most 25.",
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
    format: FormatOption = "auto",
    unit: UnitOption = None,
    rate: RateOption = None,
) -> None:
    """Navigate: from a recording, simulated or real, to a track with one row a footfall.

    The recording is judged by physics first; lost, doubled and clipped samples are told and handled.
    """
    from footfall.formats import parse_units
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
            sizes=parse_units(unit or ()),
            rate_hz=rate,
            detector=detector,
            bias_s=bias_time,
            heading=None if heading is None else math.radians(heading),
            directions=directions,
            reference=None if reference is None else math.radians(reference),
            values=values,
        )
        write_track(result.track, output)
    for sentence in result.findings.sentences():
        say(f"{recording}: {sentence}")
    if bias_time is None and "pdr.bias_s" not in values and result.bias_s < PdrParams().bias_s:
        say(f"{recording}: static bias averaged over the {result.bias_s:g} s that it rests")
    say(f"{len(result.track)} footfalls: {output}")
