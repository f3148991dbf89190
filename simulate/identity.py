"""Which walk it is: the identity of a plan, walked by these weights and this code."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import mujoco

import footfall.models
from footfall import conventions, runs, streams
from footfall.identity import WalkIdentity, digest_of, plain
from footfall.models.body import MOUNTS, Mount
from footfall.models.policy import Policy

if TYPE_CHECKING:
    from footfall.simulate.plan import Plan


def walk_identity(plan: Plan, policy: Policy) -> WalkIdentity:
    """The identity of the walk that `plan` and `policy` make."""
    return WalkIdentity(
        scenario=plan.name,
        scenario_digest=digest_of(plan),
        seed=plan.seed,
        subject=plan.subject.name,
        mount={"name": mount_name(plan.mount), **plain(plan.mount)},
        policy=policy.digest,
        code=digest_of(source_digest(), mujoco.__version__),
    )


def mount_name(mount: Mount) -> str:
    """A mounting's name in `MOUNTS`, or "custom"."""
    return next((name for name, known in MOUNTS.items() if known == mount), "custom")


@lru_cache(maxsize=1)
def source_digest() -> str:
    """Hash of the code that makes walks."""
    rooms = [Path(footfall.models.__file__).parent, Path(__file__).parent]
    shared = [Path(str(module.__file__)) for module in (conventions, runs, streams)]
    sources = sorted([*shared, *(path for room in rooms for path in room.rglob("*.py"))])
    return digest_of([(source.name, source.read_bytes()) for source in sources])
