"""What the walker is asked to follow: a line on the ground, finely sampled."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np


@dataclass(frozen=True)
class Route:
    """A line on the ground, sampled evenly (0.1 m apart or finer).

    Attributes
    ----------
    s : (n,) m, horizontal distance along the line
    x, y, z : (n,) m; the walk starts at s = 0 heading along x
    heading : (n,) rad, unwrapped
    curvature : (n,) 1/m, positive to the left
    """

    s: np.ndarray
    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    heading: np.ndarray
    curvature: np.ndarray

    @property
    def length(self) -> float:
        """Horizontal length (m)."""
        return float(self.s[-1])


@dataclass(frozen=True)
class Ground:
    """A grid of heights: `heights[j, i]` (m) at x = x0 + i cell, y = y0 + j cell."""

    x0: float
    y0: float
    cell: float
    heights: np.ndarray = field(repr=False)
