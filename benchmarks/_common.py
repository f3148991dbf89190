"""What the benchmarks share: options, and trials and other work over processes, with progress."""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import fields, replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

from footfall.models.policy import stock_policy
from footfall.models.route import Route
from footfall.scenarios.evaluate import NOISE_STEP
from footfall.scenarios.execute import execute, worker_pool
from footfall.scenarios.judge.papers import UNCORRECTED_AVERAGE_RANGE, UNCORRECTED_FINAL_RANGE
from footfall.scenarios.trial import Outcome, Row, Setup, Trial
from footfall.simulate.plan import versions

J = TypeVar("J")
R = TypeVar("R")

# A file is as wide as the widest table.
out = Console(soft_wrap=True, width=None if sys.stdout.isatty() else 150)
err = Console(stderr=True, soft_wrap=True)


def options(doc: str | None, processes: bool = True) -> argparse.ArgumentParser:
    """A parser with what every benchmark takes; its help is the script's docstring."""
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures there too")
    if processes:
        parser.add_argument("--processes", type=int, default=2, help="at once (default 2)")
    return parser


def write_json(path: Path | None, figures: dict[str, Any]) -> None:
    """The figures of a benchmark, with the versions and the walker that made them."""
    if path is None:
        return
    policy = stock_policy()
    walker = {"policy": policy.digest, **policy.meta}
    document = {"versions": versions(), "walker": walker, **figures}
    path.write_text(json.dumps(document, indent=2) + "\n", encoding="utf-8")


def run_all(work: Callable[[J], R], jobs: Sequence[J], processes: int, label: str) -> list[R]:
    """`work` of every job, in order, with a progress bar on standard error."""
    with _bar() as progress:
        if processes <= 1 or len(jobs) <= 1:
            return [work(job) for job in progress.track(jobs, description=label)]
        with worker_pool(min(processes, len(jobs))) as (pool, _):
            return list(progress.track(pool.map(work, jobs), total=len(jobs), description=label))


def _bar() -> Progress:
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    return Progress(*columns, console=err)


def shortened(route: Route, metres: float | None) -> Route:
    """The first `metres` of a route; all of it for None."""
    if metres is None:
        return route
    rows = route.s <= metres
    return Route(**{column.name: getattr(route, column.name)[rows] for column in fields(Route)})


def within_paper(errors: np.ndarray) -> np.ndarray:
    """(...) bool: errors (..., 2), final and average in deg, lie in the range of the paper's Table 2.

    Compared in whole degrees, as the paper gives them.
    """
    low, high = np.transpose([UNCORRECTED_FINAL_RANGE, UNCORRECTED_AVERAGE_RANGE])
    errors = np.round(errors)
    return ((errors >= low) & (errors <= high)).all(axis=-1)


def heard(trial: Trial, noises: int = 0) -> list[Trial]:
    """A trial through its unit's own noise, which has the unit's seed, and through `noises` more."""
    return [replace(trial, noise_seed=trial.unit_seed + NOISE_STEP * noise) for noise in range(1 + noises)]


def dealt(setup: Setup, walks: int, first_walk: int, units: Sequence[int], noises: int = 0) -> list[Trial]:
    """Unit k on walk k mod `walks`, of which the first has the seed `first_walk`; each unit as `heard`."""
    trials = [Trial(setup, unit % walks, first_walk + unit % walks, unit, unit) for unit in units]
    return [again for trial in trials for again in heard(trial, noises)]


def outcomes(trials: Sequence[Trial], processes: int, label: str) -> list[Outcome]:
    """Trials over processes, in order; those whose walk came to no end are named and left out.

    Raises
    ------
    InputError
        What a recording or a method refuses.
    """
    with _bar() as progress:
        bar = progress.add_task(label, total=len(trials))
        done = execute(
            trials, workers=processes, on_progress=lambda now: progress.update(bar, completed=now.done)
        )
        found = list(done)
    stumbles = Counter(one.rows[0].error for one in found if one.rows[0].stage == "walk")
    for reason, count in stumbles.items():
        err.print(f"[red]left out, {count} recordings:[/red] {reason}")
    found = [one for one in found if one.rows[0].stage != "walk"]
    for row in (row for one in found for row in one.rows):
        row.require()
    return found


def heading_errors_deg(row: Row) -> tuple[float, float]:
    """Final and average, in the paper's order."""
    score = row.require()
    return score.heading_error_final_deg, score.heading_error_mean_deg
