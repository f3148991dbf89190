"""Compiled kernel of the pursuit of a route."""

from __future__ import annotations

import math

from numba import njit


@njit(cache=True, nogil=True)
def pursue(px, py, heading, spacing, row, window, x, y, ahead, offset):  # type: ignore[no-untyped-def]
    """Where a walker at (x, y) is along a route, and where it aims.

    Parameters
    ----------
    px, py, heading : (n,) the route; spacing : m between its samples
    row, window : the nearest sample is sought among `window` samples from `row` on
    ahead : samples from the nearest one to the aim; straight on after the route's end
    offset : m, of the aim to the left of the route

    Returns
    -------
    row, distance to it (m), aim (m, m)
    """
    last, nearest, least = len(px) - 1, row, math.inf
    for i in range(row, min(row + window, last + 1)):
        distance2 = (px[i] - x) ** 2 + (py[i] - y) ** 2
        if distance2 < least:
            nearest, least = i, distance2
    aim = nearest + ahead
    beyond = max(0, aim - last) * spacing
    aim = min(aim, last)
    cos, sin = math.cos(heading[aim]), math.sin(heading[aim])
    return (
        nearest,
        math.sqrt(least),
        px[aim] + beyond * cos - offset * sin,
        py[aim] + beyond * sin + offset * cos,
    )
