"""Walks by content: the same plan, weights, code and versions are walked once, by one process."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import platformdirs

from footfall.errors import InputError
from footfall.identity import digest_of
from footfall.models.policy import Policy, stock_policy
from footfall.simulate.plan import Plan, versions
from footfall.simulate.walk import Walk, footfalls_path, read_walk, write_walk
from footfall.sources import stage_digest
from footfall.tables import read_meta

_versions = lru_cache(versions)  # packages' metadata are slow to read, and a study has many walks
_POLL_S = 0.2  # between looks at a walk that another process is walking
_ABANDONED_S = 3600.0  # after which a file that is being written is not any more


@dataclass(frozen=True)
class CachedWalk:
    """A walk in the cache.

    Attributes
    ----------
    file : its walk.parquet, with the footfalls beside it
    scenario, subject : names; seed : of the walk; None where the file is damaged
    size : bytes of both files
    used : s since 1970, when it was last read or written
    """

    file: Path
    scenario: str | None
    subject: str | None
    seed: int | None
    size: int
    used: float


def cache_folder() -> Path:
    """Where walks are kept: the user's cache folder (on Linux, XDG_CACHE_HOME moves it)."""
    return Path(platformdirs.user_cache_dir("footfall"))


def plan_key(plan: Plan, policy: Policy) -> str:
    """Hash of everything that determines the walk. A plan's name does not."""
    return digest_of(_versions(), stage_digest("walk"), policy.digest, plan.digest)[:32]


def walks(
    plans: Sequence[Plan], policy: Policy, on_progress: Callable[[float], None] | None
) -> Iterator[Walk]:
    """`footfall.simulate.walking.walks`: the physics are loaded where something is to be walked."""
    from footfall.simulate import walking

    return walking.walks(plans, policy, on_progress)


def is_cached(key: str, folder: Path | None = None) -> bool:
    """Whether a file of this `plan_key` is there; only reading it tells that it is whole."""
    return _file(key, folder).is_file()


def cached_walk(
    plan: Plan,
    *,
    also: Iterable[Plan] = (),
    folder: Path | None = None,
    policy: Policy | None = None,
    on_progress: Callable[[float], None] | None = None,
    on_wait: Callable[[], None] | None = None,
) -> Walk:
    """`walk(plan)`, from the cache where it has been walked before.

    A damaged cache file is walked again. What another process is walking is waited for and read.

    Parameters
    ----------
    also : plans that differ in mount and rate alone: where this one has to be walked, their truths are read
        of the same steps and kept, too
    folder : of the cache; the user's when None
    on_progress : as of `walk`
    on_wait : called once where another process is walking this plan

    Raises
    ------
    InputError
        As `walk`; or the folder cannot be written, which is told before walking.
    """
    policy = policy or stock_policy()
    key = plan_key(plan, policy)
    path = _file(key, folder)
    found = _read(path)
    if found is None:
        with _alone(path, on_wait):
            found = _read(path)
            if found is None:
                others = {other: one for one in also if (other := plan_key(one, policy)) != key}
                missing = {other: one for other, one in others.items() if not is_cached(other, folder)}
                truths = walks([plan, *missing.values()], policy, on_progress)
                found = next(truths)
                write_walk(found, path)
                with suppress(InputError):  # of another truth: it is told when that is asked for
                    for other, truth in zip(missing, truths, strict=True):
                        keep_walk(other, truth, folder)
    # Another scenario of the same content may have walked it.
    return replace(found, meta={**found.meta, "scenario": plan.name})


def kept_walk(plan: Plan, folder: Path | None = None) -> Walk | None:
    """A plan's walk where the cache has it whole; nothing is walked."""
    found = _read(_file(plan_key(plan, stock_policy()), folder))
    return None if found is None else replace(found, meta={**found.meta, "scenario": plan.name})


def keep_walk(key: str, walk: Walk, folder: Path | None = None) -> None:
    """Keep a walk that was walked elsewhere. A cache that cannot be written costs only that."""
    path = _file(key, folder)
    with suppress(OSError, InputError):
        if not path.is_file():
            path.parent.mkdir(parents=True, exist_ok=True)
            write_walk(walk, path)


def cached_walks(folder: Path | None = None) -> list[CachedWalk]:
    """What is in the cache, the last used first."""
    files = (folder or cache_folder()).glob("*.parquet")
    walks = [_entry(file) for file in files if not file.name.endswith(".footfalls.parquet")]
    return sorted((one for one in walks if one is not None), key=lambda one: (-one.used, one.file.name))


def prune(keep: int, folder: Path | None = None) -> list[CachedWalk]:
    """Remove the walks that were not used for longest, until the others fit into `keep` bytes.

    Returns
    -------
    What was removed.
    """
    _sweep(folder or cache_folder())
    removed: list[CachedWalk] = []
    kept = 0
    for one in cached_walks(folder):
        if not removed and kept + one.size <= keep:
            kept += one.size
        else:
            _remove(one.file)
            removed.append(one)
    return removed


def _file(key: str, folder: Path | None) -> Path:
    return (folder or cache_folder()) / f"{key}.parquet"


def _read(path: Path) -> Walk | None:
    """The walk in a file of the cache, if it is there and whole."""
    try:
        found = read_walk(path)
    except InputError:
        return None
    with suppress(OSError):  # a cache that is only read from
        os.utime(path)
    return found


@contextmanager
def _alone(path: Path, on_wait: Callable[[], None] | None) -> Iterator[None]:
    """No other process is in here for this file at the same time; the system frees what a dead one held."""
    from filelock import FileLock, Timeout

    lock = FileLock(path.with_suffix(".lock"))
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            lock.acquire(timeout=0)
        except Timeout:
            if on_wait is not None:
                on_wait()
            lock.acquire(poll_interval=_POLL_S)
    except OSError as error:
        raise InputError(f"walks cannot be kept there ({error.strerror or error})", path.parent) from None
    try:
        yield
    finally:
        # A process that waits for this lock finds the walk; a later one needs no lock.
        with suppress(OSError):
            path.with_suffix(".lock").unlink()
        lock.release()


def _entry(file: Path) -> CachedWalk | None:
    """What a file of the cache is; None where it has just been removed."""
    try:
        used, size = file.stat().st_mtime, file.stat().st_size
    except OSError:
        return None
    with suppress(OSError):
        size += footfalls_path(file).stat().st_size
    try:
        meta = read_meta(file)
    except InputError:
        meta = {}
    return CachedWalk(file, meta.get("scenario"), meta.get("subject"), meta.get("seed"), size, used)


def _sweep(folder: Path) -> None:
    """Remove what killed processes have left: locks that no process holds, and files half written."""
    from filelock import FileLock, Timeout

    for file in folder.glob("*.lock"):
        with suppress(Timeout, OSError), FileLock(file).acquire(timeout=0):
            file.unlink()
    for file in folder.glob(".*.tmp"):
        with suppress(OSError):
            if time.time() - file.stat().st_mtime > _ABANDONED_S:
                file.unlink()


def _remove(file: Path) -> None:
    """The walk first: footfalls alone are never read."""
    for part in (file, footfalls_path(file)):
        part.unlink(missing_ok=True)
