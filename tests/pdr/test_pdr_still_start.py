"""What counts as a still start, to the edge of each limit."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from footfall.conventions import GRAVITY
from footfall.errors import InputError
from footfall.pdr.reckoning import PdrParams, StartPose, level_attitude
from footfall.pdr.rest import static_bias
from footfall.recording import Recording

DEG = np.pi / 180
RATE, BIAS_S = 200.0, 10.0
T = np.arange(round(12 * RATE)) / RATE
ASLANT = np.array([2.0, -1.0, 2.0]) / 3
LATER = T > 6.1  # in the middle of a half second


def start(gyro=0.0, force=0.0) -> Recording:
    """At rest, but for the (n,) rates (rad/s) and forces (m/s2) aslant to every axis."""
    up = np.tile([0.0, 0.0, GRAVITY], (len(T), 1))
    return Recording(
        T, np.outer(gyro * np.ones(len(T)), ASLANT), up + np.outer(force * np.ones(len(T)), ASLANT)
    )


def refuses(recording, match, bias_s=BIAS_S):
    with pytest.raises(InputError, match=match):
        static_bias(recording, bias_s)


def test_a_foot_that_begins_to_turn_by_2_degrees_a_second_moves():
    static_bias(start(gyro=1.9 * DEG * LATER), BIAS_S)
    refuses(start(gyro=2.1 * DEG * LATER), r"moves at t = 6\.5 s \(gyro\)")
    refuses(start(gyro=-2.1 * DEG * LATER), r"moves at t = 6\.5 s \(gyro\)")


def test_a_foot_whose_force_changes_by_4_tenths_moves():
    static_bias(start(force=0.39 * LATER), BIAS_S)
    refuses(start(force=0.41 * LATER), r"moves at t = 6\.5 s \(accel\)")


def test_a_steady_bias_is_no_movement():
    rest = static_bias(start(gyro=9 * DEG, force=0.5), BIAS_S)
    np.testing.assert_allclose(rest.gyro_bias, 9 * DEG * ASLANT, rtol=1e-12)
    np.testing.assert_allclose(rest.force, [0, 0, GRAVITY] + 0.5 * ASLANT, rtol=1e-12)


@pytest.mark.parametrize(("jolt_deg_s", "still"), [(180.0, True), (220.0, False)])
def test_a_jolt_counts_by_its_mean_over_half_a_second(jolt_deg_s, still):
    """One sample of 5 ms in a hundred: 200 deg/s are 2 deg/s in the mean."""
    jolt = np.zeros(len(T))
    jolt[round(4.2 * RATE)] = jolt_deg_s * DEG
    if still:
        static_bias(start(gyro=jolt), BIAS_S)
    else:
        refuses(start(gyro=jolt), r"moves at t = 4 s")


@pytest.mark.parametrize(("bias_s", "when"), [(6.2, ""), (6.3, ""), (6.45, "5.5"), (6.9, "6")])
def test_what_is_left_beyond_whole_half_seconds_belongs_to_the_last(bias_s, when):
    """6 deg/s from 6.1 s on: 0.2 s of a last part of 0.8 s are nothing, 0.35 s of 0.95 s are too much."""
    recording = start(gyro=6 * DEG * LATER)
    if when:
        refuses(recording, rf"moves at t = {when} s", bias_s)
    else:
        static_bias(recording, bias_s)


def test_a_movement_in_the_first_half_second_shows_in_the_second():
    refuses(start(gyro=3 * DEG * (T < 0.5)), r"moves at t = 0\.5 s")


def test_stamps_may_begin_at_any_time():
    recording = start(gyro=DEG, force=0.2)
    late = Recording(recording.t + 1000.0, recording.gyro, recording.accel)
    here, there = static_bias(recording, BIAS_S), static_bias(late, BIAS_S)
    np.testing.assert_array_equal(here.gyro_bias, there.gyro_bias)
    assert here.last == there.last


def test_a_recording_as_long_as_the_bias_time_will_do_and_a_sample_less_will_not():
    recording = start()
    static_bias(recording, float(T[-1]))
    refuses(recording, r"lasts 11\.99\d* s, shorter than the 12 s at rest", 12.0)


def test_a_recording_without_a_sample_in_the_bias_time_is_refused():
    recording = start()
    sparse = Recording(recording.t[::400], recording.gyro[::400], recording.accel[::400])
    refuses(sparse, "no sample within the first 1.5 s", 1.5)
    static_bias(sparse, 2.0)  # one will do


def test_the_bias_is_the_mean_of_every_sample_but_the_first_up_to_the_bias_time():
    """The first row belongs to the time before the record."""
    rng = np.random.default_rng(4)
    gyro, force = 0.2 * DEG * rng.standard_normal(len(T)), 0.02 * rng.standard_normal(len(T))
    gyro[0] = force[0] = 50.0
    recording = start(gyro, force)
    rest = static_bias(recording, BIAS_S)
    inside = (T > 0) & (T < BIAS_S + 0.002)
    assert inside.sum() == 2000
    np.testing.assert_allclose(rest.gyro_bias, recording.gyro[inside].mean(axis=0), rtol=1e-12)
    np.testing.assert_allclose(rest.force, recording.accel[inside].mean(axis=0), rtol=1e-12)


def test_nothing_after_the_bias_time_is_looked_at():
    rest = static_bias(start(gyro=90 * DEG * (T > BIAS_S + 0.002)), BIAS_S)
    assert T[rest.last] == pytest.approx(BIAS_S)
    assert not rest.gyro_bias.any()


@pytest.mark.parametrize("sign", [1, -1])
def test_gravity_is_within_a_metre_a_second_squared(sign):
    def weighing(off):
        return Recording(T, np.zeros((len(T), 3)), np.outer(np.ones(len(T)), (GRAVITY + off) * ASLANT))

    static_bias(weighing(0.99 * sign), BIAS_S)
    refuses(weighing(1.01 * sign), r"measure \d+\.?\d* at rest, expected 9\.81 \+- 1 m/s2")


@pytest.mark.parametrize("side", [90, -90])
def test_an_x_axis_has_a_heading_10_degrees_from_vertical(side):
    def up(from_vertical_deg):
        pitch = side - np.sign(side) * from_vertical_deg
        return Rotation.from_euler("ZYX", [20, pitch, 30], degrees=True).inv().apply([0, 0, GRAVITY])

    level_attitude(up(10.1))
    with pytest.raises(InputError, match=r"is 9\.9 deg from vertical, expected at least 10 deg"):
        level_attitude(up(9.9))


def test_a_bias_time_of_half_a_second_is_one():
    assert PdrParams(bias_s=0.5).bias_s == 0.5
    assert len(static_bias(start(), 0.5).gyro_bias) == 3


def test_left_alone_a_walk_starts_at_the_origin_and_heads_along_x():
    assert StartPose() == StartPose((0.0, 0.0, 0.0), 0.0)
