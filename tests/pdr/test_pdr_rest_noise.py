"""The rest test goes by the noise that a recording shows: a phone at rest rests, and a moving foot moves."""

import math

import numpy as np
import pytest

from benchmarks.validation import still_start
from footfall.conventions import GRAVITY
from footfall.errors import InputError
from footfall.pdr.reckoning import PdrParams, dead_reckon
from footfall.pdr.rest import static_bias, still_time
from footfall.pdr.stream import dead_reckon_blocks
from footfall.recording import Recording
from tests.helpers.synthetic_foot import walk

DEG = math.pi / 180
UNITS = range(3000, 3040)
PHONE = (26.0, 6400.0)  # deg/rt-h, ug/rt-Hz
T = np.arange(27 * 200 + 1) / 200


@pytest.fixture(scope="module")
def phones():
    """Whether 40 units of a phone's grade are called moving: at rest, turning for 1 s and 3 s, stepping."""
    return np.array(list(still_start.outcomes(still_start.sheet_with(*PHONE), UNITS)))


def noisy(seed, rate_noise=PHONE[0], force_noise=PHONE[1], gyro=0.0, force=0.0, t=T):
    """Still but for `gyro` (n,) rad/s and `force` (n,) m/s2 about and along z, with white noise alone."""
    rng = np.random.default_rng(seed)
    root = math.sqrt(1 / np.median(np.diff(t)))
    z, up = np.array([0.0, 0.0, 1.0]), np.tile([0.0, 0.0, GRAVITY], (len(t), 1))
    return Recording(
        t,
        rate_noise * DEG / 60 * root * rng.standard_normal((len(t), 3)) + np.outer(gyro * np.ones(len(t)), z),
        up
        + force_noise * 1e-6 * GRAVITY * root * rng.standard_normal((len(t), 3))
        + np.outer(force * np.ones(len(t)), z),
    )


def moves(recording, bias_s=25.0):
    try:
        static_bias(recording, bias_s)
    except InputError as error:
        return "moves at" in str(error)
    return False


def test_units_of_a_phones_grade_rest(phones):
    assert phones[:, 0].sum() == 0


def test_each_of_them_is_refused_where_it_turns_by_5_degrees_a_second_or_steps(phones):
    assert phones[:, 2].all()
    assert phones[:, 3].all()
    assert phones[:, 1].mean() > 0.9  # a second is two means of half a second, or one whole one


@pytest.mark.parametrize("channel", ["gyro", "force"])
def test_one_noisy_sensor_of_the_two_is_enough(channel):
    """Without the noise most of 40 would be refused: by 2 deg/s in one, by 0.4 m/s2 in the other."""
    levels = {"rate_noise": 0.0, "force_noise": 0.0} | (
        {"rate_noise": 35.0} if channel == "gyro" else {"force_noise": 9000.0}
    )
    assert not any(moves(noisy(seed, **levels)) for seed in UNITS)


def test_the_time_at_rest_is_theirs_too():
    """`still_time` ends half a second before the half second in which the foot begins to turn."""
    for seed in UNITS:
        assert still_time(noisy(seed)) == 25.0
        begin = np.random.default_rng(seed).uniform(3.0, 20.0)
        found = still_time(noisy(seed, gyro=15 * DEG * (begin < T)))
        assert begin - 1.5 < found <= begin


@pytest.mark.parametrize(("early", "late"), [(0.0, 1.0), (1.0, 0.0)])
def test_a_foot_that_turns_in_one_half_of_the_time_is_found_whichever(early, late):
    """What is compared is the mean of all before, which a turn of the first half has moved."""
    turn = 5 * DEG * np.where(T < 12.5, early, late)
    assert all(moves(noisy(seed, gyro=turn)) for seed in UNITS[:20])


def test_without_noise_the_limits_are_2_degrees_a_second_and_4_tenths():
    """Samples of a coarse resolution show no noise at all."""
    for least, gyro in ((False, 1.9), (True, 2.1)):
        assert moves(noisy(0, 0.0, 0.0, gyro=gyro * DEG * (T > 7.0))) is least
    for least, force in ((False, 0.39), (True, 0.41)):
        assert moves(noisy(0, 0.0, 0.0, force=force * (T > 7.0))) is least


def test_a_quiet_unit_that_shows_a_little_noise_is_held_to_them():
    """A twentieth of a phone's noise explains 0.2 deg/s, not 2."""
    for seed in range(10):
        assert not moves(noisy(seed, 1.3, 320.0, gyro=1.6 * DEG * (T > 7.0)))
        assert moves(noisy(seed, 1.3, 320.0, gyro=2.4 * DEG * (T > 7.0)))


def test_a_jolt_is_no_noise():
    """A foot that is put down with a thud in the first half second does not excuse a turn later on."""
    thud = 30.0 * (np.abs(T - 0.3) < 0.02) * np.sign(np.sin(2 * np.pi * 80 * T))
    for seed in range(10):
        assert moves(noisy(seed, 1.3, 320.0, gyro=thud + 3 * DEG * (T > 7.0)))


def test_who_walks_from_the_first_sample_on_does_not_rest():
    """His swings are no noise: neighbouring samples differ by little."""
    truth = walk(np.zeros(31), still_s=0.0)
    assert moves(truth.recording(angle_random_walk=PHONE[0] * DEG / 60, seed=1), 10.0)


@pytest.mark.parametrize("rate", [25.0, 50.0, 100.0, 400.0])
def test_at_any_rate(rate):
    t = np.arange(int(27 * rate) + 1) / rate
    assert sum(moves(noisy(seed, t=t)) for seed in UNITS[:20]) == 0
    assert all(moves(noisy(seed, t=t, gyro=8 * DEG * ((t > 9) & (t < 12)))) for seed in UNITS[:20])


def test_blocks_of_a_noisy_recording_make_the_footfalls_of_the_whole():
    truth = walk(np.cumsum(np.random.default_rng(2).normal(0, 0.2, 30)), still_s=26.0)
    noise = (
        PHONE[1]
        * 1e-6
        * GRAVITY
        * math.sqrt(200)
        * np.random.default_rng(5).standard_normal(truth.accel.shape)
    )
    recording = truth.recording(accel_error=noise, angle_random_walk=PHONE[0] * DEG / 60, seed=4)
    parts = np.array_split(np.arange(len(recording.t)), 7)
    blocks = [Recording(recording.t[p], recording.gyro[p], recording.accel[p]) for p in parts]
    found, used = dead_reckon_blocks(blocks, PdrParams(), rest_time=still_time)
    assert used == 25.0
    np.testing.assert_allclose(found.position, dead_reckon(recording).position, atol=1e-9)
