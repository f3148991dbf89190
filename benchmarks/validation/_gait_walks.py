"""Simulated walks for the gait comparison: straight ones, with all that an IMU at any mount would see."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from footfall.conventions import GRAVITY
from footfall.models import body
from footfall.models.mount import MOUNTS, Mount
from footfall.models.policy import Policy, stock_policy
from footfall.models.subject import SUBJECTS
from footfall.recording import Recording
from footfall.scenarios.path import PathSpec, build_path
from footfall.simulate.episode import STAND_S, stroll
from footfall.simulate.plan import PHYSICS_STEP, Gait, Plan
from footfall.simulate.truth import imu_truth

WANDER_M = 0.10  # as in the stock scenarios
REST_S = 2.0  # of standing before the first step


@dataclass(frozen=True)
class Case:
    """What to walk: a stock subject's name, the pace asked for (m/s), a seed."""

    subject: str
    pace: float
    seed: int = 1


@dataclass(frozen=True)
class Motion:
    """The instrumented walker at every physics step, in the subject's units; the path is the world's x axis.

    Attributes
    ----------
    foot : (n, 7) position (m) of the right ankle and attitude of that foot, body to world, scalar first
    feet : (n, 2, 3) m, ankles, right and left
    load : (n, 2) body weights, right and left
    ankle : (n, 2) rad, dorsiflexion positive
    scale : lengths relative to the simulated body
    """

    case: Case
    foot: np.ndarray
    feet: np.ndarray
    load: np.ndarray
    ankle: np.ndarray
    scale: float


def walk_straight(case: Case, metres: float, policy: Policy | None = None) -> Motion:
    """Stand, then walk a straight path of some metres, with the stock weights or others.

    Raises
    ------
    FallError, StrayError
        The walk did not reach its end.
    """
    subject = SUBJECTS[case.subject]
    spec = PathSpec.model_validate({"elements": [{"kind": "straight", "length_m": metres}]})
    plan = Plan(
        name=f"straight, {case.subject}, {case.pace:g} m/s",
        route=build_path(spec).route,
        subject=subject,
        mount=Mount(position=(0.0, 0.0, 0.0), euler_deg=(0.0, 0.0, 0.0)),
        gait=Gait(pace_m_s=case.pace, wander_m=WANDER_M),
        calibration_s=REST_S,
        seed=case.seed,
    )
    kept: list[tuple[np.ndarray, ...]] = []
    for moment in stroll(plan, policy or stock_policy()):
        sensor, model = moment.trace.sensor[0], moment.walkers.models[0]
        weight = float(model.body_mass.sum()) * GRAVITY
        touch = sensor[:, body.SENSOR_TOUCH].reshape(len(sensor), 2, -1).sum(axis=2)
        joints = [
            int(model.jnt_qposadr[mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, f"ankle_{side}")])
            for side in "rl"
        ]
        kept.append(
            (
                sensor[:, body.sensor_imu(0)].copy(),
                sensor[:, body.SENSOR_FOOT_POSITION].reshape(len(sensor), 2, 3),
                touch / weight,
                moment.trace.qpos[0][:, joints],
            )
        )
    foot, feet, load, ankle = (
        np.concatenate(parts)[round(STAND_S / PHYSICS_STEP) :] for parts in zip(*kept, strict=True)
    )
    foot[:, :3] *= subject.scale
    return Motion(case, foot, feet * subject.scale, load, ankle, subject.scale)


def samples(motion: Motion, mount: str) -> Recording:
    """What a perfect IMU at a stock mount of the right foot says at the physics rate.

    The mount is one rigid body with the ankle's site, so one walk serves all mounts.
    """
    place = MOUNTS[mount]
    attitude = Rotation.from_quat(motion.foot[:, 3:], scalar_first=True)
    position = motion.foot[:, :3] + attitude.apply(np.array(place.position) * motion.scale)
    turned = attitude * Rotation.from_euler("ZYX", place.euler_deg[::-1], degrees=True)
    truth = imu_truth(position, turned.as_quat(scalar_first=True), PHYSICS_STEP, 1)
    return Recording(truth.index * PHYSICS_STEP, truth.gyro, truth.accel)
