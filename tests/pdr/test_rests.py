"""A static bias from the rest that there is, wherever it is, and a start in mid-walk."""

import numpy as np
import pytest

from footfall.conventions import GRAVITY
from footfall.errors import InputError
from footfall.pdr.reckoning import PdrParams, dead_reckon, detect
from footfall.pdr.rests import SWAY, UNKNOWN_SD, find_rest, still_stretches
from footfall.recording import Recording
from tests.helpers.synthetic_foot import walk

RATE = 200.0
BIAS = np.radians([0.4, -0.3, 0.7])
PARAMS = PdrParams()


def recorded(before=3.0, after=0.0, strides=8, cut=0.0, seed=0):
    """A straight walk with rests before and after it, from `cut` s on, as a sensor with a bias tells it."""
    truth = walk(np.zeros(strides + 1), still_s=max(before, 0.5), rate=RATE)
    gyro, accel = truth.gyro[1:], truth.accel[1:]
    rest = int(after * RATE)
    gyro = np.vstack([gyro, np.tile(gyro[-1], (rest, 1))])
    accel = np.vstack([accel, np.tile(accel[-1], (rest, 1))])
    noise = np.random.default_rng(seed).standard_normal((2, *gyro.shape))
    rows = slice(int(cut * RATE), None)
    return Recording(
        t=np.arange(len(gyro))[rows] / RATE - cut,
        gyro=(gyro + BIAS + 2e-3 * noise[0])[rows],
        accel=(accel + 2e-2 * noise[1])[rows],
    )


def navigated(recording):
    return dead_reckon(recording, PARAMS, None, detect(recording, PARAMS, find_rest(recording, PARAMS)))


def test_the_bias_is_that_of_the_start():
    rest = find_rest(recorded(before=6.0), PARAMS)
    np.testing.assert_allclose(rest.gyro_bias, BIAS, atol=2e-4)
    assert rest.source.endswith("at rest at the start")
    assert rest.bias_sd == pytest.approx(SWAY / 5.5, rel=0.1)


@pytest.mark.parametrize("still", [0.45, 0.7, 1.2])
def test_a_short_rest_is_enough_to_be_level(still):
    whole = recorded(before=3.0)
    recording = recorded(before=3.0, cut=3.0 - still)
    rest = find_rest(recording, PARAMS)
    assert 0.25 < recording.t[rest.last] < still + 0.05
    np.testing.assert_allclose(rest.force / np.linalg.norm(rest.force), whole.accel[5] / GRAVITY, atol=0.02)
    assert len(navigated(recording)) == 9


def test_people_lean_before_they_step():
    """The tenth of a second before the first movement is no rest."""
    recording = recorded(before=3.0, cut=3.0 - 0.45)
    moved = np.flatnonzero(np.linalg.norm(recording.gyro - BIAS, axis=1) > np.radians(4))[0]
    assert recording.t[find_rest(recording, PARAMS).last] < recording.t[moved] - 0.1


@pytest.mark.parametrize(("turn", "rests"), [(20.0, 1), (40.0, 0)])
def test_a_turntable_is_no_rest(turn, rests):
    t = np.arange(1000) / RATE
    gyro = np.tile(np.radians([0.0, 0.0, turn]), (len(t), 1))
    assert len(still_stretches(Recording(t, gyro, np.tile([0.0, 0.0, GRAVITY], (len(t), 1))))) == rests


def test_a_later_rest_counts_by_its_square():
    """Half a second at the start knows the bias badly, eight at the end well: these decide."""
    recording = recorded(before=3.0, cut=2.2, after=8.0)
    rest = find_rest(recording, PARAMS)
    assert "at the start" not in rest.source or "at the end" in rest.source
    np.testing.assert_allclose(rest.gyro_bias, BIAS, atol=3e-4)
    assert rest.bias_sd < SWAY / 6


def test_two_rests_that_differ_are_weighed():
    recording = recorded(before=4.5, after=8.5)
    gyro = recording.gyro.copy()
    gyro[recording.t < 4.5] += np.radians([0.0, 0.0, 0.1])
    found = find_rest(Recording(recording.t, gyro, recording.accel), PARAMS).gyro_bias - BIAS
    assert 0 < np.degrees(found[2]) < 0.1 / 3


@pytest.mark.parametrize(("change", "told"), [(0.0, False), (0.3, False), (2.0, True), (-2.0, True)])
def test_a_bias_that_changes_between_rests_is_told(change, told):
    recording = recorded(before=4.5, after=4.5)
    gyro = recording.gyro.copy()
    gyro[recording.t > 10] += np.radians([0.0, 0.0, change])
    found = find_rest(Recording(recording.t, gyro, recording.accel), PARAMS).changed
    assert bool(found) == told
    if told:
        assert np.degrees(found) == pytest.approx(abs(change), rel=0.05)


def test_short_rests_may_differ_by_more():
    """In half a second a foot sways by as much as a bias may be."""
    recording = recorded(before=3.0, cut=2.4, after=4.5)
    for change, told in ((1.2, False), (4.0, True)):
        gyro = recording.gyro.copy()
        gyro[recording.t > 8] += np.radians([0.0, 0.0, change])
        assert bool(find_rest(Recording(recording.t, gyro, recording.accel), PARAMS).changed) == told


def test_a_recording_without_rest_begins_at_its_first_stance():
    recording = recorded(before=3.0, cut=4.1)
    rest = find_rest(recording, PARAMS)
    assert rest.source == ""
    assert rest.bias_sd == UNKNOWN_SD
    np.testing.assert_array_equal(rest.gyro_bias, 0)
    # It stands on its sole, whose attitude is that of the rest.
    np.testing.assert_allclose(rest.force, recorded().accel[50], atol=0.15)
    found = navigated(recording)
    np.testing.assert_allclose(np.diff(found.position[:, 0]), 1.5, atol=0.06)
    assert len(found) >= 7


def test_a_rest_in_the_middle_or_at_the_end_serves_a_start_in_mid_walk():
    rest = find_rest(recorded(before=3.0, cut=4.1, after=6.0), PARAMS)
    assert rest.source.endswith("at rest at the end")
    np.testing.assert_allclose(rest.gyro_bias, BIAS, atol=5e-4)


def test_stances_are_no_rests():
    assert still_stretches(recorded(before=0.5, cut=0.8)) == []


def test_no_gravity_and_no_stance_are_refused():
    recording = recorded()
    with pytest.raises(InputError, match=r"expected 9\.81"):
        find_rest(Recording(recording.t, recording.gyro, recording.accel / 2), PARAMS)
    swinging = np.outer(8 * np.cos(2 * np.pi * recording.t), [1.0, 0.0, 0.0])
    with pytest.raises(InputError, match="neither rests nor has a stance"):
        find_rest(Recording(recording.t, swinging, np.tile([0, 0, GRAVITY], (len(swinging), 1))), PARAMS)
