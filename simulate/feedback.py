"""Balance feedback under the learned residual: foot placement and posture (SIMBICON and Raibert terms).

Everything is written for right stance; left stance is its mirror image. The gains are tuned by CMA-ES before
the policy is trained on top of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from footfall.models.body import JOINTS, N_SERVOS, SERVOS
from footfall.models.gait import INDEX


def _mirror(names: tuple[str, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Permutation and signs that mirror a per-joint vector."""
    swapped = [
        name[:-1] + {"r": "l", "l": "r"}[name[-1]] if name[-2:] in ("_r", "_l") else name for name in names
    ]
    signs = np.array([-1.0 if name in ("lumbar_roll", "lumbar_yaw") else 1.0 for name in names])
    return np.array([names.index(name) for name in swapped]), signs


SERVO_MIRROR, SERVO_SIGN = _mirror(tuple(SERVOS))
JOINT_MIRROR, JOINT_SIGN = _mirror(JOINTS)


def mirror_where(left_stance: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Mirror the rows (n, 17) of servo values of walkers in left stance."""
    return np.where(left_stance[:, None], values[:, SERVO_MIRROR] * SERVO_SIGN, values)


class Gains(NamedTuple):
    """Feedback gains, in rad (or rad per rad, per m, per m/s). `stance_`/`swing_` name the leg."""

    torso_pitch: float
    torso_pitch_rate: float
    torso_pitch_offset: float
    stance_hip_pitch: float
    stance_hip_pitch_rate: float
    stance_hip_offset: float
    stance_hip_roll: float
    stance_hip_roll_rate: float
    stance_adduction_offset: float
    stance_yaw: float
    stance_yaw_rate: float
    stance_knee_offset: float
    push_off: float
    push_off_speed: float
    ankle_speed: float
    subtalar_velocity: float
    subtalar_position: float
    torso_roll: float
    torso_roll_rate: float
    place_pitch: float
    place_speed: float
    place_mean_speed: float
    place_offset: float
    width_roll: float
    width_velocity: float
    width_position: float
    width_offset: float
    swing_yaw: float
    swing_knee: float
    width_mean_velocity: float
    swing_turn: float
    swing_toe_lift: float


# Hand-set start and search scale of each gain.
GAIN_START = Gains(
    0.4, 0.05, 0, 0.6, 0.08, 0, 0.5, 0.05, 0, 0.5, 0.08, 0, 0.1, 0.1, 0, 0.05, 0.1, 0.3, 0.05,
    0.6, 0.2, 0.1, 0.0, 0.6, 0.25, 0.3, -0.02, 0.3, 0.1, 0.1, 0.1, 0.03,
)  # fmt: skip
GAIN_SCALE = Gains(
    0.4, 0.05, 0.08, 0.5, 0.08, 0.08, 0.5, 0.08, 0.05, 0.4, 0.08, 0.08, 0.15, 0.2, 0.2, 0.15, 0.3, 0.3, 0.05,
    0.5, 0.2, 0.2, 0.1, 0.5, 0.2, 0.3, 0.05, 0.3, 0.15, 0.2, 0.15, 0.06,
)  # fmt: skip
_BRAKE = 0.2  # rad per m/s
FOOT_OFFSET = 0.075  # m from the stance foot to the pelvis, sideways, at which no correction is made


@dataclass(frozen=True)
class Balance:
    """What the feedback looks at, all (n,), in the heading frame and mirrored to right stance.

    pitch (nose down positive) and roll are relative to gravity, yaw_error to the commanded heading;
    `foot_y` is the pelvis relative to the stance foot (m); `step_phase` runs 0..1 over a step; `speed` is the
    commanded one.
    """

    pitch: np.ndarray
    roll: np.ndarray
    roll_rate: np.ndarray
    pitch_rate: np.ndarray
    yaw_rate: np.ndarray
    yaw_error: np.ndarray
    turn_rate: np.ndarray
    speed_error: np.ndarray
    mean_speed_error: np.ndarray
    lateral_velocity: np.ndarray
    mean_lateral_velocity: np.ndarray
    foot_y: np.ndarray
    step_phase: np.ndarray
    speed: np.ndarray


_LUMBAR_ROLL, _LUMBAR_PITCH = INDEX["lumbar_roll"], INDEX["lumbar_pitch"]
_STANCE = {
    joint: INDEX[f"{joint}_r"] for joint in ("hip_flexion", "hip_adduction", "hip_rotation", "knee", "ankle")
}
_SWING = {joint: INDEX[f"{joint}_l"] for joint in _STANCE}
_STANCE_SUBTALAR = INDEX["subtalar_r"]


def feedback(gains: np.ndarray, b: Balance) -> np.ndarray:
    """Offsets of the servo targets for right stance.

    Parameters
    ----------
    gains : (n, 32) or (32,)
    b : of n walkers

    Returns
    -------
    (n, 17) rad
    """
    g = Gains(*np.moveaxis(np.asarray(gains), -1, 0))
    swing = np.clip((b.step_phase - 0.2) / 0.15, 0, 1)  # after toe-off of the other foot
    late = np.clip((b.step_phase - 0.5) / 0.2, 0, 1)
    # Walking slowly, what drives the body on (push-off, lean, long steps) fades and the swing leg brakes.
    slow = np.clip(1 - b.speed / 0.8, 0, 1)
    going = 1 - slow
    out = np.zeros((len(b.pitch), N_SERVOS))
    out[:, _LUMBAR_ROLL] = -g.torso_roll * b.roll - g.torso_roll_rate * b.roll_rate
    out[:, _LUMBAR_PITCH] = (
        -g.torso_pitch * b.pitch - g.torso_pitch_rate * b.pitch_rate + g.torso_pitch_offset * going
    )
    out[:, _STANCE["hip_flexion"]] = (
        -g.stance_hip_pitch * b.pitch - g.stance_hip_pitch_rate * b.pitch_rate + g.stance_hip_offset * going
    )
    out[:, _STANCE["hip_adduction"]] = (
        g.stance_hip_roll * b.roll + g.stance_hip_roll_rate * b.roll_rate + g.stance_adduction_offset
    )
    out[:, _STANCE["hip_rotation"]] = g.stance_yaw * b.yaw_error + g.stance_yaw_rate * (
        b.yaw_rate - b.turn_rate
    )
    out[:, _STANCE["knee"]] = g.stance_knee_offset
    out[:, _STANCE["ankle"]] = (
        -late * g.push_off * going
        + late * g.push_off_speed * b.speed_error
        + g.ankle_speed * (1 - late) * b.speed_error
    )
    out[:, _STANCE_SUBTALAR] = g.subtalar_velocity * b.lateral_velocity + g.subtalar_position * (
        b.foot_y - FOOT_OFFSET
    )
    out[:, _SWING["hip_flexion"]] = swing * (
        g.place_pitch * b.pitch
        + g.place_speed * b.speed_error
        + g.place_mean_speed * b.mean_speed_error
        + g.place_offset * going
        + _BRAKE * slow * np.clip(b.speed_error, -0.2, 0.9)
    )
    out[:, _SWING["hip_adduction"]] = swing * (
        g.width_roll * b.roll
        - g.width_velocity * b.lateral_velocity
        - g.width_position * (b.foot_y - FOOT_OFFSET)
        + g.width_offset
        + g.width_mean_velocity * b.mean_lateral_velocity
    )
    out[:, _SWING["hip_rotation"]] = g.swing_yaw * b.yaw_error - g.swing_turn * b.turn_rate
    out[:, _SWING["knee"]] = g.swing_knee * np.sin(np.pi * b.step_phase)
    out[:, _SWING["ankle"]] = g.swing_toe_lift * swing
    return out
