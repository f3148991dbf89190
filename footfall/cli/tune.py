"""`footfall tune`: parameters chosen on some walks and units, and judged on others."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated, Any

import typer

from footfall.cli.cluster import PatienceOption, SchedulerOption, working
from footfall.cli.options import JsonOption
from footfall.cli.terminal import ERR, OUT, print_json, say


def tune(
    study: Annotated[
        str,
        typer.Argument(
            help="Your study (docs/tuning.md), the name of a stock study, or `list` to show the names.",
            show_default=False,
        ),
    ],
    method: Annotated[
        str | None, typer.Option(help="Method to tune. Default: the study's.", show_default=False)
    ] = None,
    train: Annotated[
        str | None,
        typer.Option(
            metavar="FROM..TO",
            help="Units to tune with. Default: the study's.",
            show_default=False,
        ),
    ] = None,
    test: Annotated[
        str | None,
        typer.Option(
            metavar="FROM..TO",
            help="Units to judge with. Default: the study's.",
            show_default=False,
        ),
    ] = None,
    trials: Annotated[
        int | None, typer.Option(min=2, help="Number of parameter sets to try. Default: the study's.")
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
    """Tune a method's parameters on some walks and units, and judge them and the default on others.

    The results are tuning.json, tuning.png and tuned.toml, for `--set @tuned.toml`. Methods other than hdr
    and hdr-basic need footfall\\[study].
    """
    from footfall.cli.choices import unit_range
    from footfall.scenarios.report.progress import watching
    from footfall.scenarios.report.results import results_folder
    from footfall.scenarios.report.tables import new_table
    from footfall.scenarios.report.tuning import tuning_document, tuning_report, write_tuning
    from footfall.scenarios.studies.tuning import perform_tuning
    from footfall.scenarios.studies.tuning_file import read_tuning, stock_tunings

    if study == "list":
        known = {name: read_tuning(name).file.description for name in stock_tunings()}
        table = new_table("study", "what", left=2)
        for row in known.items():
            table.add_row(*row)
        print_json(known) if as_json else OUT.print(table)
        return
    changes: dict[str, Any] = {}
    words = ["footfall", "tune", study]
    for key, value in (("method", method), ("trials", trials)):
        if value is not None:
            changes[key] = value
            words += [f"--{key}", str(value)]
    for key, text in (("train", train), ("test", test)):
        if text is not None:
            first, count = unit_range(text)
            changes[key] = {"first_unit": first, "units": count}
            words += [f"--{key}", text]
    asked = read_tuning(study, changes)
    folder = out or Path("out") / asked.name
    with working(scheduler, patience, workers) as crew, results_folder(folder):
        with watching("units recorded", "sets tried") as (shown, (heard, tried)):
            tuned = perform_tuning(
                asked, workers=crew, folder=folder, on_cases=heard, on_trials=shown, on_tried=tried
            )
        document = tuning_document(tuned, shlex.join(words))
        with ERR.status("writing files and the figure"):
            write_tuning(tuned, document, folder)
    if as_json:
        print_json(document)
    else:
        for part in tuning_report(tuned):
            OUT.print(part)
    say(f"Figures and values are in {folder}; take them with --set @{folder / 'tuned.toml'}")
