"""Compiled: how the phase runs, how variability slews, and the servo targets of a control step.

Laws in terms of one walker `s` (see state.py); the face is walkers.py. What the gait is made of comes as an
argument (`REFERENCE`), not as constants, so that compiled code in numba's cache never holds an earlier one.
"""

from __future__ import annotations

import numpy as np
from numba.extending import register_jitable

from footfall.compiled import kernel
from footfall.models import gait
from footfall.models.body import SERVOS
from footfall.simulate.walker._elementwise import choose
from footfall.simulate.walker._start_kernels import as_placed, hold_setting_out
from footfall.simulate.walker._stop_kernels import POSE_SOONER, hold_stopping, leg_gate
from footfall.simulate.walker.state import (
    ACTION_SCALE,
    AMPLITUDE,
    BEND,
    CADENCE,
    TOE_OUT_LEFT,
    TOE_OUT_RIGHT,
    TWIST,
    WIDTH,
)

_LEG_LENGTH = 0.9  # m, turns a step width into an adduction
_WIDER = 0.03  # m by which each leg is set wider while stopping
_SLEW_S = 0.12
# Of the stride after a heel strike: where the phase of a stand rests, before the walk and after a stop.
FROZEN, FROZEN_AFTER_A_STOP = 0.12, 0.06


# The reference gait: a table (phases, 17) rad, and per servo (17,) what scales, shifts and leans it.
_PARTS = {
    "table": gait.TABLE,
    "twist": gait.TWIST,
    "sinking": gait.SINKING,
    "swings": gait.SWINGS,
    "bends": gait.BENDS,
    "adduction": gait.mask("hip_adduction"),
    "toe_out_right": gait.mask("hip_rotation_r"),
    "toe_out_left": gait.mask("hip_rotation_l"),
    "standing": gait.STANDING,
    "stagger": gait.STAGGER,
    "spread": gait.SPREAD,
    "ankles": gait.mask("ankle"),
    "subtalar": gait.mask("subtalar_r") - gait.mask("subtalar_l"),
    "scale": ACTION_SCALE,
    "kp": np.array([servo.kp for servo in SERVOS.values()]),
    "kv": np.array([servo.kv for servo in SERVOS.values()]),
}
REFERENCE = np.zeros(1, [(name, float, part.shape) for name, part in _PARTS.items()])  # one record
for _name, _part in _PARTS.items():
    REFERENCE[_name] = _part


@register_jitable
def stride(s):  # type: ignore[no-untyped-def]
    """How far the phase runs in this control step; it freezes in standing."""
    opening = choose(s.gate > 0, np.maximum(s.gate, 0.5), 0.0)
    pace = choose(s.closing, s.gate * s.gate, opening)
    s.advance = gait.stride_frequency(s.speed) * (1 + s.varied[CADENCE]) * pace * s.dt
    resting = np.floor(s.phase * 2) / 2 + choose(as_placed(s), FROZEN, FROZEN_AFTER_A_STOP)
    s.next_phase = choose(s.closing & (s.gate <= 0), resting, s.phase + s.advance)


@register_jitable
def slew(s):  # type: ignore[no-untyped-def]
    """Move the variability towards its goals; a walker about to stop widens its steps."""
    braking = (s.speed_goal < 0.2) & (s.speed < 0.6) & np.logical_not(s.closing)
    # Narrow steps are no habit to stop with: the feet would never be far enough apart to stand.
    widen = choose(braking, _WIDER - np.minimum(s.varied_mean[WIDTH], 0.0), 0.0)
    for i in range(len(s.varied)):
        goal = s.varied_goal[i] + (widen if i == WIDTH else 0.0)
        s.varied[i] += (goal - s.varied[i]) * (s.dt / _SLEW_S)


@register_jitable
def amplitudes(s):  # type: ignore[no-untyped-def]
    """Excursions of the hips and of the knees, relative to those of the table."""
    hip = gait.hip_amplitude(s.speed) * (1 + s.varied[AMPLITUDE])
    return hip, gait.knee_amplitude(s.speed) * (1 + s.varied[BEND])


@register_jitable
def servo(s, ref, j, hip, knee, stagger):  # type: ignore[no-untyped-def]
    """Of servo j: factor on the table, offset in walking, angle in standing, and slope (rad)."""
    factor = 1 + ref.swings[j] * (hip - 1) + ref.bends[j] * (knee - 1)
    # The legs' rotation axes are mirrored: outwards is negative.
    toe_out = ref.toe_out_right[j] * s.varied[TOE_OUT_RIGHT] + ref.toe_out_left[j] * s.varied[TOE_OUT_LEFT]
    offset = -ref.adduction[j] * (s.varied[WIDTH] / _LEG_LENGTH) - toe_out
    turned_out = ref.toe_out_right[j] * s.out_right + ref.toe_out_left[j] * s.out_left
    standing = ref.standing[j] + stagger * s.stagger * ref.stagger[j] + s.spread * ref.spread[j] - turned_out
    return factor, offset, standing, s.grade_forward * ref.ankles[j] + s.grade_left * ref.subtalar[j]


@register_jitable
def extra(s, ref, row, j, steady):  # type: ignore[no-untyped-def]
    """What a servo's angle has beside the table's (rad): the swinging foot's turn, the pelvis's sinking."""
    return ref.twist[row, j] * s.varied[TWIST] + ref.sinking[row, j] * steady


@register_jitable
def row_at(ref, phase):  # type: ignore[no-untyped-def]
    """Row of the table."""
    count = len(ref.table)
    return np.intp((phase % 1) * count) % count


@register_jitable
def targets(s, ref, rows, out):  # type: ignore[no-untyped-def]
    """Fill `out` (k, 17) rad with the servo targets of the k physics steps; `rows` (k,) is working space."""
    count = len(out)
    resting = s.closing & (s.gate <= 0)
    for i in range(count):
        rows[i] = row_at(ref, choose(resting, s.next_phase, s.phase + s.advance * ((i + 1) / count)))
    hip, knee = amplitudes(s)
    steady = gait.steadiness(s.speed, s.turn)
    for j in range(len(ref.scale)):
        factor, offset, standing, slope = servo(s, ref, j, hip, knee, 1.0)
        for i in range(count):
            part = (i + 1) / count
            gate = leg_gate(s, s.gate_before + (s.gate - s.gate_before) * part, j, POSE_SOONER)
            walking = ref.table[rows[i], j] * factor + offset + extra(s, ref, rows[i], j, steady)
            residual = (1 - part) * s.residual[j] + part * s.next_residual[j]
            out[i, j] = gate * walking + (1 - gate) * standing + slope + ref.scale[j] * residual
    hold_setting_out(s, ref, out)
    hold_stopping(s, ref, out)


@register_jitable
def reference(s, ref, stagger, out):  # type: ignore[no-untyped-def]
    """Fill `out` (17,) rad with the reference angles of this moment."""
    row = row_at(ref, s.phase)
    hip, knee = amplitudes(s)
    steady = gait.steadiness(s.speed, s.turn)
    for j in range(len(ref.scale)):
        factor, offset, standing, slope = servo(s, ref, j, hip, knee, stagger)
        walking = ref.table[row, j] * factor + offset + extra(s, ref, row, j, steady)
        out[j] = s.gate * walking + (1 - s.gate) * standing + slope


# What a kernel fills is passed to it: an array that it returned would cost more than the kernel.


@kernel(nogil=True)
def stride_all(state, rows):  # type: ignore[no-untyped-def]
    """`stride` of every walker; how many begin a step, and in `rows` (n,) which ones."""
    count = 0
    for i in range(len(state)):
        stride(state[i])
        if np.floor(state[i].next_phase * 2) != np.floor(state[i].phase * 2):
            rows[count] = i
            count += 1
    return count


@kernel(nogil=True)
def targets_all(state, ref, start, out):  # type: ignore[no-untyped-def]
    """`slew`, then `targets` of every walker into `out` (n, k, 17).

    Fills `start` (n, 1 + nq + nv) with the states that the physics begins with: time 0, qpos, qvel.
    """
    rows = np.empty(out.shape[1], np.intp)
    for i in range(len(state)):
        s = state[i]
        slew(s)
        targets(s, ref[0], rows, out[i])
        nq = len(s.qpos)
        start[i, 0] = 0.0
        for j in range(nq):
            start[i, 1 + j] = s.qpos[j]
        for j in range(len(s.qvel)):
            start[i, 1 + nq + j] = s.qvel[j]


@kernel(nogil=True)
def reference_all(state, ref, stagger):  # type: ignore[no-untyped-def]
    """`reference` (n, 17) of every walker."""
    out = np.empty((len(state), len(ref[0].scale)))
    for i in range(len(state)):
        reference(state[i], ref[0], stagger, out[i])
    return out
