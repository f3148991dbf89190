"""Attitudes that a start needs. Importing scipy.spatial for them takes longer than a short file's walk."""

from __future__ import annotations

import numpy as np


def quaternion_of(matrix: np.ndarray) -> np.ndarray:
    """Quaternion (4,), scalar first, of a rotation matrix (3, 3).

    The largest of the four is found first, so that none is a small difference of large numbers (Markley 2008,
    "Unit quaternion from rotation matrix"). The same to the bit as `scipy.spatial.transform.Rotation`.
    """
    trace = np.trace(matrix)
    largest = int(np.argmax([*np.diag(matrix), trace]))
    vector, scalar = np.empty(3), 1.0 + trace
    if largest == 3:
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            vector[i] = matrix[k, j] - matrix[j, k]
    else:
        i, j, k = largest, (largest + 1) % 3, (largest + 2) % 3
        vector[i] = 1.0 - trace + 2.0 * matrix[i, i]
        vector[j], vector[k] = matrix[j, i] + matrix[i, j], matrix[k, i] + matrix[i, k]
        scalar = matrix[k, j] - matrix[j, k]
    x, y, z = vector
    return np.array([scalar, x, y, z]) / np.sqrt(x * x + y * y + z * z + scalar * scalar)


def turned(position: np.ndarray, heading: float) -> np.ndarray:
    """Positions (n, 3) turned about the vertical through the origin by `heading` (rad, counter-clockwise)."""
    cos, sin = np.cos(heading), np.sin(heading)
    x, y, z = position.T
    return np.column_stack([cos * x - sin * y, sin * x + cos * y, z])
