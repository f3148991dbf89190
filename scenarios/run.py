"""Run a scenario: walk, record, navigate, correct and score, walk by walk over the cores."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from multiprocessing.managers import ValueProxy

from footfall.hdr.methods import Reckoning, tracks
from footfall.models.imu import draw_unit, load_spec
from footfall.pdr.pdr import StartPose
from footfall.pdr.track import Track
from footfall.recording import Recording
from footfall.scenarios.scenario import Scenario
from footfall.scenarios.score import Score, score
from footfall.simulate.budget import DriftBudget
from footfall.simulate.cache import cached_walk
from footfall.simulate.record import record, record_with_budget
from footfall.simulate.walk import Walk

DEFAULT_METHODS = ("pdr", "hdr")
OTHER_UNITS_FROM = 1000  # seeds of the units that are reported beside the scenario's own


@dataclass(frozen=True)
class Task:
    """One walk of a run.

    Attributes
    ----------
    scenario : a stock name or a TOML file; number : of the walk in the scenario
    walk_seed, unit_seed : of the walk (body, gait, wander) and of the IMU unit with its noise
    imu : stock name or data sheet
    methods : names
    others : seeds of further units of the same sheet, scored on the same walk
    """

    scenario: Scenario
    number: int
    walk_seed: int
    unit_seed: int
    imu: str
    methods: tuple[str, ...]
    others: tuple[int, ...] = ()
    use_cache: bool = True


@dataclass(frozen=True)
class Result:
    """What one walk gave.

    Attributes
    ----------
    scores : method -> score; tracks : method -> track
    others : one method -> score mapping for each further unit
    """

    task: Task
    walk: Walk
    recording: Recording
    budget: DriftBudget
    tracks: Mapping[str, Track]
    scores: Mapping[str, Score]
    others: tuple[Mapping[str, Score], ...]


def start_pose(walk: Walk) -> StartPose:
    """The known start: position and heading of the first true footfall."""
    position = walk.footfalls.position[0]
    return StartPose(
        (float(position[0]), float(position[1]), float(position[2])), float(walk.footfalls.heading[0])
    )


def perform(task: Task, on_progress: Callable[[float], None] | None = None) -> Result:
    """Walk one walk of a scenario, record it with its unit, navigate and score.

    Raises
    ------
    InputError
        What any step refuses: a fall, an unknown method, a broken data sheet.
    """
    scenario = task.scenario
    plan = replace(scenario.plan(task.number), seed=task.walk_seed)
    walk = cached_walk(plan, use_cache=task.use_cache, on_progress=on_progress)
    spec = load_spec(task.imu)
    start = start_pose(walk)

    recording, budget = record_with_budget(
        walk, draw_unit(spec, task.unit_seed), seed=task.unit_seed, temperature=scenario.temperature
    )
    made = tracks(Reckoning(recording, start), task.methods)
    others = []
    for seed in task.others:
        other = record(walk, draw_unit(spec, seed), seed=seed, temperature=scenario.temperature)
        found = tracks(Reckoning(other, start), task.methods)
        others.append({name: score(track, walk) for name, track in found.items()})
    scores = {name: score(track, walk) for name, track in made.items()}
    return Result(task, walk, recording, budget, made, scores, tuple(others))


def tasks(
    scenario: Scenario,
    *,
    walks: int | None = None,
    seed: int | None = None,
    imu: str | None = None,
    methods: Sequence[str] = DEFAULT_METHODS,
    other_units: int = 0,
    use_cache: bool = True,
) -> list[Task]:
    """The walks of a run; arguments left out are the scenario's.

    `other_units` further units (seeds from 1000) are shared out over the walks.
    """
    count = scenario.walks if walks is None else walks
    base = scenario.seed if seed is None else seed
    own_sheet = imu is None or imu == scenario.imu
    return [
        Task(
            scenario=scenario,
            number=number,
            walk_seed=base + number,
            # Another sheet's units, or walks beyond the scenario's own, are simply drawn.
            unit_seed=scenario.unit_seed(number) if own_sheet and seed is None else base + number,
            imu=imu or scenario.imu,
            methods=tuple(methods),
            others=tuple(range(OTHER_UNITS_FROM + number, OTHER_UNITS_FROM + other_units, count)),
            use_cache=use_cache,
        )
        for number in range(count)
    ]


Progress = Callable[[int, float], None]  # walk number, metres


def _perform(task: Task, metres: ValueProxy[float] | None) -> Result:
    def report(distance: float) -> None:
        if metres is not None:
            metres.value = distance

    return perform(task, report)


def perform_all(todo: Sequence[Task], on_progress: Progress | None = None) -> Iterator[Result]:
    """Perform every task, one process a core, and yield results in order.

    Parameters
    ----------
    on_progress : called about five times a second with each walk's number and its distance so far
    """
    workers = min(len(todo), os.cpu_count() or 1)
    if workers <= 1:
        for number, task in enumerate(todo):
            yield perform(task, None if on_progress is None else partial(on_progress, number))
        return
    # Spawned, not forked: threads of the physics and of numerical libraries do not survive a fork.
    context = multiprocessing.get_context("spawn")
    with context.Manager() as manager, ProcessPoolExecutor(workers, mp_context=context) as pool:
        metres = [manager.Value("d", 0.0) for _ in todo]
        futures = [pool.submit(_perform, task, value) for task, value in zip(todo, metres, strict=True)]
        try:
            for future in futures:
                while True:
                    try:
                        result = future.result(timeout=0.2)
                        break
                    except TimeoutError:
                        if on_progress is not None:
                            for number, value in enumerate(metres):
                                on_progress(number, value.value)
                yield result
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
