"""A foot-mounted IMU whose every truth is known: kinematics in closed form, samples by pose increments.

Feet do what makes navigation hard: they roll on slowly during stance, pitch through the vertical in swing,
and wobble about three axes at once (coning). Strapdown of the perfect samples returns the truth to rounding.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from footfall.conventions import GRAVITY, heading_of
from footfall.recording import Recording

STANCE = 0.3  # share of the stride that the ball of the foot is at rest
LEVER = np.array([-0.06, 0.0, 0.07])  # m, from the ball of the foot to the IMU, in the foot's frame
PIVOT_S = 0.6  # s, of a foot that turns on the ground before its first stride
UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class SyntheticWalk:
    """Truth of a synthetic walk: poses (n, ...) at t, perfect samples, and the middle of each stance (s)."""

    t: np.ndarray
    position: np.ndarray
    quaternion: np.ndarray
    velocity: np.ndarray
    gyro: np.ndarray
    accel: np.ndarray
    mid_stance: np.ndarray

    def at(self, t: np.ndarray) -> np.ndarray:
        """Row of each stamp."""
        return np.searchsorted(self.t, t - 1e-9)

    def heading(self, t: np.ndarray) -> np.ndarray:
        """True heading (rad, unwrapped) at stamps that lie in stances."""
        return heading_of(self.quaternion[self.at(t)])

    def recording(
        self,
        *,
        gyro_error: np.ndarray | float = 0.0,
        accel_error: np.ndarray | float = 0.0,
        angle_random_walk: float = 0.0,
        seed: int = 0,
    ) -> Recording:
        """What an IMU with these errors (rad/s, m/s2, rad/sqrt(s)) says. Row 0, the start, says nothing."""
        noise = np.random.default_rng(seed).standard_normal(self.gyro.shape)
        sigma = angle_random_walk / np.sqrt(np.median(np.diff(self.t)))
        gyro, accel = self.gyro + gyro_error + sigma * noise, self.accel + accel_error
        gyro[0], accel[0] = 0.0, 0.0
        return Recording(t=self.t, gyro=gyro, accel=accel)


def increments(
    t: np.ndarray, position: np.ndarray, quaternion: np.ndarray, velocity: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Perfect gyro and accelerometer samples (n, 3) whose strapdown returns the poses; row 0 is empty."""
    dt = np.diff(t)[:, None]
    attitude = Rotation.from_quat(quaternion, scalar_first=True)
    turn = (attitude[:-1].inv() * attitude[1:]).as_rotvec()
    middle = attitude[:-1] * Rotation.from_rotvec(turn / 2)
    force = middle.inv().apply((np.diff(velocity, axis=0)) / dt + GRAVITY * UP)
    empty = np.zeros((1, 3))
    return np.concatenate([empty, turn / dt]), np.concatenate([empty, force])


def walk(
    headings: Sequence[float],
    *,
    stride: float = 1.5,
    period: float = 1.1,
    still_s: float = 25.0,
    tail_s: float = 2.0,
    pauses: Mapping[int, float] | None = None,
    rate: float = 200.0,
    jitter: float = 0.0,
    rocking: float = np.radians(6.0),
    mount_pitch: float = np.radians(20.0),
    pivot: float = 0.0,
) -> SyntheticWalk:
    """Walk with the foot at `headings` (rad) at its footfalls, the first of which is the still start.

    Parameters
    ----------
    pauses : footfall -> seconds that the foot stands still there (after half its stance)
    jitter : share of the sampling interval by which stamps scatter evenly
    rocking : rad/s, pitch rate of the foot at mid-stance
    mount_pitch : rad, the IMU's x axis points down by this when the foot is flat
    pivot : rad, the foot stands turned back by this and turns about its ball into headings[0], on the ground,
        in the last 0.6 s of the still start: peak rate 1.875 pivot / 0.6 s
    """
    psi = np.asarray(headings, dtype=float)
    last = len(psi) - 1
    middle = np.cos((psi[1:] + psi[:-1]) / 2), np.sin((psi[1:] + psi[:-1]) / 2)
    ball = np.concatenate([np.zeros((1, 2)), np.cumsum(stride * np.column_stack(middle), axis=0)])

    # Time against gait phase: phase k is the middle of stance k, and stands still in a pause.
    rest = np.zeros(last + 1)
    for footfall, seconds in (pauses or {}).items():
        rest[footfall] = seconds
    rest[0] += still_s
    rest[last] += tail_s
    arrive = np.concatenate([[0.0], np.cumsum(rest[:-1] + period)])
    times = np.column_stack([arrive, arrive + rest]).ravel()
    phases = np.repeat(np.arange(last + 1.0), 2)

    def pose(at: np.ndarray) -> tuple[np.ndarray, Rotation]:
        phase = np.interp(at, times, phases)
        k = np.minimum(phase.astype(int), last - 1)
        u = phase - k
        s = np.clip((u - STANCE / 2) / (1 - STANCE), 0.0, 1.0)
        go = s**3 * (10 - 15 * s + 6 * s**2)
        early, late = 8**8 / (3**3 * 5**5) * s**3 * (1 - s) ** 5, 8**8 / (3**3 * 5**5) * s**5 * (1 - s) ** 3
        rock = rocking * period / (2 * np.pi) * np.sin(2 * np.pi * u)
        yaw = psi[k] + (psi[k + 1] - psi[k]) * go + np.radians(10) * early
        u_pivot = np.clip((at - still_s + PIVOT_S) / PIVOT_S, 0.0, 1.0)
        yaw = yaw - pivot * (1 - u_pivot**3 * (10 - 15 * u_pivot + 6 * u_pivot**2))
        pitch = rock + np.radians(85) * early - np.radians(25) * late
        roll = np.radians(-8) * early + np.radians(12) * late
        foot = Rotation.from_euler("ZYX", np.column_stack([yaw, pitch, roll]))
        ground = np.column_stack(
            [ball[k] + (ball[k + 1] - ball[k]) * go[:, None], 0.08 * 64 * (s * (1 - s)) ** 3]
        )
        return ground + foot.apply(LEVER), foot * Rotation.from_euler("Y", mount_pitch)

    n = round(float(times[-1] * rate)) + 1
    t = np.arange(n) / rate
    if jitter:
        t[1:-1] += np.random.default_rng(0).uniform(-jitter / 2, jitter / 2, n - 2) / rate
    half = 0.5 / rate
    velocity = (pose(t + half)[0] - pose(t - half)[0]) * rate
    start, attitude = pose(t)
    quaternion = attitude.as_quat(scalar_first=True)
    gyro, accel = increments(t, start, quaternion, velocity)
    # The path whose velocity this is, trapezoid by trapezoid: within a millimetre of the closed form.
    moved = np.cumsum(np.diff(t)[:, None] * (velocity[1:] + velocity[:-1]) / 2, axis=0)
    position = start[0] + np.concatenate([np.zeros((1, 3)), moved])
    return SyntheticWalk(
        t, position, quaternion, velocity, gyro, accel, times[::2] + np.where(rest > 0, rest, 0) / 2
    )
