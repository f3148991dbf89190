"""Strapdown returns the poses that the samples were made from."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from footfall.conventions import GRAVITY, heading_of
from footfall.errors import InputError
from footfall.pdr import _kernels, _plain
from footfall.pdr.strapdown import integrate
from tests.helpers.synthetic_foot import increments, walk


def strapdown_error(truth, gyro, accel):
    found = integrate(
        truth.t,
        gyro,
        accel,
        quaternion=truth.quaternion[0],
        velocity=truth.velocity[0],
        position=truth.position[0],
    )
    return np.linalg.norm(found.position - truth.position, axis=1).max(), found


@pytest.mark.parametrize(("rate", "jitter"), [(200.0, 0.0), (400.0, 0.0), (200.0, 0.5)])
def test_perfect_samples_return_the_walked_poses(rate, jitter):
    truth = walk(np.linspace(0, 2, 60), still_s=2.0, rate=rate, jitter=jitter)
    error, found = strapdown_error(truth, truth.gyro, truth.accel)
    assert error < 1e-8
    same = np.abs(np.sum(found.quaternion * truth.quaternion, axis=1))
    assert np.abs(same - 1).max() < 1e-12


def test_the_half_rotation_matters():
    """Samples resolved at the start of the interval instead of its middle walk away."""
    truth = walk(np.zeros(60), still_s=2.0)
    attitude = Rotation.from_quat(truth.quaternion, scalar_first=True)
    force = truth.accel.copy()
    force[1:] = attitude[:-1].inv().apply((np.diff(truth.velocity, axis=0)) * 200.0 + [0, 0, GRAVITY])
    error, _ = strapdown_error(truth, truth.gyro, force)
    assert error > 1.0


def test_compiled_equals_plain():
    rng = np.random.default_rng(3)
    t = np.cumsum(rng.uniform(0.002, 0.01, 300))
    gyro, accel = rng.normal(0, 3, (300, 3)), rng.normal(0, 20, (300, 3))
    q0 = Rotation.random(rng=rng).as_quat(scalar_first=True)
    v0, p0 = rng.normal(size=3), rng.normal(size=3)
    compiled = _kernels.integrate(t, gyro, accel, q0, v0, p0)
    plain = _plain.integrate(t, gyro, accel, q0, v0, p0)
    sign = np.sign(np.sum(compiled[0] * plain[0], axis=1))[:, None]
    np.testing.assert_allclose(compiled[0] * sign, plain[0], atol=1e-12)
    np.testing.assert_allclose(compiled[1], plain[1], atol=1e-10)
    np.testing.assert_allclose(compiled[2], plain[2], atol=1e-10)


def test_free_fall_and_rest_in_closed_form():
    t = np.linspace(0, 2, 201)
    still, up = np.zeros((201, 3)), np.tile([0, 0, GRAVITY], (201, 1))
    fallen = integrate(t, still, still, velocity=(1, 0, 0)).position
    np.testing.assert_allclose(fallen[:, 2], -GRAVITY * t**2 / 2, atol=1e-12)
    np.testing.assert_allclose(fallen[:, 0], t, atol=1e-12)
    assert np.abs(integrate(t, still, up).position).max() < 1e-12


def test_turning_on_the_spot_turns_the_heading():
    t = np.linspace(0, 4, 801)
    gyro, up = np.tile([0, 0, 0.7], (801, 1)), np.tile([0, 0, GRAVITY], (801, 1))
    np.testing.assert_allclose(heading_of(integrate(t, gyro, up).quaternion), 0.7 * t, atol=1e-12)


def test_trap_10_half_interval_positions_at_an_odd_ratio():
    """200 Hz from 1 kHz: half an interval is 2.5 samples, so its position is the mean of two."""
    fine = walk(np.zeros(60), still_s=2.0, rate=1000.0)
    coarse = np.arange(5, len(fine.t) - 5, 5)
    dt = 5 / 1000.0

    def returned_to(ahead, behind):
        velocity = (ahead - behind) / dt
        quaternion = fine.quaternion[coarse]
        gyro, accel = increments(fine.t[coarse], fine.position[coarse], quaternion, velocity)
        found = integrate(
            fine.t[coarse],
            gyro,
            accel,
            quaternion=quaternion[0],
            velocity=velocity[0],
            position=fine.position[coarse[0]],
        )
        return np.linalg.norm(found.position - fine.position[coarse], axis=1)[-1]

    p = fine.position
    right = returned_to((p[coarse + 2] + p[coarse + 3]) / 2, (p[coarse - 2] + p[coarse - 3]) / 2)
    wrong = returned_to(p[coarse + 3], p[coarse - 3])
    assert right < 1e-4
    assert wrong > 1.0


def test_a_start_attitude_that_is_no_rotation_is_refused():
    with pytest.raises(InputError, match="length 1"):
        integrate(np.arange(2.0), np.zeros((2, 3)), np.zeros((2, 3)), quaternion=(1, 1, 0, 0))
