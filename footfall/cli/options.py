"""Options that several commands take."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from footfall.cli.terminal import finite

ScenarioArgument = Annotated[
    str, typer.Argument(help="A scenario that comes with Footfall (see `footfall list`), or your TOML file.")
]
OutputOption = Annotated[
    Path,
    typer.Option("--output", "-o", help="File to write: .parquet, or .csv, which holds the numbers alone."),
]
NoCacheOption = Annotated[
    bool, typer.Option("--no-cache", help="Walk even if this walk is in the cache, and do not keep it there.")
]
FormatOption = Annotated[
    str,
    typer.Option(
        "--format",
        help="What wrote the recording: auto finds out; or footfall, xio (x-io), sensorconnect "
        "(MicroStrain), openshoe, matlab (imu and ts), csv (columns like gyro_x_deg_s, accel_x_g).",
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
    typer.Option("--rate", help="Samples per second (Hz), for a file without time.", callback=finite),
]
SetOption = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="ADDRESS=VALUE",
        help="Another value for a parameter (see `footfall parameters`), or @FILE for the table [set] of a "
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
        help="How many dominant directions there are, evenly spaced, for methods that go by them: 4 if left "
        "out, 8 with diagonals.",
        show_default=False,
    ),
]
JsonOption = Annotated[
    bool, typer.Option("--json", help="Print one JSON document instead of tables, for programs.")
]
