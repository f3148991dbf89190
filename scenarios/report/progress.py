"""Progress of trials, for people who watch a terminal."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from footfall.scenarios.execute import Progress as Done


@contextmanager
def showing() -> Iterator[Callable[[Done], None]]:
    """One bar for the metres walked and one for the trials; nothing where there is no terminal."""
    console = Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bars:
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


@contextmanager
def counting(label: str) -> Iterator[Callable[[int, int], None]]:
    """A bar of what is done and how much there is; nothing where there is no terminal."""
    console = Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bars:
        task = bars.add_task(label, total=None, visible=False)
        yield lambda done, all_: bars.update(task, completed=done, total=all_, visible=True)
