"""Where a study's work is done: over the cores of this machine, or on a cluster, with the same results."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from footfall.errors import InputError
from footfall.models.policy import stock_policy
from footfall.scenarios.execute import Progress, chunks, cores, execute, grouped, in_order
from footfall.scenarios.store import footfalls_folder
from footfall.scenarios.studies.budget import Case
from footfall.scenarios.studies.cluster import Cluster, Craft, Piece
from footfall.scenarios.studies.listening import Lost, heard, listened, listening_jobs
from footfall.scenarios.studies.task import Done, Task, do, lost
from footfall.scenarios.trial import Outcome, Row, Trial, failed, perform
from footfall.simulate.cache import plan_key
from footfall.simulate.walk import Walk

Workers = int | Cluster | None  # processes of this machine, one a core where None; or a cluster


def count(workers: Workers) -> int:
    """How many there are; one, where a cluster has none yet."""
    if isinstance(workers, Cluster):
        return max(len(workers.workers), 1)
    return workers or cores()


def spread_over(cluster: Cluster) -> Callable[..., Iterator[Done]]:
    """What performs tasks of a sweep on a cluster (`footfall.scenarios.studies.local.spread`)."""

    def spread(
        tasks: Sequence[Task],
        *,
        store: Path | None = None,
        stop: Callable[[], bool],
        tick: Callable[[Mapping[str, float], bool], None],
    ) -> Iterator[Done]:
        pieces = [Piece(task.walk, (task, store is not None), at) for at, task in enumerate(tasks)]
        craft: Craft[_Task, Done] = Craft(_task_trial, _task, _task_lost)
        for at, done in cluster.work(pieces, craft, stop=stop, tick=tick):
            yield replace(done, task=tasks[at])

    return spread


def perform_trials(
    trials: Sequence[Trial],
    *,
    workers: Workers = None,
    store: Path | None = None,
    on_progress: Callable[[Progress], None] | None = None,
) -> Iterator[Outcome]:
    """`footfall.scenarios.execute.execute`, on a cluster where one is given.

    There each worker keeps footfalls in its own cache, not in `store`.
    """
    if not isinstance(workers, Cluster):
        return execute(trials, workers=workers, store=store, on_progress=on_progress)
    return in_order(_on_cluster(trials, workers, store is not None, on_progress or (lambda now: None)))


def _on_cluster(
    trials: Sequence[Trial], cluster: Cluster, keep: bool, report: Callable[[Progress], None]
) -> Iterator[tuple[int, Outcome]]:
    groups = grouped(trials)
    first = {key: group.trials[0] for key, group in groups.items()}
    at = {key: place for place, key in enumerate(groups)}
    progress = Progress(tuple(first.values()), [0.0] * len(groups), len(trials))
    parts = [(key, part) for key, group in groups.items() for part in chunks(group)]
    pieces = [Piece(key, (tuple(part.trials), keep), which) for which, (key, part) in enumerate(parts)]

    def tick(metres: Mapping[str, float], compiling: bool) -> None:
        for key in metres:
            progress.metres[at[key]] = first[key].plan.route.length
        report(progress)

    craft: Craft[_Trials, list[tuple[Row, ...]]] = Craft(_trials_trial, _trials, _trials_lost)
    for which, made in cluster.work(pieces, craft, tick=tick):
        part = parts[which][1]
        progress.done += len(made)
        for index, trial, rows in zip(part.index, part.trials, made, strict=True):
            yield index, Outcome(trial, rows)


def listen_to(
    trials: Sequence[Trial],
    *,
    workers: Workers = None,
    on_progress: Callable[[int, int], None] | None = None,
) -> list[Case | Lost]:
    """`footfall.scenarios.studies.listening.listened`, on a cluster where one is given."""
    if not isinstance(workers, Cluster):
        return listened(trials, workers=workers, on_progress=on_progress)
    jobs, policy = listening_jobs(trials), stock_policy()
    keys: dict[tuple[int, int, int], str] = {}  # plans are big: each is hashed once
    pieces: list[Piece[tuple[Trial, ...]]] = []
    for at, job in enumerate(jobs):
        short = (id(job[0].setup.scenario), job[0].number, job[0].walk_seed)
        if short not in keys:
            keys[short] = plan_key(job[0].plan, policy)
        pieces.append(Piece(keys[short], tuple(job), at))
    found: list[Case | Lost] = []
    craft: Craft[tuple[Trial, ...], list[Case | Lost]] = Craft(_first, heard, _unheard)
    for part in in_order(workers.work(pieces, craft)):
        found += part
        if on_progress is not None:
            on_progress(len(found), len(trials))
    return found


# What travels: functions of this module, by name. Tasks and trials stay here, rows are sent home.

_Task = tuple[Task, bool]  # and whether footfalls are kept
_Trials = tuple[tuple[Trial, ...], bool]


def _task_trial(given: _Task) -> Trial:
    trials, _ = next(given[0].trials())
    return trials[0]


def _task(given: _Task, walk: Walk) -> Done:
    task, keep = given
    done = do(task, store=footfalls_folder() if keep else None, walk=walk)
    return replace(done, task=replace(task, settings=()))


def _task_lost(given: _Task, error: InputError, stage: str) -> Done:
    return lost(given[0], error, stage)


def _trials_trial(given: _Trials) -> Trial:
    return given[0][0]


def _trials(given: _Trials, walk: Walk) -> list[tuple[Row, ...]]:
    trials, keep = given
    store = footfalls_folder() if keep else None
    return [perform(trial, walk, store=store).rows for trial in trials]


def _trials_lost(given: _Trials, error: InputError, stage: str) -> list[tuple[Row, ...]]:
    return [failed(trial, error, stage).rows for trial in given[0]]


def _first(trials: Sequence[Trial]) -> Trial:
    return trials[0]


def _unheard(trials: Sequence[Trial], error: InputError, stage: str) -> list[Case | Lost]:
    return [(trial, str(error)) for trial in trials]
