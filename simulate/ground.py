"""Height and gradient of a heightfield where the walker is."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from footfall.models.body import Ground


def ground_lookup(ground: Ground) -> Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]:
    """(x, y) (n,) each -> height (n,) m and gradient (n, 2), bilinear in the grid."""
    heights, rows, columns = ground.heights.astype(float), *ground.heights.shape

    def look(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        u = np.clip((x - ground.x0) / ground.cell, 0, columns - 1.001)
        v = np.clip((y - ground.y0) / ground.cell, 0, rows - 1.001)
        i, j = u.astype(int), v.astype(int)
        a, b = u - i, v - j
        h00, h10, h01, h11 = heights[j, i], heights[j, i + 1], heights[j + 1, i], heights[j + 1, i + 1]
        height = (1 - b) * ((1 - a) * h00 + a * h10) + b * ((1 - a) * h01 + a * h11)
        slope_x = ((1 - b) * (h10 - h00) + b * (h11 - h01)) / ground.cell
        slope_y = ((1 - a) * (h01 - h00) + a * (h11 - h10)) / ground.cell
        return height, np.stack([slope_x, slope_y], -1)

    return look
