"""The command line: `footfall --help`.

Results go to standard output, everything else to standard error. Exit codes: 0 success, 1 a gate or a check
failed, 2 bad input (one sentence), 3 no gate failed, but some are undecided, 4 stopped, start it again to go
on, 130 interrupted.

Each command is a file of its name. It is only a signature until it is called: what it needs it imports then,
so that `footfall list` does not wait for what `footfall run` loads.
"""

from __future__ import annotations

import logging
from pathlib import Path
from typing import Annotated

import typer

from footfall import __version__
from footfall.cli.allan import allan
from footfall.cli.cache import cache
from footfall.cli.check import check
from footfall.cli.convert import convert
from footfall.cli.export import export
from footfall.cli.gate import gate
from footfall.cli.inspect import inspect
from footfall.cli.list import list_
from footfall.cli.logs import start_log
from footfall.cli.map import map_
from footfall.cli.parameters import parameters
from footfall.cli.record import record
from footfall.cli.render import render
from footfall.cli.report import report
from footfall.cli.run import run
from footfall.cli.sample import sample
from footfall.cli.scenario import scenario
from footfall.cli.score import score
from footfall.cli.sensitivity import sensitivity
from footfall.cli.sweep import sweep
from footfall.cli.terminal import perform
from footfall.cli.track import track
from footfall.cli.tune import tune
from footfall.cli.walk import walk

app = typer.Typer(
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    help="Footfall lets a simulated person walk a path with an IMU on the shoe, and measures the error of "
    "pedestrian dead reckoning, with and without heading correction.\n\n"
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
    verbose: Annotated[
        bool, typer.Option("--verbose", "-v", help="Log what is done to standard error.")
    ] = False,
    log: Annotated[
        Path | None,
        typer.Option(help="File to whose end the log of what is done is written.", show_default=False),
    ] = None,
) -> None:
    context.call_on_close(start_log(verbose, log))
    if context.invoked_subcommand is None:
        print(context.get_help())
    else:
        logging.getLogger("footfall").info("footfall %s: %s", __version__, context.invoked_subcommand)


COMMANDS = (
    list_,
    parameters,
    run,
    walk,
    render,
    record,
    sample,
    inspect,
    convert,
    track,
    score,
    check,
    sweep,
    gate,
    sensitivity,
    map_,
    tune,
    report,
    export,
    allan,
)
for command in COMMANDS:
    app.command(command.__name__.rstrip("_"))(command)
app.add_typer(scenario, name="scenario")
app.add_typer(cache, name="cache")


def main(arguments: list[str] | None = None) -> int:
    """Entry point of the `footfall` command; returns its exit code."""
    return perform(app, arguments)
