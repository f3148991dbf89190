"""Filters on the synthetic foot, and how far they are from the truth."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from footfall.conventions import GRAVITY
from footfall.pdr.filter.ins import Alignment, FilterSettings, InertialFilter, initial_covariance
from footfall.pdr.filter.layout import ACCEL_BIAS, ATTITUDE, GYRO_BIAS
from tests.helpers.synthetic_foot import SyntheticWalk


def tossed(seed: int, n: int = 400) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """t, gyro, accel of violent motion at uneven stamps with one gap, and updates here and there."""
    rng = np.random.default_rng(seed)
    dt = rng.uniform(0.003, 0.007, n)
    dt[n // 2] = 0.12
    gyro, accel = rng.normal(0, 3, (n, 3)), rng.normal([0, 0, GRAVITY], 10, (n, 3))
    update = np.where(rng.random(n) < 0.1, rng.integers(1, 3, n), 0)
    return np.cumsum(dt), gyro, accel, update


def alignment(seed: int = 0) -> Alignment:
    """A start in some attitude with some gyro bias, at t = 0."""
    rng = np.random.default_rng(seed)
    attitude = Rotation.from_euler("ZYX", [rng.uniform(-3, 3), rng.uniform(-1, 1), rng.uniform(-1, 1)])
    return Alignment(
        t=0.0,
        quaternion=attitude.as_quat(scalar_first=True),
        gyro_bias=rng.normal(0, 0.01, 3),
        force=attitude.inv().apply([0.0, 0.0, GRAVITY]),
        position=(1.0, 2.0, 3.0),
    )


def error_of(
    found: InertialFilter, truth: SyntheticWalk, accel_bias: np.ndarray, gyro_bias: np.ndarray
) -> np.ndarray:
    """truth - estimate (15,) at the filter's time."""
    row = truth.at(np.array([found.t]))[0]
    turn = Rotation.from_quat(truth.quaternion[row], scalar_first=True)
    return np.concatenate(
        [
            truth.position[row] - truth.position[0] - found.position,
            truth.velocity[row] - found.velocity,
            (turn * Rotation.from_quat(found.quaternion, scalar_first=True).inv()).as_rotvec(),
            accel_bias - found.accel_bias,
            gyro_bias - found.gyro_bias,
        ]
    )


def drawn(
    truth: SyntheticWalk, settings: FilterSettings, seed: int
) -> tuple[InertialFilter, np.ndarray, np.ndarray]:
    """A filter whose start is off by a draw from what it believes; the true biases (3,) of both triads."""
    start = truth.quaternion[0]
    attitude = Rotation.from_quat(start, scalar_first=True)
    level = Alignment(0.0, start, np.zeros(3), attitude.inv().apply([0.0, 0.0, GRAVITY]))
    p = initial_covariance(settings, level)
    values, vectors = np.linalg.eigh(p)
    off = vectors @ (np.sqrt(np.maximum(values, 0)) * np.random.default_rng(seed).standard_normal(len(p)))
    wrong = (Rotation.from_rotvec(off[ATTITUDE]).inv() * attitude).as_quat(scalar_first=True)
    return (
        InertialFilter(settings, Alignment(0.0, wrong, np.zeros(3), level.force)),
        off[ACCEL_BIAS],
        off[GYRO_BIAS],
    )
