"""Every derivative of the filter against finite differences, and the signs that go with it."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from footfall.conventions import heading_of, wrap
from footfall.pdr.filter import _kernels as kernels
from footfall.pdr.filter._plain import PlainFilter
from footfall.pdr.filter.ins import FilterSettings, InertialFilter
from tests.helpers.filter_walks import alignment, tossed

STEP = 1e-6
WIDE = FilterSettings(g_sensitivity=True, zaru=True)


def state(seed: int = 0) -> np.ndarray:
    """Some state (25,) of the kernels."""
    rng = np.random.default_rng(seed)
    q = Rotation.from_euler("ZYX", [1.0, 0.5, -0.3]).as_quat(scalar_first=True)
    return np.concatenate([q, rng.normal(0, 1, 6), rng.normal(0, 0.1, 6), rng.normal(0, 0.01, 9)])


def moved(x: np.ndarray, error: np.ndarray) -> np.ndarray:
    """truth = estimate with its error put right."""
    truth = x.copy()
    kernels.inject(truth, error)
    return truth


def difference(truth: np.ndarray, estimate: np.ndarray) -> np.ndarray:
    """delta = truth - estimate (24,), the attitude's in the navigation frame."""
    turn = (
        Rotation.from_quat(truth[:4], scalar_first=True)
        * Rotation.from_quat(estimate[:4], scalar_first=True).inv()
    )
    return np.concatenate(
        [truth[7:10] - estimate[7:10], truth[4:7] - estimate[4:7], turn.as_rotvec(), (truth - estimate)[10:]]
    )


def advanced(x: np.ndarray, gyro: np.ndarray, accel: np.ndarray, dt: float) -> np.ndarray:
    x = x.copy()
    none = np.empty((0, 0))
    kernels.propagate(x, np.zeros((24, 24)), none, gyro, accel, dt, np.zeros(4), np.array([1.0, 0.0, 0.0]))
    return x


def transition(x: np.ndarray, gyro: np.ndarray, accel: np.ndarray, dt: float) -> np.ndarray:
    f = np.eye(24)
    gap = np.array([1.0, 0.0, 0.0])
    kernels.propagate(x.copy(), np.zeros((24, 24)), f, gyro, accel, dt, np.zeros(4), gap)
    return f


def test_what_is_put_right_is_truth_minus_estimate():
    rng = np.random.default_rng(1)
    x, error = state(), rng.normal(0, 0.1, 24)
    np.testing.assert_allclose(difference(moved(x, error), x), error, atol=1e-12)


@pytest.mark.parametrize("dt", [0.005, 0.0025])
def test_transition(dt):
    """The paper's F is of first order in dt: what is missing falls with its square."""
    rng = np.random.default_rng(2)
    x, gyro, accel = state(), rng.normal(0, 3, 3), rng.normal(0, 10, 3)
    after = advanced(x, gyro, accel, dt)
    columns = [
        (
            difference(advanced(moved(x, STEP * e), gyro, accel, dt), after)
            - difference(advanced(moved(x, -STEP * e), gyro, accel, dt), after)
        )
        / (2 * STEP)
        for e in np.eye(24)
    ]
    missing = np.abs(np.transpose(columns) - transition(x, gyro, accel, dt))
    force = np.linalg.norm(accel)
    assert missing.max() < force * force * dt**2
    assert missing.max() > 0  # it is of first order: an exact match would be a test of nothing


def test_transitions_gather_from_the_left():
    t, gyro, accel, _ = tossed(3)
    found = InertialFilter(WIDE, alignment())
    whole, product = np.eye(24), np.eye(24)
    parts = InertialFilter(WIDE, alignment())
    moving = np.zeros(400, dtype=int)
    found.advance(t, gyro, accel, moving, whole)
    for k in range(400):
        one = np.eye(24)
        parts.advance(t[k : k + 1], gyro[k : k + 1], accel[k : k + 1], moving[k : k + 1], one)
        product = one @ product
    np.testing.assert_allclose(whole, product, rtol=1e-9, atol=1e-9)


def finite_difference(measured, x):
    """d measured(truth) / d error (m, 24) at the estimate x."""
    return np.transpose(
        [(measured(moved(x, STEP * e)) - measured(moved(x, -STEP * e))) / (2 * STEP) for e in np.eye(24)]
    )


def test_velocity_row():
    """True velocity against error: H = I on the velocity."""
    np.testing.assert_allclose(
        finite_difference(lambda truth: truth[4:7], state()), np.eye(24)[3:6], atol=1e-9
    )


def test_zero_rate_rows_and_their_sign():
    """The true rate is the sample less the true errors: what is left of it is their error."""
    gyro, accel, x = np.array([0.1, -0.2, 0.3]), np.array([1.0, 2.0, 9.0]), state()

    def rate(truth):
        return np.array(kernels.corrected(truth, gyro, accel)[1])

    plain = PlainFilter(WIDE, alignment())
    plain.accel_bias = x[10:13]
    force, _ = plain.corrected(gyro, accel)
    rows = finite_difference(rate, x)
    np.testing.assert_allclose(-rows[:, :9], 0, atol=1e-9)
    np.testing.assert_allclose(-rows[:, 12:], plain.rate_rows(force)[:, 12:], atol=1e-7)
    # The rate's dependence on the accelerometer bias by way of G is of second order in small errors.
    assert np.abs(rows[:, 9:12]).max() < 0.05


@pytest.mark.parametrize("pitch_deg", [0, 10, 20, -60])
def test_heading_row(pitch_deg):
    x = state()
    x[:4] = Rotation.from_euler("ZYX", [2.0, np.radians(pitch_deg), 0.4]).as_quat(scalar_first=True)
    found = finite_difference(lambda truth: np.array([heading_of(truth[:4])]), x)[0]
    np.testing.assert_allclose(kernels.heading_row(x), found[6:9], atol=1e-8)
    assert np.abs(np.delete(found, [6, 7, 8])).max() < 1e-9
    # The paper's [0 0 1] holds on the level only.
    off = np.hypot(*found[6:8])
    assert off == pytest.approx(np.tan(np.radians(abs(pitch_deg))), abs=1e-8)


@pytest.mark.parametrize("wrong_deg", [5.0, -5.0])
def test_a_heading_error_shrinks(wrong_deg):
    """Told the truth about its heading, the filter turns towards it."""
    start = alignment()
    found = InertialFilter(FilterSettings(heading_sd=np.radians(10)), start)
    truth = found.heading - np.radians(wrong_deg)  # error = estimate - truth
    found.correct_heading(truth - found.heading, np.radians(5))
    left = wrap(found.heading - truth)
    # 10 deg known to 5: a fifth is left.
    assert np.degrees(left) == pytest.approx(wrong_deg / 5, rel=0.01)
    assert found.heading_sd == pytest.approx(np.radians(10) / np.sqrt(5), rel=0.02)


def test_a_velocity_error_vanishes_and_takes_the_tilt_with_it():
    """Half a second tilted by 1 deg runs away sideways; standing still says so."""
    start = alignment()
    tilt = Rotation.from_rotvec(np.radians([1.0, 0, 0]))  # the estimate's: truth is turned back by it
    wrong = (tilt * Rotation.from_quat(start.quaternion, scalar_first=True)).as_quat(scalar_first=True)
    settings = FilterSettings(tilt_sd=np.radians(2.0), sigma_velocity=1e-3, estimate_accel_bias=False)
    found = InertialFilter(settings, replace(start, quaternion=wrong))
    n = 100
    gyro, force = np.tile(start.gyro_bias, (n, 1)), np.tile(start.force, (n, 1))
    found.advance(np.arange(1, n + 1) / 200, gyro, force, np.zeros(n, dtype=int))
    before = found.velocity
    assert np.hypot(*before[:2]) == pytest.approx(9.8 * np.radians(1.0) * 0.5, rel=0.01)
    found.rest()
    assert np.linalg.norm(found.velocity) < 0.02 * np.linalg.norm(before)
    up = Rotation.from_quat(found.quaternion, scalar_first=True).apply(
        start.force / np.linalg.norm(start.force)
    )
    assert np.degrees(np.arccos(up[2])) < 0.05
