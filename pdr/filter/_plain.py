"""What the compiled filter computes, in numpy with whole matrices: for tests and benchmarks."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from footfall.conventions import GRAVITY
from footfall.pdr.filter.ins import ZERO_RATE, Alignment, FilterSettings, initial_covariance
from footfall.pdr.filter.layout import (
    ACCEL_BIAS,
    ATTITUDE,
    G_SENSITIVITY,
    GYRO_BIAS,
    HEADING,
    POSITION,
    VELOCITY,
)


def cross(v: np.ndarray) -> np.ndarray:
    """[v x] (3, 3)."""
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


class PlainFilter:
    """Twin of `InertialFilter`; `error` is what its last update put right."""

    def __init__(self, settings: FilterSettings, start: Alignment) -> None:
        self.settings = settings
        self.up = np.array(start.up)
        self.t = start.t
        self.attitude = Rotation.from_quat(start.quaternion, scalar_first=True).as_matrix()
        self.position, self.velocity = np.array(start.position, dtype=float), np.zeros(3)
        self.accel_bias, self.gyro_bias = np.zeros(3), np.array(start.gyro_bias, dtype=float)
        self.g_sensitivity = np.zeros((3, 3))
        self.covariance = initial_covariance(settings, start)
        self.error = np.zeros(settings.states)

    def take(self, t: float, gyro: np.ndarray, accel: np.ndarray, update: int) -> None:
        """One sample, and what is known at its end."""
        s = self.settings
        dt = t - self.t
        force, rate = self.corrected(gyro, accel)
        half = Rotation.from_rotvec(0.5 * dt * rate).as_matrix()
        middle = self.attitude @ half
        self.covariance = self._predicted(middle, force, dt)
        before = self.velocity
        self.velocity = before + dt * (middle @ force - [0.0, 0.0, GRAVITY])
        self.position = self.position + 0.5 * dt * (before + self.velocity)
        self.attitude = middle @ half
        self.t = t
        if update:
            h, z, sd = np.eye(s.states)[VELOCITY], -self.velocity, s.sigma_velocity
            self.error = self._updated(h, z, sd, np.zeros(s.states), s.velocity_turns)
            if update == ZERO_RATE and s.zaru:
                force, rate = self.corrected(gyro, accel)
                self.error = self._updated(self.rate_rows(force), rate, s.sigma_rate, self.error, True)
            self._put_right(self.error)

    def correct_heading(self, innovation: float, sd: float) -> None:
        """Twin of `InertialFilter.correct_heading`."""
        none = np.zeros(self.settings.states)
        self.error = self._updated(self.heading_row()[None], np.array([innovation]), sd, none, True)
        self._put_right(self.error)

    def corrected(self, gyro: np.ndarray, accel: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Force and rate without the errors that the state knows."""
        force = accel - self.accel_bias
        return force, gyro - self.gyro_bias - self.g_sensitivity @ force

    def rate_rows(self, force: np.ndarray) -> np.ndarray:
        """H (3, states) of the zero rate."""
        h = np.zeros((3, self.settings.states))
        h[:, GYRO_BIAS] = np.eye(3)
        if self.settings.g_sensitivity:
            h[:, G_SENSITIVITY] = np.kron(np.eye(3), force)
        return h

    def heading_row(self) -> np.ndarray:
        """H (states,) of the heading: by how much phi x e turns the level part of e, the body's x axis."""
        e = self.attitude[:, 0]
        h = np.zeros(self.settings.states)
        level = np.array([-e[1], e[0], 0.0]) / (e[0] ** 2 + e[1] ** 2)
        h[ATTITUDE] = level @ -cross(e)
        return h

    def transition(self, middle: np.ndarray, force: np.ndarray, dt: float) -> np.ndarray:
        """F (states, states), Deng Eq. 9."""
        f = np.eye(self.settings.states)
        f[POSITION, VELOCITY] = np.eye(3) * dt
        f[VELOCITY, ATTITUDE] = -cross(middle @ force) * dt
        f[VELOCITY, ACCEL_BIAS] = -middle * dt
        f[ATTITUDE, GYRO_BIAS] = -middle * dt
        if self.settings.g_sensitivity:
            f[ATTITUDE, G_SENSITIVITY] = -middle @ np.kron(np.eye(3), force) * dt
        return f

    def _predicted(self, middle: np.ndarray, force: np.ndarray, dt: float) -> np.ndarray:
        s, f = self.settings, self.transition(middle, force, dt)
        gap = float(dt > s.gap_s)
        q = np.zeros(s.states)
        q[VELOCITY] = s.accel_noise**2 * dt + gap * (s.gap_accel * dt) ** 2
        q[ATTITUDE] = s.gyro_noise**2 * dt + gap * (s.gap_gyro * dt) ** 2
        q[ACCEL_BIAS] = s.estimate_accel_bias * s.accel_bias_walk**2 * dt
        q[GYRO_BIAS] = s.estimate_gyro_bias * s.gyro_bias_walk**2 * dt
        return f @ self.covariance @ f.T + np.diag(q)

    def _updated(self, h: np.ndarray, z: np.ndarray, sd: float, error: np.ndarray, turns: bool) -> np.ndarray:
        """Joseph form for H (m, states) and z (m,); returns the whole error of this instant."""
        p, r = self.covariance, sd**2 * np.eye(len(z))
        known = p if turns else self._with_known_turn()
        gain = known @ h.T @ np.linalg.inv(h @ known @ h.T + r)
        left = np.eye(len(p)) - gain @ h
        self.covariance = left @ p @ left.T + gain @ r @ gain.T
        return error + gain @ (z - h @ error)

    def _known_rows(self) -> np.ndarray:
        """What zero velocity must not touch: heading, and the gyro's errors about the vertical."""
        rows = np.zeros((5 if self.settings.g_sensitivity else 2, self.settings.states))
        rows[0, HEADING] = 1.0
        rows[1, GYRO_BIAS] = self.up
        if self.settings.g_sensitivity:
            rows[2:, G_SENSITIVITY] = np.kron(self.up, np.eye(3))
        return rows

    def _with_known_turn(self) -> np.ndarray:
        """Covariance if they were known."""
        p = self.covariance
        live = [row for row in self._known_rows() if row @ p @ row > 0]
        if not live:
            return p
        s = np.array(live)
        # To unit variances, so that the inverse is of a correlation matrix.
        s /= np.sqrt(np.einsum("ij,jk,ik->i", s, p, s))[:, None]
        return p - p @ s.T @ np.linalg.inv(s @ p @ s.T) @ s @ p

    def _put_right(self, error: np.ndarray) -> None:
        self.position = self.position + error[POSITION]
        self.velocity = self.velocity + error[VELOCITY]
        self.attitude = Rotation.from_rotvec(error[ATTITUDE]).as_matrix() @ self.attitude
        self.accel_bias = self.accel_bias + error[ACCEL_BIAS]
        self.gyro_bias = self.gyro_bias + error[GYRO_BIAS]
        if self.settings.g_sensitivity:
            self.g_sensitivity = self.g_sensitivity + error[G_SENSITIVITY].reshape(3, 3)
