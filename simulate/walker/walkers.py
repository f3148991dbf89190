"""N walkers side by side: their state and the control step (33 a second) over the physics.

The reference gait (models.gait) plus balance feedback plus a learned residual sets the targets of the joint
servos, which are interpolated over the physics steps. No other input acts on a body. Everything is in the
units of the 1.75 m body (models.subject). The laws are compiled: `_balance_kernels`, `_gait_kernels` and
`_posture_kernels`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import mujoco
import numpy as np
from mujoco import rollout

from footfall.conventions import GRAVITY
from footfall.models import body, gait
from footfall.models.ground import N_PLANES, GroundLookup, tread
from footfall.models.subject import Habits
from footfall.simulate.walker._balance_kernels import act_all
from footfall.simulate.walker._gait_kernels import FROZEN, REFERENCE, reference_all, stride_all, targets_all
from footfall.simulate.walker._posture_kernels import land_all, posture_all
from footfall.simulate.walker.feedback import gain_records
from footfall.simulate.walker.heights import gait_heights, standing_height
from footfall.simulate.walker.observation import observe
from footfall.simulate.walker.state import WALKER
from footfall.simulate.walker.variability import Variability

CONTROL_INTERVAL = 0.030  # s, nominal: the physics step times `substeps`
N_ACTION = body.N_SERVOS
# What drives the physics, in MuJoCo's order: servo targets; the forces on the bodies while there are some;
# where the ground slopes, the planes that the feet tread on.
_CONTROL, _FORCE = int(mujoco.mjtState.mjSTATE_CTRL), int(mujoco.mjtState.mjSTATE_XFRC_APPLIED)
_PLANES = int(mujoco.mjtState.mjSTATE_MOCAP_POS | mujoco.mjtState.mjSTATE_MOCAP_QUAT)
# A standing foot would creep by tenths of a millimetre a second, on a slope by millimetres, and under the
# torques of the first and the last step it would turn by some degrees.
_NOSLIP_ITERATIONS = 4


class Trace(NamedTuple):
    """Every physics step of one control step: states after and sensors before each step, and the targets."""

    qpos: np.ndarray  # (n, k, 26)
    qvel: np.ndarray  # (n, k, 25)
    sensor: np.ndarray  # (n, k, n_sensor)
    target: np.ndarray  # (n, k, 17)


@dataclass(frozen=True)
class Gate:
    """Which walkers walk and which stand.

    Attributes
    ----------
    value : (n,) 0 stands, 1 walks
    closing : (n,) bool, has decided to stand (or stands)
    """

    value: np.ndarray
    closing: np.ndarray


class Walkers:
    """State of n walkers and the control step that moves them.

    Parameters
    ----------
    models : one per walker; they may differ in build, gravity and timestep, not in layout
    gains : (n, 32) or (32,) feedback gains
    rng : of the gait's variability
    ground : (x, y) -> height (n,) and gradient (n, 2), for models that are `sloping`; level when None
    threads : for the physics; 0 = the calling thread
    substeps : physics steps of a control step; as many as come nearest to CONTROL_INTERVAL when None
    """

    def __init__(
        self,
        models: Sequence[mujoco.MjModel],
        gains: np.ndarray,
        *,
        rng: np.random.Generator,
        ground: GroundLookup | None = None,
        threads: int = 0,
        substeps: int | None = None,
    ) -> None:
        n = len(models)
        self.n, self.models, self.rng, self.ground = n, list(models), rng, ground
        self.gains = gains
        timesteps = np.array([model.opt.timestep for model in models])
        self.substeps = substeps or max(1, round(CONTROL_INTERVAL / timesteps.mean()))
        self.dt = self.substeps * timesteps
        if np.abs(self.dt / CONTROL_INTERVAL - 1).max() > 0.1:
            raise ValueError(
                f"{self.substeps} physics steps of {timesteps.max():.4g} s are no control interval of "
                f"{CONTROL_INTERVAL} s (10 % off at the most)"
            )
        self._n_sensor = models[0].nsensordata
        self._data = [mujoco.MjData(models[0]) for _ in range(max(1, threads))]
        self._rollout = rollout.Rollout(nthread=threads)
        self._trunk = models[0].body("torso").id
        self._gait_height = np.array([gait_heights(model) for model in _distinct(models)])
        self._standing_height = np.array([standing_height(model) for model in models])

        self._state = state = np.zeros(n, WALKER)
        state["dt"] = self.dt
        state["weight"] = [GRAVITY * model.body_mass.sum() for model in models]
        state["up"], state["fresh"] = [0.0, 0.0, 1.0], True
        self.variability, self.gate = Variability(state), Gate(state["gate"], state["closing"])
        self.gate.value[:] = 1.0
        # Views: what is written to them is what the next control step sees (`up`: the next `place`).
        self.qpos, self.qvel, self.sensor = state["qpos"], state["qvel"], state["sensor"]
        self.up, self.fresh = state["up"], state["fresh"]
        self.phase, self.left_stance = state["phase"], state["left_stance"]
        self.heading, self.mean_velocity = state["heading"], state["mean_velocity"]
        self.speed, self.speed_goal = state["speed"], state["speed_goal"]
        self.setting_out = state["setting_out"]
        self.turn, self.turn_goal = state["turn"], state["turn_goal"]
        self.rotation, self.yaw, self.cos, self.sin = (
            state[key] for key in ("rotation", "yaw", "cos", "sin")
        )
        self.up_body, self.pitch, self.roll = state["up_body"], state["pitch"], state["roll"]
        self.yaw_error, self.height = state["yaw_error"], state["height"]
        self.grade_forward, self.grade_left = state["grade_forward"], state["grade_left"]
        self._stepping = np.empty(n, dtype=np.intp)
        self._start = np.empty((n, 1 + self.qpos.shape[1] + self.qvel.shape[1]))
        self._planes = np.zeros((n, N_PLANES))
        self._find_ground(self.qpos, self.sensor)
        posture_all(state)

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
        """Put the walkers in `mask` (m of them) into mid-gait or a stand (all arguments (m, ...)).

        `variability` is that of placement, cadence and toe-out (m, 3), or one for all (m,). From a stand the
        left foot steps first where `phase` is below a half, else the right one.
        """
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
        slope = forward[:, None] * REFERENCE["ankles"] + left[:, None] * REFERENCE["subtalar"]
        toe_out = np.array([habit.toe_out for habit in habits])[:, None]
        turned_out = toe_out * (REFERENCE["toe_out_right"] + REFERENCE["toe_out_left"])
        joints[:, body.SERVO_JOINT] = pose + slope - turned_out
        qpos[:, 7:] = joints + joint_noise
        for side in "rl":  # the knee's stop
            knee = 7 + body.JOINTS.index(f"knee_{side}")
            qpos[:, knee] = np.maximum(qpos[:, knee], 0.02)
        qvel[:, 6 + body.SERVO_JOINT] = rate
        qvel[:, 0], qvel[:, 1] = speed * cos, speed * sin
        qvel[:, :3] += velocity_noise

        self.qpos[mask], self.qvel[mask], self.sensor[mask] = qpos, qvel, 0
        # Nothing is sensed yet, but the ground under the feet is to be found.
        self.sensor[mask, body.SENSOR_FOOT_POSITION] = np.tile(qpos[:, :3], 2)
        self.phase[mask], self.heading[mask] = (
            np.where(standing, np.floor(phase * 2) / 2 + FROZEN, phase),
            heading,
        )
        self.speed[mask] = self.speed_goal[mask] = speed
        self.turn[mask] = self.turn_goal[mask] = 0
        self._state["residual"][mask] = 0
        self.mean_velocity[mask] = np.stack([speed, np.zeros(m)], 1)
        self._state["stagger"][mask] = self._state["spread"][mask] = 0
        self._state["out_right"][mask] = self._state["out_left"][mask] = toe_out[:, 0]
        self._state["stopping"][mask], self._state["waiting"][mask] = False, 0.0
        self.variability.place(mask, variability, habits)
        self.gate.value[mask], self.gate.closing[mask] = np.where(standing, 0.0, 1.0), standing
        self.setting_out[mask], self._state["shift"][mask] = False, 0
        self.fresh[mask] = True
        self._find_ground(self.qpos, self.sensor)
        posture_all(self._state)

    @property
    def gains(self) -> np.ndarray:
        """(n, 32) or (32,) feedback gains."""
        return self._gains

    @gains.setter
    def gains(self, gains: np.ndarray) -> None:
        self._gains, self._gain_records = gains, gain_records(gains)

    @property
    def residual(self) -> np.ndarray:
        """(n, 17) feedback and policy as applied at the end of the last step, a copy."""
        copy: np.ndarray = self._state["residual"].copy()
        return copy

    @property
    def steady(self) -> np.ndarray:
        """(n,) bool: comes to a stand, stands or sets out, so that its loaded feet should lie still."""
        steady: np.ndarray = self.gate.closing | self.setting_out | self._state["stopping"]
        return steady

    def _find_ground(self, position: np.ndarray, sensor: np.ndarray) -> None:
        """Under the pelvis (n, 2+), and under the feet."""
        state = self._state
        if self.ground is None:
            state["gradient"] = self.up[:, :2]
        else:
            state["ground"], state["gradient"] = self.ground(position[:, 0], position[:, 1])
            tread(self._planes, sensor, self.ground)

    def observe(self) -> np.ndarray:
        """(n, N_OBSERVATION) float32, mirrored to right stance."""
        return observe(self._state)

    def step(self, action: np.ndarray, force: np.ndarray | None = None) -> Trace:
        """Advance every walker by its control interval `dt`.

        Parameters
        ----------
        action : (n, 17) in [-1, 1], mirrored as the observation was
        force : (n, 3) N on the trunk during this interval; None, as nearly always: no external force

        Raises
        ------
        ValueError
            Actions of another shape.
        """
        state, n, k = self._state, self.n, self.substeps
        action = np.ascontiguousarray(action, dtype=float)
        if action.shape != (n, N_ACTION):
            raise ValueError(f"actions {action.shape}, expected ({n}, {N_ACTION})")
        act_all(state, self._gain_records, action)
        stepping = stride_all(state, self._stepping)
        if stepping:
            self.variability.draw(self._stepping[:stepping], self.rng)
        target, start = np.empty((n, k, N_ACTION)), self._start
        targets_all(state, REFERENCE, start, target)
        after, sensor = np.empty((n, k, start.shape[1])), np.empty((n, k, self._n_sensor))
        control, spec = [target], _CONTROL
        if force is not None:
            on_bodies = np.zeros((n, k, self.models[0].nbody, 6))
            on_bodies[:, :, self._trunk, :3] = force[:, None]
            control.append(on_bodies.reshape(n, k, -1))
            spec |= _FORCE
        if self.ground is not None:
            control.append(np.repeat(self._planes[:, None], k, axis=1))
            spec |= _PLANES
        # The shapes are right by construction: unchecked, a call costs 50 us less.
        self._rollout.rollout(
            self.models,
            self._data,
            start,
            np.concatenate(control, axis=2) if len(control) > 1 else target,
            control_spec=spec,
            skip_checks=True,
            nstep=k,
            state=after,
            sensordata=sensor,
        )
        if self.ground is not None:
            self._find_ground(after[:, -1, 1:3], sensor[:, -1])
        land_all(state, after, sensor)
        nq = self.qpos.shape[1]
        return Trace(after[:, :, 1 : 1 + nq], after[:, :, 1 + nq :], sensor, target)

    def reference_now(self) -> np.ndarray:
        """(n, 17) reference angles at the current phase; a stagger is better lost than kept."""
        angles: np.ndarray = reference_all(self._state, REFERENCE, 0.3)
        return angles

    def velocity(self) -> tuple[np.ndarray, np.ndarray]:
        """Pelvis velocity along and across the commanded heading (m/s)."""
        cos, sin = np.cos(self.heading), np.sin(self.heading)
        vx, vy = self.qvel[:, 0], self.qvel[:, 1]
        return cos * vx + sin * vy, -sin * vx + cos * vy

    def fallen(self) -> np.ndarray:
        """(n,) bool: down, toppled, turned away from the commanded heading, or not finite."""
        copy: np.ndarray = self._state["fallen"].copy()
        return copy


def grip(walkers: Walkers) -> None:
    """Let the soles of walkers that are steady not creep in the next control step."""
    for model, steady in zip(walkers.models, walkers.steady.tolist(), strict=True):
        model.opt.noslip_iterations = _NOSLIP_ITERATIONS if steady else 0


def _distinct(models: Sequence[mujoco.MjModel]) -> Sequence[mujoco.MjModel]:
    """One model where all are the same object."""
    return models[:1] if all(model is models[0] for model in models) else models
