"""What a track says of its own likelihood."""

import numpy as np
import pytest

from footfall.pdr.plausibility import (
    doubtful_rows,
    judge_track,
    longest_movement,
    spoilt_share,
    velocity_left,
)
from footfall.pdr.reckoning import PdrParams, detect
from footfall.recording import Recording
from tests.helpers.synthetic_foot import walk

PARAMS = PdrParams(bias_s=2.0)


def track(lengths, times=1.1, rise=0.0):
    steps = np.column_stack([lengths, np.zeros(len(lengths)), np.broadcast_to(rise, len(lengths))])
    position = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    return np.concatenate([[0.0], np.cumsum(np.broadcast_to(times, len(lengths)))]), position


def judged(lengths, times=1.1, rise=0.0, left=0.2, movement=1.0, spoilt=0.0):
    return judge_track(*track(lengths, times, rise), left, movement, spoilt)


def test_a_usual_walk_has_nothing_to_tell():
    likely = judged([1.4] * 9)
    assert (likely.impossible(), likely.warnings()) == ("", [])
    assert likely.strides == 9
    assert "longest stride 1.40 m" in likely.line()


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        ({"left": 1.4}, "leave a velocity of 1.4 m/s"),
        ({"movement": 4.0}, "moves for 4 s without a stance"),
        ({"lengths": [1.4, 2.3, 1.4]}, "a stride of 2.30 m"),
        ({"spoilt": 0.08}, "8 % of the samples"),
        ({"rise": 0.2}, "rise or fall by 0.2 m"),
    ],
)
def test_what_is_beyond_the_usual_is_warned_of(changed, told):
    likely = judged(**{"lengths": [1.4] * 9} | changed)
    assert likely.impossible() == ""
    (said,) = likely.warnings()
    assert told in said


@pytest.mark.parametrize(
    ("lengths", "times", "said"),
    [
        ([0.05] * 9, 1.1, "no stride"),
        ([1.4, 2.6, 1.4], 1.1, "a stride of 2.6 m"),
        ([2.6] * 5, 0.7, ""),  # a runner
        ([5.2] * 5, 0.7, "a stride of 5.2 m"),
        ([1.4, 1.4, 2.9, 1.4], [1.1, 1.1, 2.3, 1.1], ""),  # two strides in one
    ],
)
def test_what_no_legs_can_do_is_told_by_the_pace(lengths, times, said):
    assert said in judged(lengths, times).impossible()
    assert bool(said) == bool(judged(lengths, times).impossible())


def test_a_wrong_rate_leaves_velocity():
    truth = walk(np.zeros(9), still_s=3.0, rate=200.0)
    left = []
    for rate in (1.0, 0.75):
        recording = Recording(truth.t[1:] / rate, truth.gyro[1:], truth.accel[1:])
        left.append(velocity_left(recording, detect(recording, PARAMS), PARAMS))
    assert left[0] < 0.05
    assert left[1] > 1.0


def test_the_longest_movement_is_between_two_rests():
    t = np.arange(100) / 10
    score = np.full(100, 2.0)
    score[[10, 11, 40, 90]] = 0.5
    assert longest_movement(t, score) == pytest.approx(5.0)
    assert longest_movement(t, np.full(100, 2.0)) == pytest.approx(9.9)


def test_a_hole_makes_the_stride_around_it_doubtful():
    t = np.array([0.0, 1.0, 2.0, 3.0])
    np.testing.assert_array_equal(doubtful_rows(t, [(1.2, 1.4)]), [False, False, True, False])
    np.testing.assert_array_equal(doubtful_rows(t, [(0.9, 1.1)]), [False, True, True, False])
    assert not doubtful_rows(t, [(3.2, 3.4)]).any()


def test_the_bias_is_taken_off_before_velocity_is_left():
    truth = walk(np.zeros(9), still_s=3.0, rate=200.0)
    biased = Recording(truth.t[1:], truth.gyro[1:] + np.radians([1.0, 3.0, -2.0]), truth.accel[1:])
    assert velocity_left(biased, detect(biased, PARAMS), PARAMS) < 0.05


def test_height_is_gained_upwards():
    likely = judged([1.4] * 9, rise=0.1)
    assert likely.height_m == pytest.approx(0.9)
    assert "height +0.90 m" in likely.line()
    assert judged([1.4] * 9, rise=-0.1).height_m == pytest.approx(-0.9)


def test_filled_and_clipped_samples_are_spoilt():
    found = {"filled": 10, "clipped": {"gyro_x": 5, "accel_z": 7}, "rows": 100}
    assert spoilt_share(found) == pytest.approx(0.17)
    assert spoilt_share({}) == 0.0
