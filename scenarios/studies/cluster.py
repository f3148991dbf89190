"""Work on a Dask cluster that is there already: walks are futures, and this process alone keeps what is made.

A walk is a task; the scheduler moves its result to whoever needs it, and one copy goes into the cache here.
Dask does again what a worker that died had in the making. What this process sees to itself: that workers are
of its versions and code, that nobody waits for ever, and that a task that ends its worker costs no other its
rows.
"""

from __future__ import annotations

import os
import pickle
import queue
import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar
from uuid import uuid4
from warnings import catch_warnings, filterwarnings

from footfall.errors import InputError
from footfall.scenarios.studies.extra import needed
from footfall.scenarios.studies.queue import Job, Queue
from footfall.scenarios.studies.task import DiskFullError, StoppedError
from footfall.scenarios.studies.worker import OtherWalkError, about, do_job, require_same, walk_job
from footfall.scenarios.trial import Trial
from footfall.simulate.cache import keep_walk, kept_walk
from footfall.simulate.walk import Walk

PATIENCE_S = 600.0  # without any result, after which it stops
_ALONE_S = 60.0  # without a worker, after which it is said, again and again
_CONNECT_S = 10.0
_LOOK_S = 2.0  # between looks at who is there
_TICK_S = 0.2
_AHEAD = 2  # tasks a worker: nobody waits for the next one
_ENDED = InputError("its worker process was ended: killed, or out of memory")

P = TypeVar("P")
R = TypeVar("R")


@dataclass(frozen=True)
class Piece(Generic[P]):
    """What is done with one walk. `walk` : the walk's key; `given` : plain data; `at` : which of all."""

    walk: str
    given: P
    at: int

    @property
    def steps(self) -> str:
        """Each walk is walked by itself: it is a future of its own."""
        return self.walk


@dataclass(frozen=True)
class Craft(Generic[P, R]):
    """How pieces are done; functions of modules, which travel.

    Attributes
    ----------
    trial : one on the piece's walk
    do : of a piece and its walk, in a worker
    lost : here, of a piece that came to no end, the reason and the stage of it
    """

    trial: Callable[[P], Trial]
    do: Callable[[P, Walk], R]
    lost: Callable[[P, InputError, str], R]


class Cluster:
    """A Dask cluster, for as long as the context lasts.

    Parameters
    ----------
    scheduler : its address (`tcp://host:8786`), or a `distributed.Client`
    patience_s : without any result, after which it stops
    say : called with what people should know

    Raises
    ------
    InputError
        distributed is not installed; no scheduler answers; or it or a worker is of other versions or code.
    """

    def __init__(
        self,
        scheduler: Any,
        *,
        patience_s: float = PATIENCE_S,
        say: Callable[[str], None] = lambda text: None,
    ) -> None:
        self._given, self.patience_s, self._say = scheduler, patience_s, say
        self._client: Any = None

    def __enter__(self) -> Cluster:
        distributed = needed("distributed", extra="cluster")
        if isinstance(self._given, str):
            try:
                self._client = distributed.Client(self._given, timeout=_CONNECT_S, set_as_default=False)
            except (OSError, ValueError) as error:
                reason = (
                    str(error).splitlines()[0] if isinstance(error, ValueError) else "no scheduler answers"
                )
                raise InputError(reason, self._given) from None
        else:
            self._client = self._given
        try:
            self._require_alike()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *error: object) -> None:
        if self._client is not self._given:
            self._client.close(timeout=1)

    @property
    def workers(self) -> tuple[str, ...]:
        """Addresses of the workers that are there.

        Raises
        ------
        StoppedError
            The scheduler is gone.
        """
        try:
            return tuple(self._client.nthreads())
        except (OSError, TimeoutError) as error:
            raise self._gone() from error

    def work(
        self,
        pieces: Sequence[Piece[P]],
        craft: Craft[P, R],
        *,
        stop: Callable[[], bool] = lambda: False,
        tick: Callable[[Mapping[str, float], bool], None] = lambda metres, compiling: None,
    ) -> Iterator[tuple[int, R]]:
        """Do pieces and yield what each gives, with which it is, as it is done.

        Parameters
        ----------
        stop, tick : as of `local.spread`; of walks is told that they are done

        Raises
        ------
        StoppedError
            The scheduler is gone, there was no result for too long, no room is left at a worker, or a walk
            was walked again and is another one.
        InputError
            A worker that came later is of other versions or code.
        """
        yield from _Work(self, self._client, pieces, craft, stop, tick).run(self._say)

    def _gone(self) -> StoppedError:
        return StoppedError(f"the scheduler {self._address} is gone, or has forgotten what it was asked for")

    @property
    def _address(self) -> str:
        return self._given if isinstance(self._given, str) else str(self._given.scheduler.address)

    def _require_alike(self) -> None:
        mine = about()
        there = self._client.get_versions()["scheduler"]["packages"]["distributed"]
        if there != mine["distributed"]:
            raise InputError(
                f"of other versions than this process: distributed {there} there, {mine['distributed']} here",
                self._address,
            )
        for worker, told in self._client.run(about, on_error="return").items():
            if isinstance(told, BaseException):
                raise InputError(f"worker cannot load footfall ({type(told).__name__}: {told})", worker)
            require_same(mine, told, worker)


class _Work(Generic[P, R]):
    """Pieces on their way."""

    def __init__(
        self,
        cluster: Cluster,
        client: Any,
        pieces: Sequence[Piece[P]],
        craft: Craft[P, R],
        stop: Callable[[], bool],
        tick: Callable[[Mapping[str, float], bool], None],
    ) -> None:
        self._cluster, self._client, self._craft = cluster, client, craft
        self._patience_s = cluster.patience_s
        self._stop, self._tick = stop, tick
        self._queue: Queue[Piece[P]] = Queue(pieces, lambda key: False)
        self._left = dict.fromkeys(self._queue.walks, 0)  # pieces on each walk
        for piece in pieces:
            self._left[piece.walk] += 1
        self._walks: dict[str, tuple[Any, str]] = {}  # future and hash, of those that are there
        self._known: dict[str, str] = {}  # hashes of walks that were sent, which need not come back
        self._running: dict[Any, Job[Piece[P]]] = {}
        self._ended: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._suspects: deque[Job[Piece[P]]] = deque()  # in the making when too many workers ended
        self._name, self._sent = uuid4().hex[:12], 0

    def run(self, say: Callable[[str], None]) -> Iterator[tuple[int, R]]:
        watch = _Watch(self._cluster, self._patience_s, say)
        try:
            while True:
                workers = watch.look()
                self._fill(workers)
                if not self._running and self._suspects and not self._stop():
                    yield from self._alone(watch)
                    continue
                if not self._running or (self._stop() and not self._finishes(workers)):
                    return
                for future in self._some():
                    watch.heard()
                    yield from self._taken(future)
                self._tick({}, False)
                if self._client.status != "running":
                    raise self._cluster._gone()
                if late := watch.late():
                    raise StoppedError(f"{late}; in the making: {self._in_the_making()}")
        finally:
            with suppress(Exception):  # a scheduler that is gone
                if self._client.status == "running":
                    self._client.cancel([*self._running, *(future for future, _ in self._walks.values())])

    def _finishes(self, workers: Sequence[str]) -> bool:
        """Whether anything in the making, but for walks, comes to an end by itself."""
        return bool(workers) and not all(job.walks for job in self._running.values())

    def _fill(self, workers: Sequence[str]) -> None:
        ahead = _AHEAD * max(len(workers), 1) + 1
        while self._queue and len(self._running) < ahead and not self._stop():
            job = self._queue.next()
            self._running[self._submit(job)] = job

    def _submit(self, job: Job[Piece[P]], worker: str | None = None) -> Any:
        future = self._send(job, worker)
        future.add_done_callback(self._ended.put)
        return future

    def _send(self, job: Job[Piece[P]], worker: str | None = None) -> Any:
        piece, craft = job.task, self._craft
        content = pickle.dumps((craft.trial if job.walks else craft.do, piece.given))
        where: dict[str, Any] = {} if worker is None else {"workers": [worker]}
        self._sent += 1
        keys = {"pure": False, "key": f"footfall-{self._name}-{self._sent}", **where}
        ours = (about(), os.getcwd(), content)
        if job.walks:
            kept = kept_walk(craft.trial(piece.given).plan)
            if kept is not None:
                self._known[piece.walk] = kept.sha
            with catch_warnings():  # a walk goes with its task, so that Dask can send it again
                filterwarnings("ignore", "Sending large graph")
                return self._client.submit(walk_job, *ours, kept, **keys)
        return self._client.submit(do_job, *ours, *self._walk(piece), **keys)

    def _walk(self, piece: Piece[P]) -> tuple[Any, str]:
        """The piece's walk and its hash; sent once more where too many workers ended that had it."""
        future, sha = self._walks[piece.walk]
        if future.status == "error":
            self._walks[piece.walk] = future, sha = self._send(Job(piece, walks=True)), sha
        return future, sha

    def _some(self) -> Iterator[Any]:
        """What has ended; waits a moment for the first one."""
        try:
            yield self._ended.get(timeout=_TICK_S)
            while True:
                yield self._ended.get_nowait()
        except queue.Empty:
            return

    def _taken(self, future: Any) -> Iterator[tuple[int, R]]:
        job = self._running.pop(future)
        if job.walks and job.task.walk in self._known and future.status == "finished":
            self._walked(job.task.walk, future, self._known[job.task.walk])
            return
        try:
            result = future.result(timeout=self._patience_s)
        except InputError:
            raise
        except TimeoutError:
            raise StoppedError(f"a result did not arrive within {self._patience_s:g} s") from None
        except DiskFullError as error:
            raise StoppedError(f"no room is left at a worker: {error}") from None
        except OtherWalkError as error:
            raise StoppedError(str(error)) from None
        except Exception as error:
            if type(error).__name__ == "KilledWorker":
                self._suspects.append(job)
                return
            if future.status == "error":
                raise
            raise self._cluster._gone() from error
        yield from self._gave(job, future, result)

    def _gave(self, job: Job[Piece[P]], future: Any, result: Any) -> Iterator[tuple[int, R]]:
        piece = job.task
        if not job.walks:
            yield from self._result(piece, result)
        elif isinstance(result, Walk):
            keep_walk(piece.walk, result)
            self._walked(piece.walk, future, result.sha)
        else:
            yield from self._fell(piece, result, "walk")

    def _walked(self, key: str, future: Any, sha: str) -> None:
        self._walks[key] = future, sha
        self._queue.walked(key)
        self._tick({key: float("inf")}, False)

    def _result(self, piece: Piece[P], result: R) -> Iterator[tuple[int, R]]:
        self._left[piece.walk] -= 1
        if not self._left[piece.walk]:
            self._walks.pop(piece.walk, None)  # which lets the cluster forget it
        yield piece.at, result

    def _fell(self, piece: Piece[P], reason: InputError, stage: str) -> Iterator[tuple[int, R]]:
        for one in self._queue.fell(piece.walk):
            yield one.at, self._craft.lost(one.given, reason, stage)

    def _alone(self, watch: _Watch) -> Iterator[tuple[int, R]]:
        """One suspect after the other, each in one worker: it is lost where that one ends."""
        while self._suspects and not self._stop():
            while not (workers := watch.look(afresh=True)):
                time.sleep(_TICK_S)
                if late := watch.late():
                    raise StoppedError(late)
            job, worker = self._suspects.popleft(), workers[0]
            future = self._submit(job, worker)
            self._running[future] = job
            while not (ended := list(self._some())):
                self._tick({}, False)
                if worker not in watch.look():
                    break
                if late := watch.late():
                    raise StoppedError(f"{late}; in the making: {self._in_the_making()}")
            watch.heard()
            if ended and not (future.status == "error" and _killed(future)):
                yield from self._taken(future)
                return  # a walk may be there now, with what is to be done on it
            del self._running[future]
            self._client.cancel([future])
            if job.walks:
                yield from self._fell(job.task, _ENDED, "worker")
            else:
                yield from self._result(job.task, self._craft.lost(job.task.given, _ENDED, "worker"))

    def _in_the_making(self) -> str:
        """Of what runs: the walks, by seed."""
        seeds = sorted({self._craft.trial(job.task.given).walk_seed for job in self._running.values()})
        return f"{len(self._running)} tasks, on walks of the seeds {', '.join(map(str, seeds))}"


def _killed(future: Any) -> bool:
    return type(future.exception()).__name__ == "KilledWorker"


@dataclass
class _Watch:
    """How long it is that anything was heard."""

    cluster: Cluster
    patience_s: float
    say: Callable[[str], None]
    _workers: tuple[str, ...] = ()
    _looked: float = float("-inf")
    _heard: float = field(default_factory=time.monotonic)
    _there: float = field(default_factory=time.monotonic)  # when a worker last was, or that was said

    def look(self, *, afresh: bool = False) -> tuple[str, ...]:
        """The workers that are there, or were a moment ago."""
        now = time.monotonic()
        if afresh or now - self._looked >= _LOOK_S:
            self._workers, self._looked = self.cluster.workers, now
        if self._workers:
            self._there = now
        elif now - self._there >= _ALONE_S:
            self.say(f"no worker is there; waiting for one ({now - self._heard:.0f} s without a result)")
            self._there = now
        return self._workers

    def heard(self) -> None:
        """A result has come."""
        self._heard = time.monotonic()

    def late(self) -> str:
        """What has lasted too long; "" where nothing has."""
        if time.monotonic() - self._heard < self.patience_s:
            return ""
        why = "" if self._workers else ", and no worker is there"
        return f"no result for {self.patience_s:g} s{why}"
