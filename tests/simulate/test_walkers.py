"""The walker: mirror symmetry, no external force, falls and steering."""

from functools import partial
from importlib.resources import files
from pathlib import Path
from typing import Any
from unittest import mock

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from footfall.conventions import GRAVITY
from footfall.errors import InputError
from footfall.models.body import N_SERVOS, SENSOR_FOOT_POSITION, SENSOR_FOOT_RATE, SENSOR_TOUCH, build_body
from footfall.models.ground import GroundLookup
from footfall.models.policy import load_policy, stock_policy
from footfall.models.subject import Build, Habits
from footfall.simulate.learn.env import balance_gains
from footfall.simulate.walker._balance_kernels import Balance, balance_of, feedback
from footfall.simulate.walker._gait_kernels import targets_all
from footfall.simulate.walker._posture_kernels import land_all, posture_all
from footfall.simulate.walker.feedback import (
    GAIN_SHAPE,
    GAIN_START,
    SERVO_MIRROR,
    SERVO_SIGN,
    Gains,
    gain_records,
)
from footfall.simulate.walker.observation import MIRROR, N_OBSERVATION, SIGN
from footfall.simulate.walker.state import WALKER, Columns
from footfall.simulate.walker.walkers import N_ACTION, Walkers


def walkers(n: int = 1, timestep: float = 0.001, variability: float = 0.0) -> Walkers:
    model = build_body(Build(), timestep=timestep)
    group = Walkers([model] * n, stock_policy().feedback_gains, rng=np.random.default_rng(0))
    place(group, variability=variability)
    return group


def place(
    group: Walkers, phase: float | list[float] = 0.25, variability: float = 0.0, standing: bool = False
) -> None:
    n = group.n
    group.place(
        np.ones(n, dtype=bool),
        phase=np.full(n, phase),
        speed=np.full(n, 1.25),
        heading=np.zeros(n),
        position=np.zeros((n, 3)),
        standing=np.full(n, standing),
        variability=np.full(n, variability),
        habits=[Habits()] * n,
    )


def test_nothing_but_gravity_contact_and_joint_torques_acts() -> None:
    """At every physics step: no applied force, no constraint but contacts and joint stops, and
    momentum agrees.

    The change of the whole body's momentum must be what gravity and the ground's contact forces give.
    """
    group, policy = walkers(), stock_policy()
    model, data = group.models[0], mujoco.MjData(group.models[0])
    assert model.neq == 0
    assert model.nmocap == 0
    assert model.ntendon == 0
    assert (model.body_gravcomp == 0).all()
    mass = sum(model.body_mass)
    weight = np.array([0, 0, -mass * GRAVITY])
    force, momenta, impulses = np.zeros(6), [], []
    for _ in range(40):
        data.qpos[:], data.qvel[:] = group.qpos[0], group.qvel[0]
        data.qacc_warmstart[:] = 0  # as a rollout begins
        trace = group.step(policy(group.observe()))
        for k in range(group.substeps):
            data.ctrl[:] = trace.target[0, k]
            mujoco.mj_step(model, data)
            assert not data.qfrc_applied.any()
            assert not data.xfrc_applied.any()
            # Velocities and forces that the step leaves behind are those at its beginning.
            mujoco.mj_subtreeVel(model, data)
            momenta.append(mass * data.subtree_linvel[0])
            ground = np.zeros(3)
            for i, contact in enumerate(data.contact[: data.ncon]):
                mujoco.mj_contactForce(model, data, i, force)
                sign = 1.0 if model.geom(contact.geom1).name == "ground" else -1.0
                ground += sign * contact.frame.reshape(3, 3).T @ force[:3]
            impulses.append((ground + weight) * model.opt.timestep)
        # The walker went where these servo targets alone lead, to the last bit.
        np.testing.assert_array_equal(data.qpos, trace.qpos[0, -1])
    error = np.linalg.norm(np.diff(momenta, axis=0) - impulses[:-1], axis=1)
    assert error.max() < 0.01  # Ns (the solver stops early); the weight alone gives 0.7 a step


def test_the_policy_walks() -> None:
    """Twenty seconds of people's variability at 1.25 m/s, in a straight line, without falling."""
    group, policy = walkers(4, variability=1.0), stock_policy()
    for _ in range(667):
        group.step(policy(group.observe()))
        assert not group.fallen().any()
    distance = group.qpos[:, 0]
    assert (distance > 0.8 * 1.25 * 20).all()
    assert (distance < 1.2 * 1.25 * 20).all()


def test_without_a_policy_it_falls_and_says_so() -> None:
    group = walkers()
    group.gains = np.zeros(32)
    for _ in range(200):
        group.step(np.zeros((1, N_ACTION)))
        if group.fallen()[0]:
            return
    pytest.fail("a body without control stood for 6 s")


def test_mirrored_walkers_see_and_do_the_same() -> None:
    """A walker in left stance that mirrors one in right stance has the same observation
    and stays its mirror.
    """
    group = walkers(2)
    place(group, phase=[0.2, 0.7])
    group.turn[:] = group.turn_goal[:] = [0.3, -0.3]
    policy = stock_policy()
    for _ in range(20):
        seen = group.observe()
        np.testing.assert_allclose(seen[0], seen[1], atol=0.05)
        group.step(policy(seen))
    np.testing.assert_allclose(group.qpos[0, [0, 2]], group.qpos[1, [0, 2]], atol=2e-3)
    np.testing.assert_allclose(group.qpos[0, 1], -group.qpos[1, 1], atol=2e-3)


def test_a_walker_does_not_depend_on_its_neighbours() -> None:
    one, three, policy = walkers(1), walkers(3), stock_policy()
    for _ in range(30):
        one.step(policy(one.observe()))
        three.step(policy(three.observe()))
    np.testing.assert_allclose(one.qpos[0], three.qpos[1], atol=1e-9)


@pytest.mark.parametrize(("order", "sign"), [(MIRROR, SIGN), (SERVO_MIRROR, SERVO_SIGN)])
def test_mirroring_twice_is_nothing(order: np.ndarray, sign: np.ndarray) -> None:
    values = np.arange(1.0, len(order) + 1)
    np.testing.assert_array_equal(((values[order] * sign)[order] * sign), values)


@settings(max_examples=50)
@given(st.lists(st.floats(-1, 1), min_size=len(Balance._fields), max_size=len(Balance._fields)))
def test_feedback_is_affine_in_its_gains(values: list[float]) -> None:
    balance = Balance(*(np.array([value]) for value in values))

    def offsets(gains: np.ndarray) -> np.ndarray:
        out = np.empty((N_SERVOS, 1))
        feedback(Columns(gain_records(gains)), balance, out)
        return out

    first, second = np.array(GAIN_START), np.linspace(-1, 1, len(Gains._fields))
    together = offsets(first + second) + offsets(0 * first)
    np.testing.assert_allclose(together, offsets(first) + offsets(second), atol=1e-12)


@pytest.mark.parametrize("grade", [0.0, 0.05, 0.08])
def test_standing_stands(grade: float) -> None:
    """Ten seconds facing every way on any slope: no fall, no step, and feet that hardly turn."""
    azimuth = np.linspace(0, 2 * np.pi, 6, endpoint=False)
    up = np.column_stack([grade * np.cos(azimuth), grade * np.sin(azimuth), np.ones(6)])
    up /= np.linalg.norm(up, axis=1)[:, None]
    group, policy = walkers(6), stock_policy()
    group.models = [build_body(Build(), timestep=0.001) for _ in range(6)]
    group.up[:] = up
    for model, direction in zip(group.models, up, strict=True):
        model.opt.gravity[:] = -GRAVITY * direction
    place(group, standing=True)
    for _ in range(333):
        trace = group.step(policy(group.observe()))
    assert not group.fallen().any()
    assert (group.gate.value == 0).all()
    assert np.degrees(np.abs(trace.sensor[:, :, SENSOR_FOOT_RATE])).max() < 1.0


def slope(grade: tuple[float, float]) -> GroundLookup:
    return lambda x, y: (grade[0] * x + grade[1] * y, np.tile(grade, (len(x), 1)))


def under_tilted_gravity(grade: tuple[float, float]) -> tuple[Walkers, Rotation]:
    """A walker on level ground whose gravity makes it that slope; the turn from its frame to the slope's."""
    up = np.array([*grade, 1.0]) / np.linalg.norm([*grade, 1.0])
    tilted = walkers()
    tilted.up[:] = up
    tilted.models[0].opt.gravity[:] = -GRAVITY * up
    place(tilted)
    return tilted, Rotation.align_vectors([[0, 0, 1]], [up])[0]


def put_on_slope(sloping: Walkers, tilted: Walkers, turn: Rotation) -> None:
    """The same body in the same state, seen from the slope's frame."""
    sloping._state[:] = tilted._state
    sloping.up[:] = [0, 0, 1]
    sloping.qpos[0, :3], sloping.qvel[0, :3] = turn.apply([tilted.qpos[0, :3], tilted.qvel[0, :3]])
    attitude = turn * Rotation.from_quat(tilted.qpos[0, 3:7], scalar_first=True)
    sloping.qpos[0, 3:7] = attitude.as_quat(scalar_first=True)
    feet = turn.apply(tilted.sensor[0, SENSOR_FOOT_POSITION].reshape(2, 3))
    sloping.sensor[0, SENSOR_FOOT_POSITION] = feet.ravel()
    sloping._find_ground(sloping.qpos, sloping.sensor)
    posture_all(sloping._state)


@pytest.mark.parametrize("grade", [(0.08, 0.0), (0.0, 0.08), (0.05, -0.06)])
def test_a_slope_walks_the_same_as_level_ground_under_tilted_gravity(grade: tuple[float, float]) -> None:
    """Two seconds of physics under one and the same servo targets: in either frame a body is one."""
    (tilted, turn), policy = under_tilted_gravity(grade), stock_policy()
    model = build_body(Build(), timestep=0.001, sloping=True)
    sloping = Walkers([model], policy.feedback_gains, rng=np.random.default_rng(0), ground=slope(grade))
    for _ in range(66):
        put_on_slope(sloping, tilted, turn)
        action = policy(tilted.observe())
        target = tilted.step(action).target
        with mock.patch("footfall.simulate.walker.walkers.targets_all", partial(_follow, target)):
            trace = sloping.step(action)
        back = turn.inv().apply(trace.qpos[0, -1, :3])
        np.testing.assert_allclose(back, tilted.qpos[0, :3], atol=1e-5)
        np.testing.assert_allclose(trace.qpos[0, -1, 7:], tilted.qpos[0, 7:], atol=1e-4)
        loads = trace.sensor[0, -1, SENSOR_TOUCH]
        np.testing.assert_allclose(loads, tilted.sensor[0, SENSOR_TOUCH], atol=5.0)


def _follow(
    target: np.ndarray, state: np.ndarray, reference: Any, start: np.ndarray, out: np.ndarray
) -> None:
    """In the place of the walker's own servo targets."""
    targets_all(state, reference, start, out)
    out[:] = target


@pytest.mark.parametrize("grade", [(0.08, 0.0), (0.0, 0.08), (0.05, -0.06)])
def test_a_slope_looks_the_same_as_level_ground_under_tilted_gravity(grade: tuple[float, float]) -> None:
    """Training tilts gravity, walks tilt the ground: in either frame a body is one to the laws."""
    (tilted, turn), policy = under_tilted_gravity(grade), stock_policy()
    sloping = walkers()
    sloping.ground = slope(grade)
    for _ in range(40):
        action = policy(tilted.observe())
        tilted.step(action)
        put_on_slope(sloping, tilted, turn)
        np.testing.assert_allclose(sloping.observe(), tilted.observe(), atol=0.03)
        one, other = (balance_of(Columns(group._state)) for group in (sloping, tilted))
        np.testing.assert_allclose(np.stack(one), np.stack(other), atol=0.012)


def test_it_starts_from_standing() -> None:
    """From a stand to walking speed within three seconds, at people's variability."""
    group, policy = walkers(4), stock_policy()
    place(group, variability=1.0, standing=True)
    for step in range(int(7 / 0.03)):
        if step == 100:
            group.speed_goal[:] = 1.2
        group.step(policy(group.observe()))
        assert not group.fallen().any()
    assert (group.mean_velocity[:, 0] > 0.9).all()


@pytest.mark.parametrize(("speed", "goal"), [(1.5, 0.0), (0.5, 1.6)])
def test_whoever_follows_a_changing_command_is_on_average_neither_late_nor_early(
    speed: float, goal: float
) -> None:
    """A plain mean of the velocity lags: a walker in braking then seems too fast, and brakes too much."""
    state = np.zeros(1, WALKER)
    state["dt"], state["gate"], state["speed"], state["speed_goal"] = 0.03, 1.0, speed, goal
    state["qpos"][:, 3], state["up"], state["mean_velocity"][:, 0] = 1.0, [0, 0, 1], speed
    after = np.zeros((1, 1, 1 + state["qpos"].shape[1] + state["qvel"].shape[1]))
    after[..., 4] = 1.0
    sensor = np.zeros((1, 1, state["sensor"].shape[1]))
    for _ in range(60):
        after[..., 1 + state["qpos"].shape[1]] = state["speed"]
        land_all(state, after, sensor)
        assert state["mean_velocity"][0, 0] == pytest.approx(state["speed"][0], abs=0.02)
    assert state["speed"][0] != speed


def test_touch_sensors_carry_the_body() -> None:
    """Averaged over strides, the ground carries the weight."""
    group, policy = walkers(), stock_policy()
    load = []
    for _ in range(600):
        trace = group.step(policy(group.observe()))
        load.append(trace.sensor[0, :, SENSOR_TOUCH].sum(axis=-1).mean())
    weight = sum(group.models[0].body_mass) * GRAVITY
    assert np.mean(load[200:]) == pytest.approx(weight, rel=0.03)


def test_a_control_step_that_is_no_multiple_of_the_physics_is_refused() -> None:
    with pytest.raises(ValueError, match=r"physics steps of 0.02 s are no control interval"):
        walkers(timestep=0.02)


def test_the_shipped_policy_fits_the_walker() -> None:
    policy = stock_policy()
    assert policy(np.zeros((3, N_OBSERVATION))).shape == (3, N_ACTION)
    assert policy.feedback_gains.shape == (32,)
    assert {"seed", "samples"} <= set(policy.meta)


def test_weights_and_gains_of_another_walker_are_refused(tmp_path: Path) -> None:
    source = Path(str(files("footfall.models") / "weights" / "walker.npz"))
    with np.load(source) as data:
        arrays = dict(data)
    assert arrays["feedback_gains"].shape == GAIN_SHAPE
    arrays["feedback_gains"] = arrays["feedback_gains"][:30]
    np.savez(tmp_path / "old.npz", **arrays)
    with pytest.raises(InputError, match=r"old.npz: not a walker policy \(feedback gains \(30,\), expected"):
        load_policy(tmp_path / "old.npz")
    with pytest.raises(InputError, match=r"feedback_gains \(30,\): expected \(32,\), finite"):
        balance_gains(np.zeros(30))


def test_observations_and_actions_of_another_layout_are_refused() -> None:
    with pytest.raises(ValueError, match=r"observations \(1, 7\), expected"):
        stock_policy()(np.zeros((1, 7)))
    with pytest.raises(ValueError, match=r"actions \(2, 3\), expected \(2, 17\)"):
        walkers(2).step(np.zeros((2, 3)))


def test_a_file_that_is_no_policy_is_refused(tmp_path: Path) -> None:
    bad = tmp_path / "weights.npz"
    np.savez(bad, nothing=np.zeros(3))
    with pytest.raises(InputError, match="not a walker policy"):
        load_policy(bad)
    with pytest.raises(InputError, match=r"absent\.npz"):
        load_policy(tmp_path / "absent.npz")
