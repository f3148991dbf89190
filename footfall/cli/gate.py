"""`footfall gate`: are these methods as accurate as they must be?"""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated

import typer

from footfall.cli.options import JsonOption, NoCacheOption
from footfall.cli.terminal import OUT, print_json, require_output, say
from footfall.errors import InputError


def gate(
    gates: Annotated[
        str,
        typer.Argument(
            help="Your TOML file of gates (docs/gates.md), the name of a stock file, or `list` to show the "
            "names.",
            show_default=False,
        ),
    ],
    units: Annotated[
        int | None, typer.Option(min=1, help="Number of cases. Default: the file's.", show_default=False)
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="Use 20 cases, or as many as a gate needs.")] = False,
    sequential: Annotated[
        str | None,
        typer.Option(
            metavar="20,40,80",
            help="Judge after each of these numbers of cases, each time at an equal part of the 5 %, and "
            "stop when all gates are decided.",
            show_default=False,
        ),
    ] = None,
    record: Annotated[
        Path | None,
        typer.Option(
            help="Write the scores to this Parquet file, a baseline for comparisons. Nothing is judged.",
            show_default=False,
        ),
    ] = None,
    cache_key: Annotated[
        bool, typer.Option("--cache-key", help="Only print a hash of everything that the walks depend on.")
    ] = False,
    junit: Annotated[
        Path | None, typer.Option(help="XML file for JUnit; undecided is an error.", show_default=False)
    ] = None,
    markdown: Annotated[
        Path | None,
        typer.Option(help="File to append a table to, as $GITHUB_STEP_SUMMARY.", show_default=False),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(help="Folder for the results. Default: out/NAME.", show_default=False),
    ] = None,
    no_cache: NoCacheOption = False,
    as_json: JsonOption = False,
) -> None:
    """Judge methods over many units of an IMU: pass, fail or undecided, by exact bounds.

    Exit code 0 when all gates pass, 1 when one fails, 3 when none fails and some are undecided.

    The results are report.html, gate.json and cases.parquet.
    """
    from footfall.scenarios.report.gate_files import append_text, write_bytes, write_gate
    from footfall.scenarios.report.gates import cases_line, gate_document, gate_report
    from footfall.scenarios.report.gates import junit as junit_xml
    from footfall.scenarios.report.gates import markdown as markdown_text
    from footfall.scenarios.report.progress import showing
    from footfall.scenarios.report.results import results_folder
    from footfall.scenarios.studies.baseline import write_baseline
    from footfall.scenarios.studies.gate import cache_key as key_of
    from footfall.scenarios.studies.gate import gate as judge
    from footfall.scenarios.studies.gate import read_baselines, scored, walks_cached
    from footfall.scenarios.studies.gate_file import read_gates

    if gates == "list":
        _list(as_json)
        return
    if sum((units is not None, quick, sequential is not None)) > 1:
        raise InputError("--units, --quick and --sequential: expected one of them")
    read = read_gates(gates)
    read = read if units is None else read.with_units(units)
    read = read.quick() if quick else read
    if cache_key:
        print(key_of(read))
        return
    for file, ending in ((record, ".parquet"), (junit, ".xml"), (markdown, None)):
        if file is not None:
            require_output(file, file.suffix.lower() if ending is None else ending, Path(read.source))
    if record is None:
        read_baselines(read)  # before any work
    say(f"{cases_line(read)}; {walks_cached(read)} walks in the cache")
    if record is not None:
        with showing() as progress:
            rows = scored(read, range(read.units), use_cache=not no_cache, on_progress=progress)
        write_baseline(rows, record)
        say(f"Scores of {', '.join(dict.fromkeys(row.method for row in rows))} are in {record}")
        return
    looks = _looks(sequential)
    folder = out or Path("out") / read.name
    with results_folder(folder):
        with showing() as progress:
            judged = judge(read, looks=looks, use_cache=not no_cache, on_progress=progress)
        document = gate_document(judged, _command(gates, units, quick, sequential))
        write_gate(judged, document, folder)
    if junit is not None:
        write_bytes(junit_xml(judged), junit)
    if markdown is not None:
        append_text(markdown_text(judged), markdown)
    if as_json:
        print_json(document)
    else:
        for part in gate_report(judged):
            OUT.print(part)
    say(f"Verdicts and cases are in {folder}; look at {folder / 'report.html'}")
    if judged.exit_code:
        raise typer.Exit(judged.exit_code)


def _list(as_json: bool) -> None:
    from footfall.scenarios.report.tables import new_table
    from footfall.scenarios.studies.gate_file import described, stock_gates

    known = described(stock_gates())
    if as_json:
        print_json(known)
        return
    table = new_table("gates", "what", left=2)
    for name, text in known.items():
        table.add_row(name, text)
    OUT.print(table)


def _looks(text: str | None) -> tuple[int, ...]:
    try:
        return tuple(int(part) for part in text.split(",")) if text else ()
    except ValueError:
        raise InputError(f"--sequential {text}: expected numbers of cases, as 20,40,80,160") from None


def _command(gates: str, units: int | None, quick: bool, sequential: str | None) -> str:
    """The line that judges the same again."""
    words = ["footfall", "gate", gates]
    words += ["--units", str(units)] if units else []
    words += ["--quick"] if quick else []
    words += ["--sequential", sequential] if sequential else []
    return shlex.join(words)
