"""Progress of trials, for people who watch a terminal."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from footfall.scenarios.execute import Progress as Done

LOG = logging.getLogger(__name__)
_EVERY_S = 10.0  # between two lines of the log

Show = Callable[[Done], None]
Count = Callable[[int, int], None]  # how many are done, and how many there are


@contextmanager
def showing() -> Iterator[Show]:
    """One bar for the metres walked and one for the trials; nothing where there is no terminal."""
    with watching() as (show, _):
        yield show


@contextmanager
def counting(label: str) -> Iterator[Count]:
    """A bar of what is done and how much there is; nothing where there is no terminal."""
    with watching(label) as (_, (count,)):
        yield count


@contextmanager
def watching(*labels: str) -> Iterator[tuple[Show, tuple[Count, ...]]]:
    """The bars of `showing`, and one more for each label; each appears as soon as something is in it."""
    console = Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bars:
        counts = tuple(_counter(bars, label) for label in labels)
        walked = bars.add_task("metres walked", total=None, visible=False)
        tried = bars.add_task("recordings navigated", total=None, visible=False)
        lengths: list[float] = []
        latest: Done | None = None

        told = 0.0

        def show(now: Done) -> None:
            nonlocal latest, told
            if latest is not now:  # other trials than before
                latest = now
                lengths[:] = [trial.plan.route.length for trial in now.walks]
            bars.update(
                walked,
                description="compiling, once" if now.compiling else "metres walked",
                completed=round(sum(now.metres)),
                total=round(sum(lengths)),
                visible=True,
            )
            bars.update(tried, completed=now.done, total=now.trials, visible=True)
            if now.done == now.trials or time.monotonic() - told > _EVERY_S:
                told = time.monotonic()
                what = "compiling, once; " if now.compiling else ""
                numbers = sum(now.metres), sum(lengths), now.done, now.trials
                LOG.info(what + "%.0f of %.0f m walked, %d of %d recordings navigated", *numbers)

        yield show, counts


def _counter(bars: Progress, label: str) -> Count:
    task = bars.add_task(label, total=None, visible=False)
    return lambda done, all_: bars.update(task, completed=done, total=all_, visible=True)
