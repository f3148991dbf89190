"""Does the filter know how wrong it is? Monte Carlo on a foot whose truth is known."""

import numpy as np
import pytest
from scipy import stats

from footfall.pdr.filter.ins import FilterSettings, frozen
from footfall.pdr.filter.layout import ATTITUDE, STATE
from footfall.pdr.filter.run import run_filter
from tests.helpers.filter_walks import drawn, error_of
from tests.helpers.synthetic_foot import walk

RUNS = 60
NOISE = {"accel_noise": 0.01, "gyro_noise": 3e-4, "sigma_velocity": 0.01, "heading_sd": np.radians(2.0)}


@pytest.fixture(scope="module")
def still_foot():
    """Twenty strides through a bend on a foot that is truly at rest at mid-stance."""
    return walk(np.linspace(0.0, 1.0, 21), still_s=3.0, rocking=0.0)


def filtered(truth, settings, seed):
    """Errors (stances, 15) after each update and what the filter made of them."""
    rng = np.random.default_rng([seed, 1])
    found, accel_bias, gyro_bias = drawn(truth, settings, seed)
    rate = 1 / np.sqrt(np.median(np.diff(truth.t)))
    gyro = truth.gyro + gyro_bias + settings.gyro_noise * rate * rng.standard_normal(truth.gyro.shape)
    accel = truth.accel + accel_bias + settings.accel_noise * rate * rng.standard_normal(truth.accel.shape)
    last, rows = 0, []
    for stop in [200, 400, *truth.at(truth.mid_stance[1:])]:
        part = slice(last + 1, stop + 1)
        found.advance(truth.t[part], gyro[part], accel[part], np.zeros(stop - last, dtype=int))
        # A foot that is called still moves by what the filter believes of it.
        creep = settings.sigma_velocity * rng.standard_normal(3)
        found._x[STATE["velocity"]] += creep
        found.rest()
        found._x[STATE["velocity"]] -= creep
        rows.append((error_of(found, truth, accel_bias, gyro_bias), found.covariance))
        last = stop
    return rows


@pytest.mark.parametrize("turns", [True, False])
def test_errors_are_as_large_as_the_filter_says(still_foot, turns):
    """NEES of all fifteen states lies in its chi-square bounds, early and late."""
    settings = FilterSettings(velocity_turns=turns, accel_bias_walk=0.0, gyro_bias_walk=0.0, **NOISE)
    runs = [filtered(still_foot, settings, seed) for seed in range(RUNS)]
    for stance in (1, 8, -1):
        nees = [error @ np.linalg.solve(p, error) for error, p in (run[stance] for run in runs)]
        low, high = stats.chi2.ppf([0.001, 0.999], 15 * RUNS) / RUNS
        assert low < np.mean(nees) < high, stance
        for part in (slice(0, 3), slice(3, 6), slice(6, 9), slice(9, 12), slice(12, 15)):
            some = [
                e[part] @ np.linalg.solve(p[part, part], e[part]) for e, p in (run[stance] for run in runs)
            ]
            low, high = stats.chi2.ppf([0.0005, 0.9995], 3 * RUNS) / RUNS
            assert low < np.mean(some) < high, (stance, part)


def test_more_noise_than_believed_is_noticed(still_foot):
    """The same test with ten times the gyro noise fails: it can."""
    honest = FilterSettings(accel_bias_walk=0.0, gyro_bias_walk=0.0, **NOISE)
    nees = []
    for seed in range(20):
        noisy = filtered(still_foot, FilterSettings(**{**NOISE, "gyro_noise": 3e-3}), seed)
        quiet = filtered(still_foot, honest, seed)
        error, p = noisy[-1][0][ATTITUDE], quiet[-1][1][ATTITUDE, ATTITUDE]
        nees.append(error @ np.linalg.solve(p, error))
    assert np.mean(nees) > stats.chi2.ppf(0.9999, 3 * 20) / 20


def test_smoothing_beats_the_filter(still_foot):
    """Later strides tell earlier ones of their tilt and bias."""
    settings = FilterSettings(velocity_turns=True, **{**NOISE, "sigma_velocity": 1e-3, "heading_sd": 0.0})
    truth = walk(np.linspace(0.0, 1.0, 41), still_s=25.0, rocking=0.0)
    squares = np.zeros(2)
    for seed in range(12):
        rng = np.random.default_rng(seed)
        moving = (truth.t > 25.0)[:, None]  # a bias that the still start has not seen
        drift = moving * np.radians(rng.normal(0, 0.1, 3))
        recording = truth.recording(gyro_error=drift, angle_random_walk=3e-4, seed=seed)
        for which in (0, 1):
            found = run_filter(recording, settings, smooth=bool(which)).footfalls
            place = truth.position[truth.at(found.t)]
            squares[which] += np.sum((found.position - found.position[0] - place + place[0]) ** 2)
    assert squares[1] < 0.8 * squares[0]


def test_smoothing_leaves_what_was_frozen(still_foot):
    settings = frozen(FilterSettings())
    recording = walk(np.zeros(9), rocking=0.0).recording(gyro_error=np.array([0.001, 0.002, 0.003]))
    plain, smooth = (run_filter(recording, settings, smooth=which) for which in (False, True))
    np.testing.assert_allclose(smooth.gyro_bias, plain.gyro_bias)
    assert np.isfinite(smooth.footfalls.position).all()
    np.testing.assert_allclose(smooth.footfalls.position[-1], plain.footfalls.position[-1])
    assert (smooth.heading_sd <= plain.heading_sd + 1e-12).all()
