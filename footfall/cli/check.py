"""`footfall check`: is this a method that studies can rely on?"""

from __future__ import annotations

from typing import Annotated

import typer
from rich.text import Text

from footfall.cli.options import JsonOption
from footfall.cli.terminal import ERR, OUT, finite, print_json, words_of
from footfall.errors import InputError

FAILED = 1


def check(
    method: Annotated[
        str | None,
        typer.Argument(
            help="A method: FILE.py:NAME, package.module:NAME, or a name (docs/methods.md).",
            show_default=False,
        ),
    ] = None,
    command: Annotated[
        str | None,
        typer.Option(
            help="Instead of a method, a program: its command line with the placeholders {recording}, "
            "{track}, {start}, {params} and {rate}.",
            show_default=False,
        ),
    ] = None,
    format: Annotated[
        str,
        typer.Option("--format", help="Format of a program's recording: f64, csv or parquet."),
    ] = "f64",
    timeout: Annotated[
        float, typer.Option(help="Seconds after which a program is ended.", callback=finite)
    ] = 60.0,
    needs: Annotated[
        str | None,
        typer.Option(help="What a function is given first: samples or footfalls.", show_default=False),
    ] = None,
    full: Annotated[
        bool,
        typer.Option(
            "--full",
            help="Also run the method on the first five minutes of every stock scenario. They are simulated "
            "first.",
        ),
    ] = False,
    as_json: JsonOption = False,
) -> None:
    """Check a method, yours or a built-in one, for twelve things that every study relies on.

    It runs on recordings of a synthetic foot and takes seconds. Exit code 1 when a check fails.
    """
    from footfall.hdr.check import examine
    from footfall.hdr.methods import find_method

    if (method is None) == (command is None):
        raise InputError("check: expected either a method or --command")
    try:
        words = None if command is None else words_of(command)
    except ValueError as error:
        raise InputError(f"--command: {error}") from None
    found = find_method(method, command=words, format=format, timeout_s=timeout, needs=needs)  # type: ignore[arg-type]
    cases = []
    if full:
        from footfall.scenarios.beginnings import beginnings
        from footfall.scenarios.scenario import stock_scenarios

        with ERR.status("walking") as status:
            told = beginnings(stock_scenarios(), on_walk=lambda name: status.update(f"walking {name}"))
            cases = list(told)
    with ERR.status(f"checking {found.name}"):
        results = list(examine(found, cases))
    failures = [result for result in results if not result.passed]
    if as_json:
        checks = [{"name": one.name, "passed": one.passed, "reason": one.reason} for one in results]
        print_json({"method": found.name, "version": found.version, "passed": not failures, "checks": checks})
    else:
        from footfall.scenarios.report.tables import new_table, titled

        table = new_table("check", "", "why not", left=3)
        for result in results:
            mark = Text("passed", "green") if result.passed else Text("failed", "red")
            table.add_row(result.name, mark, Text(result.reason))
        OUT.print(
            titled(f"{found.name}: {len(results) - len(failures)} of {len(results)} checks passed", table)
        )
    if failures:
        raise typer.Exit(FAILED)
