"""N walkers side by side: their state and the control step (33 a second) over the physics.

The reference gait (models.gait) plus balance feedback plus a learned residual sets the targets of the joint
servos, which are interpolated over the physics steps. No other input acts on a body. Everything is in the
units of the 1.75 m body (models.subject).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from mujoco import rollout

from footfall.conventions import wrap
from footfall.models import body, gait
from footfall.models.subject import Habits
from footfall.simulate.feedback import FOOT_OFFSET, Balance, feedback, mirror_where
from footfall.simulate.heights import gait_heights, standing_height
from footfall.simulate.observation import observe
from footfall.simulate.standing import Gate, Stand, stand_of, standing_feedback
from footfall.simulate.variability import AMPLITUDE, CADENCE, TOE_OUT, WIDTH, Variability

CONTROL_INTERVAL = 0.030  # s, nominal: the physics step times `substeps`
SPEED_SLEW = 0.8  # m/s2, of the commanded speed
TURN_SLEW = 2.0  # rad/s2
_MEAN_VELOCITY_S = 0.5

# Residual (rad) for an action of 1.
ACTION_SCALE = 3.3 * np.array([0.2, 0.2, 0.2] + [0.35, 0.25, 0.25, 0.35, 0.25, 0.15] * 2 + [0.2, 0.2])
N_ACTION = body.N_SERVOS
_RESIDUAL_LIMIT = 2.0  # of action scale, feedback included

_ADDUCTION = gait.mask("hip_adduction")
_ANKLES = gait.mask("ankle")
_SUBTALAR = np.zeros(body.N_SERVOS)
_SUBTALAR[[gait.INDEX["subtalar_r"], gait.INDEX["subtalar_l"]]] = 1.0, -1.0
_TOE_OUT_SERVOS = np.array([gait.INDEX["hip_rotation_r"], gait.INDEX["hip_rotation_l"]])
_LEG_LENGTH = 0.9  # m, turns a step width into an adduction
_WIDER = 0.03  # m by which each leg is set wider while stopping
_HIP_R, _HIP_L = (7 + body.JOINTS.index(f"hip_flexion_{side}") for side in "rl")
_SIDE_R, _SIDE_L = (7 + body.JOINTS.index(f"hip_adduction_{side}") for side in "rl")
_LUMBAR = [7 + body.JOINTS.index(name) for name in ("lumbar_roll", "lumbar_pitch")]

Ground = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


def rotation(quaternion: np.ndarray) -> np.ndarray:
    """(n, 4) scalar first -> (n, 3, 3) body to world."""
    w, x, y, z = quaternion.T
    out = np.empty((len(quaternion), 3, 3))
    out[:, 0, 0], out[:, 0, 1], out[:, 0, 2] = (
        1 - 2 * (y * y + z * z),
        2 * (x * y - w * z),
        2 * (x * z + w * y),
    )
    out[:, 1, 0], out[:, 1, 1], out[:, 1, 2] = (
        2 * (x * y + w * z),
        1 - 2 * (x * x + z * z),
        2 * (y * z - w * x),
    )
    out[:, 2, 0], out[:, 2, 1], out[:, 2, 2] = (
        2 * (x * z - w * y),
        2 * (y * z + w * x),
        1 - 2 * (x * x + y * y),
    )
    return out


@dataclass(frozen=True)
class Trace:
    """Every physics step of one control step: states after and sensors before each step, and the targets."""

    qpos: np.ndarray  # (n, k, 26)
    qvel: np.ndarray  # (n, k, 25)
    sensor: np.ndarray  # (n, k, n_sensor)
    target: np.ndarray  # (n, k, 17)


class Walkers:
    """State of n walkers and the control step that moves them.

    Parameters
    ----------
    models : one per walker; they may differ in build, gravity and timestep, not in layout
    gains : (n, 32) or (32,) feedback gains
    rng : of the gait's variability
    ground : (x, y) -> height (n,) and gradient (n, 2); level when None
    threads : for the physics; 0 = the calling thread
    """

    def __init__(
        self,
        models: Sequence[mujoco.MjModel],
        gains: np.ndarray,
        *,
        rng: np.random.Generator,
        ground: Ground | None = None,
        threads: int = 0,
    ) -> None:
        n = len(models)
        self.n, self.models, self.gains, self.rng, self.ground = n, list(models), gains, rng, ground
        timesteps = np.array([model.opt.timestep for model in models])
        self.substeps = max(1, round(CONTROL_INTERVAL / timesteps.mean()))
        self.dt = self.substeps * timesteps
        if np.abs(self.dt / CONTROL_INTERVAL - 1).max() > 0.1:
            raise ValueError(
                f"{self.substeps} physics steps of {timesteps.max():.4g} s are no control interval of "
                f"{CONTROL_INTERVAL} s (10 % off at the most)"
            )
        self._data = [mujoco.MjData(models[0]) for _ in range(max(1, threads))]
        self._rollout = rollout.Rollout(nthread=threads)
        self._gait_height = np.array([gait_heights(model) for model in _distinct(models)])
        self._standing_height = np.array([standing_height(model) for model in models])

        def zeros(*shape: int) -> np.ndarray:
            return np.zeros((n, *shape))

        self.variability, self.gate = Variability(n), Gate(n)
        self.qpos, self.qvel = zeros(models[0].nq), zeros(models[0].nv)
        self.sensor = zeros(models[0].nsensordata)
        self.up = np.tile([0.0, 0.0, 1.0], (n, 1))  # against gravity, in the frame of qpos
        self.phase = zeros()
        self.heading = zeros()  # commanded
        self.speed, self.speed_goal = zeros(), zeros()
        self.turn, self.turn_goal = zeros(), zeros()
        self.residual = zeros(N_ACTION)
        self.mean_velocity = zeros(2)  # along and across the commanded heading
        self.stagger, self.spread = zeros(), zeros()  # rad, pose of the standing feet
        self.fresh = np.ones(n, dtype=bool)  # no physics yet, so no sensors
        self._look()

    def close(self) -> None:
        """Stop the physics threads."""
        self._rollout.close()

    def place(
        self,
        mask: np.ndarray,
        *,
        phase: np.ndarray,
        speed: np.ndarray,
        heading: np.ndarray,
        position: np.ndarray,
        standing: np.ndarray,
        variability: np.ndarray,
        habits: list[Habits],
        joint_noise: np.ndarray | float = 0.0,
        velocity_noise: np.ndarray | float = 0.0,
    ) -> None:
        """Put the walkers in `mask` (m of them) into mid-gait or a stand (all arguments (m, ...))."""
        m = int(mask.sum())
        speed = np.where(standing, 0.0, speed)
        epsilon, gate = 0.002, np.where(standing, 0.0, 1.0)[:, None]
        walking = gait.reference_angles(phase, speed)
        rate = gait.reference_angles((phase + epsilon) % 1, speed)
        rate = (rate - gait.reference_angles((phase - epsilon) % 1, speed)) / (2 * epsilon)
        rate *= gate * gait.stride_frequency(speed)[:, None]
        # Upright against gravity on sloping ground: yaw, then a small tilt.
        cos, sin = np.cos(heading), np.sin(heading)
        up = self.up[mask]
        forward, left = cos * up[:, 0] + sin * up[:, 1], -sin * up[:, 0] + cos * up[:, 1]
        tilt = np.stack([np.ones(m), -left / 2, forward / 2, left * forward / 4], 1)
        tilt /= np.linalg.norm(tilt, axis=1)[:, None]
        a, b = np.cos(heading / 2), np.sin(heading / 2)

        qpos, qvel = np.zeros((m, self.qpos.shape[1])), np.zeros((m, self.qvel.shape[1]))
        qpos[:, :3] = position
        row = (phase * self._gait_height.shape[1]).astype(int) % self._gait_height.shape[1]
        curves = (
            self._gait_height if len(self._gait_height) > 1 else np.repeat(self._gait_height, self.n, axis=0)
        )
        qpos[:, 2] += np.where(standing, self._standing_height[mask], curves[mask][np.arange(m), row]) + 0.002
        qpos[:, 3] = a * tilt[:, 0] - b * tilt[:, 3]
        qpos[:, 4] = a * tilt[:, 1] - b * tilt[:, 2]
        qpos[:, 5] = a * tilt[:, 2] + b * tilt[:, 1]
        qpos[:, 6] = a * tilt[:, 3] + b * tilt[:, 0]
        joints = np.zeros((m, body.N_JOINTS))
        pose = gate * walking + (1 - gate) * gait.STANDING
        joints[:, body.SERVO_JOINT] = pose + self._slope_offset(forward, left)
        qpos[:, 7:] = joints + joint_noise
        for side in "rl":  # the knee's stop
            knee = 7 + body.JOINTS.index(f"knee_{side}")
            qpos[:, knee] = np.maximum(qpos[:, knee], 0.02)
        qvel[:, 6 + body.SERVO_JOINT] = rate
        qvel[:, 0], qvel[:, 1] = speed * cos, speed * sin
        qvel[:, :3] += velocity_noise

        self.qpos[mask], self.qvel[mask], self.sensor[mask] = qpos, qvel, 0
        self.phase[mask], self.heading[mask] = (
            np.where(standing, np.floor(phase * 2) / 2 + 0.06, phase),
            heading,
        )
        self.speed[mask] = self.speed_goal[mask] = speed
        self.turn[mask] = self.turn_goal[mask] = 0
        self.residual[mask] = 0
        self.mean_velocity[mask] = np.stack([speed, np.zeros(m)], 1)
        self.stagger[mask] = self.spread[mask] = 0
        self.variability.place(mask, variability, habits)
        self.gate.place(mask, standing)
        self.fresh[mask] = True
        self._look()

    @staticmethod
    def _slope_offset(forward: np.ndarray, left: np.ndarray) -> np.ndarray:
        """Ankles that follow the ground's grade."""
        return forward[:, None] * _ANKLES + left[:, None] * _SUBTALAR

    def _look(self) -> None:
        """Derive what observation, feedback and reward share."""
        q = self.qpos
        unit = q[:, 3:7] / np.maximum(np.linalg.norm(q[:, 3:7], axis=1), 1e-9)[:, None]
        self.rotation = rotation(unit)
        self.yaw = np.arctan2(self.rotation[:, 1, 0], self.rotation[:, 0, 0])
        self.cos, self.sin = np.cos(self.yaw), np.sin(self.yaw)
        self.up_body = np.einsum("nji,nj->ni", self.rotation, self.up)
        self.pitch = -np.arcsin(np.clip(self.up_body[:, 0], -1, 1))  # nose down
        self.roll = np.arctan2(self.up_body[:, 1], self.up_body[:, 2])
        self.yaw_error = wrap(self.yaw - self.heading)
        if self.ground is None:
            height, gradient = np.zeros(self.n), self.up[:, :2]
        else:
            height, gradient = self.ground(q[:, 0], q[:, 1])
        self.height = q[:, 2] - height
        self.grade_forward, self.grade_left = self._turned(gradient)
        self.left_stance = np.floor(self.phase * 2) % 2 == 1

    def _turned(self, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """World x, y (n, 2) -> forward, left."""
        x, y = vector[:, 0], vector[:, 1]
        return self.cos * x + self.sin * y, -self.sin * x + self.cos * y

    def observe(self) -> np.ndarray:
        """(n, N_OBSERVATION) float32, mirrored to right stance."""
        return observe(self)

    def step(self, action: np.ndarray) -> Trace:
        """Advance every walker by its control interval `dt`.

        Parameters
        ----------
        action : (n, 17) in [-1, 1], mirrored as the observation was
        """
        n, k = self.n, self.substeps
        half = np.floor(self.phase * 2)
        balance, stand = self._balance(), self._stand()
        self._decide(stand, balance.step_phase)
        gate_before = self.gate.advance(self.dt)
        open_ = gate_before[:, None]
        # A standing body is left to the standing controller, which keeps it motionless.
        walking = open_ * (np.clip(action, -1, 1) + feedback(self.gains, balance) / ACTION_SCALE)
        correction = mirror_where(self.left_stance, walking)
        correction += (1 - open_) * standing_feedback(stand) / ACTION_SCALE
        residual = np.clip(correction, -_RESIDUAL_LIMIT, _RESIDUAL_LIMIT)

        part = np.arange(1, k + 1) / k
        cadence = (
            gait.stride_frequency(self.speed) * (1 + self.variability.value[:, CADENCE]) * self.gate.pace
        )
        phase = self.phase[:, None] + (cadence * self.dt)[:, None] * part
        stopped = self.gate.closing & (self.gate.value <= 0)
        phase = np.where(stopped[:, None], half[:, None] / 2 + 0.06, phase)
        after = np.floor(phase[:, -1] * 2)
        braking = (self.speed_goal < 0.2) & (self.speed < 0.6) & ~self.gate.closing
        self.variability.advance(after != half, (after % 2).astype(int), self.dt, self.rng, _WIDER * braking)

        gate = open_ + (self.gate.value - gate_before)[:, None] * part
        target = self._reference(phase % 1, gate)
        blend = part[None, :, None]
        target += ACTION_SCALE * ((1 - blend) * self.residual[:, None] + blend * residual[:, None])
        start = np.concatenate([np.zeros((n, 1)), self.qpos, self.qvel], axis=1)
        # One model is passed alone: its rollout skips the per-model checks.
        models = self.models if n > 1 else self.models[0]
        state, sensor = self._rollout.rollout(models, self._data, start, target)
        nq = self.qpos.shape[1]
        trace = Trace(state[:, :, 1 : 1 + nq], state[:, :, 1 + nq :], sensor, target)

        self.qpos, self.qvel = trace.qpos[:, -1].copy(), trace.qvel[:, -1].copy()
        self.sensor = sensor[:, -1].copy()
        self.phase = phase[:, -1] % 1
        self.residual = residual
        self.fresh[:] = False
        self._advance_commands()
        self._look()
        return trace

    def _decide(self, stand: Stand, step_phase: np.ndarray) -> None:
        """Stop or go; a walker that stops keeps its feet where they are."""
        new = self.gate.decide(stand, step_phase, self.speed, self.speed_goal)
        q = self.qpos
        stagger = np.clip((q[:, _HIP_R] - q[:, _HIP_L]) / 2, -0.19, 0.19)
        spread = np.clip((q[:, _SIDE_R] + q[:, _SIDE_L]) / 2, -0.12, 0.02)
        self.stagger, self.spread = np.where(new, stagger, self.stagger), np.where(new, spread, self.spread)

    def _reference(self, phase: np.ndarray, gate: np.ndarray, stagger: float = 1.0) -> np.ndarray:
        """Targets (n, k, 17) of gait and stand at (n, k) phases and gates, with variability and slope."""
        width = phase.shape[1]
        amplitude = 1 + self.variability.value[:, AMPLITUDE]
        walking = gait.reference_angles(
            phase, np.repeat(self.speed[:, None], width, 1), np.repeat(amplitude[:, None], width, 1)
        )
        offset = -_ADDUCTION * (self.variability.value[:, WIDTH] / _LEG_LENGTH)[:, None]
        # The legs' rotation axes are mirrored: outwards is negative.
        offset[:, _TOE_OUT_SERVOS] -= self.variability.value[:, TOE_OUT]
        standing = gait.STANDING + stagger * self.stagger[:, None] * gait.STAGGER
        standing = standing + self.spread[:, None] * gait.SPREAD
        standing[:, _TOE_OUT_SERVOS] -= self.variability.value[:, TOE_OUT]
        g = gate[..., None]
        target = g * (walking + offset[:, None]) + (1 - g) * standing[:, None]
        return target + self._slope_offset(self.grade_forward, self.grade_left)[:, None]

    def reference_now(self) -> np.ndarray:
        """(n, 17) reference angles at the current phase; a stagger is better lost than kept."""
        return self._reference(self.phase[:, None], self.gate.value[:, None], stagger=0.3)[:, 0]

    def _advance_commands(self) -> None:
        dt, gate = self.dt, self.gate.value
        self.heading = self.heading + self.turn * dt
        faster = SPEED_SLEW * dt * (gate > 0.3)
        self.speed = self.speed + np.clip(self.speed_goal - self.speed, -0.9 * SPEED_SLEW * dt, faster)
        self.turn = self.turn + np.clip(self.turn_goal - self.turn, -TURN_SLEW * dt, TURN_SLEW * dt)
        self.turn = np.where(gate < 0.5, 0.0, self.turn)
        along, across = self.velocity()
        self.mean_velocity += (np.stack([along, across], 1) - self.mean_velocity) * (dt / _MEAN_VELOCITY_S)[
            :, None
        ]

    def velocity(self) -> tuple[np.ndarray, np.ndarray]:
        """Pelvis velocity along and across the commanded heading (m/s)."""
        cos, sin = np.cos(self.heading), np.sin(self.heading)
        vx, vy = self.qvel[:, 0], self.qvel[:, 1]
        return cos * vx + sin * vy, -sin * vx + cos * vy

    def _feet(self) -> np.ndarray:
        """(n, 2, 3) ankles, right and left; under the hips before any physics."""
        return self.sensor[:, body.SENSOR_FOOT_POSITION].reshape(-1, 2, 3)

    def _balance(self) -> Balance:
        side = np.where(self.left_stance, -1.0, 1.0)
        v, feet = self.qvel, self._feet()
        foot = np.where(self.left_stance[:, None], feet[:, 1], feet[:, 0])
        _, aside = self._turned(self.qpos[:, :2] - foot[:, :2])
        along, across = self._turned(v[:, :2])
        return Balance(
            pitch=self.pitch,
            roll=self.roll * side,
            roll_rate=v[:, 3] * side,
            pitch_rate=v[:, 4],
            yaw_rate=v[:, 5] * side,
            yaw_error=self.yaw_error * side,
            turn_rate=self.turn * side,
            speed_error=along - self.speed,
            mean_speed_error=self.mean_velocity[:, 0] - self.speed,
            lateral_velocity=across * side,
            mean_lateral_velocity=self.mean_velocity[:, 1] * side,
            foot_y=np.where(self.fresh, FOOT_OFFSET, aside * side),
            step_phase=(self.phase * 2) % 1,
            speed=self.speed,
        )

    def _stand(self) -> Stand:
        feet, pelvis = self._feet(), np.zeros((self.n, 2))
        along, across = (self._turned(feet[:, i, :2] - self.qpos[:, :2]) for i in (0, 1))
        relative = np.stack([np.stack(along, 1), np.stack(across, 1)], 1)
        under = np.array([[-0.04, -0.09], [-0.04, 0.09]])
        up = np.stack(self._turned(self.up[:, :2]), 1)
        resting = under - body.HIP_HEIGHT * up[:, None]
        relative = np.where(self.fresh[:, None, None], resting, relative)
        force = self.sensor[:, body.SENSOR_TOUCH].reshape(-1, 2, 3).sum(axis=2)
        return stand_of(
            pelvis=pelvis,
            feet=relative,
            velocity=np.stack(self._turned(self.qvel[:, :2]), 1),
            up=up,
            pitch=self.pitch,
            roll=self.roll,
            pitch_rate=self.qvel[:, 4],
            lumbar=self.qpos[:, _LUMBAR],
            lumbar_pitch_rate=self.qvel[:, _LUMBAR[1] - 1],
            grade_left=self.grade_left,
            force=force,
        )

    def fallen(self) -> np.ndarray:
        """(n,) bool: down, toppled, turned away from the commanded heading, or not finite."""
        upright = np.einsum("ni,ni->n", self.rotation[:, :, 2], self.up)
        finite = np.isfinite(self.qpos).all(axis=1) & np.isfinite(self.qvel).all(axis=1)
        return (self.height < 0.75) | (upright < 0.75) | (np.abs(self.yaw_error) > 1.1) | ~finite


def _distinct(models: Sequence[mujoco.MjModel]) -> Sequence[mujoco.MjModel]:
    """One model where all are the same object."""
    return models[:1] if all(model is models[0] for model in models) else models
