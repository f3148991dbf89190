"""From a better heading to a better track."""

from __future__ import annotations

import numpy as np

from footfall.pdr.footfalls import Footfalls


def turned_positions(footfalls: Footfalls, heading: np.ndarray) -> np.ndarray:
    """Turn each of dead reckoning's displacements by the heading correction at its middle: (n, 3) m.

    The correction is `heading - footfalls.heading`, (n,) rad; a stride's is the mean of those at its ends.
    The foot swings between two stances, so a displacement points where the person goes, not where the
    shoe does at either end: this is why the displacement is kept and turned.
    """
    correction = heading - footfalls.heading
    middle = 0.5 * (correction[1:] + correction[:-1])
    x, y, z = np.diff(footfalls.position, axis=0).T
    steps = np.column_stack(
        [np.cos(middle) * x - np.sin(middle) * y, np.sin(middle) * x + np.cos(middle) * y, z]
    )
    return np.concatenate([footfalls.position[:1], footfalls.position[0] + np.cumsum(steps, axis=0)])


def paper_positions(footfalls: Footfalls, heading: np.ndarray) -> np.ndarray:
    """HDR Eq. 12: each stride goes D_i along psi_i, the heading of the IMU's x axis: (n, 3) m.

    x_i = x_{i-1} + D_i cos psi_i (the paper writes x_0 for x_{i-1}); height is dead reckoning's.
    A shoe that points outwards by an angle turns the whole track by it.
    """
    x, y = footfalls.position[0, :2]
    return np.column_stack(
        [
            x + np.cumsum(footfalls.distance * np.cos(heading)),
            y + np.cumsum(footfalls.distance * np.sin(heading)),
            footfalls.position[:, 2],
        ]
    )
