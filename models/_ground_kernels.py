"""Compiled kernels of the ground."""

from __future__ import annotations

import numpy as np

from footfall.compiled import kernel
from footfall.models import body

_FOOT, _TOUCH = body.SENSOR_FOOT_POSITION.start, body.SENSOR_TOUCH.start


@kernel(nogil=True)
def bilinear(heights, x0, y0, cell, x, y):  # type: ignore[no-untyped-def]
    """Height (n,) and gradient (n, 2) at x, y (n,); beyond the grid that of its edge."""
    rows, columns = heights.shape
    height, gradient = np.empty(len(x)), np.empty((len(x), 2))
    for k in range(len(x)):
        # A place that is not finite gets the grid's corner: such a walker counts as fallen anyway.
        u = min(max((x[k] - x0) / cell, 0.0), columns - 1.001) if np.isfinite(x[k]) else 0.0
        v = min(max((y[k] - y0) / cell, 0.0), rows - 1.001) if np.isfinite(y[k]) else 0.0
        i, j = int(u), int(v)
        a, b = u - i, v - j
        h00, h10, h01, h11 = heights[j, i], heights[j, i + 1], heights[j + 1, i], heights[j + 1, i + 1]
        height[k] = (1 - b) * ((1 - a) * h00 + a * h10) + b * ((1 - a) * h01 + a * h11)
        gradient[k, 0] = ((1 - b) * (h10 - h00) + b * (h11 - h01)) / cell
        gradient[k, 1] = ((1 - a) * (h01 - h00) + a * (h11 - h10)) / cell
    return height, gradient


@kernel(nogil=True)
def lay(planes, sensor, height, gradient):  # type: ignore[no-untyped-def]
    """Pose the planes (n, 14) of unloaded feet by the height (2n,) and gradient (2n, 2) where they are."""
    for i in range(len(planes)):
        for f in range(2):
            touch = _TOUCH + 3 * f
            if sensor[i, touch] + sensor[i, touch + 1] + sensor[i, touch + 2] > 0:
                continue
            k, position, quaternion = 2 * i + f, 3 * f, 6 + 4 * f
            planes[i, position] = sensor[i, _FOOT + 3 * f]
            planes[i, position + 1] = sensor[i, _FOOT + 3 * f + 1]
            planes[i, position + 2] = height[k]
            # The shortest turn from the vertical to the normal.
            a, b = gradient[k, 0], gradient[k, 1]
            normal = 1 / np.sqrt(1 + a * a + b * b)
            w = np.sqrt((1 + normal) / 2)
            planes[i, quaternion] = w
            planes[i, quaternion + 1] = b * normal / (2 * w)
            planes[i, quaternion + 2] = -a * normal / (2 * w)
            planes[i, quaternion + 3] = 0.0
