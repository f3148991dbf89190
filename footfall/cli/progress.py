"""Progress of trials, for people who watch a terminal."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from footfall.cli.terminal import ERR
from footfall.scenarios.execute import Progress as Done
from footfall.scenarios.run import Part, Result, perform_run


@contextmanager
def showing() -> Iterator[Callable[[Done], None]]:
    """One bar for the metres walked and one for the trials; nothing where there is no terminal."""
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=ERR, transient=True, disable=not ERR.is_terminal) as bars:
        walked = bars.add_task("metres walked", total=None)
        tried = bars.add_task("recordings navigated", total=None)
        lengths: list[float] = []

        def show(now: Done) -> None:
            if not lengths:
                lengths.extend(trial.plan.route.length for trial in now.walks)
            bars.update(
                walked,
                description="compiling, once" if now.compiling else "metres walked",
                completed=round(sum(now.metres)),
                total=round(sum(lengths)),
            )
            bars.update(tried, completed=now.done, total=now.trials)

        yield show


def perform_showing(todo: Sequence[Part], use_cache: bool) -> list[Result]:
    """All results of a run, with its progress."""
    with showing() as show:
        return perform_run(todo, use_cache=use_cache, on_progress=show)
