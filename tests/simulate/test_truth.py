"""IMU truth from pose increments: integrating it must give the poses back."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from footfall.conventions import GRAVITY, heading_of
from footfall.errors import InputError
from footfall.pdr.strapdown import integrate
from footfall.runs import runs
from footfall.simulate._truth_kernels import increments
from footfall.simulate.truth import ImuTruth, at_rest, divisor, imu_truth

STEP = 0.001


def swinging_foot(duration: float) -> tuple[np.ndarray, np.ndarray]:
    """Pose of a foot-like motion: surge, lift, pitching past 85 deg, coning, slow turn."""
    t = np.arange(0, duration, STEP)
    w = 2 * np.pi * 0.9
    position = np.column_stack(
        [1.2 * t - 0.2 * np.sin(w * t), 0.05 * np.sin(w * t + 0.4), 0.1 * (1 - np.cos(w * t)) / 2]
    )
    angles = np.column_stack(
        [0.1 * t + 0.1 * np.sin(w * t + 1), 0.5 + 1.1 * np.sin(w * t), 0.15 * np.sin(2 * w * t)]
    )
    return position, Rotation.from_euler("ZYX", angles).as_quat(scalar_first=True)


@pytest.mark.parametrize(("factor", "bound"), [(1, 1e-4), (2, 5e-4), (5, 5e-4), (10, 2e-3)])
def test_integrating_the_truth_returns_the_poses(factor: int, bound: float) -> None:
    position, quaternion = swinging_foot(120.0)
    truth = imu_truth(position, quaternion, STEP, factor)
    t = np.arange(len(truth.index)) * factor * STEP
    out = integrate(
        t,
        truth.gyro,
        truth.accel,
        quaternion=truth.quaternion[0],
        velocity=truth.velocity[0],
        position=truth.position[0],
    )
    assert np.linalg.norm(out.position - position[truth.index], axis=1).max() < bound
    same = np.abs((out.quaternion * quaternion[truth.index]).sum(axis=1))
    assert same.min() > 1 - 1e-12


def test_a_still_imu_reads_gravity_and_no_rate() -> None:
    attitude = Rotation.from_euler("ZYX", [0.3, 0.4, -0.2])
    quaternion = np.tile(attitude.as_quat(scalar_first=True), (100, 1))
    truth = imu_truth(np.ones((100, 3)), quaternion, STEP, 5)
    np.testing.assert_allclose(truth.gyro, 0, atol=1e-12)
    np.testing.assert_allclose(
        truth.accel, np.tile(attitude.inv().apply([0, 0, GRAVITY]), (len(truth.gyro), 1))
    )


def test_a_constant_spin_is_read_exactly() -> None:
    rate = np.array([0.3, -0.5, 0.8])
    t = np.arange(400) * STEP
    quaternion = Rotation.from_rotvec(rate * t[:, None]).as_quat(scalar_first=True)
    truth = imu_truth(np.zeros((400, 3)), quaternion, STEP, 4)
    np.testing.assert_allclose(truth.gyro, np.tile(rate, (len(truth.gyro), 1)), atol=1e-12)


@pytest.mark.parametrize("rate", [300.0, 0.0, -200.0, 2000.0])
def test_a_rate_that_does_not_divide_the_physics_is_refused(rate: float) -> None:
    with pytest.raises(InputError, match=r"does not divide the physics rate of 1000 Hz"):
        divisor(STEP, rate)


def test_rates_that_divide() -> None:
    assert [divisor(STEP, rate) for rate in (1000, 500, 250, 200, 100)] == [1, 2, 4, 5, 10]


def test_too_short_a_record_is_refused() -> None:
    with pytest.raises(InputError, match="too few"):
        imu_truth(np.zeros((4, 3)), np.tile([1.0, 0, 0, 0], (4, 1)), STEP, 5)


def test_rest_needs_load_slowness_and_length() -> None:
    n = 1000
    quaternion = np.tile([1.0, 0, 0, 0], (n, 1))
    position = np.zeros((n, 3))
    position[500:, 0] = np.arange(500) * STEP * 1.0  # 1 m/s from half-way on
    truth = imu_truth(position, quaternion, STEP, 5)
    contact = np.ones(len(truth.index))
    rest = at_rest(truth, contact, 5 * STEP)
    assert rest[truth.index < 480].all()
    assert not rest[truth.index > 520].any()
    assert not at_rest(truth, np.zeros_like(contact), 5 * STEP).any()
    brief = (truth.index > 100) & (truth.index < 140)  # 40 ms of load
    assert not at_rest(truth, brief.astype(float), 5 * STEP).any()


def moving(speed: float = 0.0, rate: float = 0.0, n: int = 100) -> ImuTruth:
    """An IMU that travels at `speed` (m/s) and turns at `rate` (rad/s), aslant to every axis."""
    still, aslant = np.zeros((n, 3)), np.array([2.0, -1.0, 2.0]) / 3
    upright = np.tile([1.0, 0, 0, 0], (n, 1))
    return ImuTruth(np.arange(n), still, upright, still + speed * aslant, still + rate * aslant, still)


@pytest.mark.parametrize(
    ("truth", "load", "resting"),
    [
        (moving(speed=0.19), 1.0, True),
        (moving(speed=0.21), 1.0, False),  # a foot that is put down still rolls and slides by less
        (moving(rate=1.15), 1.0, True),
        (moving(rate=1.25), 1.0, False),
        (moving(), 0.021, True),
        (moving(), 0.019, False),
    ],
)
def test_where_rest_ends(truth: ImuTruth, load: float, resting: bool) -> None:
    """0.20 m/s, 1.2 rad/s and 2 % of the body weight."""
    assert (at_rest(truth, np.full(100, load), 0.005) == resting).all()


def rest_of(*stretches: tuple[int, int], n: int = 100) -> np.ndarray:
    """Where the foot rests, of which nothing but the load says that it does: from and to samples of 5 ms."""
    load = np.zeros(n)
    for start, end in stretches:
        load[start:end] = 1.0
    return at_rest(moving(n=n), load, 0.005)


def test_a_twitch_of_less_than_40_ms_is_bridged() -> None:
    assert runs(rest_of((20, 40), (47, 80))).tolist() == [[20, 80]]
    assert runs(rest_of((20, 40), (49, 80))).tolist() == [[20, 40], [49, 80]]


def test_nothing_is_bridged_beyond_the_record() -> None:
    """The foot may come from a swing, or go into one, that the record does not show."""
    assert runs(rest_of((3, 97))).tolist() == [[3, 97]]
    assert runs(rest_of((0, 1), (3, 97), (99, 100))).tolist() == [[0, 100]]


def test_a_rest_of_less_than_60_ms_is_none() -> None:
    assert runs(rest_of((20, 31), (60, 73))).tolist() == [[60, 73]]


def test_twitches_are_bridged_before_short_rests_are_dropped() -> None:
    assert runs(rest_of((20, 30), (34, 44))).tolist() == [[20, 44]]


def test_heading_is_unwrapped() -> None:
    yaw = np.linspace(0, 4 * np.pi, 50)
    quaternion = Rotation.from_euler("ZYX", np.column_stack([yaw, 0.3 + 0 * yaw, 0 * yaw])).as_quat(
        scalar_first=True
    )
    np.testing.assert_allclose(heading_of(quaternion), yaw, atol=1e-12)


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from([0.0, 1e-13, 1e-9, 1e-3, 0.5, 2.5]))
def test_the_increments_are_their_twin(seed: int, turning: float) -> None:
    """The compiled increments against scipy's rotations, from no turn at all to large ones."""
    rng, n = np.random.default_rng(seed), 20
    steps = Rotation.from_rotvec(turning * rng.normal(size=(n, 3)) / np.sqrt(3))
    attitude = [Rotation.random(rng=rng)]
    for step in steps:
        attitude.append(attitude[-1] * step)
    quaternion = np.array([one.as_quat(scalar_first=True) for one in attitude])
    quaternion *= rng.choice([-1.0, 1.0], (n + 1, 1))  # both signs say the same attitude
    gained = rng.normal(size=(n, 3))
    turn, force = increments(quaternion, gained)
    attitudes = Rotation.from_quat(quaternion, scalar_first=True)
    expected = (attitudes[:-1].inv() * attitudes[1:]).as_rotvec()
    middle = attitudes[:-1] * Rotation.from_rotvec(expected / 2)
    np.testing.assert_allclose(turn, expected, rtol=0, atol=1e-12)
    np.testing.assert_allclose(force, middle.inv().apply(gained), rtol=0, atol=1e-12)
