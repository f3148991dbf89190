"""The compiled filter against its twin, split calls against whole ones, and what a covariance must be."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from footfall.errors import InputError
from footfall.pdr.filter._plain import PlainFilter
from footfall.pdr.filter.ins import FilterSettings, InertialFilter, frozen
from footfall.pdr.filter.layout import (
    ERROR,
    G_SENSITIVITY,
    GYRO_BIAS,
    HEADING,
    STATE,
    STATES,
    VELOCITY,
    Measurement,
)
from tests.helpers.filter_walks import alignment, tossed

KINDS = {
    "stance": FilterSettings(),
    "paper": FilterSettings.paper(),
    "frozen": frozen(FilterSettings()),
    "accelerometer only": FilterSettings(estimate_gyro_bias=False, heading_sd=0.1),
    "everything": FilterSettings(zaru=True, g_sensitivity=True, heading_sd=0.2),
    "everything turns": FilterSettings(zaru=True, g_sensitivity=True, velocity_turns=True),
}


# The direction of the body that counts as the vertical: that of the rest, or another.
VERTICALS = {"rest": None, "walk": np.array([-0.9, 0.2, 1.6])}


def assert_same(a, b, rtol=1e-8):
    same = np.abs(a.quaternion @ Rotation.from_matrix(b.attitude).as_quat(scalar_first=True))
    assert same == pytest.approx(1.0, abs=1e-13)
    for name in ("position", "velocity", "accel_bias", "gyro_bias", "g_sensitivity"):
        np.testing.assert_allclose(getattr(a, name), getattr(b, name), rtol=rtol, atol=1e-9, err_msg=name)
    sd = np.sqrt(np.diag(b.covariance))
    scale = np.outer(sd, sd) + 1e-300
    assert np.abs((a.covariance - b.covariance) / scale).max() < rtol


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("vertical", VERTICALS)
def test_compiled_equals_plain(kind, vertical):
    t, gyro, accel, update = tossed(1)
    # Updates that are believed little: motion that is called rest would amplify rounding beyond bounds.
    kind = replace(KINDS[kind], sigma_velocity=1.0, sigma_rate=5.0)
    start = replace(alignment(), vertical=VERTICALS[vertical])
    compiled, plain = InertialFilter(kind, start), PlainFilter(kind, start)
    for half in (slice(0, 200), slice(200, 400)):
        compiled.advance(t[half], gyro[half], accel[half], update[half])
        for k in range(*half.indices(400)):
            plain.take(t[k], gyro[k], accel[k], update[k])
        assert_same(compiled, plain)
        put_right = compiled.correct_heading(0.1, 0.05)
        plain.correct_heading(0.1, 0.05)
        np.testing.assert_allclose(put_right, plain.error, rtol=1e-7, atol=1e-10)
        assert_same(compiled, plain)


@pytest.mark.parametrize("kind", KINDS)
@given(cuts=st.lists(st.integers(0, 400), max_size=6))
@settings(max_examples=15)
def test_streaming_equals_batch(kind, cuts):
    t, gyro, accel, update = tossed(2)
    whole, split = InertialFilter(KINDS[kind], alignment()), InertialFilter(KINDS[kind], alignment())
    whole.advance(t, gyro, accel, update)
    edges = [0, *sorted(cuts), 400]
    for a, b in pairwise(edges):
        split.advance(t[a:b], gyro[a:b], accel[a:b], update[a:b])
    for name in ("position", "velocity", "quaternion", "accel_bias", "gyro_bias", "covariance"):
        np.testing.assert_allclose(getattr(split, name), getattr(whole, name), rtol=1e-9, atol=1e-12)
    assert split.t == whole.t


@pytest.mark.parametrize("kind", KINDS)
@given(seed=st.integers(0, 2**32 - 1), rows=st.integers(1, 4))
@settings(max_examples=10)
def test_any_measurement_is_taken_in(kind, seed, rows):
    """Row by row as all at once, where the rows are independent."""
    rng = np.random.default_rng(seed)
    kind = replace(KINDS[kind], sigma_velocity=1.0, sigma_rate=5.0)
    t, gyro, accel, update = (column[:100] for column in tossed(5))
    compiled, plain = InertialFilter(kind, alignment()), PlainFilter(kind, alignment())
    compiled.advance(t, gyro, accel, update)
    for k in range(len(t)):
        plain.take(t[k], gyro[k], accel[k], update[k])
    h = rng.normal(size=(rows, kind.states)) * (rng.random((rows, kind.states)) < 0.3)
    z, r = rng.normal(0, 0.1, rows), rng.uniform(0.5, 2.0, rows)
    put_right = compiled.update(Measurement(z, h, r))
    p = plain.covariance
    gain = p @ h.T @ np.linalg.inv(h @ p @ h.T + np.diag(r))
    np.testing.assert_allclose(put_right, gain @ z, rtol=1e-6, atol=1e-9)
    left = np.eye(len(p)) - gain @ h
    plain.covariance = left @ p @ left.T + gain @ np.diag(r) @ gain.T
    plain._put_right(gain @ z)
    assert_same(compiled, plain, rtol=1e-6)


@pytest.mark.parametrize("stops", [[], [-1], [-1, 0, 57, 99], [99], range(-1, 100)])
def test_states_are_kept_at_stops(stops):
    t, gyro, accel, update = (column[:100] for column in tossed(6))
    found = InertialFilter(FilterSettings(g_sensitivity=True), alignment())
    one = found.snapshot()
    states = found.advance(t, gyro, accel, update, stops=stops)
    assert len(states.t) == len(states.state) == len(states.covariance) == len(stops)
    done = -1
    for place, stop in enumerate(stops):
        rows = slice(done + 1, stop + 1)
        one.advance(t[rows], gyro[rows], accel[rows], update[rows])
        done = stop
        assert states.t[place] == one.t
        for name in ("position", "accel_bias", "gyro_bias"):
            np.testing.assert_array_equal(getattr(states, name)[place], getattr(one, name))
        np.testing.assert_array_equal(states.covariance[place], one.covariance)
        assert states.heading[place] == pytest.approx(one.heading, abs=1e-15)
        assert states.heading_sd[place] == one.heading_sd
    assert found.t == t[-1]


def test_each_error_has_its_place():
    """Nothing overlaps, nothing is left out, and what is optional comes last."""
    for layout in (ERROR, STATE):
        places = [k for part in layout.values() for k in range(part.start, part.stop)]
        assert places == list(range(len(places)))
    wide, narrow = FilterSettings(g_sensitivity=True), FilterSettings()
    assert (wide.states, narrow.states) == (24, 15)
    assert list(wide.layout)[:-1] == list(narrow.layout)
    assert all(wide.layout[name] == part for name, part in narrow.layout.items())
    assert (HEADING, STATES) == (8, 25)


def test_an_update_is_the_same_in_the_batch_and_by_hand():
    t, gyro, accel, _ = tossed(3)
    last = np.zeros(400, dtype=int)
    last[-1] = 2
    for kind in KINDS.values():
        flagged, asked = InertialFilter(kind, alignment()), InertialFilter(kind, alignment())
        flagged.advance(t, gyro, accel, last)
        asked.advance(t, gyro, accel, np.zeros(400, dtype=int))
        before = asked.velocity
        put_right = asked.rest(2)
        np.testing.assert_array_equal(asked.covariance, flagged.covariance)
        np.testing.assert_array_equal(asked.position, flagged.position)
        np.testing.assert_allclose(asked.velocity, before + put_right[VELOCITY])


@pytest.mark.parametrize("vertical", VERTICALS)
def test_zero_velocity_touches_nothing_that_turns_about_the_vertical(vertical):
    """Not the heading, nor the gyro's bias and g-sensitivity about the body's vertical; the rest it does."""
    start = replace(alignment(), vertical=VERTICALS[vertical])
    known = start.force if vertical == "rest" else VERTICALS[vertical]
    up = known / np.linalg.norm(known)
    np.testing.assert_allclose(start.up, up, atol=1e-15)
    found = InertialFilter(KINDS["everything"], start)
    put_right = 0.0
    for rows in (slice(0, 150), slice(150, 300), slice(300, 400)):  # in three attitudes
        t, gyro, accel, _ = (column[rows] for column in tossed(7))
        found.advance(t, gyro, accel, np.zeros(len(t), dtype=int))
        put_right = put_right + found.rest(1)
    assert put_right[HEADING] == pytest.approx(0.0, abs=1e-12)
    assert up @ put_right[GYRO_BIAS] == pytest.approx(0.0, abs=1e-12)
    assert np.abs(put_right[GYRO_BIAS]).max() > 1e-4
    g = put_right[G_SENSITIVITY].reshape(3, 3)
    np.testing.assert_allclose(up @ g, 0.0, atol=1e-12)
    assert np.abs(g).max() > 1e-6


@given(
    seed=st.integers(0, 2**32 - 1),
    sigma_velocity=st.floats(1e-4, 1.0),
    accel_noise=st.floats(0.0, 1.0),
    gyro_noise=st.floats(0.0, 0.1),
    gyro_bias_sd=st.floats(0.0, 0.1),
    heading_sd=st.floats(0.0, 3.0),
    turns=st.booleans(),
    wide=st.booleans(),
)
@settings(max_examples=60)
def test_a_covariance_is_symmetric_and_positive(
    seed, sigma_velocity, accel_noise, gyro_noise, gyro_bias_sd, heading_sd, turns, wide
):
    found = InertialFilter(
        FilterSettings(
            sigma_velocity=sigma_velocity,
            accel_noise=accel_noise,
            gyro_noise=gyro_noise,
            gyro_bias_sd=gyro_bias_sd,
            heading_sd=heading_sd,
            velocity_turns=turns,
            zaru=True,
            g_sensitivity=wide,
        ),
        alignment(seed),
    )
    found.advance(*tossed(seed))
    found.correct_heading(0.3, 0.01)
    p = found.covariance
    np.testing.assert_array_equal(p, p.T)
    sd = np.sqrt(np.diag(p))
    assert (sd[sd == 0].size == 0) or gyro_bias_sd == 0
    live = sd > 0
    assert np.linalg.eigvalsh(p[np.ix_(live, live)] / np.outer(sd[live], sd[live])).min() > -1e-9


def test_a_copy_goes_its_own_way():
    t, gyro, accel, update = tossed(4)
    found = InertialFilter(FilterSettings(), alignment())
    found.advance(t[:200], gyro[:200], accel[:200], update[:200])
    position, covariance, copy = found.position, found.covariance, found.snapshot()
    found.advance(t[200:], gyro[200:], accel[200:], update[200:])
    np.testing.assert_array_equal(copy.position, position)
    np.testing.assert_array_equal(copy.covariance, covariance)
    copy.advance(t[200:], gyro[200:], accel[200:], update[200:])
    np.testing.assert_array_equal(copy.position, found.position)
    assert copy.t == found.t


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"update": "often"}, "update = 'often'"),
        ({"sigma_velocity": 0.0}, "sigma_velocity = 0"),
        ({"accel_noise": float("nan")}, "accel_noise = nan"),
        ({"gyro_bias_sd": -1.0}, "gyro_bias_sd = -1.0"),
        ({"zaru": True, "estimate_gyro_bias": False}, "zaru needs"),
        ({"g_sensitivity": True, "estimate_gyro_bias": False}, "g_sensitivity needs"),
    ],
)
def test_settings_that_mean_nothing_are_refused(wrong, said):
    with pytest.raises(InputError, match=said):
        FilterSettings(**wrong)


@pytest.mark.parametrize(("innovation", "sd"), [(float("nan"), 0.1), (0.1, 0.0), (0.1, float("inf"))])
def test_a_heading_that_says_nothing_is_refused(innovation, sd):
    with pytest.raises(InputError, match="innovation"):
        InertialFilter(FilterSettings(), alignment()).correct_heading(innovation, sd)
