"""The gymnasium environment, told where scenarios are found by name: what `footfall/Walk-v0` makes."""

from __future__ import annotations

from typing import Any

from footfall.scenarios.scenario import load_scenario
from footfall.simulate.learn.walk_env import WalkEnv


def walk_env(**settings: Any) -> WalkEnv:
    """The `WalkEnv` whose scenarios may be names and files; `settings` are its parameters."""
    return WalkEnv(plan_of=lambda name: load_scenario(name).plan(0), **settings)
