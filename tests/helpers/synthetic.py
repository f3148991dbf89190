"""A walk in closed form: a foot that rolls, cones and steps, with the IMU truth taken from its poses."""

import numpy as np
from scipy.spatial.transform import Rotation

from footfall.simulate.walk import TrueFootfalls, Walk

GRAVITY = np.array([0.0, 0.0, -9.80665])
STRIDE_S = 1.1
STANCE = 0.4  # share of the stride


def synthetic_walk(strides: int = 30, rate: float = 200.0, still_s: float = 26.0, turn: float = 0.02) -> Walk:
    """Stand for `still_s`, then walk `strides` strides while turning at `turn` rad/s on average.

    In each swing the foot pitches by a radian and cones through yaw and roll; the IMU is tilted.
    """

    def swing(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Strides made so far, and how far through the present swing (0 while in stance)."""
        phase = np.clip((t - still_s) / STRIDE_S, 0.0, strides)
        return np.floor(phase), np.clip((phase % 1 - STANCE) / (1 - STANCE), 0, 1)

    def position(t: np.ndarray) -> np.ndarray:
        made, v = swing(t)
        along = 1.4 * (made + v**3 * (10 - 15 * v + 6 * v**2))
        return np.column_stack([along, 0.05 * np.sin(np.pi * v) ** 4, 0.12 * np.sin(np.pi * v) ** 4])

    def attitude(t: np.ndarray) -> Rotation:
        made, v = swing(t)
        bump = np.sin(np.pi * v) ** 4
        yaw = turn * STRIDE_S * (made + v**3 * (10 - 15 * v + 6 * v**2)) + 0.25 * bump
        pitch = 0.35 + 1.0 * bump - 0.5 * np.sin(2 * np.pi * v) ** 3 * bump
        roll = 0.05 + 0.3 * bump * np.sin(2 * np.pi * v) ** 2
        return Rotation.from_euler("ZYX", np.column_stack([yaw, pitch, roll]))

    dt = 1 / rate
    t = np.arange(round((still_s + strides * STRIDE_S) * rate) + 1) * dt
    q = attitude(t)
    velocity = (position(t + dt / 2) - position(t - dt / 2)) / dt
    turned = (q[:-1].inv() * q[1:]).as_rotvec()
    # Resolved in the frame of the middle of the interval, as the truth of a simulated walk is.
    middle = q[:-1] * Rotation.from_rotvec(turned / 2)
    force = middle.inv().apply(np.diff(velocity, axis=0) / dt - GRAVITY)
    stance = swing(t)[1] == 0
    at = np.rint((still_s + (np.arange(strides) + 0.15) * STRIDE_S) * rate).astype(int)
    quaternion = q.as_quat(scalar_first=True)
    heading = np.unwrap(np.arctan2(q.as_matrix()[:, 1, 0], q.as_matrix()[:, 0, 0]))
    return Walk(
        t=t,
        position=position(t),
        quaternion=quaternion,
        velocity=velocity,
        gyro=np.vstack([np.zeros(3), turned / dt]),
        accel=np.vstack([q[0].inv().apply(-GRAVITY), force]),
        contact=stance.astype(float),
        stance=stance,
        footfalls=TrueFootfalls(t=t[at], position=position(t)[at], heading=heading[at]),
        meta={"calibration_s": still_s, "scenario": "synthetic"},
    )
