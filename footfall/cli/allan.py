"""`footfall allan`: how long an IMU should rest."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from footfall.cli.options import FormatOption, JsonOption, RateOption, UnitOption
from footfall.cli.terminal import ERR, OUT, blaming, finite, print_json, require_output, say
from footfall.errors import InputError


def allan(
    recording: Annotated[
        Path | None,
        typer.Argument(help="A recording at rest, best an hour long. Default: one is simulated."),
    ] = None,
    imu: Annotated[str, typer.Option(help="The IMU to simulate: its name or your data sheet.")] = "nimu",
    unit_seed: Annotated[
        int, typer.Option(min=0, help="Seed of the unit of that IMU. Each seed is another unit.")
    ] = 1,
    hours: Annotated[
        float, typer.Option(min=0.05, max=24, help="How long the simulated IMU rests.", callback=finite)
    ] = 1.0,
    figure: Annotated[
        Path | None, typer.Option(help="PNG file to draw the Allan deviation into.", show_default=False)
    ] = None,
    sheet: Annotated[
        Path | None,
        typer.Option(
            help="Data sheet to write, a TOML file, with the noises of that recording.", show_default=False
        ),
    ] = None,
    format: FormatOption = "auto",
    unit: UnitOption = None,
    rate: RateOption = None,
    as_json: JsonOption = False,
) -> None:
    """Find how long an IMU should rest before a walk, from its Allan deviation.

    After that time, averaging the gyros removes no more noise (T_bias of the HDR paper).
    """
    from footfall.formats import parse_units, read
    from footfall.models.imu import draw_unit, load_spec
    from footfall.scenarios.fitted_sheet import write_sheet
    from footfall.scenarios.report.allan import allan_report, allan_table, resting_recording

    if figure is not None:
        require_output(figure, ".png")
    if sheet is not None:
        if recording is None:
            raise InputError("--sheet: expected a recording at rest, to make the sheet from")
        require_output(sheet, ".toml", recording)
    if recording is not None:
        sizes = parse_units(unit or ())
        resting, _ = read(recording, format, sizes=sizes, rate_hz=rate, walk=False)
    else:
        worn = draw_unit(load_spec(imu), unit_seed)
        with ERR.status(f"resting for {hours:g} h"):
            resting = resting_recording(worn, hours * 3600, unit_seed)
    with blaming(recording or imu):
        result = allan_report(resting, figure)
        if sheet is not None:
            assert recording is not None
            write_sheet(resting, sheet.stem, recording, sheet)
    if sheet is not None:
        say(f"{sheet}: the noises of {recording}; range, scale factor and the rest are its maker's to tell")
    if as_json:
        print_json(result)
    else:
        OUT.print(allan_table(result))
