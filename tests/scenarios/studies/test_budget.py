"""Units whose drift is scaled cause by cause, beside units that are recorded with those errors."""

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.hdr.hdr import NOTHING, HdrParams, HdrSets, heading_errors, headings
from footfall.hdr.methods import METHODS
from footfall.models.imu import load_spec
from footfall.pdr.footfalls import Footfalls
from footfall.pdr.track import Track
from footfall.scenarios.studies.budget import METRICS, Surrogate, case_of, linear, scaled_cause
from footfall.scenarios.trial import perform
from footfall.simulate.budget import DriftBudget
from tests.helpers.synthetic import synthetic_walk

RNG = np.random.default_rng(5)
NIMU = load_spec("nimu")
G, HEAT = "imu.gyro.g_sensitivity_sigma_deg_s_g", "imu.gyro.temperature_sigma_deg_s_k"


@pytest.fixture(scope="module")
def many():
    """Footfalls, their true headings and more parameter sets than a block holds."""
    n, sets = 200, 300
    t = np.cumsum(RNG.uniform(1.0, 1.2, n))
    found = Footfalls.at(t, RNG.normal(size=(n, 3)).cumsum(0), 0.3 + RNG.normal(0, 0.01, n).cumsum())
    params = [
        HdrParams(tau_s=float(tau), i_c=i_c, theta_w=theta_w)
        for tau, i_c, theta_w in RNG.uniform([0.0, 0.0, 1e-3], [12.0, 3e-4, 2e-2], (sets - 1, 3))
    ]
    return found, 0.29 + RNG.normal(0, 0.01, n).cumsum(), [*params, NOTHING]


def judged(psi, true):
    size = np.abs(psi - true)
    return np.stack([size.mean(axis=1), size[:, -1]], axis=1)


def test_errors_are_those_of_the_headings(many):
    found, true, params = many
    (psi,) = headings([found], params)
    made = heading_errors(found.rate, found.interval, true, found.heading[0], HdrSets.of(params))
    np.testing.assert_allclose(made, judged(psi, true), rtol=1e-12)
    np.testing.assert_allclose(made[-1], judged(found.heading[None], true)[0], rtol=1e-9)


def test_causes_add_to_the_raw_rate_each_with_its_weight(many):
    found, true, params = many
    causes, weights = RNG.normal(0, 1e-3, (2, len(true))), RNG.uniform(-1, 3, (2, len(params)))
    made = heading_errors(
        found.rate, found.interval, true, found.heading[0], HdrSets.of(params), causes, weights
    )
    for j in (0, 127, 128, 299):
        rate = found.rate + weights[0, j] * causes[0] + weights[1, j] * causes[1]
        own = Footfalls(**{**vars(found), "rate": rate})
        np.testing.assert_allclose(made[j], judged(headings([own], params[j : j + 1])[0], true)[0], rtol=1e-6)


def test_an_interval_that_is_none_is_refused(many):
    found, true, params = many
    with pytest.raises(InputError, match="interval"):
        heading_errors(found.rate, found.interval * 0, true, 0.0, HdrSets.of(params))


@pytest.fixture(scope="module")
def cases(walked, wearing):
    return [case_of(trial, walked) for trial in wearing(range(4))]


def test_at_the_sheets_own_values_it_is_the_chain(cases, walked, wearing):
    for method in ("pdr", "hdr"):
        for metric in METRICS:
            made = Surrogate(cases, NIMU, METHODS[method], [G, HEAT], metric)(np.array([[0.15, 0.011]]))
            for trial, error in zip(wearing(range(4)), made[0], strict=True):
                row = {row.method: row for row in perform(trial, walked).rows}[method]
                assert error == pytest.approx(getattr(row.require(), metric), rel=1e-6)


@pytest.mark.parametrize(
    ("key", "low", "high"),
    [
        ("angle_random_walk_deg_rt_h", 0.44, 13.0),
        ("flicker_deg_h", 8.0, 240.0),
        ("g_sensitivity_sigma_deg_s_g", 0.015, 0.45),
        ("scale_sigma", 0.0003, 0.03),
        ("misalignment_sigma_deg", 0.017, 1.0),
    ],
)
def test_another_sheet_is_met_within_a_few_percent(cases, walked, wearing, key, low, high):
    """Errors of dead reckoning, whose causes are all that of one property besides what the sheet has."""
    address = f"imu.gyro.{key}"
    model = Surrogate(cases, NIMU, METHODS["pdr"], [address], METRICS[0])
    for value in (low, high):
        made = model(np.array([[value]]))[0]
        trials = wearing(range(len(cases)), {address: value})
        full = [perform(trial, walked).rows[0].require().heading_error_mean_deg for trial in trials]
        np.testing.assert_allclose(made, full, rtol=0.1, atol=0.1)


def test_a_methods_own_parameters_are_in_its_own_units(cases):
    addresses = ["hdr.theta_w_deg_s", "hdr.tau_s", "hdr.i_c_deg_s"]
    point = np.array([[0.4, 5.0, 0.01]])
    made = Surrogate(cases, NIMU, METHODS["hdr"], addresses, METRICS[0])(point)
    own = HdrSets.of([HdrParams.from_degrees(theta_w_deg_s=0.4, tau_s=5.0, i_c_deg_s=0.01)])
    np.testing.assert_array_equal(made[0], [case.errors_deg(own)[0, 0] for case in cases])


def test_a_methods_other_parameters_stay(cases):
    """The basic controller has no filters, whatever its increment."""
    method = METHODS["hdr-basic"]
    made = Surrogate(cases, NIMU, method, ["hdr-basic.i_c_deg_s"], METRICS[0])(np.array([[0.01]]))
    own = HdrSets.of([HdrParams.basic(np.radians(0.01))])
    np.testing.assert_array_equal(made[0], [case.errors_deg(own)[0, 0] for case in cases])


def test_causes_where_footfalls_were_missed_lose_nothing():
    """The sum of what the causes turned does not depend on which footfalls were found."""
    walk = synthetic_walk(strides=20)
    true = walk.footfalls
    drift = np.linspace(0.01, 0.03, len(true.t) - 1)
    budget = DriftBudget(true.t[1:], np.diff(true.t), {"flicker": drift}, drift)
    rows = np.array([0, 3, 4, 9, len(true.t) - 1])
    track = Track(true.t[rows], true.position[rows], true.heading[rows])
    made = linear(track, walk, budget)
    turned = np.concatenate([[0.0], np.cumsum(drift * np.diff(true.t))])[rows]
    np.testing.assert_allclose(np.cumsum(made.causes["flicker"] * made.interval), turned, atol=1e-12)
    np.testing.assert_allclose(made.true, true.heading[rows], atol=1e-9)


@pytest.mark.parametrize(
    ("address", "reason"),
    [
        ("imu.gyro.bandwidth_hz", "not proportional"),
        ("imu.accel.flicker_ug", "not proportional"),
        ("pdr.tilt_gain", "not proportional"),
        ("imu.gyro.non_linearity_sigma_percent_fs", "has none of it"),
        ("imu.gyro.temperature2_sigma_deg_s_k2", "has none of it"),
    ],
)
def test_what_the_budget_cannot_scale_asks_for_the_full_chain(address, reason):
    with pytest.raises(InputError, match=f'{reason}.*"full"'):
        scaled_cause(address, NIMU)


def test_both_temperature_errors_are_one_cause(wearing):
    (trial,) = wearing([1], {"imu.gyro.temperature2_sigma_deg_s_k2": 0.001})
    with pytest.raises(InputError, match="together"):
        scaled_cause(HEAT, trial.setup.spec)


def test_methods_and_scores_that_the_budget_does_not_know():
    with pytest.raises(InputError, match=r"iez.*full"):
        Surrogate([], NIMU, METHODS["iez"], [G], METRICS[0])
    with pytest.raises(InputError, match="position_rmse_m"):
        Surrogate([], NIMU, METHODS["hdr"], [G], "position_rmse_m")
