"""Compiled: the ground under a walker's feet, the forces on them, and bounds on the torques that act on one.

Laws in terms of one walker `s` (see state.py). A torque on a loaded foot that is kept within lever arms
times the force on it leaves the pressure under the sole and the sole where it is; the more so, the more
steadily the joint turns and the force acts over a control step. The gait is made for
mid-walk: it would rock the foot on to its heel or toes and twist it when a walk begins or ends.
"""

from __future__ import annotations

import numpy as np
from numba.extending import register_jitable

from footfall.models.body import JOINTS, SENSOR_TOUCH
from footfall.models.gait import INDEX
from footfall.simulate.walker._elementwise import choose, clip

# Rise over run; on steeper slopes no foot of who stops is held. Of 640 stops of brisk walkers across 8 % 9
# else end in a fall, most of them when they set out again, and 1 without.
STEEP = 0.065
LIFTED = 0.2  # body weights; a foot that carries less may do what a swinging foot does
# Lever arm (m) of what turns a loaded foot: a sixth of what friction can hold. Once the walker slows down or
# has stopped, a slope asks for more.
TURN, TURN_ON_SLOPES = 0.01, 0.12

_TOUCH_R, _TOUCH_L = SENSOR_TOUCH.start, SENSOR_TOUCH.start + 3
# The servos of a leg are in a row, and so are its joints.
RIGHT, LEFT = INDEX["hip_flexion_r"], INDEX["hip_flexion_l"]
LEG = LEFT - RIGHT
RIGHT_JOINT, LEFT_JOINT = JOINTS.index("hip_flexion_r"), JOINTS.index("hip_flexion_l")
ROTATION, ANKLE, SUBTALAR = (INDEX[f"{name}_r"] - RIGHT for name in ("hip_rotation", "ankle", "subtalar"))


@register_jitable
def grade(s):  # type: ignore[no-untyped-def]
    """Rise over run of the ground, along its steepest line."""
    return np.sqrt(s.grade_forward * s.grade_forward + s.grade_left * s.grade_left)


@register_jitable
def loads(s):  # type: ignore[no-untyped-def]
    """Force on the right and the left foot (N)."""
    right = s.sensor[_TOUCH_R] + s.sensor[_TOUCH_R + 1] + s.sensor[_TOUCH_R + 2]
    left = s.sensor[_TOUCH_L] + s.sensor[_TOUCH_L + 1] + s.sensor[_TOUCH_L + 2]
    return right, left


@register_jitable
def bound(s, ref, out, held, servo, joint, low, high):  # type: ignore[no-untyped-def]
    """Clip a servo's targets in `out` (k, 17) so that its torque on a held foot is `low` to `high` (Nm).

    So it is if the joint keeps the rate that it has at the start of the control step.
    """
    count, rate = len(out), s.qvel[6 + joint]
    least, most = (low + ref.kv[servo] * rate) / ref.kp[servo], (high + ref.kv[servo] * rate) / ref.kp[servo]
    for i in range(count):
        angle = s.qpos[7 + joint] + rate * s.dt * ((i + 1) / count)
        out[i, servo] = choose(held, clip(out[i, servo], angle + least, angle + most), out[i, servo])
