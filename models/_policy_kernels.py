"""Compiled kernel of the policy's perceptron."""

from __future__ import annotations

import math

from numba import njit


@njit(cache=True, nogil=True)
def layer(x, weight, bias, bend, out):  # type: ignore[no-untyped-def]
    """Fill `out` (n, b) with x (n, a) weight (a, b) + bias (b,), through an ELU where `bend`."""
    for i in range(len(x)):
        out[i] = bias
        for k in range(weight.shape[0]):
            # Along the rows of the weights: neighbouring sums share the processor's wide registers.
            for j in range(weight.shape[1]):
                out[i, j] += x[i, k] * weight[k, j]
        if bend:
            for j in range(weight.shape[1]):
                out[i, j] = out[i, j] if out[i, j] > 0 else math.expm1(out[i, j])
