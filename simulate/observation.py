"""What the policy sees, always as a walker in right stance: left stance is mirrored."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from footfall.simulate._look_kernels import LIMIT as LIMIT
from footfall.simulate._look_kernels import observe_all
from footfall.simulate.feedback import JOINT_MIRROR, JOINT_SIGN, SERVO_MIRROR, SERVO_SIGN


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


MIRROR, SIGN = _mirror()
N_OBSERVATION = len(MIRROR)


def observe(state: np.ndarray) -> np.ndarray:
    """(n, N_OBSERVATION) float32 in [-LIMIT, LIMIT] of (n,) records of state.WALKER."""
    seen: np.ndarray = observe_all(state, MIRROR, SIGN)
    return seen
