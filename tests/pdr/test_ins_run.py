"""A recording through the filter: start, stances, heading methods, gaps, smoothing, several at once."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from footfall.conventions import GRAVITY, wrap
from footfall.errors import InputError
from footfall.hdr.methods import METHODS, Reckoning, tracks
from footfall.pdr.filter.ins import Alignment, FilterSettings, InertialFilter, frozen
from footfall.pdr.filter.layout import HEADING
from footfall.pdr.filter.run import align, run_filter, run_filters, walking_vertical
from footfall.pdr.reckoning import PdrParams, StartPose, dead_reckon, detect
from footfall.pdr.stance import Stances
from footfall.recording import Recording
from tests.helpers.synthetic_foot import walk

BEND = np.concatenate([[0.0, 0.0], np.linspace(0, 2, 40)])


@pytest.fixture(scope="module")
def bend():
    return walk(BEND, still_s=26.0)


def drift(truth, deg_s):
    """A gyro error about the IMU's axes that comes up after the still start."""
    return (truth.t > 25.5)[:, None] * np.radians(deg_s)


def heading_error(found, truth):
    return np.degrees(found.footfalls.heading - truth.heading(found.footfalls.t))


def test_a_perfect_imu_closes(bend):
    """Default settings: the heading is the gyro's, the places are the foot's to a few centimetres."""
    found = run_filter(bend.recording())
    assert len(found.footfalls) == len(BEND)
    assert np.abs(heading_error(found, bend)).max() < 0.02
    place = bend.position[bend.at(found.footfalls.t)]
    # The foot creeps forward at its quietest instant too, which zero velocity takes for standing.
    np.testing.assert_allclose(found.footfalls.position, place - place[0], atol=0.3)
    plain = dead_reckon(bend.recording())
    np.testing.assert_array_equal(found.footfalls.t, plain.t)


def test_a_foot_that_is_truly_at_rest_is_met_to_a_millimetre():
    truth = walk(BEND, still_s=26.0, rocking=0.0)
    found = run_filter(truth.recording(), frozen(FilterSettings()))
    place = truth.position[truth.at(found.footfalls.t)]
    np.testing.assert_allclose(found.footfalls.position, place - place[0], atol=1e-3)


def test_the_start_is_what_it_is_said_to_be(bend):
    start = StartPose((10.0, -5.0, 2.0), heading=2.5)
    here, there = run_filter(bend.recording()), run_filter(bend.recording(), start=start)
    np.testing.assert_allclose(there.footfalls.position[0], start.position, atol=1e-12)
    assert there.footfalls.heading[0] == pytest.approx(2.5)
    np.testing.assert_allclose(there.footfalls.heading - 2.5, here.footfalls.heading, atol=1e-9)
    c, s = math.cos(2.5), math.sin(2.5)
    turned = here.footfalls.position @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    np.testing.assert_allclose(there.footfalls.position - start.position, turned, atol=1e-8)


def test_an_update_at_every_sample_turns_and_one_a_stance_does_not(bend):
    """The false gyro bias: a perfect IMU on a foot that rolls."""
    paper = run_filter(bend.recording(), FilterSettings.paper())
    cured = run_filter(bend.recording())
    assert np.degrees(np.abs(paper.gyro_bias[-1])).max() > 1.0
    assert np.degrees(np.abs(cured.gyro_bias[-1])).max() < 0.05
    assert np.abs(heading_error(cured, bend)).max() < 1e-2 * np.abs(heading_error(paper, bend)).max()


def mean_vertical(truth, first_s, last_s):
    """Mean of the vertical in the body's axes, of the truth."""
    rows = slice(*truth.at(np.array([first_s, last_s])))
    mean = Rotation.from_quat(truth.quaternion[rows], scalar_first=True).as_matrix()[:, 2].mean(axis=0)
    return mean / np.linalg.norm(mean)


def test_the_walking_vertical_is_the_mean_of_ten_strides(bend):
    """As the foot pitches on its way: not the vertical of a stance, and without a rest that comes between."""
    paused = walk(BEND, still_s=26.0, pauses={4: 20.0})
    first, _, *_, last = dead_reckon(bend.recording()).t[:11]
    for truth in (bend, paused):
        recording = truth.recording()
        found = detect(recording, PdrParams())
        vertical = walking_vertical(recording, found, 0.2)
        np.testing.assert_allclose(vertical, mean_vertical(bend, first, last), atol=5e-3)
        assert np.linalg.norm(vertical) == pytest.approx(1.0, abs=1e-12)
        assert align(recording, found, StartPose()).up == pytest.approx(tuple(vertical))
        assert np.abs(vertical - mean_vertical(truth, 10.0, 20.0)).max() > 0.1  # at rest


@pytest.mark.parametrize("strides", [1, 10])
def test_the_walking_vertical_knows_so_many_strides_and_no_more(bend, strides):
    recording = bend.recording()
    found = detect(recording, PdrParams())
    at = found.stances.resets[found.stances.footfalls]
    known = {} if strides == 10 else {"strides": strides}  # ten, where nobody says another number

    def turned_at(row):
        gyro = recording.gyro.copy()
        gyro[row] += 20.0
        return walking_vertical(replace(recording, gyro=gyro), found, 0.2, **known)

    vertical = walking_vertical(recording, found, 0.2, **known)
    assert np.abs(turned_at(at[strides] - 100) - vertical).max() > 1e-3
    np.testing.assert_array_equal(turned_at(at[strides] + 1), vertical)


def test_zero_velocity_leaves_the_gyro_bias_about_the_walking_vertical_alone(bend):
    """Whatever the foot's attitude was at each update: corrections that are level each are not so in sum."""
    recording = bend.recording(gyro_error=drift(bend, [0.2, -0.3, 0.1]))
    vertical = walking_vertical(recording, detect(recording, PdrParams()), 0.2)
    bias = run_filter(recording, FilterSettings()).gyro_bias
    np.testing.assert_allclose(bias @ vertical, bias[0] @ vertical, atol=1e-12)
    assert np.ptp(bias, axis=0).max() > np.radians(0.1)  # the rest of it is learnt


def test_a_heading_that_nobody_knows_spoils_no_stride(bend):
    """A drift of 0.5 deg/s and a heading known to nothing: the strides stay as long as they are."""
    recording = bend.recording(gyro_error=drift(bend, [0.3, -0.3, 0.5]))
    settings = FilterSettings(gyro_bias_sd=np.radians(1.0), heading_sd=1.0)
    found = run_filter(recording, settings)
    assert found.heading_sd[-1] > 0.5
    truth = np.diff(bend.position[bend.at(found.footfalls.t)], axis=0)
    length = np.hypot(*truth[:, :2].T)
    np.testing.assert_allclose(found.footfalls.distance[1:].sum(), length.sum(), rtol=5e-3)
    assert np.abs(found.footfalls.position[:, 2]).max() < 0.3
    # Let to explain velocities by turning, the filter does worse.
    turning = run_filter(recording, FilterSettings(**{**vars(settings), "velocity_turns": True})).footfalls
    ours = np.abs(found.footfalls.distance[1:] - length).max()
    assert np.abs(turning.distance[1:] - length).max() > 2 * ours


def test_a_frozen_bias_stays_what_the_start_said(bend):
    bias = np.radians([0.1, -0.2, 0.3])
    recording = bend.recording(gyro_error=bias, angle_random_walk=1e-4)
    found = run_filter(recording, FilterSettings(estimate_gyro_bias=False))
    np.testing.assert_array_equal(found.gyro_bias, np.tile(found.gyro_bias[0], (len(BEND), 1)))
    np.testing.assert_allclose(found.gyro_bias[0], bias, atol=1e-4)
    assert np.ptp(found.accel_bias, axis=0).max() > 0
    both = run_filter(recording, frozen(FilterSettings()))
    assert np.ptp(both.accel_bias) == 0


class Told:
    """A heading method that knows the truth, and keeps what it was asked."""

    def __init__(self, truth, sd):
        self.truth, self.sd, self.steps = truth, sd, []

    def __call__(self, step):
        self.steps.append(step)
        if step.index % 2:
            return None
        (psi,) = np.atleast_1d(self.truth.heading(np.array([step.t])))
        return float(wrap(psi - step.heading)), self.sd


def test_a_heading_method_is_asked_once_a_footfall_and_heard(bend):
    recording = bend.recording(gyro_error=drift(bend, [0.0, 0.0, 0.5]))
    told = Told(bend, np.radians(0.5))
    without, found = run_filter(recording), run_filter(recording, corrector=told)
    f = found.footfalls
    assert [step.index for step in told.steps] == list(range(1, len(BEND)))
    np.testing.assert_allclose([step.t for step in told.steps], f.t[1:])
    np.testing.assert_allclose([step.stride_time for step in told.steps], f.interval[1:])
    for step in told.steps:
        if step.index % 2:
            assert np.isnan(found.innovation[step.index])
            assert step.heading == pytest.approx(f.heading[step.index])
            np.testing.assert_allclose(step.position, f.position[step.index])
        assert 0.1 < step.still_time < 0.6 or step.index == len(BEND) - 1
    assert np.isfinite(found.innovation[2::2]).all()
    assert np.abs(heading_error(without, bend)[-1]) > 10
    assert np.abs(heading_error(found, bend)).max() < 1.5
    # It learns the drift: by the end the gyro's error about the vertical is known.
    level = np.array([-np.sin(np.radians(20)), 0.0, np.cos(np.radians(20))])
    truth = np.radians([0.0, 0.0, 0.5])
    assert level @ found.gyro_bias[-1] == pytest.approx(level @ truth, abs=np.radians(0.1))


def test_a_heading_method_is_smoothed_too(bend):
    recording = bend.recording(gyro_error=drift(bend, [0.0, 0.0, 0.5]))
    plain, smooth = (
        run_filter(recording, corrector=Told(bend, np.radians(2.0)), smooth=which) for which in (False, True)
    )
    rms = [np.sqrt(np.mean(heading_error(one, bend) ** 2)) for one in (plain, smooth)]
    assert rms[1] < 0.5 * rms[0]
    np.testing.assert_allclose(smooth.innovation, plain.innovation)


def test_zero_rate_learns_the_bias_of_a_still_period():
    """A minute's pause half way: the gyro's error is seen there; without zaru the heading never shows it."""
    truth = walk(np.zeros(12), pauses={6: 60.0})
    bias = np.radians([0.1, -0.2, 0.3])
    recording = truth.recording(gyro_error=drift(truth, np.degrees(bias)))
    learnt = run_filter(recording, FilterSettings(zaru=True)).gyro_bias
    blind = run_filter(recording, FilterSettings()).gyro_bias
    np.testing.assert_allclose(learnt[7], bias, atol=np.radians(0.05))
    level = np.array([-np.sin(np.radians(20)), 0.0, np.cos(np.radians(20))])
    assert abs(level @ (blind[7] - bias)) > np.radians(0.15)
    every = FilterSettings(update="sample", zaru=True)
    assert np.abs(run_filter(recording, every).gyro_bias[7] - bias).max() < np.radians(0.1)


def test_g_sensitivity_is_told_from_bias():
    """Turned over and over between rests, an IMU shows all nine elements and its bias apart from them."""
    rng = np.random.default_rng(5)
    truth_g, bias = np.radians(rng.normal(0, 0.1, (3, 3))) / GRAVITY, np.radians([0.1, -0.2, 0.3])
    turns = np.repeat(np.pi / 2 * np.eye(3), 4, axis=0)  # rad/s, each a second long, then two of rest
    rate = np.repeat(np.stack([turns, np.zeros_like(turns), np.zeros_like(turns)], 1).reshape(-1, 3), 200, 0)
    attitude, force = Rotation.identity(), []
    for omega in rate:
        middle = attitude * Rotation.from_rotvec(omega / 400)
        force.append(middle.inv().apply([0.0, 0.0, GRAVITY]))
        attitude = attitude * Rotation.from_rotvec(omega / 200)
    force = np.array(force)
    gyro = rate + bias + force @ truth_g.T
    still = ~rate.any(axis=1) & (np.arange(len(rate)) % 40 == 0)
    up = np.array([0.0, 0.0, GRAVITY])
    start = Alignment(0.0, np.array([1.0, 0, 0, 0]), bias + truth_g @ up, up)
    settings = FilterSettings(zaru=True, g_sensitivity=True, sigma_rate=np.radians(0.01), accel_bias_sd=0.001)
    found = InertialFilter(settings, start)
    found.advance(np.arange(1, len(rate) + 1) / 200, gyro, force, 2 * still)
    np.testing.assert_allclose(found.g_sensitivity, truth_g, atol=np.radians(0.003) / GRAVITY)
    np.testing.assert_allclose(found.gyro_bias, bias, atol=np.radians(0.01))


def missing(recording, start_s, hole_s):
    """The recording without the samples of `hole_s` from `start_s` on."""
    keep = (recording.t < start_s) | (recording.t >= start_s + hole_s)
    return Recording(t=recording.t[keep], gyro=recording.gyro[keep], accel=recording.accel[keep])


def test_a_short_gap_costs_certainty_and_little_else(bend):
    """80 ms of a swing are lost; the next zero velocity mends what can be mended."""
    whole, holed = bend.recording(), missing(bend.recording(), 40.6, 0.08)
    found, lost = run_filter(whole), run_filter(holed)
    assert len(lost.footfalls) == len(found.footfalls)
    at = np.searchsorted(found.footfalls.t, 40.6)
    np.testing.assert_allclose(lost.footfalls.position[:at], found.footfalls.position[:at], atol=1e-9)
    assert (lost.heading_sd[at:] > found.heading_sd[at:] + np.radians(5)).all()
    assert np.hypot(*(lost.footfalls.position - found.footfalls.position)[at, :2]) < 0.5
    # The steps after it are as good as before: nothing of the gap is left in velocity or tilt.
    strides = np.diff(lost.footfalls.position, axis=0) - np.diff(found.footfalls.position, axis=0)
    assert np.abs(strides[at + 2 :, 2]).max() < 0.02


def test_a_long_gap_and_bad_samples_are_refused(bend):
    with pytest.raises(InputError, match="no samples for"):
        run_filter(missing(bend.recording(), 40.6, 0.4))
    bad = bend.recording()
    gyro = bad.gyro.copy()
    gyro[7000, 1] = np.nan
    with pytest.raises(InputError, match="gyro is not finite at row 7000"):
        run_filter(Recording(t=bad.t, gyro=gyro, accel=bad.accel))
    with pytest.raises(InputError, match="one update a stance"):
        run_filter(bad, FilterSettings.paper(), smooth=True)


def test_several_at_once_are_each_as_alone():
    recordings = [walk(np.linspace(0, turn, 9)).recording() for turn in (0.0, 1.0, -1.0)]
    starts = [StartPose(heading=0.1 * k) for k in range(3)]
    together = run_filters(recordings, FilterSettings(), starts=starts, threads=2)
    for one, recording, start in zip(together, recordings, starts, strict=True):
        alone = run_filter(recording, FilterSettings(), start=start)
        np.testing.assert_array_equal(one.footfalls.position, alone.footfalls.position)
    with pytest.raises(InputError, match="3 recordings, but 2 starts"):
        run_filters(recordings, starts=starts[:2])


def test_what_was_detected_may_be_handed_over(bend):
    recording = bend.recording()
    reckoning = Reckoning(recording)
    given = run_filter(recording, found=detect(recording, reckoning.pdr))
    np.testing.assert_array_equal(given.footfalls.position, run_filter(recording).footfalls.position)
    np.testing.assert_array_equal(
        reckoning.filtered(FilterSettings()).footfalls.position, given.footfalls.position
    )


def test_the_methods_carry_their_evidence_and_settings(bend):
    found = tracks(Reckoning(bend.recording()), ["iez", "iez-paper"])
    assert {"iez", "iez-paper"} <= set(METHODS)
    assert found["iez"].meta["filter"]["update"] == "stance"
    assert found["iez-paper"].meta["filter"]["update"] == "sample"
    for track in found.values():
        assert set(track.evidence) == {"gyro_bias_x", "gyro_bias_y", "gyro_bias_z", "heading_sd"}
        assert track.units["heading_sd"] == "rad"


def test_a_corrector_is_told_what_the_filter_knows(bend):
    """After the footfall's update and before its own correction; the temperature is that of the footfall."""
    recording = bend.recording()
    warm = replace(recording, temperature=20.0 + np.arange(len(recording.t)))
    told, cold = Told(bend, np.radians(0.5)), Told(bend, np.radians(0.5))
    settings = FilterSettings(heading_sd=np.radians(3.0), g_sensitivity=True)
    found = run_filter(warm, settings, corrector=told)
    run_filter(recording, settings, corrector=cold)
    rows = np.searchsorted(recording.t, found.footfalls.t - 1e-9)
    for step, without in zip(told.steps, cold.steps, strict=True):
        assert step.temperature == 20.0 + rows[step.index]
        assert without.temperature is None
        assert step.covariance.shape == (settings.states, settings.states)
        assert step.heading_sd == pytest.approx(np.sqrt(step.covariance[HEADING, HEADING]), rel=0.2)
        with pytest.raises(ValueError, match="read-only"):
            step.covariance[0, 0] = 1.0
        if step.index % 2:  # nothing is said at these
            assert step.heading_sd == found.heading_sd[step.index]
        else:
            assert step.heading_sd > found.heading_sd[step.index]
    assert told.steps[0].heading_sd > np.radians(2.9)
    assert told.steps[-1].heading_sd < np.radians(1.0)


def test_a_corrector_that_says_nothing_changes_nothing(bend):
    """Footfall by footfall or all at once."""
    recording = bend.recording(gyro_error=0.001)
    for settings in (FilterSettings(), FilterSettings.paper()):
        alone, asked = (run_filter(recording, settings, corrector=one) for one in (None, lambda step: None))
        for name in ("position", "heading", "t"):
            np.testing.assert_array_equal(getattr(alone.footfalls, name), getattr(asked.footfalls, name))
        np.testing.assert_array_equal(alone.gyro_bias, asked.gyro_bias)
        np.testing.assert_array_equal(alone.heading_sd, asked.heading_sd)
        assert np.isnan(asked.innovation).all()


@pytest.mark.parametrize("corrector", [None, lambda step: None])
def test_who_leaves_straight_from_the_rest_has_it_for_footfall_0(bend, corrector):
    """There is no reset between the averaged part and the first stride."""
    recording = bend.recording()
    found = detect(recording, PdrParams())
    first, resets = found.stances.footfalls[0], found.stances.resets
    stances = Stances(resets=resets[first:], footfalls=found.stances.footfalls - first)
    leaving = replace(found, stances=stances, rest=replace(found.rest, last=int(resets[first])))
    filtered = run_filter(recording, found=leaving, corrector=corrector)
    np.testing.assert_array_equal(filtered.footfalls.position[0], 0.0)
    assert filtered.footfalls.t[0] == recording.t[resets[first]]
    assert len(filtered.footfalls) == len(BEND)
