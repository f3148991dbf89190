"""Walks by content: the same plan, weights, code and versions are walked once."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import platformdirs

from footfall.errors import InputError
from footfall.identity import digest_of
from footfall.models.policy import Policy, stock_policy
from footfall.simulate.identity import source_digest
from footfall.simulate.plan import Plan, versions
from footfall.simulate.walk import Walk, read_walk, write_walk
from footfall.simulate.walking import walk


def cache_folder() -> Path:
    """Where walks are kept: the user's cache folder (on Linux, XDG_CACHE_HOME moves it)."""
    return Path(platformdirs.user_cache_dir("footfall"))


def plan_key(plan: Plan, policy: Policy) -> str:
    """Hash of everything that determines the walk."""
    return digest_of(versions(), source_digest(), policy.digest, plan)[:32]


def cached_walk(
    plan: Plan,
    *,
    folder: Path | None = None,
    policy: Policy | None = None,
    on_progress: Callable[[float], None] | None = None,
) -> Walk:
    """`walk(plan)`, from the cache where it has been walked before.

    A damaged cache file is walked again.

    Parameters
    ----------
    folder : of the cache; the user's when None
    """
    policy = policy or stock_policy()
    path = (folder or cache_folder()) / f"{plan_key(plan, policy)}.parquet"
    if path.exists():
        try:
            return read_walk(path)
        except InputError:
            path.unlink(missing_ok=True)
    result = walk(plan, policy, on_progress)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_walk(result, path)
    return result
