"""What the policy sees, always as a walker in right stance: left stance is mirrored."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from footfall.simulate.walker._posture_kernels import LIMIT as LIMIT
from footfall.simulate.walker._posture_kernels import observe_all
from footfall.simulate.walker.feedback import JOINT_MIRROR, JOINT_SIGN, SERVO_MIRROR, SERVO_SIGN

_JOINTS, _JOINT_SIGNS = JOINT_MIRROR.tolist(), JOINT_SIGN.tolist()
# Block by block: which of its numbers stands in each place for the mirrored walker, and with which sign.
_BLOCKS: dict[str, tuple[Sequence[int], Sequence[float]]] = {
    "height": ([0], [1]),
    "gravity": ([0, 1, 2], [1, -1, 1]),
    "velocity": ([0, 1, 2], [1, -1, 1]),
    "angular_velocity": ([0, 1, 2], [-1, 1, -1]),
    "joint_angles": (_JOINTS, _JOINT_SIGNS),
    "joint_rates": (_JOINTS, _JOINT_SIGNS),
    "touch": ([3, 4, 5, 0, 1, 2], [1] * 6),
    "step_phase": ([0, 1], [1, 1]),
    "speed_command": ([0, 1], [1, 1]),
    "heading_command": ([0, 1], [-1, -1]),
    "mean_velocity_error": ([0, 1], [1, -1]),
    "residual": (SERVO_MIRROR.tolist(), SERVO_SIGN.tolist()),
    "grade": ([0, 1], [1, -1]),
    "variability": ([0, 1, 2, 4, 3], [1] * 5),
    "gate": ([0, 1], [1, 1]),
}


def _layout() -> dict[str, slice]:
    ends = np.cumsum([len(order) for order, _ in _BLOCKS.values()]).tolist()
    return dict(zip(_BLOCKS, map(slice, [0, *ends[:-1]], ends), strict=True))


LAYOUT = _layout()  # name of a block -> its place in an observation
# The permutation and the signs that turn an observation into that of the mirrored walker.
MIRROR = np.concatenate([LAYOUT[name].start + np.array(order) for name, (order, _) in _BLOCKS.items()])
SIGN = np.concatenate([np.array(signs, dtype=float) for _, signs in _BLOCKS.values()])
N_OBSERVATION = len(MIRROR)


def observe(state: np.ndarray) -> np.ndarray:
    """(n, N_OBSERVATION) float32 in [-LIMIT, LIMIT] of (n,) records of state.WALKER."""
    seen = np.empty((len(state), N_OBSERVATION), np.float32)
    observe_all(state, MIRROR, SIGN, seen)
    return seen
