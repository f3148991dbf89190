"""`footfall run`: a scenario from the walk to its scores."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from footfall.cli.options import (
    DirectionsOption,
    JsonOption,
    NoCacheOption,
    OnlyOption,
    ScenarioArgument,
    SetOption,
    WithoutOption,
)
from footfall.cli.terminal import ERR, OUT, command_line, finite, print_json, say


def run(
    context: typer.Context,
    scenario: ScenarioArgument,
    walks: Annotated[
        int | None, typer.Option(min=1, help="Number of walks. Default: the scenario's.")
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(
            min=0, help="Seed of the first walk; the next walk has the next seed. Default: the scenario's."
        ),
    ] = None,
    imu: Annotated[
        str | None,
        typer.Option(help="IMU on the shoe: a name or your data sheet. Default: the scenario's."),
    ] = None,
    methods: Annotated[
        str,
        typer.Option(
            help="Methods to compare, separated by commas: names (see `footfall list`), or your own as "
            "NAME=FILE.py:FUNCTION (docs/methods.md)."
        ),
    ] = "pdr,hdr",
    units: Annotated[
        int,
        typer.Option(min=0, help="Number of further units of the IMU to score, spread over the walks."),
    ] = 50,
    noises: Annotated[
        int,
        typer.Option(
            min=0,
            help="Number of further noise seeds to score for each walk's own unit.",
        ),
    ] = 10,
    detector: Annotated[
        str | None, typer.Option(help="Detector of rest (see `footfall list`). Default: threshold.")
    ] = None,
    bias_time: Annotated[
        float | None,
        typer.Option(
            help="Time at rest over which the gyro bias is averaged, s. Default: the scenario's.",
            callback=finite,
        ),
    ] = None,
    directions: DirectionsOption = None,
    reference: Annotated[
        float | None,
        typer.Option(
            help="One of the dominant directions, deg, counter-clockwise from x. Default: that in which the "
            "path begins.",
            callback=finite,
            show_default=False,
        ),
    ] = None,
    without: WithoutOption = None,
    only: OnlyOption = None,
    settings: SetOption = None,
    out: Annotated[
        Path | None,
        typer.Option(help="Folder for the results. Default: out/SCENARIO.", show_default=False),
    ] = None,
    no_cache: NoCacheOption = False,
    as_json: JsonOption = False,
) -> None:
    """Run the whole chain: walk a scenario, record it, navigate by each method and score the tracks.

    The results are report.html, scores.json, every walk, recording and track (Parquet) and the figures (PNG).
    """
    from footfall.cli.choices import dropped_effects, methods_of, told_directions
    from footfall.identity import plain
    from footfall.scenarios.parameters import documents, parsed, with_values
    from footfall.scenarios.report.document import run_document
    from footfall.scenarios.report.progress import showing
    from footfall.scenarios.report.results import results_folder, write_results
    from footfall.scenarios.report.tables import run_report
    from footfall.scenarios.run import parts, perform_run

    chosen = methods_of(methods)
    dropped = dropped_effects(without, only)
    base = documents(scenario, imu=imu, methods=chosen, without=dropped)
    values = told_directions(chosen, directions, reference)
    values |= {} if detector is None else {"pdr.detector": detector}
    values |= {} if bias_time is None else {"pdr.bias_s": bias_time}
    values |= parsed(settings or ())
    setup = with_values(base, values).setup()
    name = setup.scenario.name
    todo = parts(setup, walks=walks, seed=seed, other_units=units, noises=noises)
    folder = out or Path("out") / name
    with results_folder(folder):
        with showing() as progress:
            results = perform_run(todo, use_cache=not no_cache, on_progress=progress)
        command = command_line(context, "out", "no_cache", "as_json")
        document = run_document(name, results, plain(values), dropped, command)
        with ERR.status("writing files and figures"):
            write_results(results, document, folder)
    if as_json:
        print_json(document)
    else:
        for part in run_report(name, results):
            OUT.print(part)
    say(f"Scores, walks, tracks and figures are in {folder}; look at {folder / 'report.html'}")
