"""What the policy sees, always as a walker in right stance: left stance is mirrored."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from footfall.models import body
from footfall.simulate.feedback import JOINT_MIRROR, JOINT_SIGN, SERVO_MIRROR, SERVO_SIGN

if TYPE_CHECKING:
    from footfall.simulate.walkers import Walkers

LIMIT = 6.0
_TOUCH_SCALE = 400.0  # N


def _mirror() -> tuple[np.ndarray, np.ndarray]:
    """Permutation and signs that turn an observation into that of the mirrored walker."""
    joints, joint_signs = JOINT_MIRROR.tolist(), JOINT_SIGN.tolist()
    blocks: list[tuple[Sequence[int], Sequence[float]]] = [
        ([0], [1]),  # height
        ([0, 1, 2], [1, -1, 1]),  # gravity in the body
        ([0, 1, 2], [1, -1, 1]),  # velocity
        ([0, 1, 2], [-1, 1, -1]),  # angular velocity
        (joints, joint_signs),  # angles
        (joints, joint_signs),  # rates
        ([3, 4, 5, 0, 1, 2], [1] * 6),  # touch
        ([0, 1], [1, 1]),  # step phase
        ([0, 1], [1, 1]),  # commanded speed and its change to come
        ([0, 1], [-1, -1]),  # heading error, turn rate
        ([0, 1], [1, -1]),  # mean velocity error
        (SERVO_MIRROR.tolist(), SERVO_SIGN.tolist()),  # residual
        ([0, 1], [1, -1]),  # grade forward, left
        ([0, 1, 2, 4, 3], [1] * 5),  # variability and habits
        ([0, 1], [1, 1]),  # gate
    ]
    permutation: list[int] = []
    signs: list[float] = []
    for order, sign in blocks:
        permutation += [len(signs) + i for i in order]
        signs += sign
    return np.array(permutation), np.array(signs, dtype=float)


_MIRROR, _SIGN = _mirror()
N_OBSERVATION = len(_MIRROR)


def observe(w: Walkers) -> np.ndarray:
    """(n, N_OBSERVATION) float32 in [-6, 6]."""
    q, v = w.qpos, w.qvel
    ahead = w.cos * v[:, 0] + w.sin * v[:, 1] - w.speed
    aside = -w.sin * v[:, 0] + w.cos * v[:, 1]
    step_angle = 2 * np.pi * ((w.phase * 2) % 1)
    columns = np.concatenate(
        [
            (w.height[:, None] - 0.98) * 5,
            w.up_body * 2,
            np.stack([ahead, aside, v[:, 2]], 1) * 1.5,
            v[:, 3:6] * 0.4,
            q[:, 7:] * 1.5,
            v[:, 6:] * 0.12,
            np.minimum(w.sensor[:, body.SENSOR_TOUCH] / _TOUCH_SCALE, 2.0),
            np.stack([np.sin(step_angle), np.cos(step_angle)], 1),
            np.stack([(w.speed - 1.2) * 3, w.speed_goal - w.speed], 1),
            np.stack([np.clip(w.yaw_error, -0.8, 0.8) * 2.5, w.turn * 2], 1),
            np.stack([w.mean_velocity[:, 0] - w.speed, w.mean_velocity[:, 1]], 1) * 3,
            w.residual * 2.4,
            np.stack([w.grade_forward, w.grade_left], 1) * 10,
            w.variability.value * [15, 10, 30, 8, 8],
            np.stack([(1 - w.gate.value) * 2, w.gate.closing], 1),
        ],
        axis=1,
    )
    columns = np.where(w.left_stance[:, None], columns[:, _MIRROR] * _SIGN, columns)
    return np.clip(columns, -LIMIT, LIMIT).astype(np.float32)
