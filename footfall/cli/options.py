"""Options that several commands take."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from footfall.cli.terminal import finite

ScenarioArgument = Annotated[
    str, typer.Argument(help="A stock scenario (see `footfall list`), or your TOML file.")
]
OutputOption = Annotated[
    Path,
    typer.Option("--output", "-o", help="File to write: .parquet, or .csv, which has the numbers only."),
]
NoCacheOption = Annotated[
    bool, typer.Option("--no-cache", help="Simulate the walk even if it is in the cache, and do not keep it.")
]
FormatOption = Annotated[
    str,
    typer.Option(
        "--format",
        help="Format of the recording: auto recognizes it; or a name as in docs/real_recordings.md, such as "
        "footfall, xio, xsens, ros, matlab, csv.",
    ),
]
UnitOption = Annotated[
    list[str] | None,
    typer.Option(
        "--unit",
        help="A unit that the file does not state: gyro=deg/s, accel=g, t=ms; may be repeated.",
        show_default=False,
    ),
]
RateOption = Annotated[
    float | None,
    typer.Option("--rate", help="Sampling rate, Hz, for a file without time.", callback=finite),
]
ColumnsOption = Annotated[
    str | None,
    typer.Option(
        "--columns",
        help="Names of the table's columns in order, such as t,gx,gy,gz,ax,ay,az. - skips a column.",
        show_default=False,
    ),
]
SensorOption = Annotated[
    str | None,
    typer.Option(
        "--sensor", help="Which of several sensors in a file. Without it they are listed.", show_default=False
    ),
]
SetOption = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="ADDRESS=VALUE",
        help="Another value for a parameter (see `footfall parameters`), or @FILE for the table \\[set] of a "
        "TOML file; may be repeated.",
        show_default=False,
    ),
]
WithoutOption = Annotated[
    list[str] | None,
    typer.Option(
        help="Switch a sensor effect off (see `footfall list`); may be repeated.", show_default=False
    ),
]
OnlyOption = Annotated[
    list[str] | None,
    typer.Option(help="Switch all sensor effects off but this one; may be repeated.", show_default=False),
]
DirectionsOption = Annotated[
    int | None,
    typer.Option(
        min=1,
        help="Number of dominant directions, evenly spaced, for methods that use them: 8 with diagonals. "
        "Default: 4.",
        show_default=False,
    ),
]
JsonOption = Annotated[
    bool, typer.Option("--json", help="Print one JSON document instead of tables, for programs.")
]
