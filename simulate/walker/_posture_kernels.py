"""Compiled: how the body stands after the physics, how commands slew, and what the policy sees.

Laws in terms of one walker `s` (see state.py); the faces are walkers.py and observation.py.
"""

from __future__ import annotations

import numpy as np
from numba.extending import register_jitable

from footfall.compiled import kernel
from footfall.models import body
from footfall.simulate.walker._elementwise import choose, clip, turned
from footfall.simulate.walker.state import CREEP

# m/s2, of the commanded speed upwards; share of it downwards, and until the first step has landed.
SPEED_SLEW, SLOWING_SHARE, SETTING_OUT_SHARE = 0.8, 0.9, 0.6
TURN_SLEW = 2.0  # rad/s2
LIMIT = 6.0  # of an observation
_DOWN, _TOPPLED, _LOST_HEADING = 0.75, 0.75, 1.1  # m, cosine, rad: a body beyond these has fallen
_MEAN_VELOCITY_S = 0.5
_AGAINST_DRIFT = 2.0
_TOUCH_SCALE = 400.0  # N
_N_JOINTS, _N_SERVOS = body.N_JOINTS, body.N_SERVOS
_N_QPOS, _N_QVEL = 7 + _N_JOINTS, 6 + _N_JOINTS
_TOUCH, _N_TOUCH = body.SENSOR_TOUCH.start, 6


@register_jitable
def posture(s):  # type: ignore[no-untyped-def]
    """Derive what observation, feedback and reward share."""
    w, x, y, z = s.qpos[3], s.qpos[4], s.qpos[5], s.qpos[6]
    norm = np.maximum(np.sqrt(w * w + x * x + y * y + z * z), 1e-9)
    w, x, y, z = w / norm, x / norm, y / norm, z / norm
    r = s.rotation
    r[0, 0], r[0, 1], r[0, 2] = 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)
    r[1, 0], r[1, 1], r[1, 2] = 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)
    r[2, 0], r[2, 1], r[2, 2] = 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)
    s.yaw = np.arctan2(r[1, 0], r[0, 0])
    s.cos, s.sin = np.cos(s.yaw), np.sin(s.yaw)
    for i in range(3):
        s.up_body[i] = r[0, i] * s.up[0] + r[1, i] * s.up[1] + r[2, i] * s.up[2]
    s.pitch = -np.arcsin(clip(s.up_body[0], -1.0, 1.0))
    s.roll = np.arctan2(s.up_body[1], s.up_body[2])
    s.yaw_error = (s.yaw - s.heading + np.pi) % (2 * np.pi) - np.pi
    s.height = s.qpos[2] - s.ground
    s.grade_forward, s.grade_left = turned(s, s.gradient[0], s.gradient[1])
    # Training tilts gravity over level ground, walks tilt the ground: both must be the same to the laws.
    s.tilt_forward, s.tilt_left = turned(s, s.gradient[0] - s.up[0], s.gradient[1] - s.up[1])
    s.left_stance = np.floor(s.phase * 2) % 2 == 1
    finite = np.isfinite(s.height)
    for j in range(_N_QPOS):
        finite = finite & np.isfinite(s.qpos[j])
    for j in range(_N_QVEL):
        finite = finite & np.isfinite(s.qvel[j])
    upright = r[0, 2] * s.up[0] + r[1, 2] * s.up[1] + r[2, 2] * s.up[2]
    astray = np.abs(s.yaw_error) > _LOST_HEADING
    s.fallen = (s.height < _DOWN) | (upright < _TOPPLED) | astray | np.logical_not(finite)


@register_jitable
def over_ground(s):  # type: ignore[no-untyped-def]
    """Pelvis velocity forward, left and off the ground, along which the first two are (m/s)."""
    along, aside = turned(s, s.qvel[0], s.qvel[1])
    upward = s.qvel[2] - s.tilt_forward * along - s.tilt_left * aside
    return along + s.tilt_forward * s.qvel[2], aside + s.tilt_left * s.qvel[2], upward


@register_jitable
def along_heading(s):  # type: ignore[no-untyped-def]
    """Pelvis velocity along and across the commanded heading (m/s)."""
    cos, sin = np.cos(s.heading), np.sin(s.heading)
    return cos * s.qvel[0] + sin * s.qvel[1], -sin * s.qvel[0] + cos * s.qvel[1]


@register_jitable
def wanted(s):  # type: ignore[no-untyped-def]
    """Speed to reach (m/s): as commanded, but a walker that is to stand and drifts backwards creeps on."""
    creep = clip(-_AGAINST_DRIFT * s.mean_velocity[0], 0.0, CREEP)
    return choose(s.closing, s.speed_goal, np.maximum(s.speed_goal, creep))


@register_jitable
def settle(s):  # type: ignore[no-untyped-def]
    """End a control step: phase, residual and commands move on."""
    s.phase = s.next_phase % 1
    for j in range(_N_SERVOS):
        s.residual[j] = s.next_residual[j]
    s.fresh = False
    s.heading += s.turn * s.dt
    slew = SPEED_SLEW * s.dt
    faster = choose(s.gate > 0.3, choose(s.setting_out, SETTING_OUT_SHARE, 1.0) * slew, 0.0)
    change = clip(wanted(s) - s.speed, -SLOWING_SHARE * slew, faster)
    s.speed += change
    turn = s.turn + clip(s.turn_goal - s.turn, -TURN_SLEW * s.dt, TURN_SLEW * s.dt)
    s.turn = choose(s.gate < 0.5, 0.0, turn)
    along, across = along_heading(s)
    # The mean moves with the command. Else a walker that follows a falling one would seem too fast, and be
    # braked until it walks backwards.
    s.mean_velocity[0] += change + (along - s.mean_velocity[0]) * (s.dt / _MEAN_VELOCITY_S)
    s.mean_velocity[1] += (across - s.mean_velocity[1]) * (s.dt / _MEAN_VELOCITY_S)


@register_jitable
def observe(s, mirror, sign, own, seen):  # type: ignore[no-untyped-def]
    """Fill `own` (N_OBSERVATION,) as it is, and `seen` with it mirrored to right stance.

    The order is that of `observation.LAYOUT`.
    """
    along, aside, upward = over_ground(s)
    step_angle = 2 * np.pi * ((s.phase * 2) % 1)
    own[0] = (s.height - 0.98) * 5
    for i in range(3):
        own[1 + i] = s.up_body[i] * 2
        own[7 + i] = s.qvel[3 + i] * 0.4
    own[4], own[5], own[6] = (along - s.speed) * 1.5, aside * 1.5, upward * 1.5
    at = 10
    for i in range(_N_JOINTS):
        own[at + i] = s.qpos[7 + i] * 1.5
        own[at + _N_JOINTS + i] = s.qvel[6 + i] * 0.12
    at += 2 * _N_JOINTS
    for i in range(_N_TOUCH):
        own[at + i] = np.minimum(s.sensor[_TOUCH + i] / _TOUCH_SCALE, 2.0)
    at += _N_TOUCH
    own[at], own[at + 1] = np.sin(step_angle), np.cos(step_angle)
    own[at + 2], own[at + 3] = (s.speed - 1.2) * 3, wanted(s) - s.speed
    own[at + 4], own[at + 5] = clip(s.yaw_error, -0.8, 0.8) * 2.5, s.turn * 2
    own[at + 6], own[at + 7] = (s.mean_velocity[0] - s.speed) * 3, s.mean_velocity[1] * 3
    at += 8
    for i in range(_N_SERVOS):
        own[at + i] = s.residual[i] * 2.4
    at += _N_SERVOS
    own[at], own[at + 1] = s.grade_forward * 10, s.grade_left * 10
    own[at + 2], own[at + 3], own[at + 4] = s.varied[0] * 15, s.varied[1] * 10, s.varied[2] * 30
    own[at + 5], own[at + 6] = s.varied[3] * 8, s.varied[4] * 8
    own[at + 7], own[at + 8] = (1 - s.gate) * 2, choose(s.closing, 1.0, 0.0)
    for i in range(len(mirror)):
        value = choose(s.left_stance, sign[i] * own[mirror[i]], own[i])
        seen[i] = clip(value, -LIMIT, LIMIT)


@kernel(nogil=True)
def posture_all(state):  # type: ignore[no-untyped-def]
    """`posture` of every walker."""
    for i in range(len(state)):
        posture(state[i])


@kernel(nogil=True)
def land_all(state, after, sensor):  # type: ignore[no-untyped-def]
    """Take over the last of the physics states (n, k, 1 + nq + nv) and sensors; `settle` and `posture`."""
    for i in range(len(state)):
        s = state[i]
        for j in range(_N_QPOS):
            s.qpos[j] = after[i, -1, 1 + j]
        for j in range(_N_QVEL):
            s.qvel[j] = after[i, -1, 1 + _N_QPOS + j]
        for j in range(len(s.sensor)):
            s.sensor[j] = sensor[i, -1, j]
        settle(s)
        posture(s)


@kernel(nogil=True)
def observe_all(state, mirror, sign, seen):  # type: ignore[no-untyped-def]
    """Fill `seen` (n, N_OBSERVATION)."""
    own = np.empty(len(mirror))
    for i in range(len(state)):
        observe(state[i], mirror, sign, own, seen[i])
