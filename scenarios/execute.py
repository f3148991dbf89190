"""Trials over the cores: every walk is simulated once, and workers send rows home, not walks."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import tempfile
import threading
from collections.abc import Callable, Collection, Generator, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from footfall.errors import InputError
from footfall.models.policy import stock_policy
from footfall.scenarios.trial import Kept, Outcome, Row, Trial, failed, perform, walk_of
from footfall.simulate.cache import is_cached, plan_key
from footfall.simulate.walk import Walk

# What numerical libraries read their number of threads from.
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")

T = TypeVar("T")

CHUNK = 10  # trials that a worker does in one go, with one walk in memory

_shared: Any = None  # in a worker: metres walked, by walk
_held: tuple[tuple[int, str], Walk | InputError] | None = None  # in a worker: the last walk


@dataclass
class Progress:
    """How far the work is.

    Attributes
    ----------
    walks : what is walked, in order; metres : of each, walked so far
    trials, done : how many in all, and done
    compiling : kernels are being made ready for all workers
    """

    walks: tuple[Trial, ...]
    metres: list[float]
    trials: int
    done: int = 0
    compiling: bool = False


@dataclass(frozen=True)
class Group:
    """Trials that share a walk, and which of all they are; `steps` of the walk (`Plan.steps`)."""

    trials: list[Trial] = field(default_factory=list)
    index: list[int] = field(default_factory=list)
    steps: str = ""


class _Places(NamedTuple):
    """Folders of walks (None: the user's cache) and of footfalls (None: none are kept)."""

    walks: Path | None
    footfalls: Path | None


def cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def execute(
    trials: Sequence[Trial],
    *,
    workers: int | None = None,
    use_cache: bool = True,
    keep: Collection[int] = (),
    store: Path | None = None,
    on_progress: Callable[[Progress], None] | None = None,
) -> Generator[Outcome, None, None]:
    """Perform every trial and yield the outcomes in order.

    Where the generator is closed, or something breaks, workers are ended at once. What the physics, a
    recording or a method refuses is an outcome like others, whose rows tell the reason.

    Parameters
    ----------
    workers : processes; one a core when None; 1 works in this process
    use_cache : whether walks are taken from the user's cache and kept there
    keep : indices of the trials whose walk, recording, budget and tracks are wanted
    store : folder of footfalls, for methods that need no samples (`footfall.scenarios.store`)
    on_progress : called about five times a second
    """
    groups = grouped(trials)
    work = list(groups.values())
    progress = Progress(tuple(group.trials[0] for group in work), [0.0] * len(work), len(trials))
    with ExitStack() as stack:
        folder = None if use_cache else Path(stack.enter_context(tempfile.TemporaryDirectory()))
        workers = min(workers or cores(), len(trials))
        to_walk = not all(is_cached(key, folder) for key in groups)
        run = _here if workers <= 1 else partial(_spread, workers=workers, to_walk=to_walk)
        report = on_progress or (lambda now: None)
        yield from in_order(run(work, _Places(folder, store), frozenset(keep), progress, report))


def grouped(trials: Sequence[Trial]) -> dict[str, Group]:
    """Key of a walk (`plan_key`) -> the trials on it."""
    groups: dict[str, Group] = {}
    policy, keys = stock_policy(), {}
    for index, trial in enumerate(trials):
        # Plans are big: each is hashed once, not once a trial.
        short = (id(trial.setup.scenario), trial.number, trial.walk_seed)
        if short not in keys:
            plan = trial.plan
            keys[short] = plan_key(plan, policy), plan.steps
        key, steps = keys[short]
        group = groups.setdefault(key, Group(steps=steps))
        group.trials.append(trial)
        group.index.append(index)
    return groups


def warm(trial: Trial, *, walks: bool) -> None:
    """`footfall.scenarios.warm.warm`: the physics are loaded where something is to be done."""
    from footfall.scenarios import warm as compiling

    compiling.warm(trial, walks=walks)


def in_order(found: Iterator[tuple[int, T]]) -> Iterator[T]:
    """What is found by index, as soon as what is before it is there."""
    waiting: dict[int, T] = {}
    following = 0
    for index, outcome in found:
        waiting[index] = outcome
        while following in waiting:
            yield waiting.pop(following)
            following += 1


def _here(
    work: Sequence[Group],
    places: _Places,
    keep: frozenset[int],
    progress: Progress,
    report: Callable[[Progress], None],
) -> Iterator[tuple[int, Outcome]]:
    """In this process."""
    for at, group in enumerate(work):

        def walked(metres: float, at: int = at) -> None:
            progress.metres[at] = metres
            report(progress)

        also = [one.trials[0] for one in work if one.steps == group.steps]
        walk = _walk(group.trials[0], places.walks, walked, also)
        walked(group.trials[0].plan.route.length)
        for index, trial in zip(group.index, group.trials, strict=True):
            outcome = _one(trial, walk, index in keep, places.footfalls)
            progress.done += 1
            report(progress)
            yield index, outcome


def _spread(
    work: Sequence[Group],
    places: _Places,
    keep: frozenset[int],
    progress: Progress,
    report: Callable[[Progress], None],
    *,
    workers: int,
    to_walk: bool,
) -> Iterator[tuple[int, Outcome]]:
    """Over processes: each walk is a job of its own; what needs it follows in chunks."""
    own = {index: trial for group in work for index, trial in zip(group.index, group.trials, strict=True)}
    with worker_pool(workers, len(work)) as (pool, metres):
        progress.compiling = True
        report(progress)
        warm(work[0].trials[0], walks=to_walk)  # or every worker would compile the same
        progress.compiling = False
        alike: dict[str, list[int]] = {}
        for at, group in enumerate(work):
            alike.setdefault(group.steps, []).append(at)
        walking: dict[Future[Any], list[int]] = {
            pool.submit(_walk_job, ats[0], [work[at].trials[0] for at in ats], places.walks): ats
            for ats in alike.values()
        }
        trying: set[Future[Any]] = set()
        while walking or trying:
            finished, _ = wait([*walking, *trying], timeout=0.2, return_when=FIRST_COMPLETED)
            ready: list[tuple[int, Outcome]] = []
            for future in finished:
                if future in walking:
                    for at, refused in zip(walking.pop(future), future.result(), strict=True):
                        metres[at] = work[at].trials[0].plan.route.length
                        if refused is not None:
                            lost = zip(work[at].index, work[at].trials, strict=True)
                            ready += [(index, failed(trial, refused)) for index, trial in lost]
                            continue
                        for part in chunks(work[at]):
                            kept = [index in keep for index in part.index]
                            trying.add(pool.submit(_chunk_job, part, kept, places))
                else:
                    trying.remove(future)
                    ready += [
                        (index, Outcome(own[index], rows, kept)) for index, rows, kept in future.result()
                    ]
            progress.metres[:] = metres
            progress.done += len(ready)
            report(progress)
            yield from ready


def chunks(group: Group) -> Iterator[Group]:
    """Parts of a group that a worker does in one go."""
    for first in range(0, len(group.trials), CHUNK):
        part = slice(first, first + CHUNK)
        yield Group(group.trials[part], group.index[part])


def _walk(
    trial: Trial, folder: Path | None, report: Callable[[float], None] | None, also: Iterable[Trial]
) -> Walk | InputError:
    try:
        return walk_of(trial, folder, report, also)
    except InputError as error:
        return error


def _one(trial: Trial, walk: Walk | InputError, keep: bool, store: Path | None) -> Outcome:
    if isinstance(walk, InputError):
        return failed(trial, walk)
    return perform(trial, walk, keep=keep, store=store)


def _walk_job(at: int, trials: Sequence[Trial], folder: Path | None) -> list[InputError | None]:
    """In a worker: see that walks of the same steps are in the cache, or tell why each came to no end."""
    found: list[InputError | None] = []
    for trial in trials:
        # Where one did not come to its end, neither do the others.
        walk = next(filter(None, found), None) or hold(trial, folder, telling(at), trials)
        found.append(walk if isinstance(walk, InputError) else None)
    return found


def telling(at: int) -> Callable[[float], None]:
    """In a worker of `worker_pool`: writes the shared number at this place."""

    def report(number: float) -> None:
        _shared[at] = number

    return report


def hold(
    trial: Trial,
    folder: Path | None,
    report: Callable[[float], None] | None = None,
    also: Iterable[Trial] = (),
) -> Walk | InputError:
    """The trial's walk, read once for all trials that follow each other on it; or why there is none.

    `also` as of `walk_of`.
    """
    global _held
    key = (trial.walk_seed, plan_key(trial.plan, stock_policy()))
    if _held is None or _held[0] != key:
        _held = None  # two walks at once would be too much
        _held = key, _walk(trial, folder, report, also)
    return _held[1]


def _chunk_job(
    part: Group, keep: Sequence[bool], places: _Places
) -> list[tuple[int, tuple[Row, ...], Kept | None]]:
    """In a worker: trials on one walk. The trials themselves stay here: their scenarios are big."""
    walk = hold(part.trials[0], places.walks)
    found = []
    for index, trial, kept in zip(part.index, part.trials, keep, strict=True):
        outcome = _one(trial, walk, kept, places.footfalls)
        found.append((index, outcome.rows, outcome.kept))
    return found


def _start_worker(shared: Any) -> None:
    """Take the shared numbers, and end when the parent ends, however it does."""
    global _shared
    _shared = shared

    def follow() -> None:
        parent = multiprocessing.parent_process()
        assert parent is not None
        parent.join()
        os._exit(1)

    threading.Thread(target=follow, daemon=True).start()


@contextmanager
def _one_thread_each() -> Iterator[None]:
    """Processes that are started here leave each other the cores: their libraries start no threads."""
    mine = {name: "1" for name in _THREADS if name not in os.environ}
    os.environ.update(mine)
    try:
        yield
    finally:
        for name in mine:
            os.environ.pop(name, None)


@contextmanager
def _interrupt_held() -> Iterator[None]:
    """Ctrl-C is answered at the end: a process that is half started would tell of the pipe that broke.

    It is held back by a mask, which what is started here inherits, and by a handler: the mask is this
    thread's alone, and the signal goes to any thread of the process.
    """
    main = threading.current_thread() is threading.main_thread()
    held: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, frame: held.append(number)) if main else None
    try:
        with _interrupt_masked():
            yield
    finally:
        if before is not None:
            signal.signal(signal.SIGINT, before)
        if held:
            signal.raise_signal(signal.SIGINT)


@contextmanager
def _interrupt_masked() -> Iterator[None]:
    """SIGINT waits where threads have masks."""
    if sys.platform == "win32":
        yield
        return
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)


@contextmanager
def worker_pool(workers: int, shared: int = 0) -> Iterator[tuple[ProcessPoolExecutor, Any]]:
    """A pool of processes that end with this one, and at once where something breaks.

    Parameters
    ----------
    shared : how many numbers the workers can write for this process to read

    Yields
    ------
    The pool, and the shared numbers.

    Raises
    ------
    InputError
        A worker ended before its work did.
    """
    # Spawned, not forked: threads of the physics and of numerical libraries do not survive a fork.
    context = multiprocessing.get_context("spawn")
    numbers = context.RawArray("d", shared)
    all_there = False
    others = set(multiprocessing.active_children())
    with ProcessPoolExecutor(workers, context, _start_worker, (numbers,)) as pool:
        try:
            # A spawning pool starts a worker with each job until all are there.
            with _interrupt_held(), _one_thread_each():
                for started in [pool.submit(os.getpid) for _ in range(workers)]:
                    started.result()
                all_there = True
            yield pool, numbers
        except BrokenProcessPool as error:
            if all_there:
                raise InputError("a worker process was ended: killed, or out of memory") from error
            raise InputError(
                'a worker ended at once: a script must call this below `if __name__ == "__main__":`, or '
                "with workers=1"
            ) from error
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            for worker in set(multiprocessing.active_children()) - others:
                worker.terminate()
            raise
