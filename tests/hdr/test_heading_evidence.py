"""Straightness, rhythm and dominant directions: what the heading methods go by."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from footfall.conventions import wrap
from footfall.errors import InputError
from footfall.hdr.directions import DirectionParams, Directions, deviation, folded, learned_reference
from footfall.hdr.straightness import bell_membership, circular_mean, circular_std, z_membership

DEG = math.pi / 180
ANGLES = st.floats(-20, 20)
NEAR = st.lists(st.floats(-1.0, 1.0), min_size=2, max_size=8)
COUNTS = st.sampled_from([1, 2, 4, 8])


# Circular statistics, Eq. 20


@given(NEAR, ANGLES, st.lists(st.integers(-2, 2), min_size=8, max_size=8))
def test_mean_and_scatter_do_not_know_whole_turns_or_where_zero_is(offsets, centre, turns):
    angles = [centre + offset for offset in offsets]
    wound = [angle + 2 * math.pi * turn for angle, turn in zip(angles, turns, strict=False)]
    assert float(wrap(circular_mean(wound) - circular_mean(angles))) == pytest.approx(0, abs=1e-9)
    assert circular_std(wound) == pytest.approx(circular_std(angles), abs=1e-9)
    assert circular_std(angles) == pytest.approx(circular_std(offsets), abs=1e-9)


def test_headings_about_north_are_not_averaged_to_south():
    """359 and 1 deg: 0, where the paper's mean of numbers says 180."""
    assert circular_mean([359 * DEG, 1 * DEG]) == pytest.approx(0, abs=1e-12)
    assert circular_std([359 * DEG, 1 * DEG]) == pytest.approx(math.sqrt(2) * DEG)


@given(st.lists(st.floats(-0.03, 0.03), min_size=2, max_size=8))
def test_close_to_each_other_they_are_the_ordinary_statistics(angles):
    assert circular_mean(angles) == pytest.approx(np.mean(angles), abs=1e-5)
    assert circular_std(angles) == pytest.approx(np.std(angles, ddof=1), abs=1e-5)


@given(NEAR)
def test_the_mean_lies_in_the_turn_of_the_last(angles):
    assert abs(circular_mean(angles) - angles[-1]) <= math.pi


# Membership functions, Eq. 21 and 22


@given(st.floats(0, 2), st.floats(0.1, 1000), st.floats(0.1, 30))
def test_z_membership_is_the_papers_formula(std, k1, a):
    assume(k1 * std - a < 600)
    assert z_membership(std, k1, a) == pytest.approx(1 / (1 + math.exp(k1 * std - a)), abs=1e-12)
    assert z_membership(a / k1, k1, a) == pytest.approx(0.5)
    assert z_membership(std + 0.01, k1, a) <= z_membership(std, k1, a)


def test_z_membership_of_the_wildest_heading_is_nought_and_no_overflow():
    assert z_membership(math.pi, 1e6, 1.0) == 0


@given(st.floats(0, 10), st.floats(0.1, 1e4), st.floats(0.5, 4), st.floats(0.8, 1.5))
def test_bell_membership_peaks_at_the_usual_stride_and_is_even_about_it(off, b, c, gamma_t):
    assert bell_membership(gamma_t, b, c, gamma_t) == 1
    up, down = (bell_membership(gamma_t + sign * off, b, c, gamma_t) for sign in (1, -1))
    assert up == pytest.approx(down, rel=1e-6)
    assert 0 <= up <= 1
    half = b ** (-1 / (2 * c))
    assert bell_membership(gamma_t + half, b, c, gamma_t) == pytest.approx(0.5)


# Dominant directions


@given(ANGLES, ANGLES, COUNTS)
def test_the_nearest_direction_is_one_of_them_and_none_is_nearer(heading, reference, count):
    nearest = Directions(DirectionParams(count, reference)).nearest(heading)
    steps = (nearest - reference) / (2 * math.pi / count)
    assert steps == pytest.approx(round(steps), abs=1e-6)
    every = reference + 2 * math.pi / count * np.arange(count)
    assert abs(nearest - heading) == pytest.approx(np.abs(wrap(every - heading)).min(), abs=1e-9)
    assert abs(deviation(heading, reference, count)) <= math.pi / count + 1e-9


@given(
    st.floats(-0.3, 0.3), COUNTS, st.lists(st.integers(-4, 4), min_size=10, max_size=40), st.integers(0, 999)
)
def test_directions_are_learned_from_a_walk_along_them(reference, count, which, seed):
    scatter = 2 * DEG * np.random.default_rng(seed).standard_normal(len(which))
    headings = reference + 2 * math.pi / count * np.array(which) + scatter
    found = Directions(DirectionParams(count, None, learn_after=len(which)))
    for i, heading in enumerate(headings):
        assert found.nearest(0.0) is None, i
        found.learn(float(heading))
    expected = reference + scatter.mean()
    assert deviation(found.reference, expected, count) == pytest.approx(0, abs=0.5 * DEG)
    assert abs(found.nearest(headings[0]) - headings[0]) < 10 * DEG


@pytest.mark.parametrize("count", [4, 8])
def test_a_walk_round_a_circle_teaches_no_direction(count):
    found = Directions(DirectionParams(count, None, learn_after=10))
    for heading in np.linspace(0, 2 * math.pi, 200, endpoint=False):
        found.learn(float(heading))
    assert found.reference is None


@pytest.mark.parametrize(("agreement", "known"), [(0.72, True), (0.68, False)])
def test_directions_are_learned_where_headings_agree(agreement, known):
    """Two bundles that lie 2 x apart about 10 deg: the mean of exp(4 i heading) has the length cos 4 x."""
    apart = math.acos(agreement) / 4
    found = Directions(DirectionParams(reference=None))
    for side in (-1, 1, -1, 1, -1, 1):
        found.learn(10 * DEG + side * apart)
    assert (found.reference is not None) == known
    strict = Directions(DirectionParams(reference=None, learn_agreement=0.99))
    for side in (-1, 1, -1, 1, -1, 1):
        strict.learn(10 * DEG + side * apart)
    assert strict.reference is None


def test_a_learned_reference_is_the_weighted_one():
    resultant = (3 * folded(0.1, 4) + folded(0.1 + math.pi / 2, 4)) / 4
    reference, agreement = learned_reference(resultant, 4)
    assert (reference, agreement) == pytest.approx((0.1, 1.0))
    # Of two that disagree the heavier wins, and the agreement tells.
    reference, agreement = learned_reference((3 * folded(0.0, 4) + folded(math.pi / 4, 4)) / 4, 4)
    assert (reference, agreement) == pytest.approx((0.0, 0.5), abs=1e-12)


def test_the_least_of_angles_is_one():
    assert learned_reference(complex(1.0, 5e-324), 4) == pytest.approx((0.0, 1.0), abs=1e-12)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"count": 0}, "count = 0, expected at least 1"),
        ({"reference": math.nan}, "reference = nan rad, expected a finite number"),
        ({"learn_after": 0.0}, "learn_after = 0.0, expected a positive"),
        ({"learn_agreement": 1.5}, "learn_agreement = 1.5, expected 0 to 1"),
    ],
)
def test_impossible_directions_are_refused(keys, message):
    with pytest.raises(InputError, match=message):
        DirectionParams(**keys)
