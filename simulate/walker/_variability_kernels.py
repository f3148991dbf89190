"""Compiled: what is drawn for a step that begins. The law in terms of one walker `s` (see state.py)."""

from __future__ import annotations

import math

import numpy as np
from numba.extending import register_jitable

from footfall.compiled import kernel
from footfall.simulate.walker._elementwise import choose, clip
from footfall.simulate.walker.state import (
    AMPLITUDE,
    BEND,
    CADENCE,
    OF_CADENCE,
    OF_PLACEMENT,
    OF_TOE_OUT,
    TOE_OUT_LEFT,
    TOE_OUT_RIGHT,
    TWIST,
    WIDTH,
)

CADENCE_SD, CADENCE_SLOW_SD, CADENCE_SLOW_RHO = 0.0247, 0.0126, 0.9
AMPLITUDE_SD, BEND_SD = 0.0215, 0.0540
WIDTH_SD, WIDTH_RHO = 0.0045, 0.5
TOE_OUT_SD = math.radians(1.0)
TWIST_SD, MOST_TWIST = math.radians(11.5), 0.4  # gyros of real shoes: 16 to 29 deg/s (SD) of yaw
USUAL_SPEED, SLOWEST, SLOW_POWER = 1.3, 1.0, 1.4  # slow strides scatter more (Beauchet et al. 2009)
STAND_SPEED, CALM = 0.2, 0.3
_SLOW_GAIN = CADENCE_SLOW_SD * math.sqrt(1 - CADENCE_SLOW_RHO**2)


@register_jitable
def draw(s, normal):  # type: ignore[no-untyped-def]
    """New goals of the walker's variability from seven standard normal numbers."""
    mean, goal = s.varied_mean, s.varied_goal
    # Who is about to stand steps with care; only the width scatters on, until the feet are far enough apart.
    calm = choose(s.speed_goal < STAND_SPEED, CALM, 1.0)
    placement, pace, angle = s.level[OF_PLACEMENT], calm * s.level[OF_CADENCE], calm * s.level[OF_TOE_OUT]
    swing = calm * placement * (USUAL_SPEED / np.maximum(s.speed, SLOWEST)) ** SLOW_POWER
    # 0 while the right foot stands (the left one swings), 1 otherwise
    left = np.floor(s.next_phase * 2) % 2 == 1
    s.slow = CADENCE_SLOW_RHO * s.slow + normal[0] * _SLOW_GAIN * pace
    cadence = clip(s.slow + normal[1] * CADENCE_SD * pace, -0.09, 0.09)
    # Asymmetry: the step on the right foot is quicker by as much as the one on the left is slower.
    goal[CADENCE] = mean[CADENCE] + cadence + choose(left, -s.asymmetry, s.asymmetry)
    goal[AMPLITUDE] = clip(normal[2] * AMPLITUDE_SD * swing, -0.1, 0.1)
    width = WIDTH_RHO * (goal[WIDTH] - mean[WIDTH]) + normal[3] * WIDTH_SD * placement
    goal[WIDTH] = mean[WIDTH] + clip(width, -0.03, 0.03)
    # The leg about to swing gets a new toe-out and keeps it through its next stance.
    toe_out = clip(normal[4] * TOE_OUT_SD * angle, -0.15, 0.15)
    goal[TOE_OUT_RIGHT] = choose(left, mean[TOE_OUT_RIGHT] + toe_out, goal[TOE_OUT_RIGHT])
    goal[TOE_OUT_LEFT] = choose(left, goal[TOE_OUT_LEFT], mean[TOE_OUT_LEFT] + toe_out)
    goal[BEND] = clip(normal[6] * BEND_SD * swing, -0.15, 0.15)
    goal[TWIST] = clip(normal[5] * TWIST_SD * angle, -MOST_TWIST, MOST_TWIST)


@kernel(nogil=True)
def draw_all(state, rows, normal):  # type: ignore[no-untyped-def]
    """`draw` for the walkers `rows` (m,) from `normal` (m, 7)."""
    for i in range(len(rows)):
        draw(state[rows[i]], normal[i])
