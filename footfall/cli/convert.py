"""`footfall convert`: a recording of any format, mended, in Footfall's own."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from footfall.cli.options import ColumnsOption, FormatOption, RateOption, SensorOption, UnitOption
from footfall.cli.reading import reading_of
from footfall.cli.terminal import ERR, TABLES, require_output, say


def convert(
    recording: Annotated[
        Path, typer.Argument(help="A recording, as its logger wrote it (docs/real_recordings.md).")
    ],
    output: Annotated[Path, typer.Option("--output", "-o", help="Parquet or CSV file to write.")],
    format: FormatOption = "auto",
    columns: ColumnsOption = None,
    sensor: SensorOption = None,
    unit: UnitOption = None,
    rate: RateOption = None,
) -> None:
    """Mend a recording and write it with Footfall's columns: t, gyro_x, ..., accel_z, in SI units."""
    from footfall.formats import read
    from footfall.recording import write_recording

    require_output(output, TABLES, recording)
    with ERR.status("reading"):
        found, findings = read(recording, format, reading=reading_of(unit, rate, columns, sensor))
        write_recording(found, output)
    for sentence in findings.sentences():
        say(f"{recording}: {sentence}")
    say(f"{len(found.t)} samples: {output}")
