"""A study from its first task to its dataset. What is there is not done again."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from pickle import PicklingError, dumps
from typing import Any

from footfall.errors import InputError
from footfall.scenarios.execute import cores
from footfall.scenarios.store import footfalls_folder
from footfall.scenarios.studies.cluster import Cluster
from footfall.scenarios.studies.describe import write_document
from footfall.scenarios.studies.local import spread
from footfall.scenarios.studies.parts import StudyFolder
from footfall.scenarios.studies.plan import Plan, plan_of, task_seconds, walk_seconds
from footfall.scenarios.studies.spreading import spread_over
from footfall.scenarios.studies.study import Study
from footfall.scenarios.studies.task import DiskFullError, Done, StoppedError, Task, no_room
from footfall.scenarios.studies.tracks import write_tracks
from footfall.simulate.cache import is_cached

ALIKE = 20  # tasks, or walks, that all fail for one reason: nobody waits for the rest

Executor = Callable[..., Iterator[Done]]


@dataclass(frozen=True)
class Progress:
    """How far a sweep is.

    Attributes
    ----------
    folder : of the results
    recordings : to be made or found, all in all; done : of them, and those of earlier starts
    rows, failed : of this start
    metres, route : walked so far, and to be walked
    share : of the work that this start had to do, from 0 to 1
    stage : "compiling", "walking", "navigating", "writing", or at the end "finished" or "stopped"
    warnings : what was found in the folder
    """

    folder: Path
    recordings: int
    done: int = 0
    rows: int = 0
    failed: int = 0
    metres: float = 0.0
    route: float = 0.0
    share: float = 0.0
    stage: str = "navigating"
    warnings: tuple[str, ...] = field(default=())


def sweep(
    study: Study | Plan | str | os.PathLike[str],
    folder: str | os.PathLike[str] | None = None,
    executor: int | Cluster | Executor | None = None,
    *,
    fresh: bool = False,
    retry_failed: bool = False,
    stop: Callable[[], bool] = lambda: False,
    on_progress: Callable[[Progress], None] = lambda now: None,
    command: str = "",
) -> Iterator[Progress]:
    """Run a study, or what is left of it.

    Parameters
    ----------
    study : or its name or file, or its plan
    folder : of its results; out/NAME when None
    executor : processes, one a core when None; a cluster; or a callable as `local.spread`
    fresh : delete what is there
    retry_failed : run failed tasks again
    stop : called now and then; once true, running tasks are finished, and the rest is left
    on_progress : called some times a second
    command : that makes the study again, for its document

    Yields
    ------
    Progress after each task, and at the end.

    Raises
    ------
    InputError
        The study cannot be, another sweep is at work in the folder, or all tasks fail for one reason.
    StoppedError
        The disk is full, or the cluster is gone.
    """
    if not isinstance(study, Study | Plan):
        study = Study.read(study)
    plan = study if isinstance(study, Plan) else plan_of(study)
    place = StudyFolder(Path(folder or Path("out") / plan.study.name))
    with place.alone():
        if fresh:
            place.forget()
        broken = place.tidy()
        if retry_failed:
            place.forget_failures()
        warnings = tuple(f"{name} was half written, and is made again" for name in broken)
        try:
            yield from _done(plan, place, executor, stop, on_progress, command, warnings)
        except DiskFullError as error:
            raise StoppedError(str(error)) from None
        except (InputError, OSError) as error:
            if no_room(error):
                raise StoppedError(str(error)) from None
            raise


def _done(
    plan: Plan,
    place: StudyFolder,
    executor: int | Cluster | Executor | None,
    stop: Callable[[], bool],
    on_progress: Callable[[Progress], None],
    command: str,
    warnings: tuple[str, ...],
) -> Iterator[Progress]:
    told = write_document(plan, place.path, command)
    left = place.left(plan.tasks)
    watch = _Watch(plan, left, place.path, warnings, on_progress)
    if left:
        alike = _Alike(over=len(left) < len(plan.tasks))  # others were done before
        for done in _executor(executor, left)(left, store=footfalls_folder(), stop=stop, tick=watch.tick):
            place.put(done)
            alike.see(done, place)
            yield watch.add(done)
        if place.left(plan.tasks):
            yield replace(watch.now, stage="stopped")
            return
    whole = place.is_compacted(plan)
    if not whole:
        watch.say("writing")
        place.compact(plan)
    place.write_timing()
    drawn = write_tracks(plan, place, lambda: watch.say("writing"))
    if told or drawn or not whole or not (place.path / "report.html").is_file():
        from footfall.scenarios.report.page import write_page  # late: what draws

        watch.say("writing")
        write_page(place.path)
    yield replace(watch.now, stage="finished", share=1.0)


def _executor(given: int | Cluster | Executor | None, tasks: Sequence[Task]) -> Executor:
    if isinstance(given, Cluster):
        return spread_over(given)
    if callable(given):
        return given
    workers = given or cores()
    if workers > 1 and not _travels(tasks[0]):
        workers = 1

    def local(tasks: Sequence[Task], **keys: Any) -> Iterator[Done]:
        return spread(tasks, workers=workers, **keys)

    return local


def _travels(task: Task) -> bool:
    """Whether another process can have it: a lambda, or a function of a notebook, cannot."""
    try:
        dumps(task)
    except (PicklingError, AttributeError, TypeError):
        return False
    return True


class _Watch:
    """Keeps count."""

    def __init__(
        self,
        plan: Plan,
        left: Sequence[Task],
        folder: Path,
        warnings: tuple[str, ...],
        report: Callable[[Progress], None],
    ) -> None:
        self._walks, self._report = plan.walks, report
        to_walk = {task.walk for task in left}
        self._to_walk = {key for key in to_walk if not is_cached(key)}
        self._metres: dict[str, float] = {}
        self._worked = 0.0
        self._work = sum(task_seconds(task, plan.walks[task.walk]) for task in left)
        self._walking = walk_seconds(plan.walks[key] for key in self._to_walk)
        self._work += sum(self._walking.values())
        recordings = _recordings(plan.tasks)
        self.now = Progress(
            folder=folder,
            recordings=recordings,
            done=recordings - _recordings(left),
            route=sum(plan.walks[key].metres for key in self._to_walk),
            warnings=warnings,
        )

    def tick(self, metres: Mapping[str, float], compiling: bool) -> None:
        """Of walks in the making."""
        for key in metres.keys() & self._to_walk:
            self._metres[key] = min(metres[key], self._walks[key].metres)
        walking = any(0 < self._metres.get(key, 0.0) < self._walks[key].metres for key in self._to_walk)
        self.say("compiling" if compiling else "walking" if walking else "navigating")

    def add(self, done: Done) -> Progress:
        """A task."""
        self._worked += task_seconds(done.task, self._walks[done.task.walk])
        if done.task.walk in self._to_walk:
            self._metres[done.task.walk] = self._walks[done.task.walk].metres
        self.now = replace(
            self.now,
            done=self.now.done + len(done.task.seeds),
            rows=self.now.rows + len(done.rows),
            failed=self.now.failed + done.failures,
        )
        self.say(self.now.stage)
        return self.now

    def say(self, stage: str) -> None:
        """Tell how far it is."""
        metres = sum(self._metres.values())
        shares = {
            self._walks[key].steps: walked / self._walks[key].metres for key, walked in self._metres.items()
        }
        worked = self._worked + sum(self._walking[steps] * share for steps, share in shares.items())
        self.now = replace(
            self.now, metres=metres, stage=stage, share=min(worked / self._work, 1.0) if self._work else 1.0
        )
        self._report(self.now)


class _Alike:
    """Sees to it that a study all of which fails for one reason ends with that reason, and soon."""

    def __init__(self, over: bool) -> None:
        self._reasons: frozenset[str] | None = None
        self._seen: set[str] = set()
        self._tasks: list[Task] = []
        self._over = over

    def see(self, done: Done, place: StudyFolder) -> None:
        """One more task.

        Raises
        ------
        InputError
            So many have failed alike; nothing is kept of them.
        """
        if self._over:
            return
        reasons = frozenset(_general(row.error) for row in done.rows)
        self._over = any(row.score is not None for row in done.rows) or reasons != (self._reasons or reasons)
        self._reasons = reasons
        self._tasks.append(done.task)
        self._seen.add(done.task.walk if done.rows[0].stage == "walk" else done.task.name)
        if len(self._seen) >= ALIKE and not self._over:
            place.drop(self._tasks)
            raise InputError(f"the first {ALIKE} tasks all failed: {done.rows[0].error}")


def _general(reason: str) -> str:
    return re.sub(r"\d+(\.\d+)?", "#", reason)


def _recordings(tasks: Iterable[Task]) -> int:
    return sum(len(task.seeds) for task in tasks)
