"""Progress of a run, for people who watch a terminal."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import closing

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

from footfall.cli.terminal import ERR
from footfall.scenarios.run import Result, Task, perform_all


def perform_showing(todo: Sequence[Task]) -> list[Result]:
    """All results, with one progress bar a walk."""
    length = todo[0].scenario.path.route.length

    def show(index: int, metres: float, count: int) -> None:
        task = todo[index]
        units, noises = len(task.others), len(task.noises)
        label = f"walk {task.number + 1}, unit {task.unit_seed}"
        if count > units:
            label = f"walk {task.number + 1}, other noise {count - units} of {noises}"
        elif count:
            label = f"walk {task.number + 1}, other unit {count} of {units}"
        progress.update(bars[index], completed=round(metres), description=label)

    text, metre = TextColumn("{task.description}"), TextColumn("m")
    columns = (text, BarColumn(), MofNCompleteColumn(), metre, TimeElapsedColumn())
    with Progress(*columns, console=ERR, transient=True, disable=not ERR.is_terminal) as progress:
        bars = [progress.add_task(f"walk {task.number + 1}", total=round(length)) for task in todo]
        results = []
        with closing(perform_all(todo, show)) as performed:
            for index, result in enumerate(performed):
                show(index, length, 0)
                results.append(result)
    return results
