"""What the walker is trained for: follow the command upright, like the reference, with quiet stance feet."""

from __future__ import annotations

import numpy as np

from footfall.models import body, gait
from footfall.simulate.walker.variability import WIDTH
from footfall.simulate.walker.walkers import Trace, Walkers

_KP = np.array([servo.kp for servo in body.SERVOS.values()])
_KV = np.array([servo.kv for servo in body.SERVOS.values()])
_LOW = np.array([servo.low for servo in body.SERVOS.values()])
_HIGH = np.array([servo.high for servo in body.SERVOS.values()])
_STRENGTH = np.maximum(-_LOW, _HIGH)
_POSE_WEIGHT = 1 - 0.5 * gait.mask("lumbar_yaw", "hip_rotation", "subtalar")
WEIGHTS = {
    "pose": 0.30,
    "mean_speed": 0.30,
    "speed": 0.08,
    "heading": 0.14,
    "upright": 0.08,
    "swing": 0.30,
    "still_foot": 0.20,
    "contact": 0.12,
    "load": 0.30,
    "heel": 0.08,
    "torque": -0.25,
    "power": -0.03,
    "jerk": -0.036,
    "action": -0.0135,
    "impact": -0.8,
    "foot_jolt": -0.2,
    "dawdle": -0.5,
    "restless": -1.0,
    "wide": -0.12,
}
# Joint angles to the elevation of the soles, right and left.
_SOLE = np.stack(
    [
        gait.mask(f"hip_flexion_{side}") - gait.mask(f"knee_{side}") + gait.mask(f"ankle_{side}")
        for side in "rl"
    ],
    1,
)
_BODY_WEIGHT = 740.0  # N
_LOADED = 0.2  # body weights
_RESTLESS_MOST = 4.0  # rad/s
_JOLT = (1.5, 1.0, 0.7)  # forward, aside, upward: people's heels are stopped less forward than upward

# Vertical ground force of one foot over its stride, in body weights, at about 1.3 m/s (rounded from normative
# data: Winter; Perry & Burnfield): two humps round a mid-stance dip.
_LOAD_PHASE = np.array([0, 2, 5, 8, 12, 15, 20, 25, 30, 35, 40, 45, 48, 52, 56, 60, 62, 97, 100]) / 100
_LOAD = np.array(
    [0.1, 0.3, 0.6, 0.86, 1.10, 1.11, 0.98, 0.85, 0.77, 0.77, 0.87, 1.03, 1.08, 1.00, 0.60, 0.15, 0, 0, 0.1]
)


def window(phase: np.ndarray, start: float, end: float, ramp: float = 0.03) -> np.ndarray:
    """1 inside (start, end) of the stride, 0 outside, with linear ramps."""
    return np.clip(np.minimum((phase - start) / ramp, (end - phase) / ramp) + 0.5, 0, 1)


def restless(walkers: Walkers, trace: Trace) -> np.ndarray:
    """(n,) rad/s by which loaded feet turn and tip while they should lie still.

    A foot that is to step rises with its heel, so only the one that the gait stands on counts as tipping;
    both do once the walker has decided to stand.
    """
    n, k = walkers.n, walkers.substeps
    rate = trace.sensor[:, :, body.SENSOR_FOOT_RATE].reshape(n, k, 2, 3)
    force = trace.sensor[:, :, body.SENSOR_TOUCH].reshape(n, k, 2, 3).sum(-1)
    turn = np.abs(rate[..., 2])
    sin, cos = walkers.sin[:, None, None], walkers.cos[:, None, None]
    tip = np.abs(cos * rate[..., 1] - sin * rate[..., 0])
    left, stands = walkers.left_stance, walkers.gate.closing
    stance = np.stack([stands | ~left, stands | left], axis=1)[:, None]
    moved = np.where(force > _LOADED * _BODY_WEIGHT, turn + tip * stance, 0.0).sum(-1).mean(1)
    return np.where(walkers.steady, np.minimum(moved, _RESTLESS_MOST), 0.0)


def reward_terms(
    walkers: Walkers, trace: Trace, action: np.ndarray, residual_change: np.ndarray
) -> dict[str, np.ndarray]:
    """Unweighted terms, (n,) each, of the control step that `trace` records."""
    n, k = walkers.n, walkers.substeps
    qpos, qvel = walkers.qpos, walkers.qvel
    reference = walkers.reference_now()
    joints = qpos[:, 7 + body.SERVO_JOINT]
    deviation = ((joints - reference) ** 2 * _POSE_WEIGHT).sum(1)
    along, _ = walkers.velocity()
    lag, astray = walkers.mean_velocity[:, 0] - walkers.speed, walkers.mean_velocity[:, 1]
    upright = np.einsum("ni,ni->n", walkers.rotation[:, :, 2], walkers.up)

    velocity = trace.sensor[:, :, body.SENSOR_FOOT_VELOCITY].reshape(n, k, 2, 3)
    rate = trace.sensor[:, :, body.SENSOR_FOOT_RATE].reshape(n, k, 2, 3)
    touch = trace.sensor[:, :, body.SENSOR_TOUCH].reshape(n, k, 2, 3)
    force = touch.mean(1).sum(-1)  # (n, 2)
    heel = touch.mean(1)[:, :, 0]
    speed2, rate2 = (velocity**2).sum(-1).mean(1), (rate**2).sum(-1).mean(1)
    phase = np.stack([walkers.phase, (walkers.phase + 0.5) % 1], 1)
    flat, loaded_heel = window(phase, 0.11, 0.42), window(phase, 0.05, 0.38)
    # Elevation of the soles; it should be that of the reference while a foot swings and lands.
    sole_error = (joints - reference) @ _SOLE - walkers.pitch[:, None]
    swing, stand = window(phase, 0.63, 0.97), window(phase, 0.02, 0.55)
    still = 1 / (1 + speed2 / 0.12**2 + rate2 / 0.6**2)
    gate = walkers.gate.value
    motionless = 0.4 / (1 + speed2 / 0.05**2 + rate2 / 0.3**2) + 0.6 / (
        1 + speed2 / 0.008**2 + rate2 / 0.04**2
    )

    def blend(walking: np.ndarray, standing: np.ndarray) -> np.ndarray:
        return gate * walking + (1 - gate) * standing

    wrong_contact = swing * np.minimum(force / 200, 1) + stand * (1 - np.minimum(force / 150, 1))

    wanted = np.interp(phase, _LOAD_PHASE, _LOAD)
    load_error = ((force / _BODY_WEIGHT - blend(wanted.T, np.full((2, n), 0.5)).T) ** 2).sum(1)
    angle = trace.qpos[:, :, 7 + body.SERVO_JOINT]
    angle_rate = trace.qvel[:, :, 6 + body.SERVO_JOINT]
    torque = np.clip(_KP * (trace.target - angle) - _KV * angle_rate, _LOW, _HIGH)
    jerked = np.diff(velocity, axis=1)
    forward = walkers.cos[:, None, None] * jerked[..., 0] + walkers.sin[:, None, None] * jerked[..., 1]
    aside = walkers.cos[:, None, None] * jerked[..., 1] - walkers.sin[:, None, None] * jerked[..., 0]
    jolts = np.stack([_JOLT[0] * forward, _JOLT[1] * aside, _JOLT[2] * jerked[..., 2]], -1)
    jolt = np.linalg.norm(jolts, axis=-1).max((1, 2)) / (walkers.dt / k)
    feet = walkers.sensor[:, body.SENSOR_FOOT_POSITION]
    dx, dy = feet[:, 3] - feet[:, 0], feet[:, 4] - feet[:, 1]
    separation = -walkers.sin * dx + walkers.cos * dy - 2 * walkers.variability.value[:, WIDTH]
    return {
        "pose": np.exp(-3 * deviation),
        "mean_speed": 0.6 * np.exp(-20 * lag**2 - 8 * astray**2) + 0.4 * np.exp(-2 * lag**2 - 2 * astray**2),
        "speed": np.exp(-3 * (along - walkers.speed) ** 2),
        "heading": np.exp(-12 * walkers.yaw_error**2),
        "upright": np.exp(-12 * (1 - upright) - 0.2 * (qvel[:, 3:6] ** 2).sum(1)),
        "swing": blend(np.exp(-14 * (window(phase, 0.66, 1.0) * sole_error**2).sum(1)), np.ones(n)),
        "still_foot": blend((flat * still).sum(1) / np.maximum(flat.sum(1), 0.2), 1.5 * motionless.mean(1)),
        "contact": blend(1 - np.clip(wrong_contact.sum(1), 0, 1), np.minimum(force / 200, 1).mean(1)),
        "load": np.exp(-4 * load_error),
        "heel": blend(
            (loaded_heel * np.minimum(heel / 120, 1)).sum(1) / np.maximum(loaded_heel.sum(1), 0.2),
            np.minimum(heel / 80, 1).mean(1),
        ),
        "torque": ((torque / _STRENGTH) ** 2).mean((1, 2)),
        "power": np.abs(torque * angle_rate).sum(2).mean(1) / 1000,
        "jerk": (residual_change**2).sum(1) * (1 + 3 * (1 - gate)),
        "action": (action**2).sum(1),
        "impact": np.clip(touch.sum(-1).max((1, 2)) / _BODY_WEIGHT - 1.2, 0, 1.5),
        "foot_jolt": np.clip(jolt / 50 - 1, 0, 2.5),
        # Wants to stop and still drifts.
        "dawdle": np.where((walkers.speed_goal < 0.2) & (gate > 0.01), np.abs(np.clip(lag, -0.3, 1)), 0.0),
        "restless": restless(walkers, trace),
        # Ankles more than 13 cm apart sideways, or less than 10.
        "wide": gate
        * (np.clip((separation - 0.13) / 0.05, 0, 2) + np.clip((0.10 - separation) / 0.05, 0, 2)),
    }


def total(terms: dict[str, np.ndarray]) -> np.ndarray:
    """Weighted sum (n,); 0 where a walker's state is not finite."""
    value = sum(weight * terms[name] for name, weight in WEIGHTS.items())
    return np.where(np.isfinite(value), value, 0.0)
