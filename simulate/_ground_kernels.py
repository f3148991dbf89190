"""Compiled kernel of the ground's height."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def bilinear(heights, x0, y0, cell, x, y):  # type: ignore[no-untyped-def]
    """Height (n,) and gradient (n, 2) at x, y (n,); beyond the grid that of its edge."""
    rows, columns = heights.shape
    height, gradient = np.empty(len(x)), np.empty((len(x), 2))
    for k in range(len(x)):
        # A walker that is not finite is somewhere: it falls for another reason.
        u = min(max((x[k] - x0) / cell, 0.0), columns - 1.001) if np.isfinite(x[k]) else 0.0
        v = min(max((y[k] - y0) / cell, 0.0), rows - 1.001) if np.isfinite(y[k]) else 0.0
        i, j = int(u), int(v)
        a, b = u - i, v - j
        h00, h10, h01, h11 = heights[j, i], heights[j, i + 1], heights[j + 1, i], heights[j + 1, i + 1]
        height[k] = (1 - b) * ((1 - a) * h00 + a * h10) + b * ((1 - a) * h01 + a * h11)
        gradient[k, 0] = ((1 - b) * (h10 - h00) + b * (h11 - h01)) / cell
        gradient[k, 1] = ((1 - a) * (h01 - h00) + a * (h11 - h10)) / cell
    return height, gradient
