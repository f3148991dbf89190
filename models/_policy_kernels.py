"""Compiled kernel of the policy's perceptron."""

from __future__ import annotations

import math

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def layer(x, weight, bias, bend):  # type: ignore[no-untyped-def]
    """x (n, a), weight (a, b), bias (b,) -> x weight + bias (n, b), through an ELU where `bend`."""
    out = np.empty((len(x), len(bias)))
    for i in range(len(x)):
        out[i] = bias
        for k in range(weight.shape[0]):
            # Along the rows of the weights: neighbouring sums share the processor's wide registers.
            for j in range(weight.shape[1]):
                out[i, j] += x[i, k] * weight[k, j]
        if bend:
            for j in range(weight.shape[1]):
                out[i, j] = out[i, j] if out[i, j] > 0 else math.expm1(out[i, j])
    return out
