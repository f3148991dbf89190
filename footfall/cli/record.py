"""`footfall record`: a walk, or a real recording, with the errors of an IMU."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

import typer

from footfall.cli.options import (
    FormatOption,
    OnlyOption,
    OutputOption,
    RateOption,
    SetOption,
    UnitOption,
    WithoutOption,
)
from footfall.cli.reading import require_kind
from footfall.cli.terminal import ERR, TABLES, finite, require_output, say
from footfall.errors import InputError

_TO_RECORDINGS = " (to add an IMU's errors to a recording: `footfall record --from-recording`)"


def record(
    output: OutputOption,
    walk: Annotated[
        Path | None, typer.Argument(help="A walk that `footfall walk` wrote.", show_default=False)
    ] = None,
    from_recording: Annotated[
        Path | None,
        typer.Option(
            help="Instead of a walk, a real recording. The IMU's bias, temperature and g-sensitivity errors "
            "are added to its samples.",
            show_default=False,
        ),
    ] = None,
    imu: Annotated[str, typer.Option(help="IMU: a name (see `footfall list`) or your data sheet.")] = "nimu",
    unit_seed: Annotated[
        int, typer.Option(min=0, help="Seed of the unit of that IMU. Each seed is another unit.")
    ] = 1,
    noise_seed: Annotated[
        int | None,
        typer.Option(
            min=0,
            help="Seed of noise and turn-on bias. Default: that of --unit-seed.",
            show_default=False,
        ),
    ] = None,
    without: WithoutOption = None,
    only: OnlyOption = None,
    indoors: Annotated[
        float,
        typer.Option(min=-40, max=85, help="Temperature of the IMU at the start, degC.", callback=finite),
    ] = 20.0,
    outdoors: Annotated[
        float,
        typer.Option(min=-40, max=85, help="Temperature of the air on the walk, degC.", callback=finite),
    ] = 20.0,
    bias_shift: Annotated[
        float,
        typer.Option(
            help="Gyro bias about the vertical, deg/s, left positive, from the walk's first step on.",
            callback=finite,
        ),
    ] = 0.0,
    settings: SetOption = None,
    format: FormatOption = "auto",
    unit: UnitOption = None,
    rate: RateOption = None,
) -> None:
    """Record a walk with one unit of an IMU: the truth plus that unit's errors.

    With --from-recording a real recording is used instead, so a known drift is added to a real foot.
    --format, --unit and --rate say how to read it.
    """
    from footfall.cli.choices import dropped_effects
    from footfall.formats import parse_units, read
    from footfall.models.imu import TemperatureProfile, draw_unit
    from footfall.models.imu.override import overridden
    from footfall.recording import write_recording
    from footfall.scenarios.parameters import parsed, sensor
    from footfall.simulate.from_recording import add_errors
    from footfall.simulate.record import record as record_walk
    from footfall.simulate.walk import footfalls_path, read_walk

    if walk is not None and from_recording is None:
        require_output(output, TABLES, walk, footfalls_path(walk))
    elif from_recording is not None and walk is None:
        require_output(output, TABLES, from_recording)
    else:
        raise InputError("record: expected either a walk or --from-recording with a recording")
    if walk is not None and (format != "auto" or unit or rate is not None):
        raise InputError("record: --format, --unit and --rate tell how to read --from-recording, not a walk")
    if walk is None and bias_shift:
        raise InputError("record: --bias-shift is for walks: the first step of a real recording is not known")
    off = dropped_effects(without, only)
    spec, constants = sensor(imu, parsed(settings or ()))
    worn = overridden(draw_unit(spec, unit_seed), constants)
    noise = unit_seed if noise_seed is None else noise_seed
    air = TemperatureProfile.step(indoors, outdoors)
    with ERR.status("recording"):
        if walk is not None:
            require_kind(walk, "walk", _TO_RECORDINGS)
            recording = record_walk(
                read_walk(walk),
                worn,
                seed=noise,
                temperature=air,
                without=off,
                bias_shift=math.radians(bias_shift),
            )
        else:
            assert from_recording is not None
            real, _ = read(from_recording, format, sizes=parse_units(unit or ()), rate_hz=rate)
            recording = add_errors(real, worn, seed=noise, temperature=air, without=off)
        write_recording(recording, output)
    say(f"{len(recording.t)} samples: {output}")
