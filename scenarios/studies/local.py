"""Tasks of a study over the cores of this machine: each walk first, then what is recorded on it.

A worker that is killed costs the tasks in the making: they are tried again, each alone, and one that ends its
worker again is rows that tell so.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from footfall.errors import InputError
from footfall.scenarios.execute import telling, warm, worker_pool
from footfall.scenarios.studies.queue import Job, Queue
from footfall.scenarios.studies.task import Done, Task, do, do_walk, lost
from footfall.simulate.cache import is_cached

_TICK_S = 0.2
_TRIES = 3  # of compiling
_ENDED = InputError("its worker process was ended: killed, or out of memory")

Tick = Callable[[Mapping[str, float], bool], None]


def spread(
    tasks: Sequence[Task],
    *,
    workers: int,
    walks: Path | None = None,
    store: Path | None = None,
    stop: Callable[[], bool] = lambda: False,
    tick: Tick = lambda walked, compiling: None,
) -> Iterator[Done]:
    """Perform tasks and yield each as it is done.

    Parameters
    ----------
    workers : processes; 1 works in this one
    walks, store : folders, as of `do`
    stop : asked now and then; once it is true no more is begun, and tasks in the making are finished
    tick : called some times a second with the metres walked of each walk, and whether kernels are compiled
    """
    if not tasks:
        return
    queue = Queue(tasks, lambda key: is_cached(key, walks))
    if workers <= 1:
        yield from _here(queue, walks, store, stop, tick)
    else:
        yield from _Pool(tasks, queue, workers, (walks, store), stop, tick).run()


class _StoppedError(Exception):
    """Walks in the making are not waited for."""


def _here(
    queue: Queue[Task], walks: Path | None, store: Path | None, stop: Callable[[], bool], tick: Tick
) -> Iterator[Done]:
    """In this process."""
    while queue and not stop():
        job = queue.next()
        if not job.walks:
            tick({}, False)
            yield do(job.task, walks, store)
            continue

        def report(metres: float, job: Job[Task] = job) -> None:
            if stop():
                raise _StoppedError
            tick(dict.fromkeys(job.keys, metres), False)

        try:
            refused = do_walk(job.task, walks, report, job.also)
        except _StoppedError:
            return
        tick(dict.fromkeys(job.keys, math.inf), False)
        for key in job.keys:
            if refused is None:
                queue.walked(key)
            else:
                yield from (lost(task, refused) for task in queue.fell(key))


class _Pool:
    """Over processes."""

    def __init__(
        self,
        tasks: Sequence[Task],
        queue: Queue[Task],
        workers: int,
        folders: tuple[Path | None, Path | None],
        stop: Callable[[], bool],
        tick: Tick,
    ) -> None:
        self._first, self._queue, self._folders = tasks[0], queue, folders
        self._workers = min(workers, len(tasks))
        self._stop, self._tick = stop, tick
        self._at = {key: at for at, key in enumerate(queue.walks)}
        self._suspects: deque[Job[Task]] = deque()  # in the making when a worker ended
        self._warm = 0  # tries, until it is done

    def run(self) -> Iterator[Done]:
        while (self._queue or self._suspects) and not self._stop():
            alone = bool(self._suspects)
            workers = 1 if alone else self._workers
            with suppress(_StoppedError), worker_pool(workers, len(self._at)) as (pool, metres):
                if self._make_ready(pool):
                    yield from self._work(pool, workers, metres, alone=alone)

    def _make_ready(self, pool: ProcessPoolExecutor) -> bool:
        """Compile in one worker, or all would compile the same; whether that went well."""
        if self._warm < 0:
            return True
        self._tick({}, True)
        try:
            pool.submit(_warm_job, self._first, bool(self._at)).result()
            self._warm = -1
        except BrokenProcessPool:
            self._warm += 1
            if self._warm >= _TRIES:
                raise
        return self._warm < 0

    def _work(self, pool: ProcessPoolExecutor, workers: int, metres: Any, *, alone: bool) -> Iterator[Done]:
        """Until nothing is left, whoever asked stops it, or a worker ends. Suspects go one by one."""
        running: dict[Future[Any], Job[Task]] = {}
        ahead = 1 if alone else workers + 1  # so that nobody waits for the next one
        while True:
            broken = False
            while len(running) < ahead and not self._stop() and (self._suspects if alone else self._queue):
                job = self._suspects.popleft() if alone else self._queue.next()
                try:
                    running[self._submit(pool, job)] = job
                except BrokenProcessPool:
                    self._suspects.append(job)
                    broken = True
                    break
            if not running and not broken:
                return
            if self._stop():
                walking = sum(job.walks for job in running.values())
                if walking >= workers or walking == len(running):
                    raise _StoppedError
            finished, _ = wait(running, timeout=_TICK_S, return_when=FIRST_COMPLETED)
            for future in finished:
                try:
                    result = future.result()
                except BrokenProcessPool:
                    broken = True
                    continue
                job = running.pop(future)
                if job.walks:
                    metres[self._at[job.task.walk]] = math.inf
                yield from self._ended(job, result)
            self._tick({key: metres[at] for key, at in self._at.items()}, False)
            if broken and alone:
                for job in running.values():
                    yield from self._ended(job, _ENDED)
                return
            if broken:
                self._suspects.extend(running.values())
                return

    def _submit(self, pool: ProcessPoolExecutor, job: Job[Task]) -> Future[Any]:
        walks, store = self._folders
        if job.walks:
            at = self._at[job.task.walk]
            self._at |= dict.fromkeys(job.keys, at)
            return pool.submit(_walk_job, at, job.task, walks, job.also)
        return pool.submit(do, job.task, walks, store)

    def _ended(self, job: Job[Task], result: Done | InputError | None) -> Iterator[Done]:
        if isinstance(result, Done):
            yield result
        elif result is None:
            for key in job.keys:
                self._queue.walked(key)
        elif job.walks:
            stage = "worker" if result is _ENDED else "walk"
            for key in job.keys:
                yield from (lost(task, result, stage) for task in self._queue.fell(key))
        else:
            yield lost(job.task, result, "worker")


def _walk_job(at: int, task: Task, folder: Path | None, also: Sequence[Task]) -> InputError | None:
    """In a worker."""
    return do_walk(task, folder, telling(at), also)


def _warm_job(task: Task, walks: bool) -> None:
    """In a worker: what is compiled, whatever the parameters."""
    trials, _ = next(task.trials())
    setup = trials[0].setup
    methods = {method.name: method for method in setup.methods}
    warm(replace(trials[0], setup=replace(setup, methods=tuple(methods.values()))), walks=walks)
