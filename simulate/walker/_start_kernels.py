"""Compiled: the first and the last step, through which a loaded foot lies still.

Laws in terms of one walker `s` (see state.py). People take half a second to shift their weight before the
first foot leaves the ground. Until that foot lands, the torques of a loaded foot's ankle and hip rotation are
kept within what leaves the pressure under the sole, and the sole where it is: the gait, made for mid-walk,
would else rock the foot on to its heel and twist it. After a stop the feet stand one before the other and
apart; from there a shift of the weight falls more often than the gait's own step, so the body is only let
fall forwards, and the ankle of the foot that steps is free; on steep slopes nothing is bounded. While
stopping only the twist is bounded: the ankle brakes.
"""

from __future__ import annotations

import numpy as np
from numba.extending import register_jitable

from footfall.models.body import JOINTS, SENSOR_TOUCH
from footfall.models.gait import INDEX, mask
from footfall.simulate.walker._elementwise import choose, clip

# The shift: hips that push sideways and ankles that let the body fall forwards (rad), within `_SHIFT_S`. The
# first step begins as soon as the foot that is to make it carries no more than `_UNLOADED` body weights.
_SIDEWAYS, _FORWARDS = 0.10, 0.15
_SHIFT_S, _LONGEST_S, _SHORTEST_S = 0.40, 0.50, 0.1
_UNLOADED = 0.25
_LEAN_S = 0.36  # after a stop
# Of a step: from then on the foot that it stands on lies flat; until then the other one may come to stay.
_FLAT, _LEAVING = 0.15, 0.25
_LIFTED = 0.2  # body weights; a foot that carries less may do what a swinging foot does
_LANDED, _LATEST = 0.05, 0.3  # body weights on it, or so far into the next step, end the first one
# Lever arms (m) of a loaded foot's torques over the force on it: its centre of pressure stays so far
# before the ankle and so near its middle line, and what turns it is a sixth of what friction can hold.
_BACK, _FRONT = 0.005, 0.10
_BACK_AFTER_A_STOP, _FRONT_AFTER_A_STOP, _ASIDE_AFTER_A_STOP = 0.005, 0.12, 0.04
# On steeper slopes nothing is held once the walker has stopped: of 640 stops of brisk walkers across 8 % 9
# else end in a fall, most of them when they set out again, and 1 without.
STEEP = 0.065
# A slope asks for more, or twice as many would fall when they stop across one of 8 %.
_TURN_ON_SLOPES = 0.12
_ASIDE, _TURN = 0.02, 0.01

_PUSH_ASIDE = mask("hip_adduction_r") - mask("hip_adduction_l")
_LET_FALL = mask("ankle")
_TOUCH_R, _TOUCH_L = SENSOR_TOUCH.start, SENSOR_TOUCH.start + 3
# The servos of a leg are in a row, and so are its joints.
_RIGHT, _LEFT = INDEX["hip_flexion_r"], INDEX["hip_flexion_l"]
_RIGHT_JOINT, _LEFT_JOINT = JOINTS.index("hip_flexion_r"), JOINTS.index("hip_flexion_l")
_ROTATION, _ANKLE, _SUBTALAR = (INDEX[f"{name}_r"] - _RIGHT for name in ("hip_rotation", "ankle", "subtalar"))


@register_jitable
def as_placed(s):  # type: ignore[no-untyped-def]
    """The feet are side by side, where they were set down before the walk: it has not stopped yet."""
    return (s.stagger == 0.0) & (s.spread == 0.0)


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
def set_out(s, wish, step_phase):  # type: ignore[no-untyped-def]
    """Shift the weight of a standing walker that is to walk; True once the first step may begin."""
    begins = s.closing & (s.gate <= 0) & wish
    s.left_first = choose(begins, s.left_stance, s.left_first)
    right, left = loads(s)
    stepping = choose(s.left_first, right, left)
    landed = (s.left_stance != s.left_first) & ((stepping > _LANDED * s.weight) | (step_phase > _LATEST))
    s.setting_out = begins | (s.setting_out & np.logical_not(s.closing | landed))
    s.shift = choose(begins, s.shift + s.dt, choose(s.setting_out, s.shift, 0.0))
    unloaded = (s.shift > _SHORTEST_S) & (stepping < _UNLOADED * s.weight)
    ready = choose(as_placed(s), unloaded | (s.shift > _LONGEST_S), s.shift > _LEAN_S)
    return wish & (ready | np.logical_not(begins))


@register_jitable
def shifted(s, j):  # type: ignore[no-untyped-def]
    """Offset (rad) of servo j's target in standing that shifts the weight."""
    aside = choose(as_placed(s), choose(s.left_first, -_SIDEWAYS, _SIDEWAYS), 0.0)
    return np.minimum(s.shift / _SHIFT_S, 1.0) * (aside * _PUSH_ASIDE[j] + _FORWARDS * _LET_FALL[j])


@register_jitable
def bound(s, ref, out, held, servo, joint, low, high):  # type: ignore[no-untyped-def]
    """Clip a servo's targets in `out` (k, 17) so that its torque on a held foot is `low` to `high` (Nm)."""
    count, rate = len(out), s.qvel[6 + joint]
    least, most = (low + ref.kv[servo] * rate) / ref.kp[servo], (high + ref.kv[servo] * rate) / ref.kp[servo]
    for i in range(count):
        angle = s.qpos[7 + joint] + rate * s.dt * ((i + 1) / count)
        out[i, servo] = choose(held, clip(out[i, servo], angle + least, angle + most), out[i, servo])


@register_jitable
def bound_foot(s, ref, out, stands, stance, load, servo, joint):  # type: ignore[no-untyped-def]
    """`bound` what acts on one foot; `servo`, `joint`: the first of its leg.

    `stands`: through the first step; `stance`: by the phase of the gait.
    """
    loaded, placed, step = load > _LIFTED * s.weight, as_placed(s), (s.phase * 2) % 1
    slope = grade(s)
    bounded = s.setting_out & (placed | (slope <= STEEP))
    held = bounded & (stands | (loaded & placed))
    # A foot that the last step unloads must not turn either.
    rests = s.closing | choose(stance, loaded & (step > _FLAT), step < _LEAVING)
    lies = (bounded & (stands | loaded)) | (s.stopping & rests)
    force = np.maximum(load, _LIFTED * s.weight)
    first = s.setting_out & placed
    turn = (_TURN + choose(first, 0.0, _TURN_ON_SLOPES * slope)) * force
    aside = choose(first, _ASIDE, _ASIDE_AFTER_A_STOP) * force
    front = choose(first, _FRONT, _FRONT_AFTER_A_STOP) * force
    back = choose(first, _BACK, _BACK_AFTER_A_STOP) * force
    bound(s, ref, out, held, servo + _ANKLE, joint + _ANKLE, -front, -back)
    bound(s, ref, out, held, servo + _SUBTALAR, joint + _SUBTALAR, -aside, aside)
    bound(s, ref, out, lies, servo + _ROTATION, joint + _ROTATION, -turn, turn)


@register_jitable
def hold_feet(s, ref, out):  # type: ignore[no-untyped-def]
    """Bound the servo targets `out` (k, 17) while setting out or stopping, so that loaded feet lie still."""
    right, left = loads(s)
    stands, stance = np.logical_not(s.left_first), np.logical_not(s.left_stance)
    bound_foot(s, ref, out, stands, stance, right, _RIGHT, _RIGHT_JOINT)
    bound_foot(s, ref, out, s.left_first, s.left_stance, left, _LEFT, _LEFT_JOINT)
