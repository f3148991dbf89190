"""`footfall run`: a scenario from the walk to its scores."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from footfall.cli.options import JsonOption, NoCacheOption, ScenarioArgument
from footfall.cli.terminal import ERR, OUT, print_json, say


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
