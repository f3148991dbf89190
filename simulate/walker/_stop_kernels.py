"""Compiled: the last step before a stand, through which a loaded foot lies flat and does not turn.

Laws in terms of one walker `s` (see state.py), for all but steep slopes. Left alone, the ankle that brakes
pulls the foot that the last step is taken from on to its heel, and then the gait's curves raise that heel. So
the torques of a loaded foot are bounded (_foot_kernels), and the leg that this step is taken from takes the
stand's pose at once. A body that does not move forwards any more, or that is far behind its feet, needs its
heels: while it steps, only the twist is bounded then.
"""

from __future__ import annotations

import numpy as np
from numba.extending import register_jitable

from footfall.simulate.walker._elementwise import choose
from footfall.simulate.walker._foot_kernels import (
    ANKLE,
    LEFT,
    LEFT_JOINT,
    LEG,
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
# While it steps: a body that moves forwards (m/s), and whose capture point is not so far behind (m).
_MOVES, _FAR_BEHIND = 0.05, -0.115
# Lever arms (m) of the ankle's torque over the force on the foot, which hold its pressure about so far behind
# the ankle at most: in the step, late in it, and of the foot that is leaving.
_HEEL, _HEEL_LATE, _HEEL_LEAVING = 0.03, 0.01, 0.01
_LATE = 0.68
# In a stand: behind the ankle, and as much more as the capture point is farther behind the standing point;
# likewise before it, or a body that sways forwards could not be held. (The standing point is itself 4.6 cm
# before the ankles.)
_STANDING_HEEL, _BEHIND, _STANDING_TOES, _AHEAD = 0.01, -0.04, 0.095, 0.02
_ANY = 9.0  # m, no bound
POSE_SOONER, HOLD_SOONER = 12.0, 2.0  # how many times as fast that leg takes the stand's pose, and its hold


@register_jitable
def leg_gate(s, gate, j, sooner):  # type: ignore[no-untyped-def]
    """The gate of servo j: of the leg that the last step is taken from it closes so many times as fast.

    It jumps where a walker is told to walk on while it closes. No walk of a path does that.
    """
    right, left = (j >= RIGHT) & (j < RIGHT + LEG), (j >= LEFT) & (j < LEFT + LEG)
    steps = s.closing & s.stopping & choose(s.left_stance, right, left)
    return choose(steps, np.maximum(1 - sooner * (1 - gate), 0.0), gate)


@register_jitable
def hold_foot(s, ref, out, stance, load, servo, joint):  # type: ignore[no-untyped-def]
    """`bound` what acts on one foot of who comes to a stand; `servo`, `joint`: the first of its leg.

    `stance`: by the phase of the gait.
    """
    step, steps = (s.phase * 2) % 1, s.stopping & np.logical_not(s.closing)
    flat = stance & (load > LIFTED * s.weight) & (step > _FLAT)
    leaves = np.logical_not(stance) & (step < _LEAVING)
    stands = s.stopping & s.closing
    moves = (s.mean_velocity[0] > _MOVES) & (s.capture > _FAR_BEHIND)
    force = np.maximum(load, LIFTED * s.weight)
    heel = choose(leaves, _HEEL_LEAVING, choose(step > _LATE, _HEEL_LATE, _HEEL))
    heel = choose(stands, _STANDING_HEEL + np.maximum(_BEHIND - s.capture, 0.0), heel) * force
    toes = choose(stands, _STANDING_TOES + np.maximum(s.capture - _AHEAD, 0.0), _ANY) * force
    turn = (TURN + TURN_ON_SLOPES * grade(s)) * force
    held = steps & moves & (flat | leaves)
    bound(s, ref, out, held | stands, servo + ANKLE, joint + ANKLE, -toes, heel)
    lies = (steps & (flat | leaves)) | stands
    bound(s, ref, out, lies, servo + ROTATION, joint + ROTATION, -turn, turn)


@register_jitable
def hold_stopping(s, ref, out):  # type: ignore[no-untyped-def]
    """Bound the servo targets `out` (k, 17) of who comes to a stand, so that loaded feet lie flat."""
    right, left = loads(s)
    hold_foot(s, ref, out, np.logical_not(s.left_stance), right, RIGHT, RIGHT_JOINT)
    hold_foot(s, ref, out, s.left_stance, left, LEFT, LEFT_JOINT)
