"""Compiled detection says what its plain twin says, to the last bit."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from footfall.conventions import GRAVITY
from footfall.pdr import _detection, _plain
from footfall.pdr.detectors import Means
from footfall.pdr.reckoning import PdrParams, detect
from footfall.pdr.rest import static_bias
from footfall.pdr.stance import StanceParams, ThresholdDetector, find_stances
from tests.helpers.synthetic_foot import walk

SEEDS = st.integers(0, 2**32 - 1)
STILLNESS = (0.1, 0.1, 0.3, 0.9, 1.0, 1.2, math.nan, math.inf)  # of instants equally still the first counts


def record(seed, n):
    """Stamps that jitter and have gaps, a foot that now moves and now does not."""
    rng = np.random.default_rng(seed)
    t = np.cumsum(rng.uniform(0.003, 0.007, n) + 0.3 * (rng.random(n) < 0.01)) + rng.uniform(0, 100)
    moving = np.repeat(rng.random(n // 20 + 1) < 0.5, 20)[:n, None]
    gyro = rng.normal(0, 0.01, (n, 3)) + moving * rng.normal(0, 3, (n, 3))
    accel = rng.normal([0, 0, GRAVITY], 0.1, (n, 3)) + moving * rng.normal(0, 9, (n, 3))
    return t, gyro, accel


@settings(max_examples=50)
@given(SEEDS, st.integers(1, 1000), st.floats(0, 0.2))
def test_the_score_is_the_twins(seed, n, window):
    t, gyro, accel = record(seed, n)
    detector = ThresholdDetector(window_s=window)
    np.testing.assert_array_equal(detector(t, gyro, accel), _plain.threshold(t, gyro, accel, detector))


@settings(max_examples=30)
@given(SEEDS, st.lists(st.integers(0, 299), min_size=1, max_size=5), st.sampled_from([math.nan, math.inf]))
def test_the_score_is_the_twins_where_samples_are_no_numbers(seed, rows, value):
    t, gyro, accel = record(seed, 300)
    for row in rows:
        (gyro if row % 2 else accel)[row, row % 3] = value
    detector = ThresholdDetector()
    np.testing.assert_array_equal(detector(t, gyro, accel), _plain.threshold(t, gyro, accel, detector))


@settings(max_examples=50)
@given(SEEDS, st.integers(1, 400), st.floats(0, 0.3))
def test_means_and_what_holds_a_window_are_the_twins(seed, n, window):
    t, gyro, accel = record(seed, n)
    found, whole = _detection.means(t, gyro, accel, window)
    assert whole
    np.testing.assert_array_equal(found, _plain.means(t, gyro, accel, window))
    value = Means(*found).rate2
    np.testing.assert_array_equal(_detection.held(t, value, window), _plain.held(t, value, window))
    accel[n // 2, 1] = math.nan
    assert not _detection.means(t, gyro, accel, window)[1]


@st.composite
def scored_records(draw):
    """Stretches of one stillness, with gaps and instants of another in them."""
    rng = np.random.default_rng(draw(SEEDS))
    lengths = rng.integers(1, draw(st.sampled_from([10, 60, 400])), draw(st.integers(1, 30)))
    score = np.repeat(rng.choice(STILLNESS, len(lengths)), lengths)
    odd = rng.random(len(score)) < draw(st.sampled_from([0.0, 0.02]))
    score = np.where(odd, rng.choice(STILLNESS, len(score)), score)
    step = np.where(rng.random(len(score)) < 0.01, rng.uniform(0.1, 1.0), 0.005)
    return np.cumsum(step), score


@settings(max_examples=300)
@given(
    scored_records(),
    st.sampled_from([0.0, 0.02, 0.1]),
    st.sampled_from([0.0, 0.05, 0.4, 2.0]),
    st.sampled_from([0.02, 0.3, math.inf]),
)
def test_stances_are_the_twins(record, stance, stride, reset):
    t, score = record
    params = StanceParams(min_stance_s=stance, min_stride_s=stride, reset_s=reset)
    found, plain = find_stances(t, score, params), _plain.find_stances(t, score, params)
    np.testing.assert_array_equal(found.resets, plain.resets)
    np.testing.assert_array_equal(found.footfalls, plain.footfalls)


def test_a_walks_stances_are_the_twins_from_the_still_start_on():
    truth = walk(np.cumsum(np.random.default_rng(1).normal(0, 0.3, 60)), still_s=6.0, pauses={20: 4.0})
    recording = truth.recording(gyro_error=0.02, angle_random_walk=1e-3, seed=3)
    params = PdrParams(bias_s=5.0)
    rest = static_bias(recording, 5.0)
    t = recording.t[1:]
    score = _plain.threshold(t, recording.gyro[1:] - rest.gyro_bias, recording.accel[1:], params.detector)
    score[: rest.last] = np.minimum(score[: rest.last], 0.5)
    plain = _plain.find_stances(t, score, params.stance)
    found = detect(recording, params)
    np.testing.assert_array_equal(found.score, [score[0], *score])
    later = plain.resets + 1 > rest.last
    np.testing.assert_array_equal(found.stances.resets, [rest.last, *(plain.resets[later] + 1)])
    assert len(found.stances.footfalls) == 60


def test_a_bias_is_taken_off_each_axis():
    values = np.arange(12.0).reshape(4, 3)
    bias = np.array([0.5, -1.0, 7.0])
    np.testing.assert_array_equal(_detection.less(values, bias), values - bias)


@pytest.mark.parametrize("name", ["gyro", "accel"])
def test_columns_of_whole_numbers_and_strides_are_taken(name):
    """Readers hand out what a file holds: integers, columns of a wider table."""
    t, gyro, accel = record(0, 100)
    given = {"gyro": gyro, "accel": accel}
    given[name] = np.asfortranarray(np.round(given[name]))
    plain = _plain.threshold(t, given["gyro"], given["accel"], ThresholdDetector())
    given[name] = given[name].astype(int)
    np.testing.assert_array_equal(ThresholdDetector()(t, **given), plain)
