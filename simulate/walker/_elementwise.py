"""Small functions that take numbers when compiled and columns in plain numpy."""

from __future__ import annotations

import numpy as np
from numba.extending import overload, register_jitable


def choose(condition, yes, no):  # type: ignore[no-untyped-def]
    """`yes` where the condition holds, `no` elsewhere; both are evaluated."""
    return np.where(condition, yes, no)


@overload(choose)
def _choose(condition, yes, no):  # type: ignore[no-untyped-def]
    # numba's own np.where makes an array even of numbers.
    return lambda condition, yes, no: yes if condition else no


@register_jitable
def clip(value, low, high):  # type: ignore[no-untyped-def]
    """Within [low, high]."""
    return np.minimum(np.maximum(value, low), high)


@register_jitable
def turned(s, x, y):  # type: ignore[no-untyped-def]
    """World x, y -> forward, left of the walker `s`."""
    return s.cos * x + s.sin * y, -s.sin * x + s.cos * y
