"""The body: masses, mirror symmetry, and nothing but contact and gravity acting on it."""

import math

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from footfall.errors import InputError
from footfall.models.body import JOINTS, N_JOINTS, SERVO_JOINT, SERVOS, build_body, sensor_imu
from footfall.models.gait import TABLE, reference_angles
from footfall.models.mount import MOUNTS, Mount
from footfall.models.route import Ground
from footfall.models.subject import Build, Subject, draw_subject

STEP = 0.001


def test_the_reference_body_has_the_reference_mass_and_legs() -> None:
    model = build_body(Build(), timestep=STEP)
    assert sum(model.body_mass) == pytest.approx(75.0, rel=0.01)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    leg = data.body("pelvis").xpos[2] - data.body("foot_r").xpos[2]
    assert leg == pytest.approx((0.245 + 0.246) * 1.75 + 0.06, rel=1e-9)


def test_a_heavier_person_of_the_same_height_has_a_heavier_trunk() -> None:
    light, heavy = Subject("a", mass_kg=60.0), Subject("b", mass_kg=95.0)
    assert heavy.build.trunk_mass > 1 > light.build.trunk_mass
    # A taller person of the same body-mass index is the same body, enlarged.
    tall = Subject("c", height_m=1.90, mass_kg=75.0 * (1.90 / 1.75) ** 2)
    assert tall.build.trunk_mass == pytest.approx(1.0)
    assert tall.time_scale == pytest.approx(np.sqrt(1.90 / 1.75))


@pytest.mark.parametrize("height", [1.50, 1.75, 1.95])
def test_a_sole_takes_the_time_that_it_takes_whoever_wears_it(height: float) -> None:
    """The walk of the simulated body is stretched by `time_scale`: so is what its sole does."""
    subject = Subject("a", height_m=height, sole_time_s=0.02)
    assert subject.build.sole_time * subject.time_scale == pytest.approx(0.02)
    model = build_body(subject.build, timestep=STEP)
    assert model.geom("sole_in_r").solref[0] == pytest.approx(0.02 / subject.time_scale)


@given(st.integers(0, 10_000))
def test_drawn_people_can_all_walk(seed: int) -> None:
    subject = draw_subject(np.random.default_rng(seed))
    assert 1.50 <= subject.height_m <= 1.95
    assert 50 <= subject.mass_kg <= 100
    assert subject == draw_subject(np.random.default_rng(seed))


@settings(max_examples=30)
@given(st.lists(st.floats(-0.5, 0.5), min_size=N_JOINTS, max_size=N_JOINTS))
def test_the_body_is_its_own_mirror_image(angles: list[float]) -> None:
    """Mirrored joint angles put each foot where the mirror image of the other one is."""
    from footfall.simulate.walker.feedback import JOINT_MIRROR, JOINT_SIGN

    model = build_body(Build(), timestep=STEP)
    data = mujoco.MjData(model)
    q = np.array(angles)
    feet = []
    for joints in (q, (q[JOINT_MIRROR] * JOINT_SIGN)):
        data.qpos[:7] = [0, 0, 1, 1, 0, 0, 0]
        data.qpos[7:] = joints
        mujoco.mj_kinematics(model, data)
        feet.append(
            (data.body("toe_r").xpos.copy(), data.body("toe_l").xpos.copy(), data.body("torso").xpos.copy())
        )
    mirror = np.array([1, -1, 1])
    np.testing.assert_allclose(feet[0][0], feet[1][1] * mirror, atol=1e-12)
    np.testing.assert_allclose(feet[0][2], feet[1][2] * mirror, atol=1e-12)


def test_servos_name_their_joints_in_order() -> None:
    model = build_body(Build(), timestep=STEP)
    assert [model.actuator(i).name for i in range(model.nu)] == list(SERVOS)
    assert [model.joint(i + 1).name for i in range(model.njnt - 1)] == list(JOINTS)
    for i, name in enumerate(SERVOS):
        assert JOINTS[SERVO_JOINT[i]] == name


def test_servo_torques_are_limited() -> None:
    model = build_body(Build(), timestep=STEP)
    data = mujoco.MjData(model)
    data.ctrl[:] = 100.0  # an absurd target
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.actuator_force, [servo.high for servo in SERVOS.values()])


def test_the_reference_gait_is_symmetric_and_periodic() -> None:
    """The left leg does what the right leg did half a stride before."""
    phase = np.linspace(0, 0.999, 200)
    here = reference_angles(phase, np.full(200, 1.25))
    there = reference_angles((phase + 0.5) % 1, np.full(200, 1.25))
    np.testing.assert_allclose(here[:, 3:9], there[:, 9:15], atol=1e-12)
    assert np.abs(np.diff(np.vstack([TABLE, TABLE[:1]]), axis=0)).max() < np.radians(1.2)


def test_the_reference_foot_is_flat_in_mid_stance() -> None:
    """From 10 to 35 % of the stride the sole stays within 4 deg of level."""
    phase = np.linspace(0.12, 0.35, 30)
    angles = reference_angles(phase, np.full(30, 1.25))
    foot_pitch = angles[:, 3] - angles[:, 6] + angles[:, 7]
    assert np.degrees(np.abs(foot_pitch)).max() < 4


@pytest.mark.parametrize("sloping", [False, True])
def test_what_is_only_seen_changes_no_bit(sloping: bool) -> None:
    """The simulated body without its looks moves as the one that is drawn; all that touches is in both."""
    bare, dressed = (
        build_body(Build(), timestep=STEP, sloping=sloping, looks=looks) for looks in (False, True)
    )
    touching = (dressed.geom_contype | dressed.geom_conaffinity) != 0
    assert bare.ngeom == touching.sum() < dressed.ngeom
    states = []
    for model in (bare, dressed):
        data, rng = mujoco.MjData(model), np.random.default_rng(1)
        data.qpos[2] = 1.0
        for _ in range(300):
            data.ctrl[:] = rng.normal(0, 0.3, model.nu)
            mujoco.mj_step(model, data)
        assert data.ncon > 0
        states.append(np.concatenate([data.qpos, data.qvel, data.sensordata]))
    np.testing.assert_array_equal(*states)


def test_scenery_is_drawn_at_its_height_and_touches_nothing() -> None:
    """The ground that is seen is where the grid says, also off its nodes."""
    x = np.arange(0, 20.01, 0.5)
    heights = np.tile(0.05 * x, (41, 1)).astype(np.float32)
    model = build_body(
        Build(), timestep=STEP, sloping=True, looks=True, scenery=Ground(-5.0, -10.0, 0.5, heights)
    )
    scenery = model.geom("scenery")
    assert not scenery.contype.any()
    assert not scenery.conaffinity.any()
    data = mujoco.MjData(model)
    geom = np.zeros(1, dtype=np.int32)
    for at in (-3.2, 0.0, 4.71):
        start = np.array([at, 1.3, 5.0])
        mujoco.mj_forward(model, data)
        distance = mujoco.mj_ray(model, data, start, np.array([0, 0, -1.0]), None, 1, -1, geom)
        assert start[2] - distance == pytest.approx(0.05 * (at + 5), abs=1e-5)


def test_mounts_give_imu_sensors_on_their_leg() -> None:
    model = build_body(Build(shank=1.1), timestep=STEP, mounts=tuple(MOUNTS.values()))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    for k, mount in enumerate(MOUNTS.values()):
        ankle = data.body(f"foot_{mount.foot[0]}").xpos
        pose = data.sensordata[sensor_imu(k)]
        np.testing.assert_allclose(pose[:3] - ankle, mount.position, atol=1e-12)
        turned = Rotation.from_euler("ZYX", mount.euler_deg[::-1], degrees=True)
        assert (Rotation.from_quat(pose[3:], scalar_first=True).inv() * turned).magnitude() < 1e-9
        assert data.sensor(f"imu_{k}_pos").data.tolist() == pose[:3].tolist()


def test_the_shank_bends_at_the_ankle_below_its_imu() -> None:
    shank, instep = MOUNTS["shank-left"], MOUNTS["instep-left"]
    model = build_body(Build(), timestep=STEP, mounts=(shank, instep))
    data = mujoco.MjData(model)
    poses = []
    for angle in (0.0, 0.3):
        data.joint("ankle_l").qpos = angle
        mujoco.mj_forward(model, data)
        poses.append([data.sensordata[sensor_imu(k)].copy() for k in (0, 1)])
    assert poses[0][0].tolist() == poses[1][0].tolist()
    assert np.linalg.norm(poses[1][1][:3] - poses[0][1][:3]) == pytest.approx(
        2 * math.sin(0.15) * math.hypot(*instep.position), rel=1e-6
    )


def test_the_rest_of_a_shank_is_that_of_its_foot() -> None:
    assert [mount.on_foot for mount in MOUNTS.values()] == [
        *(MOUNTS[name] for name in ("instep", "medial", "heel", "instep-left", "instep", "instep-left"))
    ]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"height_m": 2.2}, "height_m = 2.2 is outside"),
        ({"mass_kg": float("nan")}, "mass_kg = nan is outside"),
        ({"friction": 0.0}, "friction = 0 is outside"),
    ],
)
def test_bodies_that_the_walker_cannot_carry_are_refused(change: dict, message: str) -> None:
    with pytest.raises(InputError, match=message):
        Subject("odd", **change)


def test_a_mount_on_no_foot_is_refused() -> None:
    with pytest.raises(InputError, match="foot = 'middle'"):
        Mount(foot="middle")
    with pytest.raises(InputError, match="segment = 'thigh', expected 'foot' or 'shank'"):
        Mount(segment="thigh")
    with pytest.raises(InputError, match="finite"):
        Mount(position=(0.0, float("nan"), 0.0))
