"""The identity of the walk that a plan, the walker's weights and this code make."""

from __future__ import annotations

from importlib.metadata import version

from footfall.identity import WalkIdentity, digest_of, plain
from footfall.models.mount import MOUNTS, Mount
from footfall.models.policy import Policy
from footfall.simulate.plan import Plan
from footfall.sources import stage_digest


def walk_identity(plan: Plan, policy: Policy) -> WalkIdentity:
    """The identity of the walk that `plan` and `policy` make."""
    return WalkIdentity(
        scenario=plan.name,
        scenario_digest=plan.digest,
        seed=plan.seed,
        subject=plan.subject.name,
        mount={"name": mount_name(plan.mount), **plain(plan.mount)},
        policy=policy.digest,
        code=digest_of(stage_digest("walk"), version("mujoco")),
    )


def mount_name(mount: Mount) -> str:
    """A mounting's name in `MOUNTS`, or "custom"."""
    return next((name for name, known in MOUNTS.items() if known == mount), "custom")
