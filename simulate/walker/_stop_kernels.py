"""Compiled: the last step before a stand, through which a loaded foot does not turn.

Laws in terms of one walker `s` (see state.py), for all but steep slopes. The ankle is free: it brakes.
"""

from __future__ import annotations

import numpy as np
from numba.extending import register_jitable

from footfall.simulate.walker._foot_kernels import (
    LEFT,
    LEFT_JOINT,
    LIFTED,
    RIGHT,
    RIGHT_JOINT,
    ROTATION,
    TURN,
    TURN_ON_SLOPES,
    bound,
    grade,
    loads,
)

# Of a step: from then on the foot that it stands on lies flat; until then the other one may come to stay.
_FLAT, _LEAVING = 0.15, 0.25


@register_jitable
def hold_foot(s, ref, out, stance, load, servo, joint):  # type: ignore[no-untyped-def]
    """`bound` what acts on one foot of who comes to a stand; `servo`, `joint`: the first of its leg.

    `stance`: by the phase of the gait.
    """
    step, steps = (s.phase * 2) % 1, s.stopping & np.logical_not(s.closing)
    flat = stance & (load > LIFTED * s.weight) & (step > _FLAT)
    leaves = np.logical_not(stance) & (step < _LEAVING)
    stands = s.stopping & s.closing
    force = np.maximum(load, LIFTED * s.weight)
    turn = (TURN + TURN_ON_SLOPES * grade(s)) * force
    lies = (steps & (flat | leaves)) | stands
    bound(s, ref, out, lies, servo + ROTATION, joint + ROTATION, -turn, turn)


@register_jitable
def hold_stopping(s, ref, out):  # type: ignore[no-untyped-def]
    """Bound the servo targets `out` (k, 17) of who comes to a stand, so that loaded feet do not turn."""
    right, left = loads(s)
    hold_foot(s, ref, out, np.logical_not(s.left_stance), right, RIGHT, RIGHT_JOINT)
    hold_foot(s, ref, out, s.left_stance, left, LEFT, LEFT_JOINT)
