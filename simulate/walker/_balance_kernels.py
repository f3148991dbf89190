"""Compiled: balance feedback under the learned residual, the standing controller, and when to stop and go.

Laws in terms of one walker `s` (see state.py); the face is walkers.py. Foot placement and posture are
SIMBICON's and Raibert's terms, written for right stance: left stance is its mirror image. A standing
controller (ankles and hips about the pose in which the feet stopped) is blended with the gait by a gate: 0
stands, 1 walks. Stopping waits for a step from which the body can be captured (its extrapolated centre of
mass stays over the feet); until then it steps on the spot, and creeps on where it would drift backwards. A
stand that loses its balance steps.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba.extending import register_jitable

from footfall.compiled import kernel
from footfall.models.body import HIP_HEIGHT, JOINTS, N_SERVOS, SENSOR_FOOT_POSITION
from footfall.models.gait import INDEX, mask
from footfall.simulate.walker._elementwise import choose, clip, turned
from footfall.simulate.walker._foot_kernels import STEEP, grade, loads
from footfall.simulate.walker._posture_kernels import over_ground
from footfall.simulate.walker._start_kernels import set_out, shifted
from footfall.simulate.walker._stop_kernels import HOLD_SOONER, leg_gate
from footfall.simulate.walker.feedback import SERVO_MIRROR, SERVO_SIGN
from footfall.simulate.walker.state import ACTION_SCALE, CREEP

FOOT_OFFSET = 0.075  # m from the stance foot to the pelvis, sideways, at which no correction is made
GO_SPEED = 0.2  # m/s; a commanded speed above it is a wish to walk
_RESIDUAL_LIMIT = 2.0  # of action scale, feedback included
_BRAKE = 0.2  # rad per m/s
# What a slope adds to the targets of slow steps, rad per rise over run, along the way and to the side of the
# swing leg: found by CMA-ES over stops of drawn people on 8 %, of which one in 20 else ends in a fall
# backwards.
_CLIMB_STANCE_HIP, _CLIMB_STANCE_KNEE, _CLIMB_STANCE_ANKLE = 0.60, 0.10, 0.20
_CLIMB_SWING_HIP, _CLIMB_SWING_KNEE, _CLIMB_TRUNK = 0.45, 0.10, 0.20
_ASLANT_STANCE_SIDE, _ASLANT_SWING_SIDE, _ASLANT_SUBTALAR = -0.15, -0.10, 0.15
_UPHILL_BEND = 0.3  # of the uphill leg's knee, stretch of the other's; without it three times as many fall
_STOP_SPEED = CREEP + 0.05
_GATE_DOWN_S, _GATE_UP_S, _FIRST_GATE_UP_S = 0.23, 0.35, 0.40
_PENDULUM_S = 0.31  # sqrt(height of the centre of mass / g)
_TRUNK_ARM = 0.18  # m by which the centre of mass moves per rad of trunk lean
# m, centre of mass before the middle of the feet's own, which are 5 cm before the ankles
_STANDING_POINT = -0.004
_PATIENCE_S = 1.5  # on the spot; after twice that time a stand may begin within the second of two bounds
_GENTLE = 0.03  # on steeper slopes such a stand tips more often
# m about the standing point: where the capture point may lie, and the share of it that may be behind, or the
# feet roll on to their heels
_FORWARD, _FORWARD_AT_LAST, _BACK_SHARE = 0.05, 0.07, 0.6
_SIDE_SHARE, _SIDE_AT_LAST = 0.25, 0.40  # of the feet's distance across
_NARROWEST = 0.13  # m, of that distance
_STAGGER, _STAGGER_AT_LAST = 0.11, 0.14  # m; a longer stand tips slowly, and its feet rock
_FASTEST = 0.25  # m/s; of the closings of a half-trained walker within all these bounds 86 % held, else 46 %
_LOADED = 100.0  # N
_ANKLE_X, _ANKLE_Y = -0.04, 0.09  # m from the pelvis to the ankles in standing, while there are no sensors

# Gains of the standing controller, rad per m, per m/s, per rad: found by CMA-ES over stops of drawn people on
# level ground and slopes, for feet that stay and are soon at rest. Sideways they must be soft: the hips move
# the pressure under the feet several times as far as the body, and a stiff hold rocks from foot to foot.
_ANKLE, _LEAD_S = 5.0, 0.5  # on where the body will be after that time, were it not held
_HIP, _HIP_RATE = 2.6, 0.085
_SIDE, _SIDE_RATE = 0.55, 0.36
_TRUNK_ROLL = 0.6
_UPHILL_KNEE, _HIGH_KNEE = 2.85, 5.5  # before and after the pelvis has rolled

# Servos: the right leg stands.
_LUMBAR_ROLL, _LUMBAR_PITCH = INDEX["lumbar_roll"], INDEX["lumbar_pitch"]
_STANCE_HIP, _SWING_HIP = INDEX["hip_flexion_r"], INDEX["hip_flexion_l"]
_STANCE_SIDE, _SWING_SIDE = INDEX["hip_adduction_r"], INDEX["hip_adduction_l"]
_STANCE_YAW, _SWING_YAW = INDEX["hip_rotation_r"], INDEX["hip_rotation_l"]
_STANCE_KNEE, _SWING_KNEE = INDEX["knee_r"], INDEX["knee_l"]
_STANCE_ANKLE, _SWING_ANKLE = INDEX["ankle_r"], INDEX["ankle_l"]
_STANCE_SUBTALAR = INDEX["subtalar_r"]

_ANKLE_R, _ANKLE_L = mask("ankle_r"), mask("ankle_l")
_HIPS, _TRUNK = mask("hip_flexion"), mask("lumbar_roll")
_SIDEWAYS = mask("hip_adduction_r") - mask("hip_adduction_l")
_BEND_R = mask("knee_r") + 0.5 * mask("hip_flexion_r") + 0.5 * mask("ankle_r")
_BEND_L = mask("knee_l") + 0.5 * mask("hip_flexion_l") + 0.5 * mask("ankle_l")

# Places in qpos, qvel and the sensors.
_HIP_R, _HIP_L = 7 + JOINTS.index("hip_flexion_r"), 7 + JOINTS.index("hip_flexion_l")
_SIDE_R, _SIDE_L = 7 + JOINTS.index("hip_adduction_r"), 7 + JOINTS.index("hip_adduction_l")
_TURN_R, _TURN_L = 7 + JOINTS.index("hip_rotation_r"), 7 + JOINTS.index("hip_rotation_l")
_ROLL, _PITCH = 7 + JOINTS.index("lumbar_roll"), 7 + JOINTS.index("lumbar_pitch")
_FOOT_R, _FOOT_L = SENSOR_FOOT_POSITION.start, SENSOR_FOOT_POSITION.start + 3


class Balance(NamedTuple):
    """What the feedback goes by, in the heading frame and mirrored to right stance.

    pitch (nose down positive) and roll are relative to gravity, yaw_error to the commanded heading;
    `foot_y` is the pelvis relative to the stance foot (m); places and velocities are along the ground.
    `step_phase` runs 0..1 over a step; `speed` is the commanded one. `climb` and `aslant` are the ground's
    rise over run forward and to the side of the swing leg.
    """

    pitch: Any
    roll: Any
    roll_rate: Any
    pitch_rate: Any
    yaw_rate: Any
    yaw_error: Any
    turn_rate: Any
    speed_error: Any
    mean_speed_error: Any
    lateral_velocity: Any
    mean_lateral_velocity: Any
    foot_y: Any
    step_phase: Any
    speed: Any
    climb: Any
    aslant: Any


class Stand(NamedTuple):
    """The body over its feet, in the heading frame, against gravity.

    `forward`, `left`: centre of mass from the standing point (m), and their velocities (m/s);
    `capture_forward`, `capture_left`: extrapolated centre of mass; `stagger`, `width`: distances of the feet
    along and across; `loaded`: both feet carry.
    """

    forward: Any
    left: Any
    forward_velocity: Any
    left_velocity: Any
    capture_forward: Any
    capture_left: Any
    trunk_roll: Any
    stagger: Any
    width: Any
    loaded: Any


@register_jitable
def balance_of(s):  # type: ignore[no-untyped-def]
    """The `Balance` of a walker."""
    side = choose(s.left_stance, -1.0, 1.0)
    foot_x = choose(s.left_stance, s.sensor[_FOOT_L], s.sensor[_FOOT_R])
    foot_y = choose(s.left_stance, s.sensor[_FOOT_L + 1], s.sensor[_FOOT_R + 1])
    foot_z = choose(s.left_stance, s.sensor[_FOOT_L + 2], s.sensor[_FOOT_R + 2])
    _, aside = turned(s, s.qpos[0] - foot_x, s.qpos[1] - foot_y)
    aside = aside + s.tilt_left * (s.qpos[2] - foot_z)
    along, across, _ = over_ground(s)
    return Balance(
        pitch=s.pitch,
        roll=s.roll * side,
        roll_rate=s.qvel[3] * side,
        pitch_rate=s.qvel[4],
        yaw_rate=s.qvel[5] * side,
        yaw_error=s.yaw_error * side,
        turn_rate=s.turn * side,
        speed_error=along - s.speed,
        mean_speed_error=s.mean_velocity[0] - s.speed,
        lateral_velocity=across * side,
        mean_lateral_velocity=s.mean_velocity[1] * side,
        foot_y=choose(s.fresh, FOOT_OFFSET, aside * side),
        step_phase=(s.phase * 2) % 1,
        speed=s.speed,
        climb=s.grade_forward,
        aslant=s.grade_left * side,
    )


@register_jitable
def feedback(g, b, out):  # type: ignore[no-untyped-def]
    """Fill `out` (17,) rad with the offsets of the servo targets for right stance.

    `g` has the fields of `feedback.Gains`; the law is affine in them.
    """
    swing = clip((b.step_phase - 0.2) / 0.15, 0.0, 1.0)  # after toe-off of the other foot
    late = clip((b.step_phase - 0.5) / 0.2, 0.0, 1.0)
    # Walking slowly, what drives the body on (push-off, lean, long steps) fades and the swing leg brakes.
    slow = clip(1 - b.speed / 0.8, 0.0, 1.0)
    going = 1 - slow
    climb, aslant = slow * b.climb, slow * b.aslant
    for j in range(N_SERVOS):
        out[j] = 0.0
    out[_LUMBAR_ROLL] = -g.torso_roll * b.roll - g.torso_roll_rate * b.roll_rate
    out[_LUMBAR_PITCH] = (
        -g.torso_pitch * b.pitch - g.torso_pitch_rate * b.pitch_rate + g.torso_pitch_offset * going
    )
    out[_STANCE_HIP] = (
        -g.stance_hip_pitch * b.pitch - g.stance_hip_pitch_rate * b.pitch_rate + g.stance_hip_offset * going
    )
    out[_STANCE_SIDE] = (
        g.stance_hip_roll * b.roll + g.stance_hip_roll_rate * b.roll_rate + g.stance_adduction_offset
    )
    out[_STANCE_YAW] = g.stance_yaw * b.yaw_error + g.stance_yaw_rate * (b.yaw_rate - b.turn_rate)
    out[_STANCE_KNEE] = g.stance_knee_offset
    out[_STANCE_ANKLE] = (
        -late * g.push_off * going
        + late * g.push_off_speed * b.speed_error
        + g.ankle_speed * (1 - late) * b.speed_error
    )
    out[_STANCE_SUBTALAR] = g.subtalar_velocity * b.lateral_velocity + g.subtalar_position * (
        b.foot_y - FOOT_OFFSET
    )
    out[_SWING_HIP] = swing * (
        g.place_pitch * b.pitch
        + g.place_speed * b.speed_error
        + g.place_mean_speed * b.mean_speed_error
        + g.place_offset * going
        + _BRAKE * slow * clip(b.speed_error, -0.2, 0.9)
    )
    out[_SWING_SIDE] = swing * (
        g.width_roll * b.roll
        - g.width_velocity * b.lateral_velocity
        - g.width_position * (b.foot_y - FOOT_OFFSET)
        + g.width_offset
        + g.width_mean_velocity * b.mean_lateral_velocity
    )
    out[_SWING_YAW] = g.swing_yaw * b.yaw_error - g.swing_turn * b.turn_rate
    out[_SWING_KNEE] = g.swing_knee * np.sin(np.pi * b.step_phase)
    out[_SWING_ANKLE] = g.swing_toe_lift * swing
    out[_STANCE_HIP] += _CLIMB_STANCE_HIP * climb
    out[_STANCE_KNEE] += _CLIMB_STANCE_KNEE * climb
    out[_STANCE_ANKLE] += _CLIMB_STANCE_ANKLE * climb
    out[_SWING_HIP] += _CLIMB_SWING_HIP * climb * swing
    out[_SWING_KNEE] += _CLIMB_SWING_KNEE * climb * swing
    out[_LUMBAR_PITCH] += _CLIMB_TRUNK * climb
    out[_STANCE_SIDE] += _ASLANT_STANCE_SIDE * aslant
    out[_SWING_SIDE] += _ASLANT_SWING_SIDE * aslant * swing
    out[_STANCE_SUBTALAR] += _ASLANT_SUBTALAR * aslant
    bend = _UPHILL_BEND * aslant
    out[_STANCE_KNEE] -= bend
    out[_STANCE_HIP] -= 0.5 * bend
    out[_STANCE_ANKLE] -= 0.5 * bend
    out[_SWING_KNEE] += bend * swing
    out[_SWING_HIP] += 0.5 * bend * swing


@register_jitable
def stand_of(s):  # type: ignore[no-untyped-def]
    """The `Stand` of a walker."""
    up_x, up_y = turned(s, s.up[0], s.up[1])
    rx, ry = turned(s, s.sensor[_FOOT_R] - s.qpos[0], s.sensor[_FOOT_R + 1] - s.qpos[1])
    lx, ly = turned(s, s.sensor[_FOOT_L] - s.qpos[0], s.sensor[_FOOT_L + 1] - s.qpos[1])
    rx = choose(s.fresh, _ANKLE_X - HIP_HEIGHT * up_x, rx)
    lx = choose(s.fresh, _ANKLE_X - HIP_HEIGHT * up_x, lx)
    ry = choose(s.fresh, -_ANKLE_Y - HIP_HEIGHT * up_y, ry)
    ly = choose(s.fresh, _ANKLE_Y - HIP_HEIGHT * up_y, ly)
    lean, trunk_roll = s.pitch + s.qpos[_PITCH], s.roll + s.qpos[_ROLL]
    forward = -(rx + lx) / 2 - HIP_HEIGHT * up_x + _TRUNK_ARM * lean - _STANDING_POINT
    left = -(ry + ly) / 2 - HIP_HEIGHT * up_y - _TRUNK_ARM * trunk_roll
    along, across = turned(s, s.qvel[0], s.qvel[1])
    along = along + _TRUNK_ARM * (s.qvel[4] + s.qvel[_PITCH - 1])
    force_r, force_l = loads(s)
    return Stand(
        forward=forward,
        left=left,
        forward_velocity=along,
        left_velocity=across,
        capture_forward=forward + _PENDULUM_S * along,
        capture_left=left + _PENDULUM_S * across,
        trunk_roll=trunk_roll,
        stagger=np.abs(rx - lx),
        width=np.abs(ry - ly),
        loaded=(force_r > _LOADED) & (force_l > _LOADED),
    )


@register_jitable
def standing_offset(s, stand, j):  # type: ignore[no-untyped-def]
    """Offset (rad) of servo j's target that holds a stand."""
    # From the place alone the ankles would push on a body that is on its way to rest. Each acts as far as its
    # foot is loaded: an unloaded one that pushed would lift its heel and tip the pelvis.
    ankle = -_ANKLE * (stand.forward + _LEAD_S * stand.forward_velocity)
    load_r = 2 * clip(0.5 - stand.left / np.maximum(stand.width, 0.1), 0.0, 1.0)
    hip = -_HIP * s.pitch - _HIP_RATE * s.qvel[4]
    side = _SIDE * stand.left + _SIDE_RATE * stand.left_velocity
    out = ankle * (load_r * _ANKLE_R[j] + (2 - load_r) * _ANKLE_L[j]) + hip * _HIPS[j]
    out = out + side * _SIDEWAYS[j] - _TRUNK_ROLL * stand.trunk_roll * _TRUNK[j]
    # Across a slope the uphill knee bends, and wherever the pelvis has rolled the knee of its high side.
    right = np.maximum(-_UPHILL_KNEE * s.grade_left, 0.0) + np.maximum(-_HIGH_KNEE * s.roll, 0.0)
    left = np.maximum(_UPHILL_KNEE * s.grade_left, 0.0) + np.maximum(_HIGH_KNEE * s.roll, 0.0)
    return out + right * _BEND_R[j] + left * _BEND_L[j] + shifted(s, j)


@register_jitable
def decide(s, stand, step_phase):  # type: ignore[no-untyped-def]
    """Decide to stop or to go; a walker that stops keeps its feet where they are."""
    off_balance = (np.abs(stand.capture_forward - 0.005) > 0.115 + 0.3 * stand.stagger) | (
        np.abs(stand.capture_left) > stand.width / 2 + 0.035
    )
    s.capture = choose(s.fresh, 0.0, stand.capture_forward)
    begins = set_out(s, s.speed_goal > GO_SPEED, step_phase)
    stumbles = s.closing & (s.gate < 0.3) & off_balance & np.logical_not(s.setting_out)
    go = begins | stumbles
    slope = grade(s)
    # Stepping on the spot is less sure than a stand: whoever does it for long may stand less well.
    late = choose(slope < _GENTLE, clip((s.waiting - _PATIENCE_S) / _PATIENCE_S, 0.0, 1.0), 0.0)
    forward = _FORWARD + late * (_FORWARD_AT_LAST - _FORWARD)
    share = _SIDE_SHARE + late * (_SIDE_AT_LAST - _SIDE_SHARE)
    stagger = choose(slope > STEEP, _STAGGER_AT_LAST, _STAGGER + late * (_STAGGER_AT_LAST - _STAGGER))
    capturable = (
        (stand.capture_forward < forward)
        & (stand.capture_forward > -_BACK_SHARE * forward)
        & (stand.forward_velocity < _FASTEST)
        & (np.abs(stand.capture_left) < share * stand.width)
        & (stand.width > _NARROWEST)
        & (stand.stagger < stagger)
        & stand.loaded
    )
    stop = (s.speed < _STOP_SPEED) & (step_phase < 0.35) & capturable & np.logical_not(go)
    new = stop & np.logical_not(s.closing)
    s.closing = (s.closing | stop) & np.logical_not(go)
    stagger = clip((s.qpos[_HIP_R] - s.qpos[_HIP_L]) / 2, -0.19, 0.19)
    spread = clip((s.qpos[_SIDE_R] + s.qpos[_SIDE_L]) / 2, -0.12, 0.02)
    s.stagger, s.spread = choose(new, stagger, s.stagger), choose(new, spread, s.spread)
    s.out_right = choose(new, -s.qpos[_TURN_R], s.out_right)
    s.out_left = choose(new, -s.qpos[_TURN_L], s.out_left)
    nearly = (s.speed_goal <= GO_SPEED) & (s.speed < _STOP_SPEED)
    s.waiting = choose(nearly & np.logical_not(s.closing), s.waiting + s.dt, 0.0)
    s.stopping = nearly & np.logical_not(s.setting_out | (slope > STEEP))


@register_jitable
def open_gate(s):  # type: ignore[no-untyped-def]
    """Open or close the gate over this control step."""
    s.gate_before = s.gate
    opening = 1.0 / choose(s.setting_out, _FIRST_GATE_UP_S, _GATE_UP_S)
    s.gate = clip(s.gate + s.dt * choose(s.closing, -1.0 / _GATE_DOWN_S, opening), 0.0, 1.0)


@register_jitable
def act(s, g, action):  # type: ignore[no-untyped-def]
    """Decide, and correct the gait by feedback and `action` (17,), mirrored as the observation was."""
    balance, stand = balance_of(s), stand_of(s)
    decide(s, stand, balance.step_phase)
    open_gate(s)
    feedback(g, balance, s.feedback)
    for j in range(N_SERVOS):
        m = SERVO_MIRROR[j]
        here = clip(action[j], -1.0, 1.0) + s.feedback[j] / ACTION_SCALE[j]
        there = clip(action[m], -1.0, 1.0) + s.feedback[m] / ACTION_SCALE[m]
        gate = leg_gate(s, s.gate_before, j, HOLD_SOONER)
        walking = gate * choose(s.left_stance, SERVO_SIGN[j] * there, here)
        standing = (1 - gate) * standing_offset(s, stand, j) / ACTION_SCALE[j]
        s.next_residual[j] = clip(walking + standing, -_RESIDUAL_LIMIT, _RESIDUAL_LIMIT)


@kernel(nogil=True)
def act_all(state, gains, action):  # type: ignore[no-untyped-def]
    """`act` of every walker; one row of gains serves all."""
    for i in range(len(state)):
        act(state[i], gains[i % len(gains)], action[i])
