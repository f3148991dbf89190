"""Compiled kernel of the policy's perceptron."""

from __future__ import annotations

import math

import numpy as np

from footfall.compiled import kernel


@kernel(nogil=True)
def perceptron(x, sizes, parameters, out):  # type: ignore[no-untyped-def]
    """Fill `out` (n, sizes[-1]) from x (n, sizes[0]); ELU between the layers.

    `parameters` holds of each layer the weights (inputs, outputs), row by row, then the biases.
    """
    for i in range(len(x)):
        here, at = x[i], 0
        for layer in range(len(sizes) - 1):
            inputs, outputs = sizes[layer], sizes[layer + 1]
            there = np.empty(outputs)
            for j in range(outputs):
                there[j] = parameters[at + inputs * outputs + j]
            # Along the rows of the weights: neighbouring sums share the processor's wide registers.
            for k in range(inputs):
                row = parameters[at + k * outputs : at + (k + 1) * outputs]
                for j in range(outputs):
                    there[j] += here[k] * row[j]
            if layer < len(sizes) - 2:
                for j in range(outputs):
                    there[j] = there[j] if there[j] > 0 else math.expm1(there[j])
            here, at = there, at + (inputs + 1) * outputs
        for j in range(len(here)):  # to assign the slice would compile numba's words on shapes that differ
            out[i, j] = here[j]
