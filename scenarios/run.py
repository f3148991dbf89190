"""Run a scenario: walk, record, navigate, correct and score, walk by walk over the cores."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Generator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, wait
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from footfall.errors import InputError
from footfall.hdr.directions import DirectionParams
from footfall.hdr.methods import Reckoning, require_methods, tracks
from footfall.models.imu import draw_unit, load_spec
from footfall.pdr.filter.ins import FilterSettings
from footfall.pdr.reckoning import PdrParams, StartPose
from footfall.pdr.track import Track
from footfall.recording import Recording
from footfall.scenarios.judge.score import Score, score
from footfall.scenarios.scenario import Scenario
from footfall.simulate.budget import DriftBudget
from footfall.simulate.cache import cached_walk
from footfall.simulate.record import BIAS_TIME, record, record_with_budget
from footfall.simulate.walk import Walk

DEFAULT_METHODS = ("pdr", "hdr")
UNSURE = FilterSettings.paper().gyro_bias_sd  # rad/s, of a gyro bias that no rest has told
OTHER_UNITS_FROM = 1000  # seeds of the units that are reported beside the scenario's own
OTHER_NOISES_FROM = 5000  # seeds of the noises that the walks' own units are heard through once more

_done: Any = None  # in a worker: two numbers a task, what `perform` reports


@dataclass(frozen=True)
class Task:
    """One walk of a run.

    Attributes
    ----------
    scenario : what to walk; number : of the walk in it, from 0
    walk_seed : of the walk (body, gait, wander)
    unit_seed, noise_seed : of the IMU unit, and of what differs from recording to recording of one unit
    imu : stock name or data sheet
    methods : names
    others : seeds of further units of the same sheet, each with the noise of its own seed, on the same walk
    noises : seeds of further noises of this unit, scored on the same walk
    """

    scenario: Scenario
    number: int
    walk_seed: int
    unit_seed: int
    noise_seed: int
    imu: str
    methods: tuple[str, ...]
    others: tuple[int, ...] = ()
    noises: tuple[int, ...] = ()
    use_cache: bool = True


@dataclass(frozen=True)
class Result:
    """What one walk gave.

    Attributes
    ----------
    scores : method -> score; tracks : method -> track
    others, noises : one method -> score mapping for each further unit, and for each further noise
    """

    task: Task
    walk: Walk
    recording: Recording
    budget: DriftBudget
    tracks: Mapping[str, Track]
    scores: Mapping[str, Score]
    others: tuple[Mapping[str, Score], ...]
    noises: tuple[Mapping[str, Score], ...] = ()


def start_pose(walk: Walk, bias_s: float = BIAS_TIME) -> StartPose:
    """The known start: the IMU's true pose at rest, at the last sample of the first `bias_s` seconds.

    Raises
    ------
    InputError
        The walk does not stand still for so long.
    """
    if bias_s > walk.calibration_s:
        raise InputError(
            f"start: the walk stands still for {walk.calibration_s:g} s, less than the {bias_s:g} s of T_bias"
        )
    return StartPose(*walk.pose_at_rest(bias_s))


def reckoning(scenario: Scenario, walk: Walk, recording: Recording) -> Reckoning:
    """A recording and what a run tells of it: start pose, T_bias, and the direction of the path's begin.

    Where a bias appears with the first step, filters under a heading method are told that the rest says
    little of it.
    """
    guided = FilterSettings(gyro_bias_sd=UNSURE) if scenario.bias_shift else FilterSettings()
    return Reckoning(
        recording,
        start_pose(walk, scenario.bias_time),
        PdrParams(bias_s=scenario.bias_time),
        DirectionParams(reference=float(scenario.path.route.heading[0])),
        guided,
    )


def perform(task: Task, on_progress: Callable[[float, int], None] | None = None) -> Result:
    """Walk one walk of a scenario, record it with its unit, navigate and score.

    Parameters
    ----------
    on_progress : called now and then with the metres walked and which further recording is being scored (or
        0): those of `task.others` first, then those of `task.noises`

    Raises
    ------
    InputError
        What any step refuses: a fall, an unknown method, a broken data sheet.
    """
    scenario = task.scenario
    plan = replace(scenario.plan(task.number), seed=task.walk_seed)
    report, length = on_progress or (lambda metres, units: None), plan.route.length
    walk = cached_walk(plan, use_cache=task.use_cache, on_progress=lambda metres: report(metres, 0))
    spec = load_spec(task.imu)

    air = scenario.temperature_of(task.number)
    recording, budget = record_with_budget(
        walk,
        draw_unit(spec, task.unit_seed),
        seed=task.noise_seed,
        temperature=air,
        bias_shift=scenario.unit_bias_shift(task.unit_seed),
        bias_time=scenario.bias_time,
    )
    made = tracks(reckoning(scenario, walk, recording), task.methods)

    seeds = [*((unit, unit) for unit in task.others), *((task.unit_seed, noise) for noise in task.noises)]
    further = []
    for count, (unit, noise) in enumerate(seeds, start=1):
        report(length, count)
        other = record(
            walk,
            draw_unit(spec, unit),
            seed=noise,
            temperature=air,
            bias_shift=scenario.unit_bias_shift(unit),
        )
        found = tracks(reckoning(scenario, walk, other), task.methods)
        further.append({name: score(track, walk) for name, track in found.items()})
    others, noises = further[: len(task.others)], further[len(task.others) :]
    scores = {name: score(track, walk) for name, track in made.items()}
    return Result(task, walk, recording, budget, made, scores, tuple(others), tuple(noises))


def tasks(
    scenario: Scenario,
    *,
    walks: int | None = None,
    seed: int | None = None,
    imu: str | None = None,
    methods: Sequence[str] = DEFAULT_METHODS,
    other_units: int = 0,
    noises: int = 0,
    use_cache: bool = True,
) -> list[Task]:
    """The walks of a run; arguments left out are the scenario's.

    `other_units` further units (seeds from 1000) are shared out over the walks; each walk's own unit is heard
    through `noises` further noises, which no other walk has (seeds from 5000).

    Raises
    ------
    InputError
        An unknown method or IMU; or the scenario stands still for too short a time before it walks.
    """
    require_methods(methods)
    load_spec(imu or scenario.imu)
    if scenario.calibration < scenario.bias_time:
        raise InputError(
            f"{scenario.name}: sensor.calibration_s = {scenario.calibration:g}: "
            f"a run averages the static bias over sensor.bias_time_s = {scenario.bias_time:g} s at rest"
        )
    count = scenario.walks if walks is None else walks
    base = scenario.seed if seed is None else seed
    own_sheet = imu is None or imu == scenario.imu
    # Another sheet's units, or walks beyond the scenario's own, are simply drawn.
    chosen = own_sheet and seed is None
    units = [scenario.unit_seed(number) if chosen else base + number for number in range(count)]
    return [
        Task(
            scenario=scenario,
            number=number,
            walk_seed=base + number,
            unit_seed=unit,
            noise_seed=unit,
            imu=imu or scenario.imu,
            methods=tuple(methods),
            others=tuple(range(OTHER_UNITS_FROM + number, OTHER_UNITS_FROM + other_units, count)),
            noises=tuple(range(OTHER_NOISES_FROM + number, OTHER_NOISES_FROM + noises * count, count)),
            use_cache=use_cache,
        )
        for number, unit in enumerate(units)
    ]


def _start_worker(done: Any) -> None:
    """Take the shared array of progress, and end when the parent ends, however it does."""
    global _done
    _done = done

    def follow() -> None:
        parent = multiprocessing.parent_process()
        assert parent is not None
        parent.join()
        os._exit(1)

    threading.Thread(target=follow, daemon=True).start()


def _perform(index: int, task: Task) -> Result:
    def report(metres: float, units: int) -> None:
        _done[2 * index], _done[2 * index + 1] = metres, units

    return perform(task, report)


def perform_all(
    todo: Sequence[Task], on_progress: Callable[[int, float, int], None] | None = None
) -> Generator[Result, None, None]:
    """Perform every task, one process a core, and yield results in order.

    Where one task fails, or the generator is closed, the others are ended at once.

    Parameters
    ----------
    on_progress : called about five times a second with each task's index and what `perform` reports
    """
    workers = min(len(todo), len(os.sched_getaffinity(0)))
    if workers <= 1:
        for index, task in enumerate(todo):
            yield perform(task, None if on_progress is None else partial(on_progress, index))
        return
    # Spawned, not forked: threads of the physics and of numerical libraries do not survive a fork.
    context = multiprocessing.get_context("spawn")
    done = context.RawArray("d", 2 * len(todo))
    others = set(multiprocessing.active_children())
    with ProcessPoolExecutor(workers, context, _start_worker, (done,)) as pool:
        try:
            # Ctrl-C is the parent's to answer. Workers inherit that it is held back while they are started.
            mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
            try:
                futures = [pool.submit(_perform, index, task) for index, task in enumerate(todo)]
            finally:
                signal.pthread_sigmask(signal.SIG_SETMASK, mask)
            for future in futures:
                while not wait([future], timeout=0.2).done:
                    if on_progress is not None:
                        for index in range(len(todo)):
                            on_progress(index, done[2 * index], int(done[2 * index + 1]))
                yield future.result()
        except BaseException:
            for worker in set(multiprocessing.active_children()) - others:
                worker.terminate()
            raise
