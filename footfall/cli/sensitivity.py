"""`footfall sensitivity`: which parameters an error depends on."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated

import typer

from footfall.cli.cluster import PatienceOption, SchedulerOption, working
from footfall.cli.options import JsonOption
from footfall.cli.terminal import ERR, OUT, print_json, say


def sensitivity(
    study: Annotated[
        str,
        typer.Argument(
            help="Your study (docs/sensitivity.md), the name of a stock study, or `list` to show the names.",
            show_default=False,
        ),
    ],
    fidelity: Annotated[
        str | None,
        typer.Option(help="full: the whole chain; budget: by the drift budget. Default: the study's."),
    ] = None,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Number of processes. Default: one a core.", show_default=False)
    ] = None,
    scheduler: SchedulerOption = None,
    patience: PatienceOption = 600.0,
    out: Annotated[
        Path | None, typer.Option(help="Folder for the results. Default: out/STUDY.", show_default=False)
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Find the parameters that a method's error depends on, alone and together (Morris, Sobol).

    The results are report.html, sensitivity.json, points.parquet and the figures (PNG). Needs
    footfall\\[study].
    """
    from footfall.scenarios.report.progress import watching
    from footfall.scenarios.report.results import results_folder
    from footfall.scenarios.report.sensitivity import (
        check_report,
        sensitivity_document,
        sensitivity_report,
        write_sensitivity,
    )
    from footfall.scenarios.report.tables import new_table
    from footfall.scenarios.studies.extra import needed
    from footfall.scenarios.studies.sensitivity import Watch, perform_study
    from footfall.scenarios.studies.sensitivity_file import read_study, stock_studies

    if study == "list":
        known = {name: read_study(name).file.description for name in stock_studies()}
        table = new_table("study", "question", left=2)
        for row in known.items():
            table.add_row(*row)
        print_json(known) if as_json else OUT.print(table)
        return
    asked = read_study(study, {} if fidelity is None else {"fidelity": fidelity})
    needed("SALib.sample.sobol")
    folder = out or Path("out") / asked.name
    with working(scheduler, patience, workers) as crew, results_folder(folder):
        with watching("points", "units recorded") as (trials, (points, heard)):
            watch = Watch(
                workers=crew,
                store=folder / "footfalls",
                on_points=points,
                on_trials=trials,
                on_cases=heard,
                on_check=lambda check: ERR.print(check_report(asked, check)),
            )
            found = perform_study(asked, watch)
        words = ["footfall", "sensitivity", study, *([] if fidelity is None else ["--fidelity", fidelity])]
        document = sensitivity_document(found, shlex.join(words))
        with ERR.status("writing files and figures"):
            write_sensitivity(found, document, folder)
    if as_json:
        print_json(document)
    else:
        for part in sensitivity_report(found):
            OUT.print(part)
    say(f"Figures, points and indices are in {folder}")
