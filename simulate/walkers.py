"""N walkers side by side: state, observation and the 33 Hz control step over the physics.

The reference gait (models.gait) plus balance feedback plus a learned residual sets the targets of the joint
servos, which are interpolated over the physics steps. No other input acts on a body.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from mujoco import rollout

from footfall.conventions import wrap
from footfall.models import body, gait
from footfall.models.subject import Subject
from footfall.simulate.feedback import (
    FOOT_OFFSET,
    JOINT_MIRROR,
    JOINT_SIGN,
    SERVO_MIRROR,
    SERVO_SIGN,
    Balance,
    feedback,
    mirror_where,
)
from footfall.simulate.variability import Variability

CONTROL_INTERVAL = 0.030  # s
ACCELERATION = 0.4  # m/s2, slew of the commanded speed
TURN_ACCELERATION = 1.5  # rad/s2
_MEAN_VELOCITY_S = 0.5

# Residual (rad) for an action of 1.
ACTION_SCALE = 3.3 * np.array([0.2, 0.2, 0.2] + [0.35, 0.25, 0.25, 0.35, 0.25, 0.15] * 2)
N_ACTION = body.N_SERVOS
_RESIDUAL_LIMIT = 2.0  # of action scale, feedback included

_ADDUCTION = gait.mask("hip_adduction")
_ANKLES = gait.mask("ankle")
_SUBTALAR = np.zeros(body.N_SERVOS)
_SUBTALAR[[gait.INDEX["subtalar_r"], gait.INDEX["subtalar_l"]]] = 1.0, -1.0
_TOE_OUT = np.array([gait.INDEX["hip_rotation_r"], gait.INDEX["hip_rotation_l"]])
_LEG_LENGTH = 0.9  # m, turns a step width into an adduction


def _observation_mirror() -> tuple[np.ndarray, np.ndarray]:
    """Permutation and signs that turn an observation into that of the mirrored walker."""
    blocks: list[tuple[Sequence[int], Sequence[float]]] = [
        ([0], [1]),  # height
        ([0, 1, 2], [1, -1, 1]),  # gravity in the body
        ([0, 1, 2], [1, -1, 1]),  # velocity
        ([0, 1, 2], [-1, 1, -1]),  # angular velocity
        (JOINT_MIRROR.tolist(), JOINT_SIGN.tolist()),
        (JOINT_MIRROR.tolist(), JOINT_SIGN.tolist()),
        ([3, 4, 5, 0, 1, 2], [1] * 6),  # touch
        ([0, 1], [1, 1]),  # step phase
        ([0, 1], [1, 1]),  # commanded speed and its change to come
        ([0, 1], [-1, -1]),  # heading error, turn rate
        ([0, 1], [1, -1]),  # mean velocity error
        (SERVO_MIRROR.tolist(), SERVO_SIGN.tolist()),  # residual
        ([0, 1], [1, -1]),  # grade forward, left
        ([0, 1, 2, 4, 3], [1] * 5),  # variability
    ]
    permutation: list[int] = []
    signs: list[float] = []
    for order, sign in blocks:
        permutation += [len(signs) + i for i in order]
        signs += sign
    return np.array(permutation), np.array(signs, dtype=float)


_OBSERVATION_MIRROR, _OBSERVATION_SIGN = _observation_mirror()
N_OBSERVATION = len(_OBSERVATION_MIRROR)
OBSERVATION_LIMIT = 6.0


def rotation(quaternion: np.ndarray) -> np.ndarray:
    """(n, 4) scalar first -> (n, 3, 3) body to world."""
    w, x, y, z = quaternion.T
    return np.stack(
        [
            np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], -1),
            np.stack([2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)], -1),
            np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], -1),
        ],
        -2,
    )


@dataclass(frozen=True)
class Trace:
    """Every physics step of one control step: states after and sensors before each step, and the targets."""

    qpos: np.ndarray  # (n, k, 24)
    qvel: np.ndarray  # (n, k, 23)
    sensor: np.ndarray  # (n, k, n_sensor)
    target: np.ndarray  # (n, k, 15)


class Walkers:
    """State of n walkers and the control step that moves them.

    Parameters
    ----------
    models : one per walker; they may differ in body and gravity, not in layout
    subjects : one per walker
    gains : (n, 32) or (32,) feedback gains
    variability : (n,) level of gait variability, 1 = that of people
    rng : gait variability
    ground : (x, y) -> height and gradient (n,), (n, 2); level when None
    threads : for the physics; 0 = the calling thread
    """

    def __init__(
        self,
        models: Sequence[mujoco.MjModel],
        subjects: Sequence[Subject],
        gains: np.ndarray,
        *,
        variability: np.ndarray,
        rng: np.random.Generator,
        ground: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]] | None = None,
        threads: int = 0,
    ) -> None:
        n = len(models)
        self.n, self.models, self.gains, self.rng, self.ground = n, list(models), gains, rng, ground
        timestep = models[0].opt.timestep
        self.substeps = round(CONTROL_INTERVAL / timestep)
        if abs(self.substeps * timestep - CONTROL_INTERVAL) > 1e-9:
            raise ValueError(
                f"the control interval {CONTROL_INTERVAL} s is no multiple of the physics step {timestep} s"
            )
        self.scale = np.array([subject.scale for subject in subjects])
        self.strength = np.array([subject.scale * subject.mass_ratio for subject in subjects])
        self.variability = Variability(np.asarray(variability, dtype=float))
        self._data = [mujoco.MjData(models[0]) for _ in range(max(1, threads))]
        self._rollout = rollout.Rollout(nthread=threads)
        self.start_height = _start_heights(models[0]) / subjects[0].scale

        def zeros(*shape: int) -> np.ndarray:
            return np.zeros((n, *shape))

        self.qpos, self.qvel = zeros(models[0].nq), zeros(models[0].nv)
        self.sensor = zeros(models[0].nsensordata)
        self.up = np.tile([0.0, 0.0, 1.0], (n, 1))  # against gravity, in the frame of qpos
        self.phase = zeros()
        self.heading = zeros()  # commanded
        self.speed, self.speed_goal = zeros(), zeros()
        self.turn, self.turn_goal = zeros(), zeros()
        self.residual = zeros(N_ACTION)
        self.mean_velocity = zeros(2)  # along and across the commanded heading
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
        joint_noise: np.ndarray | float = 0.0,
        velocity_noise: np.ndarray | float = 0.0,
    ) -> None:
        """Put the walkers in `mask` (m of them) into mid-gait on the reference motion (all arguments (m, ...))."""
        m, scale = int(mask.sum()), self.scale[mask]
        amplitude = gait.hip_amplitude(speed)
        epsilon = 0.002
        before = gait.reference_angles((phase - epsilon) % 1, amplitude)
        after = gait.reference_angles((phase + epsilon) % 1, amplitude)
        rate = (after - before) / (2 * epsilon) * gait.stride_frequency(speed)[:, None]
        # Upright against gravity on sloping ground: yaw, then a small tilt.
        cos, sin = np.cos(heading), np.sin(heading)
        up = self.up[mask]
        forward, left = cos * up[:, 0] + sin * up[:, 1], -sin * up[:, 0] + cos * up[:, 1]
        tilt = np.stack([np.ones(m), -left / 2, forward / 2, left * forward / 4], 1)
        tilt /= np.linalg.norm(tilt, axis=1)[:, None]
        a, b = np.cos(heading / 2), np.sin(heading / 2)

        qpos, qvel = np.zeros((m, self.qpos.shape[1])), np.zeros((m, self.qvel.shape[1]))
        qpos[:, :3] = position
        qpos[:, 2] += (
            np.interp(phase, np.linspace(0, 1, len(self.start_height)), self.start_height) * scale + 0.002
        )
        qpos[:, 3] = a * tilt[:, 0] - b * tilt[:, 3]
        qpos[:, 4] = a * tilt[:, 1] - b * tilt[:, 2]
        qpos[:, 5] = a * tilt[:, 2] + b * tilt[:, 1]
        qpos[:, 6] = a * tilt[:, 3] + b * tilt[:, 0]
        joints = np.zeros((m, body.N_JOINTS))
        joints[:, body.SERVO_JOINT] = gait.reference_angles(phase, amplitude) + self._slope_offset(
            forward, left
        )
        qpos[:, 7:] = joints + joint_noise
        for side in "rl":  # the knee's stop
            knee = 7 + body.JOINTS.index(f"knee_{side}")
            qpos[:, knee] = np.maximum(qpos[:, knee], 0.02)
        qvel[:, 6 + body.SERVO_JOINT] = rate
        qvel[:, 0], qvel[:, 1] = speed * cos, speed * sin
        qvel[:, :3] += velocity_noise

        self.qpos[mask], self.qvel[mask], self.sensor[mask] = qpos, qvel, 0
        self.phase[mask], self.heading[mask] = phase, heading
        self.speed[mask] = self.speed_goal[mask] = speed
        self.turn[mask] = self.turn_goal[mask] = 0
        self.residual[mask] = 0
        self.mean_velocity[mask] = np.stack([speed, np.zeros(m)], 1)
        self.variability.reset(mask)
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
        self.yaw_error = wrap(self.yaw - self.heading)
        if self.ground is None:
            height, gradient = np.zeros(self.n), self.up[:, :2]
        else:
            height, gradient = self.ground(q[:, 0], q[:, 1])
        self.height = (q[:, 2] - height) / self.scale
        self.grade_forward = self.cos * gradient[:, 0] + self.sin * gradient[:, 1]
        self.grade_left = -self.sin * gradient[:, 0] + self.cos * gradient[:, 1]
        self.left_stance = np.floor(self.phase * 2) % 2 == 1

    def observe(self) -> np.ndarray:
        """(n, N_OBSERVATION) float32, mirrored to right stance."""
        q, v = self.qpos, self.qvel
        ahead = self.cos * v[:, 0] + self.sin * v[:, 1] - self.speed
        aside = -self.sin * v[:, 0] + self.cos * v[:, 1]
        step_angle = 2 * np.pi * ((self.phase * 2) % 1)
        variability = self.variability.value * [15, 10, 30, 8, 8]
        observation = np.concatenate(
            [
                (self.height[:, None] - 0.98) * 5,
                self.up_body * 2,
                np.stack([ahead, aside, v[:, 2]], 1) * 1.5,
                v[:, 3:6] * 0.4,
                q[:, 7:] * 1.5,
                v[:, 6:] * 0.12,
                np.minimum(self.sensor[:, body.SENSOR_TOUCH] / 400, 2.0),
                np.stack([np.sin(step_angle), np.cos(step_angle)], 1),
                np.stack([(self.speed - 1.2) * 3, self.speed_goal - self.speed], 1),
                np.stack([np.clip(self.yaw_error, -0.8, 0.8) * 2.5, self.turn * 2], 1),
                np.stack([self.mean_velocity[:, 0] - self.speed, self.mean_velocity[:, 1]], 1) * 3,
                self.residual * 2.4,
                np.stack([self.grade_forward, self.grade_left], 1) * 10,
                variability,
            ],
            axis=1,
        )
        mirrored = observation[:, _OBSERVATION_MIRROR] * _OBSERVATION_SIGN
        observation = np.where(self.left_stance[:, None], mirrored, observation)
        return np.clip(observation, -OBSERVATION_LIMIT, OBSERVATION_LIMIT).astype(np.float32)

    def step(self, action: np.ndarray) -> Trace:
        """Advance every walker by CONTROL_INTERVAL.

        Parameters
        ----------
        action : (n, 15) in [-1, 1], mirrored as the observation was
        """
        n, k = self.n, self.substeps
        half = np.floor(self.phase * 2)
        correction = np.clip(action, -1, 1) + feedback(self.gains, self._balance()) / ACTION_SCALE
        correction = mirror_where(self.left_stance, correction)
        residual = np.clip(correction, -_RESIDUAL_LIMIT, _RESIDUAL_LIMIT)
        cadence = gait.stride_frequency(self.speed) / np.sqrt(self.scale) * (1 + self.variability.value[:, 0])
        part = np.arange(1, k + 1) / k
        phase = self.phase[:, None] + cadence[:, None] * CONTROL_INTERVAL * part
        new_step = np.floor(phase[:, -1] * 2) != half
        self.variability.advance(
            new_step, (np.floor(phase[:, -1] * 2) % 2).astype(int), CONTROL_INTERVAL, self.rng
        )

        target = self._reference(phase % 1)
        blend = part[None, :, None]
        target += ACTION_SCALE * ((1 - blend) * self.residual[:, None] + blend * residual[:, None])
        start = np.concatenate([np.zeros((n, 1)), self.qpos, self.qvel], axis=1)
        # One model is passed alone: its rollout may then use every data and skips the per-model checks.
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

    def _reference(self, phase: np.ndarray) -> np.ndarray:
        """Targets of the reference gait at (n, k) phases, with variability and slope."""
        amplitude = gait.hip_amplitude(self.speed) * (1 + self.variability.value[:, 1])
        target = gait.reference_angles(phase, np.repeat(amplitude[:, None], phase.shape[1], 1))
        offset = self._slope_offset(self.grade_forward, self.grade_left)
        offset -= _ADDUCTION * (self.variability.value[:, 2] / _LEG_LENGTH)[:, None]
        offset[:, _TOE_OUT] += self.variability.value[:, 3:5]
        return target + offset[:, None]

    def reference_now(self) -> np.ndarray:
        """(n, 15) reference angles at the current phase."""
        return self._reference(self.phase[:, None])[:, 0]

    def _advance_commands(self) -> None:
        dt = CONTROL_INTERVAL
        self.heading = self.heading + self.turn * dt
        change = np.clip(self.speed_goal - self.speed, -ACCELERATION * dt, ACCELERATION * dt)
        self.speed = self.speed + change
        self.turn = self.turn + np.clip(
            self.turn_goal - self.turn, -TURN_ACCELERATION * dt, TURN_ACCELERATION * dt
        )
        along, across = self.velocity()
        self.mean_velocity += (np.stack([along, across], 1) - self.mean_velocity) * (dt / _MEAN_VELOCITY_S)

    def velocity(self) -> tuple[np.ndarray, np.ndarray]:
        """Pelvis velocity along and across the commanded heading (m/s)."""
        cos, sin = np.cos(self.heading), np.sin(self.heading)
        vx, vy = self.qvel[:, 0], self.qvel[:, 1]
        return cos * vx + sin * vy, -sin * vx + cos * vy

    def _balance(self) -> Balance:
        side = np.where(self.left_stance, -1.0, 1.0)
        v = self.qvel
        x, y, z = self.up_body.T
        feet = self.sensor[:, body.SENSOR_FOOT_POSITION]
        foot = np.where(self.left_stance[:, None], feet[:, 3:], feet[:, :3])
        dx, dy = self.qpos[:, 0] - foot[:, 0], self.qpos[:, 1] - foot[:, 1]
        foot_y = (-self.sin * dx + self.cos * dy) * side
        along = self.cos * v[:, 0] + self.sin * v[:, 1]
        across = -self.sin * v[:, 0] + self.cos * v[:, 1]
        return Balance(
            pitch=-np.arcsin(np.clip(x, -1, 1)),
            roll=np.arctan2(y, z) * side,
            roll_rate=v[:, 3] * side,
            pitch_rate=v[:, 4],
            yaw_rate=v[:, 5] * side,
            yaw_error=self.yaw_error * side,
            turn_rate=self.turn * side,
            speed_error=along - self.speed,
            mean_speed_error=self.mean_velocity[:, 0] - self.speed,
            lateral_velocity=across * side,
            mean_lateral_velocity=self.mean_velocity[:, 1] * side,
            foot_y=np.where(self.fresh, FOOT_OFFSET, foot_y),
            step_phase=(self.phase * 2) % 1,
        )

    def fallen(self) -> np.ndarray:
        """(n,) bool: down, toppled, turned away from the commanded heading, or not finite."""
        upright = np.einsum("ni,ni->n", self.rotation[:, :, 2], self.up)
        finite = np.isfinite(self.qpos).all(axis=1) & np.isfinite(self.qvel).all(axis=1)
        return (self.height < 0.75) | (upright < 0.75) | (np.abs(self.yaw_error) > 1.1) | ~finite


def _start_heights(model: mujoco.MjModel) -> np.ndarray:
    """Pelvis height (m) over the stride at which the lower foot touches level ground."""
    data = mujoco.MjData(model)
    touching = [model.geom(f"{part}_{side}").id for side in "rl" for part in ("heel", "ball", "toe")]
    phases = np.linspace(0, 1, 101)
    heights = np.zeros(len(phases))
    for i, phase in enumerate(phases):
        joints = np.zeros(body.N_JOINTS)
        joints[body.SERVO_JOINT] = gait.reference_angles(np.array(phase % 1), np.array(1.0))
        for side, offset in (("r", 0.0), ("l", 0.5)):
            if 0.3 < (phase + offset) % 1 < 0.63:  # the toe bends under a lifted heel
                joint = {
                    name: joints[body.JOINTS.index(f"{name}_{side}")]
                    for name in ("hip_flexion", "knee", "ankle")
                }
                foot_pitch = joint["hip_flexion"] - joint["knee"] + joint["ankle"]
                joints[body.JOINTS.index(f"toe_{side}")] = np.clip(-foot_pitch, 0, 0.6)
        data.qpos[:] = 0
        data.qpos[3] = 1
        data.qpos[7:] = joints
        mujoco.mj_kinematics(model, data)
        heights[i] = -min(data.geom_xpos[g][2] - model.geom_size[g][0] for g in touching)
    return heights
