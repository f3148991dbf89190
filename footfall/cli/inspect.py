"""`footfall inspect`: what a recording holds, without navigating it."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

import typer

from footfall.cli.options import (
    ColumnsOption,
    FormatOption,
    JsonOption,
    RateOption,
    SensorOption,
    UnitOption,
)
from footfall.cli.reading import reading_of
from footfall.cli.terminal import ERR, OUT, print_json


def inspect(
    recording: Annotated[
        Path, typer.Argument(help="A recording, as its logger wrote it (docs/real_recordings.md).")
    ],
    format: FormatOption = "auto",
    columns: ColumnsOption = None,
    sensor: SensorOption = None,
    unit: UnitOption = None,
    rate: RateOption = None,
    json: JsonOption = False,
) -> None:
    """Show what is in a recording: columns and their meaning, rate, rests, noise, clipping.

    Nothing is navigated or written.
    """
    from footfall.formats.inspect import inspect as look

    with ERR.status("reading"):
        found = look(recording, format, reading_of(unit, rate, columns, sensor))
    if json:
        print_json(found.as_dict())
        return

    def show(text: str = "") -> None:
        OUT.print(text, markup=False, highlight=False, soft_wrap=True)

    for line in found.columns:
        show(line)
    if found.columns:
        show()
    show(f"{recording}: {found.format}, {found.rows} rows, {found.rate_hz:.5g} Hz, {found.duration_s:.4g} s")
    rests = ", ".join(f"{first:.1f} to {last:.1f} s" for first, last in found.rests)
    show(f"at rest: {rests or 'nowhere for 1.5 s'}")
    x, y, z = found.up
    show(f"up at rest: x {x:+.2f}, y {y:+.2f}, z {z:+.2f}")
    if found.gyro_noise_rad_s is not None and found.accel_noise_m_s2 is not None:
        gyro = math.degrees(found.gyro_noise_rad_s)
        show(f"noise at rest: gyro {gyro:.2g} deg/s, accelerometer {found.accel_noise_m_s2:.2g} m/s2")
    show(f"largest: {math.degrees(found.gyro_most_rad_s):.0f} deg/s, {found.accel_most_m_s2:.3g} m/s2")
    for sentence in found.findings:
        show(f"mended: {sentence}")
    if found.refused:
        show(f"would be refused: {found.refused}")
    show()
    show(f"turns  |{found.turning}|")
    show(f"forces |{found.force}|")
