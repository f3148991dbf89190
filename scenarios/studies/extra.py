"""Libraries that only studies need: the extras `study` and `cluster`."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from footfall.errors import InputError


def needed(module: str, extra: str = "study") -> Any:
    """A module of an extra.

    Raises
    ------
    InputError
        It is not installed, and how to install it.
    """
    try:
        return import_module(module)
    except ImportError as error:
        library = module.partition(".")[0]
        missing = f" ({error.name} is missing)" if error.name not in (module, library, None) else ""
        raise InputError(
            f"this study needs {library}, which is not installed{missing}: pip install 'footfall[{extra}]'"
        ) from None
