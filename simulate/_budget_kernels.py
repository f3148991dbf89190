"""Compiled kernel of the drift budget."""

from __future__ import annotations

import math

import numpy as np

from footfall.compiled import kernel


@kernel()
def compose(rate: np.ndarray, interval: float, edges: np.ndarray) -> np.ndarray:
    """Rotation over each stretch of samples: the product of Exp(rate * interval).

    Parameters
    ----------
    rate : (n, 3) rad/s, over the interval that ends at each sample
    interval : s
    edges : (m + 1,) samples; stretch i holds the samples after edges[i] up to edges[i + 1]

    Returns
    -------
    (m, 4) quaternions, scalar first
    """
    out = np.empty((len(edges) - 1, 4))
    for i in range(len(edges) - 1):
        w, x, y, z = 1.0, 0.0, 0.0, 0.0
        for k in range(edges[i] + 1, edges[i + 1] + 1):
            a, b, c = 0.5 * interval * rate[k, 0], 0.5 * interval * rate[k, 1], 0.5 * interval * rate[k, 2]
            half = math.sqrt(a * a + b * b + c * c)
            s = math.sin(half) / half if half > 0 else 1.0
            d, a, b, c = math.cos(half), s * a, s * b, s * c
            w, x, y, z = (
                w * d - x * a - y * b - z * c,
                w * a + x * d + y * c - z * b,
                w * b - x * c + y * d + z * a,
                w * c + x * b - y * a + z * d,
            )
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = w, x, y, z
    return out
