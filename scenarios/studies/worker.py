"""What a worker of a cluster does, and how it tells that it does it as the driver would."""

from __future__ import annotations

import pickle
import threading
from collections.abc import Mapping
from contextlib import chdir, nullcontext
from functools import lru_cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from footfall.errors import InputError
from footfall.models.policy import stock_policy
from footfall.scenarios.studies.extra import needed
from footfall.scenarios.studies.task import DiskFullError, no_room
from footfall.scenarios.trial import walk_of
from footfall.simulate.plan import versions
from footfall.simulate.walk import Walk
from footfall.sources import STAGES, stage_digest

Told = Mapping[str, str]  # versions, and digests of the code

_ONE = threading.Lock()  # threads of one worker take turns: what is held in memory is one walk's


class OtherWalkError(Exception):
    """A walk was walked again, and to other bits."""


@lru_cache
def about() -> dict[str, str]:
    """Versions and digests of code, of this process: what rows depend on besides their task."""
    packages = ("numba", "pyarrow", "distributed")
    return {
        **versions(),
        **{package: version(package) for package in packages},
        **{f"code of {stage}": stage_digest(stage)[:12] for stage in STAGES},
        "walker's weights": stock_policy().digest[:12],
    }


def require_same(mine: Told, theirs: Told, worker: str) -> None:
    """Refuse a worker of other versions or code.

    Raises
    ------
    InputError
        What differs, here and there.
    """
    other = [name for name in mine if mine[name] != theirs.get(name)]
    if other:
        named = ", ".join(f"{name} {theirs.get(name, 'none')} there, {mine[name]} here" for name in other)
        raise InputError(f"worker of other versions than this process: {named}", worker)


def walk_job(mine: Told, folder: str, content: bytes, kept: Walk | None) -> Walk | InputError:
    """A walk, from the driver's cache, from one's own, or walked; or why it came to no end.

    Parameters
    ----------
    mine : what the driver says `about` itself
    folder : the driver's
    content : pickled, what tells a trial on the walk, and of what
    kept : the walk, where the driver has it

    Raises
    ------
    InputError
        This worker is another one than the driver, or cannot load the content.
    DiskFullError
        No room is left here.
    """
    with _ONE:
        trial, given = _unpacked(mine, folder, content)
        if kept is not None:
            return kept
        try:
            return walk_of(trial(given))
        except InputError as error:
            if no_room(error):
                raise DiskFullError(str(error)) from None
            return error


def do_job(mine: Told, folder: str, content: bytes, walk: Walk, sha: str) -> Any:
    """What is to be done with a walk; as `walk_job`.

    Parameters
    ----------
    sha : of the walk as the driver has it

    Raises
    ------
    OtherWalkError
        This walk is another one.
    """
    with _ONE:
        do, given = _unpacked(mine, folder, content)
        if walk.sha != sha:
            raise OtherWalkError(
                f"walk {walk.meta.get('seed')} was walked again to other bits by {_here()}, on another "
                "processor; the first one is in the cache"
            )
        return do(given, walk)


def _unpacked(mine: Told, folder: str, content: bytes) -> Any:
    """What is to be done, once it is sure that this worker does it as the driver would."""
    require_same(mine, about(), _here())
    try:
        with chdir(folder) if Path(folder).is_dir() else nullcontext():  # files of methods are relative to it
            return pickle.loads(content)
    except Exception as error:
        raise InputError(f"worker cannot load what it is to do ({error})", _here()) from None


def _here() -> str:
    """This worker's address."""
    return str(needed("distributed", extra="cluster").get_worker().address)
