"""What the benchmarks share: options, work over processes with progress, units dead-reckoned on walks."""

from __future__ import annotations

import argparse
import json
import multiprocessing
import sys
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, fields, replace
from itertools import product
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

from footfall.errors import InputError
from footfall.hdr.methods import Reckoning, pdr_track
from footfall.models.imu import draw_unit, load_spec
from footfall.models.policy import stock_policy
from footfall.models.route import Route
from footfall.pdr.footfalls import Footfalls
from footfall.scenarios.judge.papers import UNCORRECTED_AVERAGE_RANGE, UNCORRECTED_FINAL_RANGE
from footfall.scenarios.judge.score import compare
from footfall.scenarios.scenario import Scenario
from footfall.scenarios.trial import start_pose
from footfall.simulate.cache import cached_walk
from footfall.simulate.plan import versions
from footfall.simulate.record import record

J = TypeVar("J")
R = TypeVar("R")

NOISE_STEP = 100_000  # between the seeds of one unit's noises: more than there are units

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
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=err) as progress:
        if processes <= 1 or len(jobs) <= 1:
            return [work(job) for job in progress.track(jobs, description=label)]
        # Spawned, not forked: threads of the physics and of numerical libraries do not survive a fork.
        context = multiprocessing.get_context("spawn")
        with ProcessPoolExecutor(min(processes, len(jobs)), mp_context=context) as pool:
            return list(progress.track(pool.map(work, jobs), total=len(jobs), description=label))


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


@dataclass(frozen=True)
class Wearing:
    """One walk of a scenario and the seeds of the units to wear on it.

    `number` of the walk in the scenario decides its subject and its weather, `seed` all else. Each unit is
    heard through its own noise and `noises` more.
    """

    scenario: Scenario
    number: int
    seed: int
    units: tuple[int, ...]
    noises: int = 0


@dataclass(frozen=True)
class Case:
    """One unit on one walk, dead-reckoned, whose heading is off by `error`: (n,) rad, estimate - truth.

    `noise` counts the noises that the unit was heard through; 0 is its own.
    """

    walk: int
    unit: int
    noise: int
    footfalls: Footfalls
    error: np.ndarray

    def uncorrected_deg(self) -> np.ndarray:
        """(2,) final and average absolute heading error of dead reckoning."""
        return _final_and_average_deg(self.error)

    def corrected_deg(self, headings: np.ndarray) -> np.ndarray:
        """(s, 2) the same of a method's (s, n) headings (rad), which start where dead reckoning does."""
        return _final_and_average_deg(self.error + headings - self.footfalls.heading)


def _final_and_average_deg(error: np.ndarray) -> np.ndarray:
    size = np.degrees(np.abs(error))
    return np.stack([size[..., -1], size.mean(axis=-1)], axis=-1)


def _dead_reckon(wearing: Wearing) -> list[Case] | str:
    """Every unit of one walk; or why the walk came to no end."""
    scenario = wearing.scenario
    try:
        walk = cached_walk(replace(scenario.plan(wearing.number), seed=wearing.seed))
    except InputError as error:
        return str(error)
    spec, start, cases = load_spec(scenario.imu), start_pose(walk), []
    air = scenario.temperature_of(wearing.number)
    for unit, noise in product(wearing.units, range(1 + wearing.noises)):
        recording = record(walk, draw_unit(spec, unit), seed=unit + NOISE_STEP * noise, temperature=air)
        footfalls = Reckoning(recording, start).footfalls
        heading_error = compare(pdr_track(footfalls), walk).heading_error
        cases.append(Case(wearing.seed, unit, noise, footfalls, heading_error))
    return cases


def dead_reckoned(todo: Iterable[Wearing], processes: int, label: str) -> list[Case]:
    """Every unit on its walk, by unit and noise. Walks that came to no end are named and left out."""
    jobs = [wearing for wearing in todo if wearing.units]
    cases: list[Case] = []
    for wearing, result in zip(jobs, run_all(_dead_reckon, jobs, processes, label), strict=True):
        if isinstance(result, str):
            err.print(f"[red]left out, with {len(wearing.units)} units:[/red] {result}")
        else:
            cases += result
    return sorted(cases, key=lambda case: (case.unit, case.noise))


def shared_out(
    scenario: Scenario, walks: int, first_walk: int, units: Sequence[int], noises: int = 0
) -> list[Wearing]:
    """Walks with the seeds `first_walk`.., unit k on walk k mod `walks`."""
    worn = [tuple(unit for unit in units if unit % walks == number) for number in range(walks)]
    return [Wearing(scenario, number, first_walk + number, worn[number], noises) for number in range(walks)]
