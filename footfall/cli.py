"""The command line: `footfall --help`.

Results go to standard output, everything else to standard error. Exit codes: 0 well, 1 a gate failed, 2 bad
input, told in one sentence.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

from footfall import __version__
from footfall.errors import InputError

if TYPE_CHECKING:
    from footfall.scenarios.run import Result, Task

app = typer.Typer(
    add_completion=False,
    no_args_is_help=True,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    help="Footfall: a physics-simulated gait testbed for pedestrian dead reckoning.\n\n"
    "Start with: [bold]footfall run closed-loop[/bold]",
)
_out = Console()
_err = Console(stderr=True)

ScenarioArgument = Annotated[
    str, typer.Argument(help="A stock scenario (see `footfall list`) or a TOML file.")
]
SeedOption = Annotated[
    int | None, typer.Option(min=0, help="Seed of the first walk; the scenario's own if left out.")
]
NoCacheOption = Annotated[bool, typer.Option("--no-cache", help="Walk anew, and do not keep the walk.")]
JsonOption = Annotated[
    bool, typer.Option("--json", help="One JSON document on standard output instead of tables.")
]


def _version(asked: bool) -> None:
    if asked:
        print(__version__)
        raise typer.Exit


@app.callback()
def _main(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    pass


@app.command("list")
def list_(as_json: JsonOption = False) -> None:
    """Scenarios, IMUs, mounts and methods that come with Footfall."""
    from footfall.hdr.methods import METHODS
    from footfall.models.body import MOUNTS
    from footfall.models.imu import EFFECTS, load_spec, stock_specs
    from footfall.scenarios.scenario import load_scenario, stock_scenarios

    scenarios = {name: load_scenario(name) for name in stock_scenarios()}
    imus = {name: load_spec(name).name for name in stock_specs()}
    methods = {name: method.description for name, method in METHODS.items()}
    if as_json:
        document = {
            "scenarios": {name: scenario.description for name, scenario in scenarios.items()},
            "imus": imus,
            "methods": methods,
            "mounts": list(MOUNTS),
            "effects": list(EFFECTS),
        }
        print(json.dumps(document, indent=2))
        return
    table = Table(title="Scenarios", title_justify="left")
    for column in ("name", "length m", "pace m/s", "walks", "what"):
        table.add_column(column, justify="right" if column in ("length m", "pace m/s", "walks") else "left")
    for name, scenario in scenarios.items():
        length = f"{scenario.path.route.length:.0f}"
        table.add_row(name, length, f"{scenario.pace:g}", f"{scenario.walks}", scenario.description)
    _out.print(table)
    for title, rows in (("IMUs", imus), ("Methods", methods)):
        table = Table(title=title, title_justify="left")
        table.add_column("name")
        table.add_column("what")
        for name, text in rows.items():
            table.add_row(name, text)
        _out.print(table)
    _out.print(f"Mounts: {', '.join(MOUNTS)}")
    _out.print(f"Sensor effects, in their order: {', '.join(EFFECTS)}")


@app.command()
def run(
    scenario: ScenarioArgument,
    walks: Annotated[
        int | None, typer.Option(min=1, help="How many walks; the scenario's own if left out.")
    ] = None,
    seed: SeedOption = None,
    imu: Annotated[str | None, typer.Option(help="IMU: a stock name or a data sheet's path.")] = None,
    methods: Annotated[str, typer.Option(help="Methods, separated by commas.")] = "pdr,hdr",
    units: Annotated[
        int, typer.Option(min=0, help="Further units of the sheet to score on the same walks.")
    ] = 50,
    out: Annotated[
        Path | None, typer.Option(help="Folder for tables and figures; out/SCENARIO if left out.")
    ] = None,
    no_cache: NoCacheOption = False,
    as_json: JsonOption = False,
) -> None:
    """Walk, record, navigate, correct and score a scenario."""
    from footfall.hdr.methods import require_methods
    from footfall.models.imu import load_spec
    from footfall.scenarios import report
    from footfall.scenarios.results import write_results
    from footfall.scenarios.run import tasks
    from footfall.scenarios.scenario import load_scenario

    chosen = load_scenario(scenario)
    names = tuple(dict.fromkeys(name.strip() for name in methods.split(",")))
    require_methods(names)
    load_spec(imu or chosen.imu)
    folder = out or Path("out") / chosen.name
    _require_folder(folder)
    todo = tasks(
        chosen, walks=walks, seed=seed, imu=imu, methods=names, other_units=units, use_cache=not no_cache
    )
    results = _perform(todo)
    document = report.as_json(chosen.name, results)
    with _err.status("writing files and figures"):
        write_results(results, document, folder)
    if as_json:
        print(json.dumps(document, indent=2))
    else:
        _print_run(results, chosen.name)
    _err.print(f"Scores, walks, tracks and figures are in {folder}")


def _print_run(results: list[Result], name: str) -> None:
    from footfall.scenarios import report

    first = results[0]
    distance = report.as_json(name, results)["distance_m"]
    _out.print(f"[bold]{name}[/bold]: {len(results)} walks of {distance:.0f} m, IMU {first.task.imu}")
    _out.print(report.heading_table(results))
    if name == "closed-loop":
        _out.print(report.paper_table())
    if first.task.scenario.units and first.task.unit_seed in first.task.scenario.units:
        _out.print(
            "The walks' own units were drawn from the sheet and kept because their uncorrected errors lie in the "
            "range of the paper's Table 2; the other units below were not chosen.",
            style="dim",
        )
    if (others := report.others_table(results)) is not None:
        _out.print(others)
    _out.print(report.position_table(results))


def _perform(todo: list[Task]) -> list[Result]:
    """All results, with one progress bar a walk."""
    from footfall.scenarios.run import perform_all

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("m"),
        TimeElapsedColumn(),
    )
    with Progress(*columns, console=_err, transient=True) as progress:
        length = todo[0].scenario.path.route.length
        bars = [
            progress.add_task(f"walk {task.number + 1}, unit {task.unit_seed}", total=round(length))
            for task in todo
        ]
        results = []
        for result in perform_all(todo, lambda i, metres: progress.update(bars[i], completed=round(metres))):
            progress.update(bars[result.task.number], completed=round(length))
            results.append(result)
    return results


@app.command()
def walk(
    scenario: ScenarioArgument,
    output: Annotated[Path, typer.Option("--output", "-o", help="Parquet file to write.")],
    seed: SeedOption = None,
    number: Annotated[int, typer.Option(min=1, help="Which of the scenario's walks (its subject).")] = 1,
    rate: Annotated[float | None, typer.Option(help="Hz; must divide 1000.")] = None,
    mount: Annotated[str | None, typer.Option(help="Where the IMU sits (see `footfall list`).")] = None,
    no_cache: NoCacheOption = False,
) -> None:
    """Truth only: walk a scenario once."""
    from dataclasses import replace

    from footfall.models.body import MOUNTS
    from footfall.scenarios.scenario import load_scenario
    from footfall.simulate.cache import cached_walk
    from footfall.simulate.journey import PHYSICS_STEP
    from footfall.simulate.truth import divisor
    from footfall.simulate.walk import write_walk

    chosen = load_scenario(scenario)
    plan = chosen.plan(number - 1)
    if mount is not None:
        if mount not in MOUNTS:
            raise InputError(f"--mount {mount!r} is unknown, expected one of {', '.join(MOUNTS)}")
        plan = replace(plan, mount=MOUNTS[mount])
    if rate is not None:
        divisor(PHYSICS_STEP, rate)
        plan = replace(plan, rate_hz=rate)
    if seed is not None:
        plan = replace(plan, seed=seed)
    _require_parent(output)
    with Progress(console=_err, transient=True) as progress:
        bar = progress.add_task("walking", total=plan.route.length)
        truth = cached_walk(
            plan, use_cache=not no_cache, on_progress=lambda metres: progress.update(bar, completed=metres)
        )
    write_walk(truth, output)
    _err.print(f"{len(truth.footfalls.t)} footfalls in {truth.t[-1]:.0f} s: {output}")


@app.command()
def record(
    walk: Annotated[Path, typer.Argument(help="A walk that `footfall walk` wrote.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="Parquet file to write.")],
    imu: Annotated[str, typer.Option(help="A stock IMU or a data sheet's path.")] = "nimu",
    unit_seed: Annotated[int, typer.Option(min=0, help="Which unit is drawn from the sheet.")] = 1,
    without: Annotated[
        list[str] | None, typer.Option(help="Switch an effect off; may be repeated (see `footfall list`).")
    ] = None,
    indoors: Annotated[float, typer.Option(help="degC, the unit when it is carried out.")] = 20.0,
    outdoors: Annotated[float, typer.Option(help="degC, the air outside.")] = 20.0,
) -> None:
    """What one IMU unit would have said on a walk."""
    from footfall.models.imu import TemperatureProfile, draw_unit, load_spec
    from footfall.recording import write_recording
    from footfall.simulate.record import record as record_walk
    from footfall.simulate.walk import read_walk

    unit = draw_unit(load_spec(imu), unit_seed)
    truth = read_walk(walk)
    _require_parent(output)
    recording = record_walk(
        truth,
        unit,
        seed=unit_seed,
        temperature=TemperatureProfile.step(indoors, outdoors),
        without=without or (),
    )
    write_recording(recording, output)
    _err.print(f"{len(recording.t)} samples: {output}")


@app.command()
def track(
    recording: Annotated[Path, typer.Argument(help="A recording, simulated or real: Parquet or CSV.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="Parquet file to write.")],
    method: Annotated[str, typer.Option(help="How to navigate (see `footfall list`).")] = "hdr",
    bias_time: Annotated[float, typer.Option(help="s at rest from which the static bias is taken.")] = 25.0,
    heading: Annotated[float, typer.Option(help="deg, heading at the start.")] = 0.0,
) -> None:
    """Navigate a recording."""
    import math

    from footfall.hdr.methods import require_methods
    from footfall.hdr.methods import track as navigate
    from footfall.pdr.pdr import PdrParams, StartPose
    from footfall.pdr.track import write_track
    from footfall.recording import read_recording

    require_methods([method])
    _require_parent(output)
    start = StartPose(heading=math.radians(heading))
    result = navigate(read_recording(recording), method, start, PdrParams(bias_s=bias_time))
    write_track(result, output)
    _err.print(f"{len(result)} footfalls: {output}")


@app.command()
def score(
    track: Annotated[Path, typer.Argument(help="A track, ours or anyone's (t, x, y, z, heading).")],
    walk: Annotated[Path, typer.Argument(help="The walk that it was made from.")],
    as_json: JsonOption = False,
) -> None:
    """How far a track is off the truth."""
    from footfall.pdr.track import read_track
    from footfall.scenarios.report import score_table
    from footfall.scenarios.score import score as judge
    from footfall.simulate.walk import read_walk

    result = judge(read_track(track), read_walk(walk))
    if as_json:
        print(json.dumps(result.as_dict(), indent=2))
    else:
        _out.print(score_table({track.stem: result}))


@app.command()
def allan(
    recording: Annotated[
        Path | None, typer.Argument(help="A recording at rest, an hour or so; a simulated one if left out.")
    ] = None,
    imu: Annotated[str, typer.Option(help="The IMU to simulate at rest.")] = "nimu",
    unit_seed: Annotated[int, typer.Option(min=0, help="Which unit of it.")] = 1,
    hours: Annotated[float, typer.Option(min=0.05, max=24, help="How long it rests.")] = 1.0,
    figure: Annotated[Path | None, typer.Option(help="PNG file to draw the Allan deviation into.")] = None,
    as_json: JsonOption = False,
) -> None:
    """Allan deviation of a resting IMU's gyros, and the bias time T_bias that it justifies."""
    from footfall.models.imu import draw_unit, load_spec
    from footfall.recording import read_recording
    from footfall.scenarios.allan import allan_report, resting_recording

    if figure is not None:
        _require_parent(figure)
    if recording is not None:
        resting = read_recording(recording)
    else:
        unit = draw_unit(load_spec(imu), unit_seed)
        with _err.status(f"resting for {hours:g} h"):
            resting = resting_recording(unit, hours * 3600, unit_seed)
    result = allan_report(resting, figure)
    if as_json:
        print(json.dumps(result, indent=2))
        return
    for name, value in result.items():
        _out.print(f"{name:28s} {value:.4g}")


def _require_folder(folder: Path) -> None:
    """Refuse a folder that cannot be written before any work is done."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"--out {folder}: cannot be made ({error.strerror})") from None


def _require_parent(file: Path) -> None:
    if not file.parent.is_dir():
        raise InputError(f"{file}: the folder {file.parent} does not exist")


def main(arguments: list[str] | None = None) -> Any:
    """Entry point of the `footfall` command."""
    try:
        app(arguments)
    except InputError as error:
        print(f"footfall: {error}", file=sys.stderr)
        raise SystemExit(2) from None
    except KeyboardInterrupt:
        print("footfall: interrupted", file=sys.stderr)
        raise SystemExit(130) from None


if __name__ == "__main__":
    main()
