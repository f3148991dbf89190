"""Modules that take long to import, imported when something of them is first used.

numba, scipy's parts and mujoco take 0.2 to 0.6 s each, and most commands need few of them.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any


class _Late:
    def __init__(self, name: str) -> None:
        self._name = name

    def __getattr__(self, attribute: str) -> Any:
        found = getattr(import_module(self._name), attribute)
        setattr(self, attribute, found)  # from now on as quick as in the module itself
        return found


def late(name: str) -> Any:
    """Stand in for the module of this name, which is imported at the first use of one of its attributes.

    For a module that only some callers of the importing one need.
    """
    return _Late(name)
