"""What many scores come to."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def spread(values: Sequence[float] | np.ndarray) -> dict[str, float]:
    """Mean, median and 90th percentile."""
    array = np.asarray(values, dtype=float)
    return {
        "mean": float(array.mean()),
        "median": float(np.median(array)),
        "p90": float(np.percentile(array, 90)),
    }


def extent(values: Sequence[float] | np.ndarray) -> dict[str, float]:
    """Median, smallest and largest."""
    return {"median": float(np.median(values)), "smallest": float(min(values)), "largest": float(max(values))}


def running_mean(values: np.ndarray, count: int = 25) -> np.ndarray:
    """Mean over so many neighbours, of the same length: fewer of them at the ends."""
    kernel = np.ones(min(count, len(values)))
    return np.convolve(values, kernel, "same") / np.convolve(np.ones(len(values)), kernel, "same")
