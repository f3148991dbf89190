"""IMU truth from pose increments: integrating it returns the walked positions (mujoco's IMU sensors do not).

With v from half-interval positions and increments resolved in the mid-interval frame, the consumer

    v+ = v + R(q Exp(dth / 2)) dv + g T;   p += T (v + v+) / 2;   q = q Exp(dth)

returns the poses to a millimetre after 20 minutes, at the physics rate and at any rate that divides it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from footfall.conventions import GRAVITY
from footfall.errors import InputError
from footfall.late import late
from footfall.runs import runs

_kernels = late("footfall.simulate._truth_kernels")

# The foot is at rest on the ground: it carries load while the IMU neither travels nor turns fast.
REST_SPEED = 0.20  # m/s
REST_RATE = 1.2  # rad/s
REST_CONTACT = 0.02  # of body weight
_SHORTEST_STANCE_S = 0.06
_BRIDGED_GAP_S = 0.04


@dataclass(frozen=True)
class ImuTruth:
    """Poses on the output grid and what a perfect IMU measures over the interval that ends at each.

    `index` (n,) are the rows of the physics record that the output rows stand on.
    """

    index: np.ndarray
    position: np.ndarray
    quaternion: np.ndarray
    velocity: np.ndarray
    gyro: np.ndarray
    accel: np.ndarray


def divisor(physics_step: float, rate_hz: float) -> int:
    """Physics steps per output sample.

    Raises
    ------
    InputError
        `rate_hz` does not divide the physics rate.
    """
    physics_rate = round(1 / physics_step)
    factor = round(physics_rate / rate_hz) if rate_hz > 0 else 0
    if factor < 1 or abs(factor * rate_hz - physics_rate) > 1e-6:
        raise InputError(f"rate = {rate_hz:g} Hz does not divide the physics rate of {physics_rate} Hz")
    return factor


def imu_truth(position: np.ndarray, quaternion: np.ndarray, physics_step: float, factor: int) -> ImuTruth:
    """What a perfect IMU on this motion measures.

    Parameters
    ----------
    position : (m, 3) m and quaternion : (m, 4) body to world, scalar first, at every physics step
    physics_step : s
    factor : physics steps per output sample
    """
    margin = (factor + 1) // 2
    index = np.arange(margin, len(position) - margin, factor)
    if len(index) < 3:
        raise InputError(
            f"walk: {len(position)} physics steps are too few for one output sample of {factor} steps"
        )
    interval = factor * physics_step
    # Position half an output interval later and earlier; between two samples when the ratio is odd.
    low, high = factor // 2, (factor + 1) // 2
    later = (position[index + low] + position[index + high]) / 2
    earlier = (position[index - low] + position[index - high]) / 2
    velocity = (later - earlier) / interval

    gained = np.diff(velocity, axis=0) + np.array([0, 0, GRAVITY * interval])
    turn, force = _kernels.increments(quaternion[index], gained)
    return ImuTruth(
        index=index[1:],
        position=position[index[1:]],
        quaternion=quaternion[index[1:]],
        velocity=velocity[1:],
        gyro=turn / interval,
        accel=force / interval,
    )


def at_rest(truth: ImuTruth, contact: np.ndarray, interval: float) -> np.ndarray:
    """When a foot is on the ground at rest; runs shorter than 60 ms do not count.

    Parameters
    ----------
    truth : of a place on the foot, n samples
    contact : (n,) body weights on it
    interval : s between samples

    Returns
    -------
    (n,) bool
    """
    slow = np.linalg.norm(truth.velocity, axis=1) < REST_SPEED
    quiet = np.linalg.norm(truth.gyro, axis=1) < REST_RATE
    rest = slow & quiet & (contact > REST_CONTACT)
    for start, end in runs(~rest):
        inside = start > 0 and end < len(rest)
        if inside and (end - start) * interval < _BRIDGED_GAP_S:
            rest[start:end] = True
    for start, end in runs(rest):
        if (end - start) * interval < _SHORTEST_STANCE_S:
            rest[start:end] = False
    return rest
