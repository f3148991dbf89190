"""IHDE+: straights along directions are corrected, everything else is left alone."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from footfall.conventions import wrap
from footfall.errors import InputError
from footfall.hdr.directions import DirectionParams
from footfall.hdr.ihde_plus import (
    IhdePlus,
    IhdePlusParams,
    beside,
    direction_probability,
    line,
    straight_probability,
)
from tests.helpers.walked_steps import DEG, T, walked

SEEDS = st.integers(0, 9999)
PARAMS = IhdePlusParams()


def ask(steps, params=PARAMS):
    """What it said of each step, as (innovation, SD) in rad, and the corrector."""
    corrector = IhdePlus(params)
    return [corrector(step) for step in steps], corrector


def scattered(n, seed, sd=1.5):
    return sd * DEG * np.random.default_rng(seed).standard_normal(n)


def route(seed):
    """Courses of straights and corners of a building, with people's scatter."""
    rng = np.random.default_rng(seed)
    corridors = np.cumsum(rng.choice([-90, 90], 4)) * DEG
    return np.repeat(np.concatenate([[0.0], corridors]), rng.integers(6, 25, 5))


# What it says of straights, curves and corners


@given(SEEDS, st.integers(-4, 4))
@settings(max_examples=25)
def test_a_straight_along_a_direction_is_led_to_it(seed, quarter):
    off = 3 * DEG
    said, corrector = ask(walked(quarter * 90 * DEG + off + scattered(30, seed, 1.0)))
    told = [one[0] for one in said if one is not None]
    assert len(told) >= 20
    assert np.mean(told) == pytest.approx(-off, abs=1.2 * DEG)
    for row in corrector.rows[1:]:
        off_it = float(wrap(row.reference - quarter * 90 * DEG))
        assert math.isnan(off_it) or abs(off_it) < 1e-9


def test_it_speaks_of_the_first_straight_from_the_eighth_step_on():
    """Three steps of setting out, and five headings, the last of which says nothing yet."""
    course = np.zeros(12)
    course[6] = 2 * DEG  # the seventh step
    said, corrector = ask(walked(course))
    assert said[:7] == [None] * 7
    assert said[7][0] == pytest.approx(-2 * DEG)
    assert said[8][0] == pytest.approx(0)
    row = corrector.rows[8]
    sd = 3 * DEG / math.sqrt(row.straight * row.along)
    assert (row.headings, row.innovation_sd) == (5, pytest.approx(sd))
    assert said[7][1] == row.innovation_sd


@given(SEEDS, st.sampled_from([0.5, 0.8, 1.6, 2.4, 4.0]), st.sampled_from([-1, 1]))
@settings(max_examples=25)
def test_a_curve_is_left_alone(seed, turn, side):
    """From R 160 (0.5 deg a stride) to R 20: after its first strides nothing is said until the line fades."""
    bend = side * turn * np.arange(60)
    course = np.concatenate([np.zeros(25), bend]) * DEG + scattered(85, seed, 1.0)
    said, _ = ask(walked(course))
    told = np.array([0.0 if one is None else one[0] for one in said[25:]]) / DEG
    spoken = np.array([one is not None for one in said[25:]])
    assert spoken[20:].mean() < 0.1
    # What is said on the way in is wrong by what the curve has turned until then.
    assert np.abs(told).sum() * 0.2 < 12


def test_a_straight_beside_all_directions_is_left_alone():
    for off in (15, 30, 45, -20):
        said, corrector = ask(walked(off * DEG + scattered(40, off + 50)))
        assert said == [None] * 40, off
        assert corrector.rows[-1].straight > 0.8
        assert corrector.rows[-1].along < 0.1


def test_there_is_no_cliff_at_five_degrees():
    """Minutes without a correction, then a straight 9 deg beside its direction: drift, and put right."""
    long = walked(np.concatenate([np.zeros(20), 2.5 * np.arange(1, 145) * DEG, np.full(25, 9 * DEG)]))
    assert any(one is not None for one in ask(long)[0][-20:])
    soon = walked(np.full(25, 9 * DEG))
    assert ask(soon)[0] == [None] * 25


def test_it_speaks_where_a_straight_along_a_direction_is_likelier_than_not():
    """Straights ever further beside a direction: said while the product of the two is above 1/2."""
    rows = [ask(walked(np.full(12, off * DEG)))[1].rows[-1] for off in np.arange(0, 12, 0.1)]
    sure = np.array([row.straight * row.along for row in rows])
    assert ((sure > 0.45) & (sure < 0.5)).any()
    assert ((sure > 0.5) & (sure < 0.55)).any()
    np.testing.assert_array_equal([math.isfinite(row.innovation) for row in rows], sure > 0.5)


def test_the_heading_grows_uncertain_from_the_last_correction_on():
    """Each step of a straight is one: a stride's time counts, not that since the start."""
    _, corrector = ask(walked(np.zeros(60)))
    assert corrector.rows[-1].along == pytest.approx(direction_probability(0.0, T, 10, PARAMS))
    assert corrector.rows[8].along == pytest.approx(direction_probability(0.0, 8 * T, 5, PARAMS))


def test_a_corner_starts_anew_and_its_settling_says_nothing():
    course = np.concatenate([np.zeros(20), [45, 110, 80], np.full(15, 90)]) * DEG
    said, corrector = ask(walked(course))
    headings = [row.headings for row in corrector.rows[1:]]
    assert headings[19] == 17
    assert headings[20:28] == [0, 0, 0, 1, 2, 3, 4, 5]
    assert all(one is None for one in said[20:27])
    told = [one[0] for one in said[27:] if one is not None]
    assert len(told) >= 5
    assert told == pytest.approx([0.0] * len(told), abs=1e-6)


def test_a_first_heading_that_is_the_turns_is_dropped():
    course = np.concatenate([np.zeros(3), [9.0], np.zeros(9)]) * DEG
    _, corrector = ask(walked(course))
    assert [row.headings for row in corrector.rows[4:8]] == [1, 2, 3, 4]
    assert corrector.rows[-1].headings == 9  # of the ten after the settling


# Laws


@given(SEEDS, st.integers(1, 3))
@settings(max_examples=20)
def test_a_building_looks_the_same_from_all_its_directions(seed, quarters):
    course = route(seed) + scattered(len(route(seed)), seed)
    said, turned = (ask(walked(course + by))[0] for by in (0.0, quarters * math.pi / 2))
    assert [one is None for one in said] == [one is None for one in turned]
    for a, b in zip(said, turned, strict=True):
        assert a is None or b == pytest.approx(a, abs=1e-7)


@given(SEEDS, st.floats(-45, 45))
@settings(max_examples=20)
def test_a_building_may_lie_anyhow(seed, by):
    course = route(seed) + scattered(len(route(seed)), seed)
    said = ask(walked(course))[0]
    there = IhdePlusParams(directions=DirectionParams(reference=by * DEG))
    for a, b in zip(said, ask(walked(course + by * DEG), there)[0], strict=True):
        assert (a is None) == (b is None)
        assert a is None or b == pytest.approx(a, abs=1e-7)


@given(SEEDS)
@settings(max_examples=20)
def test_left_and_right_are_alike(seed):
    course = route(seed) + scattered(len(route(seed)), seed)
    for a, b in zip(ask(walked(course))[0], ask(walked(-course))[0], strict=True):
        assert (a is None) == (b is None)
        assert a is None or (b[0], b[1]) == pytest.approx((-a[0], a[1]), abs=1e-9)


@given(st.floats(-60, 60), SEEDS)
@settings(max_examples=20)
def test_the_foots_angle_is_learned_and_does_not_matter(toe_out, seed):
    params = IhdePlusParams(heading="both")
    course = scattered(30, seed, 1.0)
    straight, beside_it = (ask(walked(course, by * DEG), params) for by in (0.0, toe_out))
    assert beside_it[1].rows[-1].toe_out == pytest.approx(toe_out * DEG, abs=1e-2)
    for a, b in zip(straight[0], beside_it[0], strict=True):
        assert (a is None) == (b is None)
        assert a is None or b == pytest.approx(a, abs=1e-7)


@given(st.sampled_from([-0.4, -0.2, 0.1, 0.3]), SEEDS)
@settings(max_examples=20, deadline=None)
def test_a_gyro_bias_on_a_straight_is_taken_out(bias, seed):
    """A filter of two states, heading and bias (deg/s), told by it: both errors end near nought."""
    corrector, noise = IhdePlus(), scattered(60, seed, 1.0)
    error, left, past = 0.0, bias * DEG, 0.0
    p = np.diag([0.0, (0.3 * DEG) ** 2])
    f = np.array([[1.0, T], [0.0, 1.0]])
    for i in range(60):
        past, error = error, error + left * T
        p = f @ p @ f.T
        (step,) = walked([noise[i] + (past + error) / 2])
        step = step.__class__(**{**vars(step), "index": i + 1, "t": T * (i + 1)})
        said = corrector(step)
        if said is not None:
            gain = p[:, 0] / (p[0, 0] + said[1] ** 2)
            p -= np.outer(gain, p[0])
            error += gain[0] * said[0]
            left += gain[1] * said[0]
            corrector.applied(gain[0] * said[0])
    assert abs(error) < 2 * DEG
    assert abs(left) < 0.06 * DEG


def test_directions_can_be_learned():
    params = IhdePlusParams(directions=DirectionParams(reference=None))
    said, corrector = ask(walked(20 * DEG + scattered(40, 1, 1.0)), params)
    assert sum(one is not None for one in said) > 20
    assert corrector.rows[-1].reference == pytest.approx(20 * DEG, abs=1 * DEG)
    assert [one is None for one in said[:12]] == [True] * 12


# Its parts


@given(st.lists(st.floats(-1, 1), min_size=2, max_size=20))
def test_the_line_is_that_of_least_squares(headings):
    mean, slope, weight = line(headings)
    fitted = np.polyfit(np.arange(len(headings)), headings, 1)[0]
    assert (mean, slope) == pytest.approx((np.mean(headings), fitted), abs=1e-9)
    assert weight == pytest.approx(np.var(np.arange(len(headings))) * len(headings))


def density(x, variance):
    return math.exp(-x * x / variance / 2) / math.sqrt(2 * math.pi * variance)


@given(st.integers(5, 30), st.floats(-2, 2), SEEDS)
def test_the_probability_of_a_straight_is_bayes(n, slope, seed):
    headings = slope * DEG * np.arange(n) + scattered(n, seed)
    least = math.inf
    for window in (10, 20):
        _, k, weight = line(headings[-window:])
        own = (2 * DEG) ** 2 / weight
        curve = np.mean([density(k, own + (q * DEG) ** 2) for q in (0.6, 2.5)])
        assume(curve > 1e-200)
        straight = density(k, own + (0.1 * DEG) ** 2)
        least = min(least, 0.8 * straight / (0.8 * straight + 0.2 * curve))
    assert straight_probability(list(headings), PARAMS) == pytest.approx(least, abs=1e-6)


@given(st.floats(-44, 44), st.floats(0, 600), st.integers(1, 10), st.sampled_from([1, 4, 8]))
def test_the_probability_of_a_direction_is_bayes(off, since, n, count):
    params = IhdePlusParams(directions=DirectionParams(count))
    variance = (2**2 + (0.05 * since) ** 2 + 2**2 / n) * DEG**2
    along = 0.7 * density(off * DEG, variance)
    expected = along / (along + 0.3 * count / (2 * math.pi))
    assert direction_probability(off * DEG, since, n, params) == pytest.approx(expected, abs=1e-9)


def test_certainties_do_not_overflow():
    assert straight_probability(list(np.arange(20.0)), PARAMS) == 0
    assert direction_probability(math.pi, 0.0, 10, IhdePlusParams(directions=DirectionParams(1))) < 1e-100


def test_what_lies_beside_a_line():
    flat, bent = [0.0] * 10, list(2 * DEG * np.arange(10))
    assert not beside(flat, 5 * DEG, PARAMS)
    assert beside(flat, 10 * DEG, PARAMS)
    assert not beside(bent, 20 * DEG, PARAMS)  # it goes on as it did
    assert beside(bent, 5 * DEG, PARAMS)
    assert not beside([0.0], 10 * DEG, PARAMS)  # one heading tells no slope
    assert beside([0.0], 25 * DEG, PARAMS)
    assert beside(flat, -10 * DEG, PARAMS)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"scatter": 0.0}, "scatter = 0.0 rad, expected a positive"),
        ({"sigma": math.inf}, "sigma = inf rad, expected a positive"),
        ({"drift": -0.1}, "drift = -0.1 rad/s, expected 0 or more"),
        ({"settle": -1}, "settle = -1, expected 0 or more"),
        ({"straight_share": 1.0}, "straight_share = 1.0, expected between 0 and 1"),
        ({"curve_slopes": ()}, r"curve_slopes = \(\), expected positive"),
    ],
)
def test_impossible_parameters_are_refused(keys, message):
    with pytest.raises(InputError, match=f"ihde-plus: {message}"):
        IhdePlusParams(**keys)
