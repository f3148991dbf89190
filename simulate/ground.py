"""Height and gradient of a heightfield where the walker is."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from footfall.models.body import Ground
from footfall.simulate._ground_kernels import bilinear


def ground_lookup(ground: Ground) -> Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]:
    """(x, y) (n,) each -> height (n,) m and gradient (n, 2), bilinear in the grid."""
    heights = np.ascontiguousarray(ground.heights, dtype=float)
    x0, y0, cell = float(ground.x0), float(ground.y0), float(ground.cell)

    def look(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        height, gradient = bilinear(heights, x0, y0, cell, np.ascontiguousarray(x), np.ascontiguousarray(y))
        return height, gradient

    return look
