"""What HDR does to straights, corners, arcs and drift."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from footfall.hdr.hdr import HdrParams, trace
from tests.helpers.synthetic_foot import footfalls

DEG = np.pi / 180
T = 1.1


def sway(n, seed=0):
    """Raw rate of a foot whose stance yaw scatters 2 deg about a straight path."""
    yaw = 2 * DEG * np.random.default_rng(seed).standard_normal(n + 1)
    return np.diff(yaw) / T


@pytest.mark.parametrize("drift_deg_s", [0.15, 0.05, -0.1, -0.2])
@pytest.mark.parametrize("swaying", [False, True])
def test_constant_drift_on_a_straight_is_cancelled(drift_deg_s, swaying):
    """-I settles on the drift: the sum of errors stops growing."""
    drift = drift_deg_s * DEG
    rate = np.full(1000, drift) + (sway(1000) if swaying else 0.0)
    found = trace(footfalls(rate, T))
    late = slice(500, None)
    assert np.mean(-found.integrator[late]) == pytest.approx(drift, abs=0.005 * DEG)
    uncorrected = drift * T * 1000
    slope = np.polyfit(np.arange(500), found.heading[501:], 1)[0] / T
    assert abs(slope) < HdrParams().i_c
    assert abs(found.heading[-1]) < 0.25 * abs(uncorrected)


def test_without_drift_a_straight_stays_straight():
    found = trace(footfalls(np.zeros(200), T))
    assert (found.heading == 0).all()  # sign(0) = 0
    assert (found.integrator == 0).all()
    errors = [trace(footfalls(sway(1000, seed), T)).heading[-1] / DEG for seed in range(20)]
    assert np.std(errors) < 8.0


def test_a_drift_beyond_the_threshold_locks_hdr_out_for_ever():
    drift = 0.6 * DEG
    found = trace(footfalls(np.full(2000, drift), T))
    assert (found.attenuator[200:] == 0).all()
    assert (np.diff(found.integrator[200:]) == 0).all()
    assert found.heading[-1] > 0.7 * drift * T * 2000
    free = trace(footfalls(np.full(2000, drift), T), HdrParams.from_degrees(theta_w_deg_s=1.0))
    assert abs(free.heading[-1]) < 0.1 * found.heading[-1]


def test_a_corner_suspends_the_controller_and_keeps_its_angle():
    rate = np.zeros(200)
    rate[50:53] = 30 * DEG / T
    found = trace(footfalls(rate, T))
    assert (found.attenuator[52:75] == 0).all()
    assert found.heading[-1] == pytest.approx(np.pi / 2, abs=5 * DEG)
    # The basic controller has nothing to suspend it: it acts in the corner as on a straight.
    assert np.abs(np.diff(trace(footfalls(rate, T), HdrParams.basic(0.01 * DEG)).integrator))[51:53].min() > 0


def arc(radius, speed, length=500.0):
    """A straight, an arc to the left and a straight."""
    turning = int(length / speed / T)
    rate = np.concatenate([np.zeros(100), np.full(turning, speed / radius), np.zeros(100)])
    return footfalls(rate, T, speed), turning * T * speed / radius


def test_trap_9_what_is_taken_for_drift_is_decided_by_speed_over_radius():
    """theta_w works through v/R: an arc of R > v/theta_w is erased, a tighter one is left alone."""
    params = HdrParams()
    assert params.erased_radius(1.5) == pytest.approx(344, abs=1)

    def kept(radius, speed):
        walk, turned = arc(radius, speed)
        return trace(walk, params).heading[-1] / turned

    assert abs(kept(900.0, 1.5)) < 0.35
    assert kept(100.0, 1.5) > 0.9
    # The same arc, walked fast or slowly, is a curve or a straight.
    assert kept(250.0, 1.8) > kept(250.0, 0.6) + 0.5


@given(st.integers(0, 2**32 - 1))
def test_the_controller_takes_one_footfall_to_act(seed):
    """I_i uses w_{i-1}: the first increment comes with the second stride."""
    rng = np.random.default_rng(seed)
    rate = np.full(5, rng.choice([-1, 1]) * rng.uniform(0.01, 0.2) * DEG)
    found = trace(footfalls(rate, T))
    assert found.integrator[1] == 0
    assert found.integrator[2] == pytest.approx(
        -np.sign(rate[0]) * (1 - abs(found.rate[1]) / (0.25 * DEG)) * 0.007 * DEG
    )
