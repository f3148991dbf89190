"""A task of a study: some units on one walk, under every setting and method. Plain data, and one function.

Whatever runs it, here, in another process or on another machine, gets the same rows.
"""

from __future__ import annotations

import errno
import socket
import time
import traceback
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path

from footfall.errors import InputError
from footfall.hdr.method import Method
from footfall.identity import digest_of
from footfall.scenarios.execute import hold
from footfall.scenarios.parameters import Documents
from footfall.scenarios.scenario import Scenario, build_scenario
from footfall.scenarios.trial import Row, Trial, failed, perform, recording_of
from footfall.simulate.walk import Walk

_built: dict[str, Scenario] = {}  # in a worker: the last scenarios
_BUILT = 8  # of them


@dataclass(frozen=True)
class Cell:
    """A method with its parameters, and the key of its rows: the hash of all that makes them."""

    key: str
    method: Method


@dataclass(frozen=True)
class Setting:
    """What dead reckoning and filters are told, and the methods that go over it."""

    documents: Documents
    cells: tuple[Cell, ...]


@dataclass(frozen=True)
class Task:
    """Units on one walk.

    Attributes
    ----------
    key : hash of all that makes the recordings; walk : that of the walk; steps : of its steps (`Plan.steps`)
    number, walk_seed : of the walk
    seeds : of each unit and its noise
    settings : which share walk and recordings
    """

    key: str
    walk: str
    steps: str
    number: int
    walk_seed: int
    seeds: tuple[tuple[int, int], ...]
    settings: tuple[Setting, ...]

    @property
    def cells(self) -> tuple[str, ...]:
        """Keys of all rows."""
        return tuple(cell.key for setting in self.settings for cell in setting.cells)

    @property
    def name(self) -> str:
        """Of a file with the rows: the key, and which cells."""
        return f"{self.key}-{digest_of(sorted(self.cells))[:8]}"

    def without(self, done: Collection[str]) -> Task | None:
        """What is left of it when some cells are done."""
        settings = [
            replace(setting, cells=tuple(cell for cell in setting.cells if cell.key not in done))
            for setting in self.settings
        ]
        left = tuple(setting for setting in settings if setting.cells)
        return replace(self, settings=left) if left else None

    def trials(self) -> Iterator[tuple[list[Trial], list[tuple[Cell, ...]]]]:
        """For each unit a trial under each setting, and its cells.

        Raises
        ------
        InputError
            What the documents cannot be.
        """
        setups = [
            replace(
                setting.documents.setup(_scenario(setting.documents)),
                methods=tuple(cell.method for cell in setting.cells),
            )
            for setting in self.settings
        ]
        cells = [setting.cells for setting in self.settings]
        for unit, noise in self.seeds:
            yield [Trial(setup, self.number, self.walk_seed, unit, noise) for setup in setups], cells


@dataclass(frozen=True)
class Done:
    """What became of a task.

    Attributes
    ----------
    rows : by unit, setting and method; keys : of the cell of each
    seconds : by stage, and "all"; host : where
    tracebacks : of unexpected exceptions
    """

    task: Task
    rows: tuple[Row, ...]
    keys: tuple[str, ...]
    seconds: Mapping[str, float] = field(default_factory=dict)
    host: str = ""
    tracebacks: str = ""

    @property
    def failures(self) -> int:
        """How many rows have no score."""
        return sum(row.score is None for row in self.rows)


class StoppedError(Exception):
    """Something outside of the study ended it; it may be taken up where it was."""


class DiskFullError(Exception):
    """There is no room left where a walk, or what a method writes, is to be."""


def do(task: Task, walks: Path | None = None, store: Path | None = None, walk: Walk | None = None) -> Done:
    """Perform a task. What fails is rows.

    Parameters
    ----------
    walks : folder of walks; the user's cache when None
    store : folder of footfalls (`footfall.scenarios.store`); None keeps none
    walk : the task's, where whoever calls has it

    Raises
    ------
    DiskFullError
        No room is left.
    """
    try:
        return _done(task, walks, store, walk)
    except DiskFullError:
        raise
    except Exception as error:  # outside of any trial: unexpected, but no reason to end the others
        _require_room(error)
        reason = InputError(f"{type(error).__name__}: {(str(error).splitlines() or [''])[0]}")
        return replace(lost(task, reason, "worker"), tracebacks="".join(traceback.format_exception(error)))


def _done(task: Task, walks: Path | None, store: Path | None, walk: Walk | None) -> Done:
    start = time.perf_counter()
    spent = dict.fromkeys(("walk", "record", "track", "score"), 0.0)
    rows: list[Row] = []
    keys: list[str] = []
    told: list[str] = []
    for trials, cells in task.trials():
        if walk is None:
            found = hold(trials[0], walks)
            spent["walk"] = time.perf_counter() - start
            if isinstance(found, InputError):
                _require_room(found)
                return lost(task, found)
            walk = found
        source = cache(lambda trial=trials[0], walk=walk: recording_of(trial, walk))
        for trial, own in zip(trials, cells, strict=True):
            surprised = _surprised(told, trial)
            outcome = perform(trial, walk, store=store, source=source, surprised=surprised)
            rows += outcome.rows
            keys += [cell.key for cell in own]
            for stage, seconds in outcome.seconds.items():
                spent[stage] += seconds
    spent["all"] = time.perf_counter() - start
    return Done(task, tuple(rows), tuple(keys), spent, socket.gethostname(), "\n".join(told))


def do_walk(
    task: Task,
    walks: Path | None = None,
    report: Callable[[float], None] | None = None,
    also: Sequence[Task] = (),
) -> InputError | None:
    """See that the task's walk is in the folder of walks, or tell why it came to no end.

    Parameters
    ----------
    also : tasks on walks of the same steps, which are walked at once

    Raises
    ------
    DiskFullError
        No room is left.
    """
    trials, _ = next(task.trials())
    walk = hold(trials[0], walks, report, (next(one.trials())[0][0] for one in also))
    if isinstance(walk, InputError):
        _require_room(walk)
        return walk
    return None


def lost(task: Task, error: InputError, stage: str = "walk") -> Done:
    """A task none of which came to an end, for one reason."""
    rows: list[Row] = []
    keys: list[str] = []
    for trials, cells in task.trials():
        for trial, own in zip(trials, cells, strict=True):
            rows += failed(trial, error, stage).rows
            keys += [cell.key for cell in own]
    return Done(task, tuple(rows), tuple(keys), {}, socket.gethostname())


def no_room(error: BaseException | None) -> bool:
    """Whether an exception comes of a full disk, or of a quota."""
    while error is not None:
        if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT):
            return True
        error = error.__cause__ or error.__context__
    return False


def _require_room(error: Exception) -> None:
    if no_room(error):
        raise DiskFullError(str(error)) from None


def _surprised(told: list[str], trial: Trial) -> Callable[[Exception], None]:
    def note(error: Exception) -> None:
        _require_room(error)
        where = f"walk {trial.walk_seed}, unit {trial.unit_seed}, noise {trial.noise_seed}"
        told.append(f"{where}:\n{''.join(traceback.format_exception(error))}")

    return note


def _scenario(documents: Documents) -> Scenario:
    """What is built of a document, once for all tasks that follow each other on it."""
    key = digest_of(documents.scenario.name, dict(documents.scenario.table))
    if key not in _built:
        while len(_built) >= _BUILT:
            del _built[next(iter(_built))]
        _built[key] = build_scenario(documents.scenario)
    return _built[key]
