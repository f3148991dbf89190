"""The die behind the air."""

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.models.imu import TemperatureProfile

T = np.arange(0, 1200, 0.5)
TAU = 600.0


def test_out_of_the_warm_the_die_cools_exponentially():
    die = TemperatureProfile.step(20.0, -5.0).die(T, TAU)
    np.testing.assert_allclose(die, -5 + 25 * np.exp(-T / TAU), rtol=0, atol=1e-10)


def test_behind_a_ramp_it_lags_by_the_time_constant():
    """T' = (A - T)/tau with A = r t and T(0) = 0 gives r (t - tau (1 - exp(-t/tau)))."""
    rate = 0.02
    die = TemperatureProfile(0.0, (0.0, 2000.0), (0.0, 2000 * rate)).die(T, TAU)
    np.testing.assert_allclose(die, rate * (T - TAU * (1 - np.exp(-T / TAU))), rtol=0, atol=1e-10)


def test_the_sampling_rate_makes_no_difference():
    profile = TemperatureProfile(21.0, (0.0, 300.0, 700.0), (18.0, -4.0, 2.0))
    fine = profile.die(np.arange(0, 1200, 0.05), TAU)
    np.testing.assert_allclose(profile.die(T, TAU), fine[::10], rtol=0, atol=1e-9)


def test_the_die_sets_out_at_the_records_first_stamp():
    die = TemperatureProfile.step(20.0, -5.0).die(T + 300.0, TAU)
    np.testing.assert_allclose(die, -5 + 25 * np.exp(-T / TAU), rtol=0, atol=1e-10)


def test_instants_may_be_close_together():
    """A door that opens: 10 degC down within a tenth of a second."""
    profile = TemperatureProfile(20.0, (10.0, 10.1), (20.0, 10.0))
    die = profile.die(np.arange(0, 20, 0.05), 5.0)
    assert die[-1] == pytest.approx(10 + 10 * np.exp(-(19.95 - 10.05) / 5.0), abs=1e-3)


def test_a_steady_die_stays_exactly_where_it_is():
    assert (TemperatureProfile.steady(21.7).die(T, TAU) == 21.7).all()


def test_without_a_lag_the_die_is_the_air():
    profile = TemperatureProfile(20.0, (100.0, 200.0), (10.0, 0.0))
    np.testing.assert_array_equal(profile.die(np.array([0.0, 100.0, 150.0, 500.0]), 0.0), [10, 10, 5, 0])


@pytest.mark.parametrize(
    ("time", "ambient", "reason"),
    [((), (), "at least one"), ((0.0, 1.0), (5.0,), "2 instants"), ((0.0, 0.0), (5.0, 6.0), "increase"),
     ((0.0,), (float("nan"),), "finite")],
)  # fmt: skip
def test_a_bad_profile_is_refused(time, ambient, reason):
    with pytest.raises(InputError, match=reason):
        TemperatureProfile(20.0, time, ambient)
