"""Compiled: the first step, through which a loaded foot lies still.

Laws in terms of one walker `s` (see state.py). People take half a second to shift their weight before the
first foot leaves the ground. Until that foot lands, the torques of a loaded foot's ankle and hip rotation are
bounded (_foot_kernels). After a stop the feet stand one before the other and apart; from there a shift of the
weight falls more often than the gait's own step, so the body is only let fall forwards, and the ankle of the
foot that steps is free; on steep slopes nothing is bounded.
"""

from __future__ import annotations

import numpy as np
from numba.extending import register_jitable

from footfall.models.gait import mask
from footfall.simulate.walker._elementwise import choose
from footfall.simulate.walker._foot_kernels import (
    ANKLE,
    LEFT,
    LEFT_JOINT,
    LIFTED,
    RIGHT,
    RIGHT_JOINT,
    ROTATION,
    STEEP,
    SUBTALAR,
    TURN,
    TURN_ON_SLOPES,
    bound,
    grade,
    loads,
)

# The shift: hips that push sideways and ankles that let the body fall forwards (rad), within `_SHIFT_S`. The
# first step begins as soon as the foot that is to make it carries no more than `_UNLOADED` body weights.
_SIDEWAYS, _FORWARDS = 0.10, 0.15
_SHIFT_S, _LONGEST_S, _SHORTEST_S = 0.40, 0.50, 0.1
_UNLOADED = 0.25
_LEAN_S = 0.36  # after a stop
_LANDED, _LATEST = 0.05, 0.3  # body weights on it, or so far into the next step, end the first one
# Lever arms (m) of a loaded foot's torques over the force on it: its centre of pressure stays so far
# before the ankle and so near its middle line.
_BACK, _FRONT, _ASIDE = 0.005, 0.10, 0.02
_FRONT_AFTER_A_STOP, _ASIDE_AFTER_A_STOP = 0.12, 0.04

_PUSH_ASIDE = mask("hip_adduction_r") - mask("hip_adduction_l")
_LET_FALL = mask("ankle")


@register_jitable
def as_placed(s):  # type: ignore[no-untyped-def]
    """The feet are side by side, where they were set down before the walk: it has not stopped yet."""
    return (s.stagger == 0.0) & (s.spread == 0.0)


@register_jitable
def set_out(s, wish, step_phase):  # type: ignore[no-untyped-def]
    """Shift the weight of a standing walker that is to walk; True once the first step may begin."""
    begins = s.closing & (s.gate <= 0) & wish
    s.left_stands = choose(begins, s.left_stance, s.left_stands)
    right, left = loads(s)
    stepping = choose(s.left_stands, right, left)
    landed = (s.left_stance != s.left_stands) & ((stepping > _LANDED * s.weight) | (step_phase > _LATEST))
    s.setting_out = begins | (s.setting_out & np.logical_not(s.closing | landed))
    s.shift = choose(begins, s.shift + s.dt, choose(s.setting_out, s.shift, 0.0))
    unloaded = (s.shift > _SHORTEST_S) & (stepping < _UNLOADED * s.weight)
    ready = choose(as_placed(s), unloaded | (s.shift > _LONGEST_S), s.shift > _LEAN_S)
    return wish & (ready | np.logical_not(begins))


@register_jitable
def shifted(s, j):  # type: ignore[no-untyped-def]
    """Offset (rad) of servo j's target in standing that shifts the weight."""
    aside = choose(as_placed(s), choose(s.left_stands, -_SIDEWAYS, _SIDEWAYS), 0.0)
    return np.minimum(s.shift / _SHIFT_S, 1.0) * (aside * _PUSH_ASIDE[j] + _FORWARDS * _LET_FALL[j])


@register_jitable
def hold_foot(s, ref, out, stands, load, servo, joint):  # type: ignore[no-untyped-def]
    """`bound` what acts on one foot of who sets out; `servo`, `joint`: the first of its leg.

    `stands`: through the first step.
    """
    loaded, placed, slope = load > LIFTED * s.weight, as_placed(s), grade(s)
    bounded = s.setting_out & (placed | (slope <= STEEP))
    held = bounded & (stands | (loaded & placed))
    lies = bounded & (stands | loaded)
    force = np.maximum(load, LIFTED * s.weight)
    turn = (TURN + choose(placed, 0.0, TURN_ON_SLOPES * slope)) * force
    aside = choose(placed, _ASIDE, _ASIDE_AFTER_A_STOP) * force
    front = choose(placed, _FRONT, _FRONT_AFTER_A_STOP) * force
    bound(s, ref, out, held, servo + ANKLE, joint + ANKLE, -front, -_BACK * force)
    bound(s, ref, out, held, servo + SUBTALAR, joint + SUBTALAR, -aside, aside)
    bound(s, ref, out, lies, servo + ROTATION, joint + ROTATION, -turn, turn)


@register_jitable
def hold_setting_out(s, ref, out):  # type: ignore[no-untyped-def]
    """Bound the servo targets `out` (k, 17) of who sets out, so that loaded feet lie still."""
    right, left = loads(s)
    hold_foot(s, ref, out, np.logical_not(s.left_stands), right, RIGHT, RIGHT_JOINT)
    hold_foot(s, ref, out, s.left_stands, left, LEFT, LEFT_JOINT)
