"""`footfall sweep`: a study of many trials, from its document to one table of rows."""

from __future__ import annotations

import logging
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from footfall.cli.cluster import PatienceOption, SchedulerOption, working
from footfall.cli.options import JsonOption, SetOption
from footfall.cli.terminal import ERR, INTERRUPTED, OUT, print_json, say
from footfall.errors import InputError

if TYPE_CHECKING:
    from footfall.scenarios.studies.spreading import Workers
    from footfall.scenarios.studies.study import Study
    from footfall.scenarios.studies.sweep import Progress

LOG = logging.getLogger(__name__)
REASONS = 12  # that are printed
_EVERY_S = 30.0  # a line, in the log alone where a bar is shown


def sweep(
    study: Annotated[
        str,
        typer.Argument(
            help="Your study (TOML, docs/sweeps.md), the name of a stock study, or `list` to show the names.",
            show_default=False,
        ),
    ],
    plan: Annotated[bool, typer.Option("--plan", help="Only print what the study would cost.")] = False,
    units: Annotated[int | None, typer.Option(min=1, help="Number of units. Default: the study's.")] = None,
    walks: Annotated[
        int | None, typer.Option(min=1, help="Number of walks of each scenario. Default: the study's.")
    ] = None,
    settings: SetOption = None,
    out: Annotated[
        Path | None, typer.Option(help="Folder for the results. Default: out/STUDY.", show_default=False)
    ] = None,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Number of processes. Default: one a core.", show_default=False)
    ] = None,
    scheduler: SchedulerOption = None,
    patience: PatienceOption = 600.0,
    retry_failed: Annotated[bool, typer.Option("--retry-failed", help="Run the failed tasks again.")] = False,
    fresh: Annotated[bool, typer.Option("--fresh", help="Delete earlier results first.")] = False,
    strict: Annotated[bool, typer.Option("--strict", help="Exit with 1 if any row failed.")] = False,
    as_json: JsonOption = False,
) -> None:
    """Run a study over walks, units, sheets, settings and methods: one table, a row of scores for each.

    Start it again after an interruption: finished work is kept, and a changed study keeps the parts that
    still belong to it. The results are report.html and results.parquet.
    """
    from footfall.scenarios.parameters import parsed
    from footfall.scenarios.studies.study import Study

    if study == "list":
        _list(as_json)
        return
    chosen = Study.read(study)
    told = [f"footfall sweep {study}"]
    if cases := {name: value for name, value in (("units", units), ("walks", walks)) if value is not None}:
        chosen = chosen.of(**cases)
        told += [f"--{name} {value}" for name, value in cases.items()]
    if settings:
        chosen = chosen.set(parsed(settings))
        told += [f"--set '{setting}'" for setting in settings]
    folder = out or Path("out") / chosen.name
    if plan:
        _plan(chosen, folder, workers, as_json)
    else:
        command = " ".join([*told, *([f"--out {out}"] if out else [])])
        how = {"as_json": as_json, "strict": strict, "retry": retry_failed, "fresh": fresh}
        with working(scheduler, patience, workers) as crew:
            _sweep(chosen, folder, crew, command, **how)


def _list(as_json: bool) -> None:
    from footfall.scenarios.report.tables import new_table
    from footfall.scenarios.studies.study import described, stock_studies

    known = described(stock_studies())
    if as_json:
        print_json(known)
        return
    table = new_table("study", "what", left=2)
    for name, text in known.items():
        table.add_row(name, text)
    OUT.print(table)


def _plan(study: Study, folder: Path, workers: int | None, as_json: bool) -> None:
    from footfall.scenarios.execute import cores
    from footfall.scenarios.studies.describe import cost_line, headline
    from footfall.scenarios.studies.parts import StudyFolder
    from footfall.scenarios.studies.plan import cost_of, plan_of

    with ERR.status("planning"):
        made = plan_of(study)
        left = cost_of(made, StudyFolder(folder).left(made.tasks))
    if as_json:
        print_json({"rows": made.rows, "left": left._asdict() | {"cores": workers or cores()}})
        return
    _line(headline(made))
    _line(f"   {cost_line(left, workers or cores())}")


def _sweep(
    study: Study,
    folder: Path,
    crew: Workers,
    command: str,
    *,
    as_json: bool,
    strict: bool,
    retry: bool,
    fresh: bool,
) -> None:
    from footfall.scenarios.studies.describe import cost_line, headline
    from footfall.scenarios.studies.parts import StudyFolder
    from footfall.scenarios.studies.plan import cost_of, plan_of
    from footfall.scenarios.studies.spreading import count
    from footfall.scenarios.studies.sweep import sweep as perform

    start = time.monotonic()
    with ERR.status("planning"):
        made = plan_of(study)
        left = [] if fresh or retry else StudyFolder(folder).left(made.tasks)
    say(headline(made))
    if not (fresh or retry):
        say(f"   {cost_line(cost_of(made, left), count(crew))}")
    with _stopping() as asked, _showing(study.name) as show:
        keys = {"fresh": fresh, "retry_failed": retry, "command": command, "on_progress": show}
        *_, now = perform(made, folder, crew, stop=lambda: bool(asked), **keys)
        show(now)
    for warning in now.warnings:
        say(f"{folder}: {warning}")
    if now.stage == "stopped":
        say(f"{now.done:,} of {now.recordings:,} recordings are done; start it again to go on")
        raise typer.Exit(INTERRUPTED)
    _report(study, folder, command, time.monotonic() - start, as_json=as_json, strict=strict)


def _report(study: Study, folder: Path, command: str, seconds: float, *, as_json: bool, strict: bool) -> None:
    """Say what came of it, and refuse what came to nothing."""
    from footfall.scenarios.studies.describe import duration, failures

    rows = study.results(folder).table
    reasons = failures(rows)
    lost = sum(count for count, _ in reasons)
    if as_json:
        told = [{"rows": count, "reason": reason} for count, reason in reasons]
        about = {"name": study.name, "folder": str(folder), "seconds": round(seconds, 1)}
        print_json(about | {"rows": len(rows), "failed": lost, "reasons": told})
    else:
        how = f"of which {lost:,} failed:" if lost else "none failed"
        _line(f"Done in {duration(seconds)}: {len(rows):,} rows, {how}")
        for count, reason in reasons[:REASONS]:
            _line(f"  {count:,}  {reason}")
        if len(reasons) > REASONS:
            _line(f"  and {len(reasons) - REASONS:,} reasons more, in the column error")
        _line(f"{folder / 'results.parquet'}, {folder / 'report.html'}")
        _line(f"Again: {command}   (nothing is left to do)")
    if lost == len(rows):
        raise InputError(f"all {lost:,} rows failed, as: {reasons[0][1]}", study.source or study.name)
    if strict and lost:
        raise typer.Exit(1)


def _line(text: str) -> None:
    OUT.print(text, highlight=False, markup=False, soft_wrap=True)


@contextmanager
def _stopping() -> Iterator[list[int]]:
    """A list that is empty until Ctrl-C or SIGTERM; the second one ends at once."""
    asked: list[int] = []

    def ask(number: int, frame: Any) -> None:
        if asked:
            raise KeyboardInterrupt
        asked.append(number)
        say("finishing the running tasks; Ctrl-C again stops at once")

    before = {number: signal.signal(number, ask) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield asked
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextmanager
def _showing(name: str) -> Iterator[Any]:
    """A bar on a terminal, or else a line now and then."""
    from rich.progress import BarColumn, TaskProgressColumn, TextColumn
    from rich.progress import Progress as Bars

    start = last = time.monotonic()
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TaskProgressColumn(),
        TextColumn("{task.fields[told]}"),
    )
    with Bars(*columns, console=ERR, transient=True, disable=not ERR.is_terminal) as bars:
        bar = bars.add_task(name, total=1.0, told="")

        def show(now: Progress) -> None:
            nonlocal last
            told = _told(now, time.monotonic() - start)
            bars.update(bar, completed=now.share, description=now.stage, told=told)
            over = now.stage in ("finished", "stopped")
            if over or time.monotonic() - last >= _EVERY_S:
                last = time.monotonic()
                tell = LOG.info if over or ERR.is_terminal else say
                tell(f"{name}: {now.share:.0%}, {now.stage}, {told}")

        yield show


def _told(now: Progress, seconds: float) -> str:
    told = [f"{now.done:,} of {now.recordings:,} recordings"]
    if now.route:
        told.append(f"{now.metres:,.0f} of {now.route:,.0f} m walked")
    if seconds > 1 and now.share > 0.01:
        left = round(seconds * (1 - now.share) / now.share)
        if now.rows:
            told.append(f"{now.rows / seconds:.1f} rows/s")
        told.append(f"{left // 60}:{left % 60:02d} left")
    if now.failed:
        told.append(f"{now.failed:,} failed rows")
    return ", ".join(told)
