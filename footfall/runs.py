"""Where a flag is up: stretches of true values."""

from __future__ import annotations

import numpy as np


def runs(flags: np.ndarray) -> np.ndarray:
    """(m, 2) first row of each run of true (n,) flags, and the first after it."""
    edges = np.diff(np.concatenate([[False], flags, [False]]))
    return np.flatnonzero(edges).reshape(-1, 2)
