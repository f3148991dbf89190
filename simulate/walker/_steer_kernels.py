"""Compiled kernel of the pursuit of a route."""

from __future__ import annotations

import math

from footfall.compiled import kernel


@kernel(nogil=True)
def pursue(line, spacing, row, window, x, y, ahead, offset):  # type: ignore[no-untyped-def]
    """Where a walker at (x, y) is along a route, and where it aims.

    Parameters
    ----------
    line : (n, 3) the route: x, y (m), heading (rad); spacing : m between its samples
    row, window : the nearest sample is sought among `window` samples from `row` on
    ahead : samples from the nearest one to the aim; straight on after the route's end
    offset : m, of the aim to the left of the route

    Returns
    -------
    row, distance to it (m), aim (m, m)
    """
    last, nearest, least = len(line) - 1, row, math.inf
    for i in range(row, min(row + window, last + 1)):
        distance2 = (line[i, 0] - x) ** 2 + (line[i, 1] - y) ** 2
        if distance2 < least:
            nearest, least = i, distance2
    aim = nearest + ahead
    beyond = max(0, aim - last) * spacing
    aim = min(aim, last)
    cos, sin = math.cos(line[aim, 2]), math.sin(line[aim, 2])
    return (
        nearest,
        math.sqrt(least),
        line[aim, 0] + beyond * cos - offset * sin,
        line[aim, 1] + beyond * sin + offset * cos,
    )
