"""Gains of the balance feedback under the learned residual, and the mirror image of servos and joints.

The feedback itself is `_balance_kernels.feedback`. The gains are tuned by CMA-ES before the policy is trained
on top of them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from footfall.models.body import JOINTS, SERVOS


def _mirror(names: tuple[str, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Permutation and signs that mirror a per-joint vector."""
    swapped = [
        name[:-1] + {"r": "l", "l": "r"}[name[-1]] if name[-2:] in ("_r", "_l") else name for name in names
    ]
    signs = np.array([-1.0 if name in ("lumbar_roll", "lumbar_yaw") else 1.0 for name in names])
    return np.array([names.index(name) for name in swapped]), signs


SERVO_MIRROR, SERVO_SIGN = _mirror(tuple(SERVOS))
JOINT_MIRROR, JOINT_SIGN = _mirror(JOINTS)


class Gains(NamedTuple):
    """Feedback gains, in rad (or rad per rad, per m, per m/s). `stance_`/`swing_` name the leg."""

    torso_pitch: float
    torso_pitch_rate: float
    torso_pitch_offset: float
    stance_hip_pitch: float
    stance_hip_pitch_rate: float
    stance_hip_offset: float
    stance_hip_roll: float
    stance_hip_roll_rate: float
    stance_adduction_offset: float
    stance_yaw: float
    stance_yaw_rate: float
    stance_knee_offset: float
    push_off: float
    push_off_speed: float
    ankle_speed: float
    subtalar_velocity: float
    subtalar_position: float
    torso_roll: float
    torso_roll_rate: float
    place_pitch: float
    place_speed: float
    place_mean_speed: float
    place_offset: float
    width_roll: float
    width_velocity: float
    width_position: float
    width_offset: float
    swing_yaw: float
    swing_knee: float
    width_mean_velocity: float
    swing_turn: float
    swing_toe_lift: float


# Where the search begins (found by such a search for a slightly brisker reference gait) and the scale of each
# gain.
GAIN_START = Gains(
    -0.299, 0.078, 0.367, 0.395, 0.082, -0.012, -0.159, 0.447, -0.076, -0.21, 0.171, 0.16, -0.023, -0.142,
    -0.305, -0.021, -0.172, -0.415, 0.103, 1.77, -0.828, 0.551, 0.259, 1.142, 0.36, 0.482, 0.051, 0.188,
    -0.098, -0.101, -0.069, 0.164,
)  # fmt: skip
GAIN_SCALE = Gains(
    0.4, 0.05, 0.08, 0.5, 0.08, 0.08, 0.5, 0.08, 0.05, 0.4, 0.08, 0.08, 0.15, 0.2, 0.2, 0.15, 0.3, 0.3, 0.05,
    0.5, 0.2, 0.2, 0.1, 0.5, 0.2, 0.3, 0.05, 0.3, 0.15, 0.2, 0.15, 0.06,
)  # fmt: skip

GAIN_SHAPE = (len(Gains._fields),)
_RECORD = np.dtype([(name, float) for name in Gains._fields])


def gain_records(gains: np.ndarray) -> np.ndarray:
    """(n, 32) or (32,) -> (n,) or (1,) records whose fields are those of `Gains`."""
    return np.ascontiguousarray(np.atleast_2d(gains), dtype=float).view(_RECORD)[:, 0]
