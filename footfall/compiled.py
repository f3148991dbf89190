"""Compiled kernels, kept on disk and never older than what they were compiled from."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba import njit

from footfall.sources import modules_digest


def kernel(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """`numba.njit(cache=True)`, whose cache holds for as long as nothing changes that made the code.

    numba itself compares the time and size of the file that a kernel stands in. What the kernel calls or
    reads elsewhere may have changed since, as after an update of a checkout, and would silently stay as it
    was. So the stamp in numba's index is the content of that module and of all that it imports.
    """

    def compiled(function: Callable[..., Any]) -> Any:
        dispatcher = njit(cache=True, **options)(function)
        if hasattr(dispatcher, "_cache"):  # not where NUMBA_DISABLE_JIT is set
            dispatcher._cache._cache_file._source_stamp = modules_digest(function.__module__)
        return dispatcher

    return compiled
