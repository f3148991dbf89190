"""`gymnasium.make("footfall/Walk-v0")` works wherever footfall is imported, before gymnasium or after it.

Few need gymnasium, and it takes a tenth of a second to import: footfall waits until it is imported, and then
registers its environment.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from importlib.machinery import ModuleSpec, PathFinder
from types import ModuleType
from typing import Any

_REGISTRY = "gymnasium.envs.registration"


def register_when_imported() -> None:
    """Register the environment now, or as soon as gymnasium is imported."""
    registry = sys.modules.get(_REGISTRY)
    if registry is not None:
        _register(registry.register)
    else:
        sys.meta_path.insert(0, _Waiting())


def _register(register: Callable[..., None]) -> None:
    # Strings only: nothing of the simulator is imported before an environment is made.
    register(
        id="footfall/Walk-v0",
        entry_point="footfall.scenarios.environment:walk_env",
        vector_entry_point="footfall.simulate.learn.env:WalkVectorEnv",
        max_episode_steps=333,
    )


class _Waiting:
    """A finder that finds gymnasium's registry as Python does, and registers the environment in it."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        spec = PathFinder.find_spec(fullname, path) if fullname == _REGISTRY else None
        if spec is not None and spec.loader is not None:
            loader: Any = spec.loader
            execute = loader.exec_module

            def execute_and_register(module: ModuleType) -> None:
                execute(module)
                _register(module.register)

            loader.exec_module = execute_and_register
        return spec
