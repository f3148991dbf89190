"""The folder of a study: parts by content, tracebacks, timing, and the one dataset that they become.

A part is written under another name and renamed, so that whatever ends the process leaves whole parts alone.
Parts are all that a study is taken up from.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from footfall.errors import InputError
from footfall.late import late
from footfall.scenarios.studies.plan import Plan
from footfall.scenarios.studies.rows import column_value, in_order, read_rows, schema, table, write_rows
from footfall.scenarios.studies.task import Done, Task
from footfall.tables import META_KEY, replacing

pa, pc, pq = late("pyarrow"), late("pyarrow.compute"), late("pyarrow.parquet")

_MAGIC = b"PAR1"  # at both ends of a whole Parquet file
_PLAN = "plan"  # key, in the dataset's metadata, of the digest of the plan that made it


@dataclass(frozen=True)
class StudyFolder:
    """Where a study's files are."""

    path: Path

    @property
    def parts(self) -> Path:
        """Rows, one file a task."""
        return self.path / "parts"

    @property
    def results(self) -> Path:
        """All rows of the study."""
        return self.path / "results.parquet"

    @contextmanager
    def alone(self) -> Iterator[None]:
        """No other process works in this folder meanwhile; the system frees what a killed one held.

        Raises
        ------
        InputError
            Another one does; or the folder cannot be made or written.
        """
        from filelock import FileLock, Timeout

        try:
            self.parts.mkdir(parents=True, exist_ok=True)
            (self.path / "errors").mkdir(exist_ok=True)
            lock = FileLock(self.path / ".lock")
            lock.acquire(timeout=0)
        except Timeout:
            raise InputError("another sweep is at work in this folder", self.path) from None
        except OSError as error:
            raise InputError(f"the folder cannot be written ({error.strerror})", self.path) from None
        try:
            yield
        finally:
            lock.release()

    def tidy(self) -> list[str]:
        """Remove what was being written when a process ended, and parts that are not whole.

        Returns
        -------
        Names of the latter.
        """
        broken = []
        for file in (*self.path.glob(".*.tmp"), *self.parts.glob(".*.tmp")):
            file.unlink(missing_ok=True)
        for file in self._files():
            if not _whole(file):
                broken.append(file.name)
                file.unlink()
        return broken

    def forget(self) -> None:
        """Remove all that a study has written here, and nothing else."""
        for file in (*self._files(), *(self.path / "errors").glob("*.txt"), self._timing, self.results):
            file.unlink(missing_ok=True)

    def forget_failures(self) -> int:
        """Remove parts in which some row has no score, so that their tasks are done again; how many."""
        gone = 0
        for file in self._files():
            if pq.ParquetFile(file).read(["stage"])["stage"].to_pylist().count("") != _rows(file):
                file.unlink()
                gone += 1
        if gone:
            self.results.unlink(missing_ok=True)
        return gone

    def left(self, tasks: Sequence[Task]) -> list[Task]:
        """What of these tasks is not done."""
        there = self._by_task()
        found = []
        for task in tasks:
            files = there.get(task.key, [])
            if any(file.stem == task.name for file in files):
                continue
            done = {key for file in files for key in _keys(file)}
            if (rest := task.without(done)) is not None:
                found.append(rest)
        return found

    def put(self, done: Done) -> None:
        """Keep the rows of a task.

        Raises
        ------
        InputError
            They cannot be written.
        """
        errors = self.path / "errors" / f"{done.task.key}.txt"
        if done.tracebacks:
            with replacing(errors) as temporary:
                temporary.write_text(done.tracebacks, encoding="utf-8")
        else:
            errors.unlink(missing_ok=True)
        write_rows(table(done.rows, keys=done.keys), self.parts / f"{done.task.name}.parquet")
        if done.seconds:
            spent = {stage: round(seconds, 6) for stage, seconds in done.seconds.items()}
            line = {"key": done.task.key, "host": done.host, "rows": len(done.rows), **spent}
            with suppress(OSError), open(self._timing, "a", encoding="utf-8") as file:
                file.write(json.dumps(line) + "\n")

    def drop(self, tasks: Iterable[Task]) -> None:
        """Remove the parts of tasks."""
        for task in tasks:
            (self.parts / f"{task.name}.parquet").unlink(missing_ok=True)

    def is_compacted(self, plan: Plan) -> bool:
        """Whether the dataset is there, of this plan."""
        try:
            meta = pq.read_schema(self.results).metadata or {}
            return bool(json.loads(meta[META_KEY]).get(_PLAN) == plan.digest)
        except (OSError, pa.ArrowException, KeyError, ValueError):
            return False

    def compact(self, plan: Plan) -> None:
        """Make one sorted dataset of the parts: whatever parts there are, the same rows are the same bytes.

        Raises
        ------
        InputError
            A part is damaged or missing; or the dataset cannot be written.
        """
        rows = self._rows_of(plan)
        at: dict[str, list[int]] = {}
        for index, key in enumerate(rows["key"].to_pylist()):
            at.setdefault(key, []).append(index)
        take: list[int] = []
        values: dict[str, list[Any]] = {axis: [] for axis in plan.kinds}
        for entry in plan.entries:
            mine = at[entry.key]
            take += mine
            for axis, kind in plan.kinds.items():
                values[axis] += [column_value(entry.values.get(axis), kind)] * len(mine)
        wanted = schema(plan.kinds)
        taken = rows.take(pa.array(take, pa.int64()))
        columns = [
            pa.array(values[name], wanted.field(name).type) if name in values else taken[name]
            for name in wanted.names
        ]
        whole = in_order(pa.Table.from_arrays(columns, schema=wanted), tuple(plan.kinds)).combine_chunks()
        meta = dict(wanted.metadata)
        meta[META_KEY] = json.dumps(json.loads(meta[META_KEY]) | {_PLAN: plan.digest}).encode()
        write_rows(whole.replace_schema_metadata(meta), self.results)

    def write_timing(self) -> None:
        """Seconds by stage of every task that was done here, the last time that it was."""
        found: dict[str, Mapping[str, Any]] = {}
        with suppress(OSError):
            for line in self._timing.read_text(encoding="utf-8").splitlines():
                with suppress(ValueError, TypeError, KeyError):  # half a line, where a process ended
                    one = json.loads(line)
                    found[one["key"]] = one
        if found:
            with replacing(self.path / "timing.parquet") as temporary:
                pq.write_table(pa.Table.from_pylist(list(found.values())), temporary)

    @property
    def _timing(self) -> Path:
        return self.path / ".timing.jsonl"

    def _files(self) -> list[Path]:
        return sorted(self.parts.glob("*.parquet"))

    def _by_task(self) -> dict[str, list[Path]]:
        there: dict[str, list[Path]] = {}
        for file in self._files():
            there.setdefault(file.stem.partition("-")[0], []).append(file)
        return there

    def _rows_of(self, plan: Plan) -> Any:
        """The rows of a plan's tasks, of whatever parts, none twice."""
        there, found = self._by_task(), []
        walks: dict[str, set[str]] = {}
        for task in plan.tasks:
            files = there.get(task.key, [])
            exact = [file for file in files if file.stem == task.name]
            wanted = set(task.cells)
            for file in exact or files:
                part = _read(file)
                keys = part["key"].to_pylist()
                if wanted.issuperset(keys):
                    found.append(part)
                else:
                    found.append(part.filter(pa.array([key in wanted for key in keys])))
                wanted.difference_update(keys)
                walks.setdefault(task.walk, {""}).update(pc.unique(part["walk_sha"]).to_pylist())
            if wanted:
                raise InputError(f"rows of task {task.key} are missing: start the sweep again", self.path)
            if len(walks[task.walk]) > 2:
                raise InputError(
                    f"rows of walk {task.walk_seed} are of walks that differ, made on different processors: "
                    "start the sweep with --fresh",
                    self.path,
                )
        return pa.concat_tables(found)


def _read(file: Path) -> Any:
    """A part; one that cannot be read goes, so that its task is done again."""
    try:
        return read_rows(file)
    except InputError:
        file.unlink(missing_ok=True)
        raise InputError("was damaged, and is removed: start the sweep again", file) from None


def _whole(file: Path) -> bool:
    try:
        with open(file, "rb") as opened:
            opened.seek(-len(_MAGIC), os.SEEK_END)
            return opened.read() == _MAGIC
    except OSError:
        return False


def _keys(file: Path) -> set[str]:
    return set(pq.ParquetFile(file).read(["key"])["key"].to_pylist())


def _rows(file: Path) -> int:
    return int(pq.ParquetFile(file).metadata.num_rows)
