"""The command line: `footfall --help`.

Results go to standard output, everything else to standard error. Exit codes: 0 well, 1 a gate failed, 2 bad
input, told in one sentence.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer
from rich.progress import Progress

from footfall import __version__
from footfall.cli.options import JsonOption, NoCacheOption, ScenarioArgument
from footfall.cli.recordings import allan, export, record, score, track
from footfall.cli.terminal import ERR, OUT, finite, perform, print_json, require_output, say
from footfall.errors import InputError

app = typer.Typer(
    add_completion=False,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    help="Footfall lets a simulated person walk a path with an IMU on the shoe, and tells how far pedestrian "
    "dead reckoning goes astray on it, with and without heading correction.\n\n"
    "Start with [bold]footfall run closed-loop[/bold], or go step by step: walk, record, track, score.",
)


def _version(asked: bool) -> None:
    if asked:
        print(__version__)
        raise typer.Exit


@app.callback(invoke_without_command=True)
def _main(
    context: typer.Context,
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    if context.invoked_subcommand is None:
        print(context.get_help())


@app.command("list")
def list_(as_json: JsonOption = False) -> None:
    """Show what comes with Footfall: scenarios, IMUs, methods, detectors, mounts and sensor effects."""
    from footfall.hdr.methods import METHODS
    from footfall.models.body import MOUNTS
    from footfall.models.imu import EFFECTS, load_spec, stock_specs
    from footfall.pdr.detectors import DETECTORS, summary
    from footfall.scenarios.report.tables import new_table, titled
    from footfall.scenarios.scenario import load_scenario, stock_scenarios

    scenarios = {name: load_scenario(name) for name in stock_scenarios()}
    imus = {name: load_spec(name).name for name in stock_specs()}
    methods = {name: method.description for name, method in METHODS.items()}
    detectors = {name: summary(found) for name, found in DETECTORS.items()}
    if as_json:
        print_json(
            {
                "scenarios": {name: scenario.description for name, scenario in scenarios.items()},
                "imus": imus,
                "methods": methods,
                "detectors": detectors,
                "mounts": list(MOUNTS),
                "effects": list(EFFECTS),
            }
        )
        return
    table = new_table("name", "what", "length\nm", "pace\nm/s", "walks", left=2)
    for name, scenario in scenarios.items():
        length = f"{scenario.path.route.length:.0f}"
        table.add_row(name, scenario.description, length, f"{scenario.pace:g}", f"{scenario.walks}")
    OUT.print(titled("Scenarios", table))
    for title, rows in (
        ("IMUs", imus),
        ("Methods, from a recording to a track", methods),
        ("Detectors of rest", detectors),
    ):
        table = new_table("name", "what", left=2)
        for name, text in rows.items():
            table.add_row(name, text)
        OUT.print(titled(title, table))
    OUT.print(f"[bold]Mounts of the IMU[/bold]: {', '.join(MOUNTS)}")
    OUT.print(f"[bold]Sensor effects[/bold], in their order: {', '.join(EFFECTS)}")


@app.command()
def run(
    scenario: ScenarioArgument,
    walks: Annotated[
        int | None, typer.Option(min=1, help="How many walks; the scenario says if left out.")
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(
            min=0, help="Seed of the first walk, the next has the next; the scenario says if left out."
        ),
    ] = None,
    imu: Annotated[
        str | None,
        typer.Option(help="IMU on the shoe: a name or your data sheet; the scenario says if left out."),
    ] = None,
    methods: Annotated[
        str, typer.Option(help="Methods to compare, separated by commas (see `footfall list`).")
    ] = "pdr,hdr",
    units: Annotated[
        int,
        typer.Option(min=0, help="So many other units of the IMU are scored too, shared among the walks."),
    ] = 50,
    noises: Annotated[
        int,
        typer.Option(
            min=0, help="So many other noises of each walk's own unit are scored too, for what is chance."
        ),
    ] = 10,
    out: Annotated[
        Path | None,
        typer.Option(help="Folder for the results; out/SCENARIO if left out.", show_default=False),
    ] = None,
    no_cache: NoCacheOption = False,
    as_json: JsonOption = False,
) -> None:
    """Do it all: walk a scenario, record it, navigate by each method and score the tracks.

    The folder gets scores.json, every walk, recording and track (Parquet) and the figures (PNG).
    """
    from footfall.cli.progress import perform_showing
    from footfall.scenarios.report import tables as report
    from footfall.scenarios.report.results import results_folder, write_results
    from footfall.scenarios.run import tasks
    from footfall.scenarios.scenario import load_scenario

    chosen = load_scenario(scenario)
    names = tuple(dict.fromkeys(name.strip() for name in methods.split(",")))
    todo = tasks(
        chosen,
        walks=walks,
        seed=seed,
        imu=imu,
        methods=names,
        other_units=units,
        noises=noises,
        use_cache=not no_cache,
    )
    folder = out or Path("out") / chosen.name
    with results_folder(folder):
        results = perform_showing(todo)
        document = report.as_json(chosen.name, results)
        with ERR.status("writing files and figures"):
            write_results(results, document, folder)
    if as_json:
        print_json(document)
    else:
        for part in report.run_report(chosen.name, results):
            OUT.print(part)
    say(f"Scores, walks, tracks and figures are in {folder}")


@app.command()
def walk(
    scenario: ScenarioArgument,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output", "-o", help="Parquet file to write; may be left out with --view.", show_default=False
        ),
    ] = None,
    seed: Annotated[
        int | None, typer.Option(min=0, help="Seed of this walk; the scenario says if left out.")
    ] = None,
    number: Annotated[
        int, typer.Option(min=1, help="Which of the scenario's walks: its subject and its seed.")
    ] = 1,
    rate: Annotated[
        float | None,
        typer.Option(
            help="Samples per second (Hz), a divisor of 1000; the scenario says if left out.",
            callback=finite,
        ),
    ] = None,
    mount: Annotated[
        str | None,
        typer.Option(
            help="Where on the shoe the IMU sits (see `footfall list`); the scenario says if left out."
        ),
    ] = None,
    view: Annotated[
        bool, typer.Option("--view", help="Watch it first in MuJoCo's viewer, which needs a screen.")
    ] = False,
    no_cache: NoCacheOption = False,
) -> None:
    """Walk a scenario once and write the truth: where the IMU was, and what a perfect one would say.

    The true footfalls go into a second file: walk.parquet and walk.footfalls.parquet.
    """
    from dataclasses import replace

    from footfall.models.body import MOUNTS
    from footfall.scenarios.scenario import load_scenario
    from footfall.simulate.cache import cached_walk
    from footfall.simulate.truth import divisor
    from footfall.simulate.walk import write_walk
    from footfall.simulate.walking import PHYSICS_STEP

    if output is not None:
        require_output(output, ".parquet")
    elif not view:
        raise InputError("Missing option '--output' / '-o' (see `footfall walk --help`)")
    plan = load_scenario(scenario).plan(number - 1)
    if mount is not None:
        if mount not in MOUNTS:
            raise InputError(f"--mount {mount!r} is unknown, expected one of {', '.join(MOUNTS)}")
        plan = replace(plan, mount=MOUNTS[mount])
    if rate is not None:
        divisor(PHYSICS_STEP, rate)
        plan = replace(plan, rate_hz=rate)
    if seed is not None:
        plan = replace(plan, seed=seed)
    if view:
        from footfall.simulate.render import view as show

        show(plan)
    if output is None:
        return
    with Progress(console=ERR, transient=True, disable=not ERR.is_terminal) as progress:
        bar = progress.add_task("walking", total=plan.route.length)
        truth = cached_walk(
            plan, use_cache=not no_cache, on_progress=lambda metres: progress.update(bar, completed=metres)
        )
    write_walk(truth, output)
    say(f"{len(truth.footfalls.t)} footfalls in {truth.t[-1]:.0f} s: {output}")


@app.command()
def render(
    scenario: ScenarioArgument,
    output: Annotated[Path, typer.Option("--output", "-o", help="WebP or PNG file to write.")],
    number: Annotated[int, typer.Option(min=1, help="Which of the scenario's walks: its subject.")] = 1,
    skip: Annotated[
        float, typer.Option(min=0, help="Seconds after the first step at which it begins.", callback=finite)
    ] = 4.0,
    seconds: Annotated[
        float, typer.Option(min=0.5, max=60, help="How much a moving picture shows.", callback=finite)
    ] = 4.0,
) -> None:
    """Draw the walker at the beginning of a walk: moving (.webp) or as a strip of moments (.png).

    Without a screen it draws through EGL; set MUJOCO_GL to choose another way.
    """
    from footfall.scenarios.scenario import load_scenario
    from footfall.simulate.render import render as draw

    require_output(output, (".webp", ".png"))
    plan = load_scenario(scenario).plan(number - 1)
    with ERR.status("walking and drawing"):
        pictures = draw(plan, output, skip=skip, seconds=seconds)
    say(f"{pictures} pictures: {output}")


for command in (record, track, score, export, allan):
    app.command()(command)


def main(arguments: list[str] | None = None) -> int:
    """Entry point of the `footfall` command; returns its exit code."""
    return perform(app, arguments)


if __name__ == "__main__":
    sys.exit(main())
