"""Commands on recordings and tracks: record, track, score, export, allan. They are registered in cli.py."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

import typer

from footfall.cli.options import FormatOption, JsonOption, OutputOption, RateOption, UnitOption
from footfall.cli.terminal import ERR, OUT, blaming, finite, print_json, require_output, say
from footfall.errors import InputError


def record(
    output: OutputOption,
    walk: Annotated[
        Path | None, typer.Argument(help="A walk that `footfall walk` wrote.", show_default=False)
    ] = None,
    from_recording: Annotated[
        Path | None,
        typer.Option(
            help="Instead of a walk, a real recording: its samples with that IMU's bias, temperature and "
            "g-sensitivity errors on top.",
            show_default=False,
        ),
    ] = None,
    imu: Annotated[
        str, typer.Option(help="An IMU's name (see `footfall list`) or your data sheet.")
    ] = "nimu",
    unit_seed: Annotated[
        int, typer.Option(min=0, help="Which individual of that IMU: each seed is another one.")
    ] = 1,
    noise_seed: Annotated[
        int | None,
        typer.Option(
            min=0,
            help="Which recording of it: noise and turn-on bias; the number of --unit-seed if left out.",
            show_default=False,
        ),
    ] = None,
    without: Annotated[
        list[str] | None,
        typer.Option(
            help="Switch a sensor effect off (see `footfall list`); may be repeated.", show_default=False
        ),
    ] = None,
    indoors: Annotated[
        float, typer.Option(help="Temperature of the room that the IMU comes from, degC.", callback=finite)
    ] = 20.0,
    outdoors: Annotated[
        float, typer.Option(help="Temperature where it is walked, degC.", callback=finite)
    ] = 20.0,
    bias_shift: Annotated[
        float,
        typer.Option(
            help="Gyro bias about the vertical, deg/s, left positive, from the walk's first step on.",
            callback=finite,
        ),
    ] = 0.0,
    format: FormatOption = "auto",
    unit: UnitOption = None,
    rate: RateOption = None,
) -> None:
    """Record a walk with one individual IMU: the truth with that sensor's errors.

    With --from-recording a real foot walks, and what the IMU adds to its recording is known; --format, --unit
    and --rate tell how to read it.
    """
    from footfall.formats import parse_units, read
    from footfall.models.imu import TemperatureProfile, draw_unit, load_spec
    from footfall.recording import write_recording
    from footfall.simulate.from_recording import add_errors
    from footfall.simulate.record import record as record_walk
    from footfall.simulate.walk import footfalls_path, read_walk

    if walk is not None and from_recording is None:
        require_output(output, ".parquet", walk, footfalls_path(walk))
    elif from_recording is not None and walk is None:
        require_output(output, ".parquet", from_recording)
    else:
        raise InputError("record: expected either a walk or --from-recording with a recording")
    if walk is not None and (format != "auto" or unit or rate is not None):
        raise InputError("record: --format, --unit and --rate tell how to read --from-recording, not a walk")
    if walk is None and bias_shift:
        raise InputError(
            "record: --bias-shift is for walks: nobody says when a real recording begins to move"
        )
    worn = draw_unit(load_spec(imu), unit_seed)
    noise = unit_seed if noise_seed is None else noise_seed
    air = TemperatureProfile.step(indoors, outdoors)
    with ERR.status("recording"):
        if walk is not None:
            recording = record_walk(
                read_walk(walk),
                worn,
                seed=noise,
                temperature=air,
                without=without or (),
                bias_shift=math.radians(bias_shift),
            )
        else:
            assert from_recording is not None
            real, _ = read(from_recording, format, sizes=parse_units(unit or ()), rate_hz=rate)
            recording = add_errors(real, worn, seed=noise, temperature=air, without=without or ())
        write_recording(recording, output)
    say(f"{len(recording.t)} samples: {output}")


def track(
    recording: Annotated[
        Path,
        typer.Argument(
            help="A recording, simulated or real: Parquet or CSV with t (s), gyro_x, gyro_y, gyro_z (rad/s), "
            "accel_x, accel_y, accel_z (m/s2), or a file of another --format."
        ),
    ],
    output: OutputOption,
    method: Annotated[str, typer.Option(help="How to navigate (see `footfall list`).")] = "hdr",
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
    format: FormatOption = "auto",
    unit: UnitOption = None,
    rate: RateOption = None,
) -> None:
    """Navigate: from a recording, simulated or real, to a track with one row a footfall.

    The recording is judged by physics first; lost, doubled and clipped samples are told and handled.
    """
    from footfall.formats import parse_units
    from footfall.pdr.reckoning import PdrParams
    from footfall.pdr.track import write_track
    from footfall.tracking import track_file

    require_output(output, ".parquet", recording)
    if bias_time is not None:
        with blaming("--bias-time", "pdr"):
            PdrParams(bias_s=bias_time)
    with ERR.status("navigating"):
        result = track_file(
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
        )
        write_track(result.track, output)
    for sentence in result.findings.sentences():
        say(f"{recording}: {sentence}")
    if bias_time is None and result.bias_s < PdrParams().bias_s:
        say(f"{recording}: static bias averaged over the {result.bias_s:g} s that it rests")
    say(f"{len(result.track)} footfalls: {output}")


def score(
    track: Annotated[
        Path,
        typer.Argument(
            help="A track, ours or anyone's: Parquet or CSV with t, x, y, z, heading (s, m, rad)."
        ),
    ],
    walk: Annotated[Path, typer.Argument(help="The walk that was recorded.")],
    align: Annotated[
        str,
        typer.Option(
            help="What is fitted first, by a shift on the plane and a turn: none, nothing; start, the first "
            "row; yaw, the first row's position and the best turn; rigid, the best shift and turn. For "
            "tracks of an unknown start."
        ),
    ] = "none",
    as_json: JsonOption = False,
) -> None:
    """Score a track against the true walk: heading and position errors.

    Nothing is fitted, unless --align asks for it.
    """
    from footfall.pdr.track import read_track
    from footfall.scenarios.judge.score import require_align
    from footfall.scenarios.judge.score import score as judge
    from footfall.scenarios.report.tables import score_table
    from footfall.simulate.walk import read_walk

    fitted = require_align(align)
    estimate, truth = read_track(track), read_walk(walk)
    with blaming(track, "track"):
        result = judge(estimate, truth, fitted)
    if as_json:
        print_json({"align": fitted, **result.as_dict()})
    else:
        OUT.print(score_table(result, fitted))


def export(
    file: Annotated[Path, typer.Argument(help="A track or a walk.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="File to write.")],
    format: Annotated[
        str, typer.Option(help="tum: a line `t x y z qx qy qz qw` a pose (s, m), as evo and others read it.")
    ] = "tum",
) -> None:
    """Write a track, or a walk's truth, in the format of other tools.

    A track has headings alone: its poses are level. Compare positions, not rotations, with those of a walk.
    """
    from footfall.formats.tum import export_tum

    if format != "tum":
        raise InputError(f"--format {format!r} is unknown, expected tum")
    require_output(output, (".tum", ".txt"), file)
    say(f"{export_tum(file, output)} poses: {output}")


def allan(
    recording: Annotated[
        Path | None,
        typer.Argument(help="A recording at rest, best an hour long; if left out, one is simulated."),
    ] = None,
    imu: Annotated[str, typer.Option(help="The IMU to simulate: its name or your data sheet.")] = "nimu",
    unit_seed: Annotated[
        int, typer.Option(min=0, help="Which individual of that IMU: each seed is another one.")
    ] = 1,
    hours: Annotated[
        float, typer.Option(min=0.05, max=24, help="How long the simulated IMU rests.", callback=finite)
    ] = 1.0,
    figure: Annotated[
        Path | None, typer.Option(help="PNG file to draw the Allan deviation into.", show_default=False)
    ] = None,
    format: FormatOption = "auto",
    unit: UnitOption = None,
    rate: RateOption = None,
    as_json: JsonOption = False,
) -> None:
    """Tell how long an IMU should rest before a walk, from its Allan deviation.

    The time is that after which averaging the gyros removes no more noise (T_bias of the HDR paper).
    """
    from footfall.formats import parse_units, read
    from footfall.models.imu import draw_unit, load_spec
    from footfall.scenarios.report.allan import allan_report, allan_table, resting_recording

    if figure is not None:
        require_output(figure, ".png")
    if recording is not None:
        sizes = parse_units(unit or ())
        resting, _ = read(recording, format, sizes=sizes, rate_hz=rate, walk=False)
    else:
        worn = draw_unit(load_spec(imu), unit_seed)
        with ERR.status(f"resting for {hours:g} h"):
            resting = resting_recording(worn, hours * 3600, unit_seed)
    with blaming(recording or imu):
        result = allan_report(resting, figure)
    if as_json:
        print_json(result)
    else:
        OUT.print(allan_table(result))
