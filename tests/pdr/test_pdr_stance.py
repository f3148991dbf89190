"""One footfall a stance, at rest, at any rate; still periods are reset again and again."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from footfall.conventions import GRAVITY
from footfall.pdr.stance import StanceParams, ThresholdDetector, find_stances, moving_mean
from tests.helpers.synthetic_foot import walk

STRIDES = 30


def stances(truth, rows=slice(None), params=None):
    t = truth.t[rows]
    return t, find_stances(t, ThresholdDetector()(t, truth.gyro[rows], truth.accel[rows]), params)


def footfall_times(truth, rows=slice(1, None)):
    t, found = stances(truth, rows)
    return t[found.resets[found.footfalls]]


@given(st.integers(0, 2**32 - 1), st.floats(0.001, 0.2))
def test_moving_mean_is_the_mean_over_the_window(seed, window):
    rng = np.random.default_rng(seed)
    t = np.cumsum(rng.uniform(0.002, 0.02, 40))
    values = rng.normal(size=(40, 3))
    expected = [values[np.abs(t - now) <= window / 2 + 1e-6].mean(axis=0) for now in t]
    np.testing.assert_allclose(moving_mean(values, t, window), expected, atol=1e-12)


@pytest.mark.parametrize("rate", [100.0, 200.0, 250.0, 400.0])
def test_one_footfall_a_stance_at_any_rate(rate):
    truth = walk(np.zeros(STRIDES + 1), still_s=2.0, rate=rate)
    found = footfall_times(truth)
    assert len(found) == STRIDES + 1
    assert np.abs(found[1:-1] - truth.mid_stance[1:-1]).max() < 0.15 * 1.1  # within the stance


def test_footfalls_stay_where_they_are_when_samples_drop_and_jitter():
    truth = walk(np.zeros(STRIDES + 1), still_s=2.0, jitter=0.5)
    keep = np.random.default_rng(1).random(len(truth.t)) > 0.03
    keep[0] = False
    assert len(footfall_times(truth, keep)) == STRIDES + 1


@pytest.mark.parametrize(("cut_s", "footfalls"), [(0.0, 31), (0.05, 31), (0.15, 30), (0.3, 30), (0.8, 30)])
def test_the_records_tail_is_a_stance_only_if_the_foot_rests_there(cut_s, footfalls):
    """The last stance begins 0.165 s before its middle, where the uncut record ends."""
    truth = walk(np.zeros(STRIDES + 1), still_s=2.0, tail_s=0.0)
    end = int(np.searchsorted(truth.t, truth.t[-1] - cut_s)) + 1
    assert len(footfall_times(truth, slice(1, end))) == footfalls


def test_a_still_period_is_one_footfall_with_resets_all_along():
    truth = walk(np.zeros(STRIDES + 1), still_s=2.0, pauses={10: 6.0})
    t, found = stances(truth, slice(1, None))
    assert len(found.footfalls) == STRIDES + 1
    inside = t[found.resets][np.abs(t[found.resets] - truth.mid_stance[10]) < 3.0]
    assert np.diff(inside).max() < 2 * StanceParams().reset_s + 0.01
    assert len(inside) > 15
    # The walk resumes from the last of them.
    assert t[found.resets[found.footfalls[10]]] > truth.mid_stance[10] + 2.5


def score_of(*rests, end=10.0):
    """A score that is low during (start, stop, level) and high elsewhere."""
    t = np.arange(0, end, 0.005)
    score = np.full(len(t), 5.0)
    for start, stop, level in rests:
        score[(t >= start) & (t <= stop)] = level
    return t, score


def test_a_mean_over_what_is_no_number_is_none_and_other_windows_do_not_feel_it():
    t = np.arange(40) / 200
    values = np.random.default_rng(0).normal(3.0, 1.0, (40, 3))
    holed = values.copy()
    holed[20, 1], holed[0, 0] = np.nan, np.inf
    found, whole = moving_mean(holed, t, 0.02), moving_mean(values, t, 0.02)
    assert np.isnan(found[18:23, 1]).all()
    assert np.isnan(found[:3, 0]).all()
    assert np.isnan(found).sum() == 8
    kept = np.isfinite(found)
    np.testing.assert_allclose(found[kept], whole[kept], atol=1e-12)


@pytest.mark.parametrize(("level", "count"), [(0.99, 1), (1.0, 0)])
def test_rest_is_a_score_below_one(level, count):
    t, score = score_of((1.0, 1.3, level))
    assert len(find_stances(t, score).footfalls) == count


def test_a_moment_of_rest_in_swing_is_no_stance():
    t, score = score_of((1.0, 1.3, 0.1), (1.7, 1.76, 0.9), (2.1, 2.4, 0.1))
    assert len(find_stances(t, score).footfalls) == 2


def test_of_two_rests_too_close_the_quieter_counts():
    t, score = score_of((1.0, 1.2, 0.5), (1.25, 1.5, 0.1), (2.4, 2.7, 0.3), (2.72, 2.9, 0.6))
    found = find_stances(t, score)
    assert len(found.footfalls) == 2
    first, second = t[found.resets[found.footfalls]]
    assert 1.25 <= first <= 1.5
    assert 2.4 <= second <= 2.7


def test_no_rest_no_stance():
    t, score = score_of()
    assert len(find_stances(t, score).resets) == 0


@given(st.integers(0, 2**32 - 1))
def test_footfalls_are_at_rest_and_never_closer_than_a_stride(seed):
    rng = np.random.default_rng(seed)
    edges = np.cumsum(rng.uniform(0.02, 1.0, 20))
    t, score = score_of(
        *((a, b, rng.uniform(0, 0.99)) for a, b in edges.reshape(-1, 2)), end=float(edges[-1]) + 1
    )
    found = find_stances(t, score)
    assert (score[found.resets] < 1).all()
    assert (np.diff(found.resets) > 0).all()
    assert (np.diff(t[found.resets[found.footfalls]]) >= StanceParams().min_stride_s - 1e-9).all()


def test_another_detector_only_needs_to_say_how_unquiet_it_is():
    """The interface: a score below 1 at rest. Here, rest is what the accelerometers alone say."""

    def by_force(t, gyro, accel):
        return moving_mean(np.abs(np.linalg.norm(accel, axis=1) - 9.8), t, 0.1) / 1.5

    truth = walk(np.zeros(STRIDES + 1), still_s=2.0)
    found = find_stances(truth.t[1:], by_force(truth.t[1:], truth.gyro[1:], truth.accel[1:]))
    assert len(found.footfalls) == STRIDES + 1


def scores(gyro, accel, rate=200.0):
    return ThresholdDetector()(np.arange(len(gyro)) / rate, gyro, accel)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_rest_ends_at_60_degrees_a_second_and_at_4_metres_a_second_squared_off_g(axis):
    n = 40
    turning, level = np.zeros((n, 3)), np.tile([0.0, 0.0, GRAVITY], (n, 1))
    turning[:, axis] = -np.radians(60.0)
    np.testing.assert_allclose(scores(turning, level), 1.0, rtol=1e-12)
    for force in (GRAVITY + 4.0, GRAVITY - 4.0):
        pushed = np.zeros((n, 3))
        pushed[:, axis] = force  # which way is up does not matter
        np.testing.assert_allclose(scores(np.zeros((n, 3)), pushed), 1.0, rtol=1e-12)
    assert (scores(np.zeros((n, 3)), level) < 1e-12).all()
    # The worse of the two counts.
    np.testing.assert_allclose(scores(turning, 1.2 * level), 1.0, rtol=1e-12)
    np.testing.assert_allclose(scores(0.2 * turning, 1.2 * level), 0.2 * GRAVITY / 4.0, rtol=1e-12)


@pytest.mark.parametrize(("rate", "samples"), [(200.0, 5), (100.0, 3), (1000.0, 21)])
def test_a_jolt_counts_by_its_mean_over_20_milliseconds(rate, samples):
    """The window holds so many samples at each rate; both sensors are averaged before anything is squared."""
    n = 101
    level = np.tile([0.0, 0.0, GRAVITY], (n, 1))
    jolted = np.zeros((n, 3))
    jolted[50, 1] = np.radians(60.0) * samples
    found = scores(jolted, level, rate)
    assert np.count_nonzero(found > 1e-9) == samples
    np.testing.assert_allclose(found[found > 1e-9], 1.0, rtol=1e-9)
    pushed = level.copy()
    pushed[50, 2] += 4.0 * samples
    found = scores(np.zeros((n, 3)), pushed, rate)
    assert np.count_nonzero(found > 1e-9) == samples
    np.testing.assert_allclose(found[found > 1e-9], 1.0, rtol=1e-9)


@pytest.mark.parametrize(("rest_s", "count"), [(0.09, 1), (0.11, 2)])
def test_a_stance_takes_a_tenth_of_a_second(rest_s, count):
    t, score = score_of((1.0, 1.3, 0.1), (2.0, 2.0 + rest_s + 1e-9, 0.1))
    assert len(find_stances(t, score).footfalls) == count


@pytest.mark.parametrize(("apart_s", "count"), [(0.38, 1), (0.42, 2)])
def test_two_stances_are_four_tenths_of_a_second_apart(apart_s, count):
    t, score = score_of((1.0, 1.2, 0.5), (1.1 + apart_s - 0.05, 1.1 + apart_s + 0.1, 0.5))
    score[220] = score[220 + round(apart_s / 0.005)] = 0.1  # their quietest instants, at 1.1 s and later
    found = find_stances(t, score)
    assert len(found.footfalls) == count
    if count == 2:
        assert np.diff(t[found.resets[found.footfalls]]) == pytest.approx(apart_s)


@pytest.mark.parametrize(("rest_s", "resets"), [(0.55, 1), (0.65, 2), (1.0, 3), (3.1, 10)])
def test_a_stance_longer_than_two_resets_is_a_still_period(rest_s, resets):
    """One reset in each part of 0.3 s or a little more."""
    t, score = score_of((1.0, 1.0 + rest_s + 1e-9, 0.1))
    found = find_stances(t, score)
    assert len(found.resets) == resets
    assert found.footfalls.tolist() == [resets - 1]
    parts = (t[found.resets] - 1.0) // (rest_s / resets - 1e-3)
    assert parts.tolist() == list(range(resets))
