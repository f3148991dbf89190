"""Walks by content: the same plan, weights, code and versions are walked once."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import platformdirs

import footfall.models
from footfall import conventions, streams
from footfall.errors import InputError
from footfall.models.policy import Policy, stock_policy
from footfall.simulate.journey import Plan, versions, walk
from footfall.simulate.walk import Walk, read_walk, write_walk


def cache_folder() -> Path:
    """Where walks are kept: the user's cache folder (on Linux, XDG_CACHE_HOME moves it)."""
    return Path(platformdirs.user_cache_dir("footfall"))


@lru_cache(maxsize=1)
def _source_digest() -> str:
    """Hash of the code that makes walks, so that a developer's change is never answered from the cache."""
    digest = hashlib.sha256()
    rooms = [Path(footfall.models.__file__).parent, Path(__file__).parent]
    shared = [Path(str(module.__file__)) for module in (conventions, streams)]
    for source in sorted([*shared, *(path for room in rooms for path in room.glob("*.py"))]):
        digest.update(source.name.encode() + source.read_bytes())
    return digest.hexdigest()


def _feed(digest: Any, value: Any) -> None:
    if is_dataclass(value) and not isinstance(value, type):
        for item in fields(value):
            digest.update(item.name.encode())
            _feed(digest, getattr(value, item.name))
    elif isinstance(value, np.ndarray):
        digest.update(str((value.dtype.str, value.shape)).encode() + np.ascontiguousarray(value).tobytes())
    else:
        digest.update(repr(value).encode())


def plan_key(plan: Plan, policy: Policy) -> str:
    """Hash of everything that determines the walk."""
    digest = hashlib.sha256()
    digest.update(json.dumps(versions(), sort_keys=True).encode())
    digest.update((_source_digest() + policy.digest).encode())
    _feed(digest, plan)
    return digest.hexdigest()[:32]


def cached_walk(
    plan: Plan,
    *,
    use_cache: bool = True,
    policy: Policy | None = None,
    on_progress: Callable[[float], None] | None = None,
) -> Walk:
    """`walk(plan)`, from the cache where it has been walked before.

    `use_cache=False` neither reads nor writes the cache. A damaged cache file is walked again.
    """
    policy = policy or stock_policy()
    if not use_cache:
        return walk(plan, policy, on_progress)
    path = cache_folder() / f"{plan_key(plan, policy)}.parquet"
    if path.exists():
        try:
            return read_walk(path)
        except InputError:
            path.unlink(missing_ok=True)
    result = walk(plan, policy, on_progress)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_walk(result, path)
    return result
