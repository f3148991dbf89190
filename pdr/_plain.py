"""What the compiled kernels compute, in numpy and with rotation matrices: for tests and benchmarks."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from scipy.spatial.transform import Rotation

from footfall.conventions import GRAVITY


class Strapdown:
    """Attitude (3, 3), velocity and position that take one sample at a time."""

    def __init__(self, q0: np.ndarray, v0: np.ndarray, p0: np.ndarray) -> None:
        self.attitude = Rotation.from_quat(q0, scalar_first=True).as_matrix()
        self.velocity, self.position = np.array(v0, dtype=float), np.array(p0, dtype=float)

    def take(self, half_turn: np.ndarray, accel: np.ndarray, dt: float) -> None:
        """Advance by a sample whose rotation is `half_turn` (3, 3) twice."""
        middle = self.attitude @ half_turn
        before = self.velocity
        self.velocity = before + dt * (middle @ accel - [0.0, 0.0, GRAVITY])
        self.position = self.position + 0.5 * dt * (before + self.velocity)
        self.attitude = middle @ half_turn

    @property
    def quaternion(self) -> np.ndarray:
        """Attitude as a quaternion (4,), scalar first and positive."""
        return np.asarray(Rotation.from_matrix(self.attitude).as_quat(canonical=True, scalar_first=True))


def half_turns(t: np.ndarray, gyro: np.ndarray) -> np.ndarray:
    """Rotation by half of each sample's angle: (n, 3, 3)."""
    dt = np.diff(t, prepend=t[0])[:, None]
    return np.asarray(Rotation.from_rotvec(0.5 * dt * gyro).as_matrix())


def integrate(
    t: np.ndarray, gyro: np.ndarray, accel: np.ndarray, q0: np.ndarray, v0: np.ndarray, p0: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Twin of `_kernels.integrate`."""
    state, half = Strapdown(q0, v0, p0), half_turns(t, gyro)
    rows = [(state.quaternion, state.velocity, state.position)]
    for k in range(1, len(t)):
        state.take(half[k], accel[k], t[k] - t[k - 1])
        rows.append((state.quaternion, state.velocity, state.position))
    quaternion, velocity, position = (np.array(column) for column in zip(*rows, strict=True))
    return quaternion, velocity, position


def reckon(
    t: np.ndarray, gyro: np.ndarray, accel: np.ndarray, q0: np.ndarray, resets: np.ndarray, tilt_gain: float
) -> tuple[np.ndarray, np.ndarray]:
    """Twin of `_kernels.reckon`."""
    zero = np.zeros(3)
    state, half = Strapdown(q0, zero, zero), half_turns(t, gyro)
    quaternion, position = [state.quaternion], [zero]
    for first, last in pairwise(resets):
        state.velocity, state.position = zero, zero
        for k in range(first + 1, last + 1):
            state.take(half[k], accel[k], t[k] - t[k - 1])
        duration = t[last] - t[first]
        position.append(position[-1] + state.position - state.velocity * duration / 2)
        error = np.cross([0.0, 0.0, 1.0], -state.velocity) / (GRAVITY * duration)
        state.attitude = Rotation.from_rotvec(tilt_gain * error).as_matrix() @ state.attitude
        quaternion.append(state.quaternion)
    return np.array(quaternion), np.array(position)
