"""The walker's body of 1.75 m, built with MjSpec: 25 degrees of freedom, 17 torque-limited joint servos.

Segment lengths and masses follow Winter, Biomechanics and Motor Control of Human Movement, table 4.1
(thigh 0.245 H, shank 0.246 H; thigh 0.100 M, shank 0.0465 M, foot with shoe 0.017 M, arm and hand 0.05 M).
The pelvis carries 0.142 M, the rigid head and trunk the rest. Nothing but joint torques, gravity and
ground contact acts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from footfall.conventions import GRAVITY
from footfall.models.appearance import (
    SHIRT,
    SHOE,
    SKIN,
    TROUSERS,
    add_look,
    add_sky_and_paving,
    add_torso_looks,
)
from footfall.models.mount import Mount
from footfall.models.route import Ground
from footfall.models.subject import REFERENCE_HEIGHT_M, Build

# Joint names, in the order of qpos after the free joint. Right leg first: it carries the IMU by default.
LEG_JOINTS = ("hip_flexion", "hip_adduction", "hip_rotation", "knee", "ankle", "subtalar", "toe")
LUMBAR_JOINTS = ("lumbar_roll", "lumbar_pitch", "lumbar_yaw")
ARM_JOINTS = ("shoulder_r", "shoulder_l")
JOINTS = (
    *(f"{joint}_r" for joint in LEG_JOINTS),
    *(f"{joint}_l" for joint in LEG_JOINTS),
    *LUMBAR_JOINTS,
    *ARM_JOINTS,
)


@dataclass(frozen=True)
class Servo:
    """A position servo: stiffness (Nm/rad), damping (Nms/rad) and torque limits (Nm)."""

    kp: float
    kv: float
    low: float
    high: float


_LEG_SERVOS = {
    "hip_flexion": Servo(500, 40, -200, 200),
    "hip_adduction": Servo(500, 40, -150, 150),
    "hip_rotation": Servo(250, 16, -80, 80),
    "knee": Servo(400, 25, -180, 200),
    "ankle": Servo(300, 12, -160, 60),
    "subtalar": Servo(150, 6, -50, 50),
}
# The actuators, in control order: lumbar, right leg, left leg, arms. The toes are passive.
SERVOS = {
    "lumbar_roll": Servo(600, 50, -150, 150),
    "lumbar_pitch": Servo(600, 50, -150, 150),
    "lumbar_yaw": Servo(300, 25, -80, 80),
    **{f"{joint}_{side}": servo for side in "rl" for joint, servo in _LEG_SERVOS.items()},
    **{name: Servo(25, 2.5, -30, 30) for name in ARM_JOINTS},
}
N_JOINTS, N_SERVOS = len(JOINTS), len(SERVOS)
SERVO_JOINT = np.array([JOINTS.index(name) for name in SERVOS])  # control index -> joint index

# name -> (axis on the right side, range in degrees, damping, armature, stiffness). A left joint mirrors the
# axes along x and z, so that equal angles are mirror images.
_LEG_AXES = {
    "hip_flexion": ((0, -1, 0), (-40, 110), 2.0, 0.01, 0.0),
    "hip_adduction": ((1, 0, 0), (-35, 25), 2.0, 0.01, 0.0),
    "hip_rotation": ((0, 0, 1), (-40, 40), 1.0, 0.01, 0.0),
    "knee": ((0, 1, 0), (0, 140), 1.0, 0.01, 0.0),
    "ankle": ((0, -1, 0), (-50, 30), 1.0, 0.008, 0.0),
    "subtalar": ((1, 0, 0), (-25, 25), 1.0, 0.008, 0.0),
    "toe": ((0, -1, 0), (-10, 60), 0.6, 0.002, 25.0),
}
_LUMBAR_AXES = {
    "lumbar_roll": ((1, 0, 0), (-25, 25), 2.0, 0.01, 0.0),
    "lumbar_pitch": ((0, 1, 0), (-30, 45), 2.0, 0.01, 0.0),
    "lumbar_yaw": ((0, 0, 1), (-35, 35), 2.0, 0.01, 0.0),
}
_SHOULDER_AXIS = ((0, -1, 0), (-60, 90), 0.3, 0.005, 0.0)  # flexion, forward, is positive
_SHOULDER = (0.0, 0.21, 0.40)  # m from the torso's origin

ANKLE_HEIGHT = 0.075  # m above the ground, sole included, reference body
# The sole from heel to ball, m from the ankle: a rocker of SOLE_HALF_LENGTH^2 / SOLE_RISE = 1.7 m radius. A
# foot in a shoe turns by some 10 deg/s even at mid-stance (real recordings: 4-18), because it rolls on.
SOLE_CENTRE, SOLE_HALF_LENGTH, SOLE_RISE, SOLE_HALF_GAP = 0.0425, 0.0975, 0.0055, 0.026
HIP_HALF_WIDTH = 0.088
HIP_HEIGHT = 0.95  # of the pelvis in standing


def build_body(
    build: Build,
    *,
    timestep: float,
    mounts: Sequence[Mount] = (),
    sloping: bool = False,
    looks: bool = False,
    scenery: Ground | None = None,
) -> mujoco.MjModel:
    """Compile the walker.

    Parameters
    ----------
    timestep : s
    mounts : of IMUs: each adds a site `imu_K` and sensors `imu_K_pos`, `imu_K_quat` after those of control.
        A site weighs nothing: the steps are the same to the last bit, however many there are
    sloping : each foot treads on a plane of its own, which `models.ground.tread` lays under it; else both on
        one level plane
    looks : adds what is only drawn; the physics is the same to the last bit, and 5 % slower
    scenery : a heightfield that is only drawn
    """
    spec = mujoco.MjSpec()
    spec.modelname = "footfall walker"
    spec.compiler.degree = False
    option = spec.option
    option.timestep = timestep
    option.gravity = [0, 0, -GRAVITY]
    option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    option.solver = mujoco.mjtSolver.mjSOL_NEWTON
    option.cone = mujoco.mjtCone.mjCONE_PYRAMIDAL
    # MuJoCo 4.0.0's sparse Cholesky gives Newton a wrong Hessian.
    option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    # Measured to be enough for this body; more iterations change nothing that shows.
    option.iterations, option.ls_iterations = 4, 6
    option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_EULERDAMP | mujoco.mjtDisableBit.mjDSBL_ISLAND)
    spec.visual.headlight.ambient = [0.35, 0.35, 0.35]
    spec.visual.map.shadowclip = 4

    _add_ground(spec, build, sloping)
    if scenery is not None:
        _add_scenery(spec, scenery)
    pelvis = spec.worldbody.add_body(name="pelvis", pos=[0, 0, 1])
    pelvis.add_freejoint(name="root")
    # The sun goes along, so that the shadow's resolution is spent on the walker.
    pelvis.add_light(
        name="sun",
        mode=mujoco.mjtCamLight.mjCAMLIGHT_TRACK,
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        pos=[-1.5, -2.0, 4.0],
        dir=[0.3, 0.4, -0.85],
        diffuse=[0.6, 0.6, 0.6],
    )
    _inertial(pelvis, [0, 0, 0.02], 10.65, np.array([0.08, 0.07, 0.09]) * build.trunk_mass, build.trunk_mass)
    add_look(pelvis, [0, -0.08, 0], [0, 0.08, 0], 0.09, TROUSERS)
    for side in "rl":
        _add_leg(pelvis, side, build)
    torso = pelvis.add_body(name="torso", pos=[0, 0, 0.10])
    inertia = np.array([1.35, 1.45, 0.68]) * build.trunk_mass
    _inertial(torso, [0, 0, 0.274], 32.7, inertia, build.trunk_mass)
    for name, axis in _LUMBAR_AXES.items():
        _joint(torso, name, *axis)
    add_torso_looks(torso)
    for side in "rl":
        _add_arm(torso, side, build)
    _keep_shoes_apart(spec)

    for name, servo in SERVOS.items():
        actuator = spec.add_actuator(name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        actuator.set_to_position(kp=servo.kp, kv=servo.kv)
        actuator.forcelimited = mujoco.mjtLimited.mjLIMITED_TRUE
        actuator.forcerange = [servo.low, servo.high]
    _add_sensors(spec, mounts)
    if not looks:
        for geom in [one for one in spec.geoms if not (one.contype or one.conaffinity)]:
            spec.delete(geom)
    return spec.compile()


def _inertial(
    body: mujoco.MjsBody, position: list[float], mass: float, inertia: np.ndarray, mass_factor: float = 1.0
) -> None:
    body.explicitinertial = True
    body.ipos, body.mass, body.inertia = position, mass * mass_factor, list(inertia)


def _joint(
    body: mujoco.MjsBody,
    name: str,
    axis: tuple[int, int, int],
    limits_deg: tuple[float, float],
    damping: float,
    armature: float,
    stiffness: float,
) -> None:
    joint = body.add_joint(name=name, type=mujoco.mjtJoint.mjJNT_HINGE, axis=axis, armature=armature)
    joint.range = np.radians(limits_deg)
    joint.limited = mujoco.mjtLimited.mjLIMITED_TRUE
    joint.damping = [damping, 0, 0]
    joint.stiffness = [stiffness, 0, 0]


def _contact(build: Build) -> dict[str, Any]:
    """A sole on the ground: it resists twisting like a patch, not like a point, and hardly creeps."""
    return {
        "condim": 4,
        "friction": [build.friction, 0.06, 0.0001],
        "solref": [build.sole_time, 1.0],
        "solimp": [0.92, 0.982, 0.005, 0.5, 2.0],
    }


# A foot's bit in the contact masks of the ground that it may touch.
_TOUCHES = {"r": 1, "l": 2}


def _add_ground(spec: mujoco.MjSpec, build: Build, sloping: bool) -> None:
    """One level plane, or one for each foot: those are mocap bodies, right and left."""
    plane = {"type": mujoco.mjtGeom.mjGEOM_PLANE, "size": [0, 0, 1], "material": "paving", "conaffinity": 0}
    plane |= _contact(build)
    add_sky_and_paving(spec)
    if not sloping:
        spec.worldbody.add_geom(name="ground", contype=sum(_TOUCHES.values()), **plane)
        return
    for side, bit in _TOUCHES.items():
        under = spec.worldbody.add_body(name=f"ground_{side}", mocap=True)
        under.add_geom(name=f"ground_{side}", contype=bit, group=4, **plane)


def _add_scenery(spec: mujoco.MjSpec, ground: Ground) -> None:
    """A heightfield that is only drawn."""
    rows, columns = ground.heights.shape
    low, high = float(ground.heights.min()), float(ground.heights.max())
    span = max(high - low, 1e-3)
    half_x, half_y = (columns - 1) * ground.cell / 2, (rows - 1) * ground.cell / 2
    spec.add_hfield(
        name="scenery",
        nrow=rows,
        ncol=columns,
        size=[half_x, half_y, span, 1.0],
        userdata=((ground.heights - low) / span).astype(float).ravel(),
    )
    spec.worldbody.add_geom(
        name="scenery",
        type=mujoco.mjtGeom.mjGEOM_HFIELD,
        hfieldname="scenery",
        pos=[ground.x0 + half_x, ground.y0 + half_y, low],
        material="paving",
        contype=0,
        conaffinity=0,
    )


def _add_leg(pelvis: mujoco.MjsBody, side: str, build: Build) -> None:
    sign = -1 if side == "r" else 1  # of y
    thigh_length = 0.245 * REFERENCE_HEIGHT_M * build.thigh
    shank_length = 0.246 * REFERENCE_HEIGHT_M * build.shank

    def joints(body: mujoco.MjsBody, *names: str) -> None:
        for name in names:
            axis, limits, damping, armature, stiffness = _LEG_AXES[name]
            mirrored = axis if side == "r" else (-axis[0], axis[1], -axis[2])
            _joint(body, f"{name}_{side}", mirrored, limits, damping, armature, stiffness)

    thigh = pelvis.add_body(name=f"thigh_{side}", pos=[0, sign * HIP_HALF_WIDTH * build.hip_width, -0.06])
    inertia = np.array([0.144, 0.144, 0.03]) * build.leg_mass
    _inertial(thigh, [0, 0, -0.433 * thigh_length], 7.5, inertia, build.leg_mass)
    joints(thigh, "hip_flexion", "hip_adduction", "hip_rotation")
    add_look(thigh, [0, 0, 0], [0, 0, -thigh_length], 0.065, TROUSERS)

    shank = thigh.add_body(name=f"shank_{side}", pos=[0, 0, -thigh_length])
    inertia = np.array([0.059, 0.059, 0.006]) * build.leg_mass
    _inertial(shank, [0, 0, -0.433 * shank_length], 3.49, inertia, build.leg_mass)
    joints(shank, "knee")
    add_look(shank, [0, 0, 0], [0, 0, -shank_length + 0.03], 0.048, TROUSERS)

    foot = shank.add_body(name=f"foot_{side}", pos=[0, 0, -shank_length])
    _inertial(foot, [0.05, 0, -0.04], 1.15, np.array([0.0012, 0.005, 0.005]))
    joints(foot, "ankle", "subtalar")
    touch = {"contype": 0, "conaffinity": _TOUCHES[side], "mass": 0, "rgba": SHOE, "group": 1}
    touch |= _contact(build)
    # Two long, flat ellipsoids side by side: the shoe's sole, on which the foot rolls from heel to ball.
    sole, length = -ANKLE_HEIGHT, build.foot
    for name, y in (("in", -sign * SOLE_HALF_GAP), ("out", sign * SOLE_HALF_GAP)):
        foot.add_geom(
            name=f"sole_{name}_{side}",
            type=mujoco.mjtGeom.mjGEOM_ELLIPSOID,
            pos=[SOLE_CENTRE * length, y, sole + SOLE_RISE],
            size=[SOLE_HALF_LENGTH * length, 0.02, SOLE_RISE],
            **touch,
        )
    for y in (-0.018, 0.018):
        add_look(foot, [-0.025 * length, y * 0.6, -0.045], [0.10 * length, y, -0.053], 0.022, SHOE)
    add_look(foot, [-0.02 * length, 0, -0.03], [0.07 * length, 0, -0.04], 0.034, SHOE)
    toe = foot.add_body(name=f"toe_{side}", pos=[0.135 * length, 0, sole + 0.018])
    _inertial(toe, [0.03, 0, 0], 0.15, np.full(3, 1e-4))
    joints(toe, "toe")
    # Toes spring: they touch when the foot has rolled on to the ball.
    toe.add_geom(
        name=f"toe_{side}",
        type=mujoco.mjtGeom.mjGEOM_SPHERE,
        pos=[0.05, 0, 0.0055],
        size=[0.0178, 0, 0],
        **touch,
    )
    for y in (-0.018, 0.018):
        add_look(toe, [0.0, y, 0.004], [0.045, y / 4.5, 0.006], 0.02, SHOE)

    # Boxes round each contact, for the touch sensors.
    hidden = {"type": mujoco.mjtGeom.mjGEOM_BOX, "group": 4}
    for name, x in (("heel", -0.0275), ("ball", 0.1)):  # they part below the instep
        foot.add_site(
            name=f"{name}_{side}",
            pos=[x * length, 0, sole + 0.02],
            size=[0.06375 * length, 0.07, 0.04],
            **hidden,
        )
    toe.add_site(name=f"toe_{side}", pos=[0.055, 0, 0], size=[0.04, 0.06, 0.04], **hidden)


def _keep_shoes_apart(spec: mujoco.MjSpec) -> None:
    """Shoes push each other aside, without friction: they do not pass through each other."""
    for right in ("sole_in_r", "toe_r"):
        for left in ("sole_in_l", "toe_l"):
            spec.add_pair(geomname1=right, geomname2=left, condim=1, solref=[0.008, 1.0])


def _add_arm(torso: mujoco.MjsBody, side: str, build: Build) -> None:
    """An arm that swings at the shoulder, its elbow a little bent."""
    sign = -1 if side == "r" else 1
    x, y, z = _SHOULDER
    arm = torso.add_body(name=f"arm_{side}", pos=[x, sign * y, z])
    # Winter: centre of mass 0.530 and radius of gyration 0.368 of the 0.58 m from shoulder to wrist.
    inertia = np.array([0.171, 0.171, 0.010]) * build.trunk_mass
    _inertial(arm, [0.03, sign * 0.03, -0.308], 3.75, inertia, build.trunk_mass)
    _joint(arm, f"shoulder_{side}", *_SHOULDER_AXIS)
    elbow, wrist = [-0.01, sign * 0.045, -0.31], [0.07, sign * 0.045, -0.55]
    add_look(arm, [0, 0, 0], elbow, 0.045, SHIRT)
    add_look(arm, elbow, wrist, 0.036, SKIN)
    add_look(arm, wrist, [0.105, sign * 0.04, -0.63], 0.034, SKIN)


# Sensor layout: what control and scoring read, in this order.
SENSOR_FOOT_POSITION = slice(0, 6)  # right, left foot body (m)
SENSOR_FOOT_VELOCITY = slice(6, 12)
SENSOR_FOOT_RATE = slice(12, 18)
SENSOR_TOUCH = slice(18, 24)  # heel, ball, toe: right, left (N)
N_SENSOR = SENSOR_TOUCH.stop  # without IMUs


def sensor_imu(k: int) -> slice:
    """Where the pose of IMU number `k` (from 0) stands: position (3) m, quaternion (4), scalar first."""
    return slice(N_SENSOR + 7 * k, N_SENSOR + 7 * (k + 1))


def _add_sensors(spec: mujoco.MjSpec, mounts: Sequence[Mount]) -> None:
    body, site, kind = mujoco.mjtObj.mjOBJ_BODY, mujoco.mjtObj.mjOBJ_SITE, mujoco.mjtSensor
    for quantity in (kind.mjSENS_FRAMEPOS, kind.mjSENS_FRAMELINVEL, kind.mjSENS_FRAMEANGVEL):
        for side in "rl":
            spec.add_sensor(type=quantity, objtype=body, objname=f"foot_{side}")
    for side in "rl":
        for part in ("heel", "ball", "toe"):
            spec.add_sensor(type=kind.mjSENS_TOUCH, objtype=site, objname=f"{part}_{side}")
    for k, mount in enumerate(mounts):
        name, quaternion = f"imu_{k}", np.zeros(4)
        mujoco.mju_euler2Quat(quaternion, np.radians(mount.euler_deg[::-1]), "zyx")
        # A foot's origin is its ankle, a shank's the knee: the foot hangs at its ankle.
        ankle = np.zeros(3) if mount.segment == "foot" else spec.body(f"foot_{mount.foot[0]}").pos
        spec.body(f"{mount.segment}_{mount.foot[0]}").add_site(
            name=name,
            pos=ankle + mount.position,
            quat=quaternion,
            type=mujoco.mjtGeom.mjGEOM_BOX,
            size=[0.022, 0.012, 0.007],  # the nIMU's 45 x 23 x 13 mm
            rgba=[0.1, 0.5, 0.9, 1],
        )
        spec.add_sensor(name=f"{name}_pos", type=kind.mjSENS_FRAMEPOS, objtype=site, objname=name)
        spec.add_sensor(name=f"{name}_quat", type=kind.mjSENS_FRAMEQUAT, objtype=site, objname=name)
