"""What the compiled kernels compute, in numpy and with rotation matrices: for tests and benchmarks."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from scipy.spatial.transform import Rotation

from footfall.conventions import GRAVITY
from footfall.pdr._detection import BARELY, SLACK
from footfall.pdr.stance import StanceParams, Stances, ThresholdDetector, moving_mean
from footfall.runs import runs


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
    t: np.ndarray,
    gyro: np.ndarray,
    accel: np.ndarray,
    bias: np.ndarray,
    q0: np.ndarray,
    resets: np.ndarray,
    tilt_gain: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Twin of `_kernels.reckon`."""
    zero = np.zeros(3)
    state, half = Strapdown(q0, zero, zero), half_turns(t, gyro - bias)
    quaternion, position, sums = [state.quaternion], [zero], [np.zeros(30)]
    for first, last in pairwise(resets):
        state.velocity, state.position, total = zero, zero, np.zeros((10, 3))
        for k in range(first + 1, last + 1):
            before, dt = state.attitude[2], t[k] - t[k - 1]
            state.take(half[k], accel[k], dt)
            up = dt * (before + state.attitude[2]) / 2
            total += np.vstack(
                [up, np.outer(up, accel[k]), np.outer(up, gyro[k] - bias), np.outer(up, accel[k] ** 2)]
            )
        sums.append(total.ravel())
        duration = t[last] - t[first]
        position.append(position[-1] + state.position - state.velocity * duration / 2)
        error = np.cross([0.0, 0.0, 1.0], -state.velocity) / (GRAVITY * duration)
        state.attitude = Rotation.from_rotvec(tilt_gain * error).as_matrix() @ state.attitude
        quaternion.append(state.quaternion)
    return np.array(quaternion), np.array(position), np.array(sums)


def threshold(t: np.ndarray, gyro: np.ndarray, accel: np.ndarray, detector: ThresholdDetector) -> np.ndarray:
    """Twin of `ThresholdDetector`'s score."""
    rate = np.linalg.norm(moving_mean(gyro, t, detector.window_s), axis=1)
    force = np.linalg.norm(moving_mean(accel, t, detector.window_s), axis=1)
    score = np.maximum(rate / detector.gyro_max, np.abs(force - GRAVITY) / detector.accel_max)
    return np.where(np.isnan(score), np.inf, score)


def means(t: np.ndarray, gyro: np.ndarray, accel: np.ndarray, window_s: float) -> np.ndarray:
    """Twin of `_detection.means`."""
    values = np.column_stack(
        [
            accel,
            (accel**2).sum(axis=1),
            (gyro**2).sum(axis=1),
            (np.linalg.norm(accel, axis=1) - GRAVITY) ** 2,
        ]
    )
    total = np.concatenate([np.zeros_like(values[:1]), np.cumsum(values, axis=0)])
    stop = np.searchsorted(t, t + window_s + SLACK)
    return ((total[stop] - total[:-1]) / (stop - np.arange(len(t)))[:, None]).T


def held(t: np.ndarray, value: np.ndarray, window_s: float) -> np.ndarray:
    """Twin of `_detection.held`."""
    about = value[np.searchsorted(t, t - window_s / 2 - SLACK)]
    first = np.searchsorted(t, t - window_s - SLACK)
    least = np.array([value[a : k + 1].min() for k, a in enumerate(first)])
    return np.where((about >= 1) & (least < 1), BARELY, about)


def find_stances(t: np.ndarray, score: np.ndarray, params: StanceParams) -> Stances:
    """Twin of `stance.find_stances`."""
    kept: list[np.ndarray] = []
    for start, stop in runs(score < 1.0):
        if t[stop - 1] - t[start] < params.min_stance_s:
            continue
        resets = _resets(t, score, start, stop, params.reset_s)
        if kept and t[resets[0]] - t[kept[-1][-1]] < params.min_stride_s:
            if score[resets].min() >= score[kept[-1]].min():
                continue
            kept.pop()
        kept.append(resets)
    counts = np.array([len(resets) for resets in kept], dtype=int)
    return Stances(
        resets=np.concatenate(kept) if kept else np.empty(0, dtype=int), footfalls=np.cumsum(counts) - 1
    )


def _resets(t: np.ndarray, score: np.ndarray, start: int, stop: int, reset_s: float) -> np.ndarray:
    """The quietest instant of a stance, or of each part of a still period."""
    duration = t[stop - 1] - t[start]
    parts = int(duration / reset_s) if duration > 2 * reset_s else 1
    edges = np.searchsorted(t[start:stop], t[start] + np.arange(1, parts) * (duration / parts)) + start
    bounds = np.concatenate([[start], edges, [stop]])
    return np.array([a + np.argmin(score[a:b]) for a, b in pairwise(bounds) if b > a])
