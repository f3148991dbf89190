"""The start pose is the foot's at rest: what it does from there to its first footfall is navigated."""

from dataclasses import replace

import numpy as np
import pytest

from footfall.conventions import BIAS_TIME
from footfall.hdr.filtered import filter_track
from footfall.hdr.methods import METHODS, Reckoning, tracks
from footfall.models.imu import draw_unit, load_spec
from footfall.pdr.filter.ins import FilterSettings, InertialFilter, frozen
from footfall.pdr.filter.run import align, run_filter, updates
from footfall.pdr.reckoning import PdrParams, StartPose, dead_reckon, detect
from footfall.pdr.stream import dead_reckon_blocks
from footfall.recording import Recording
from footfall.scenarios.judge.score import compare, score
from footfall.scenarios.trial import start_pose
from footfall.simulate.record import record
from tests.helpers.synthetic import synthetic_walk
from tests.helpers.synthetic_foot import walk

DEG = np.pi / 180
STILL = 26.0
# Turns of the foot on the ground, all below the 60 deg/s of the detector: it calls the foot at rest.
PIVOTS = (10 * DEG, -10 * DEG, 0.0)


def blocks(recording):
    for part in np.split(np.arange(len(recording.t)), range(500, len(recording.t), 500)):
        yield Recording(recording.t[part], recording.gyro[part], recording.accel[part])


def batch(recording, start):
    return dead_reckon(recording, start=start)


def streamed(recording, start):
    return dead_reckon_blocks(blocks(recording), start=start)[0]


def stances(recording, start):
    return run_filter(recording, start=start).footfalls


def samples(recording, start):
    return run_filter(recording, frozen(FilterSettings(update="sample")), start=start).footfalls


def smoothed(recording, start):
    return run_filter(recording, start=start, smooth=True).footfalls


def pivoted(pivot, **more):
    """A walk whose foot turns by `pivot` before its first stride, and its pose at the end of T_bias."""
    truth = walk(np.linspace(0.4, 1.4, 9), still_s=STILL, rocking=0.0, pivot=pivot, **more)
    row = detect(truth.recording(), PdrParams()).rest.last
    heading = float(truth.heading(truth.t[[row]])[0])
    return truth, StartPose(tuple(truth.position[row]), heading)


@pytest.mark.parametrize("navigate", [batch, streamed, stances, samples, smoothed])
@pytest.mark.parametrize("pivot", PIVOTS)
def test_a_foot_that_turns_on_the_ground_has_turned_at_its_first_footfall(pivot, navigate):
    """The IMU moves by 1 cm in the turn, of which zero velocity on the way takes a part."""
    truth, start = pivoted(pivot)
    assert start.heading == pytest.approx(0.4 - pivot, abs=1e-6)
    found = navigate(truth.recording(), start)
    assert found.t[0] == pytest.approx(STILL, abs=0.3)
    error = np.abs(found.heading - truth.heading(found.t))
    off = np.linalg.norm(found.position - truth.position[truth.at(found.t)], axis=1)
    assert error[0] < 0.05 * DEG
    assert off[0] < 0.011
    # An update at every sample takes the end of the swing for rest too: its later rows are worth less.
    assert error.max() < (0.3 if navigate is samples else 0.05) * DEG
    assert off.max() < 0.011 or navigate is samples


def test_the_heading_is_as_uncertain_at_the_first_footfall_as_the_gyro_has_made_it():
    """Known at the rest, to `heading_sd`; from there on it grows, and the place with it."""
    truth, start = pivoted(0.0)
    recording = truth.recording()
    since = dead_reckon(recording).t[0] - 25.0
    for sd in (0.0, 2 * DEG):
        settings = frozen(FilterSettings(heading_sd=sd))
        noise = settings.gyro_noise * np.sqrt(since)
        for smooth in (False, True):
            first = run_filter(recording, settings, start=start, smooth=smooth).heading_sd[0]
            assert first == pytest.approx(np.hypot(sd, noise), rel=0.15)  # and by the tilt


def test_the_place_is_as_uncertain_at_the_first_footfall_as_the_way_to_it_leaves_it():
    truth, start = pivoted(10 * DEG)
    recording = truth.recording()
    found = detect(recording, PdrParams())
    now = InertialFilter(FilterSettings(), align(recording, found, start))
    assert not now.covariance[:3, :3].any()
    rows = slice(found.rest.last + 1, found.stances.resets[found.stances.footfalls[0]] + 1)
    update = updates(recording.t, found, None)[rows]
    now.advance(recording.t[rows], recording.gyro[rows], recording.accel[rows], update)
    sd = np.sqrt(np.diag(now.covariance)[:3])
    assert (sd < 0.02).all()
    assert (np.abs(now.position - truth.position[truth.at(np.array([now.t]))[0]]) < 2 * sd).all()


# Simulated walks


def test_the_start_pose_is_that_of_the_end_of_the_averaged_rest():
    walk = synthetic_walk(strides=4, still_s=27.0)
    turn = np.linspace(0, 2.7, len(walk.t))  # a foot that never stands still
    drifting = replace(
        walk,
        position=np.column_stack([walk.t, -walk.t, 0.1 * walk.t]),
        quaternion=np.column_stack([np.cos(turn / 2), 0 * turn, 0 * turn, np.sin(turn / 2)]),
    )
    for bias_s, row in ((BIAS_TIME, 5000), (5.0, 1000)):
        start = start_pose(drifting, bias_s)
        np.testing.assert_allclose(start.position, drifting.position[row])
        assert start.heading == pytest.approx(turn[row])
    assert start_pose(drifting) == start_pose(drifting, 25.0)
    end = int(np.searchsorted(walk.t, walk.footfalls.t[0]))  # with footfall 0 the motionless start is over
    np.testing.assert_allclose(drifting.pose_at_rest(99.0)[0], drifting.position[end])
    # A recording says so itself.
    recording = record(drifting, draw_unit(load_spec("perfect"), 1), seed=1)
    assert StartPose.of(recording.meta) == start_pose(drifting)


@pytest.mark.parametrize("meta", [{}, {"start": "noon"}, {"start": {"position_m": [0, 1], "heading_rad": 1}}])
def test_a_recording_that_knows_no_start_starts_at_the_origin(meta):
    assert StartPose.of(meta) == StartPose()


# Heading (deg) at any footfall that a perfect IMU on a walk with one corner may cost.
WORTH = {"pdr": 0.1, "iez": 0.1, "iez-smoothed": 0.1, "hdr-basic": 2.0, "hdr-filter": 3.0}


def test_with_a_perfect_imu_a_track_needs_no_alignment(short_walk):
    """Every method's first footfall, unaligned, is the truth's; those that only navigate keep to it."""
    recording = record(short_walk, draw_unit(load_spec("perfect"), 1), seed=1)
    start = start_pose(short_walk)
    found = tracks(Reckoning(recording, start), METHODS)
    settings = FilterSettings()
    smooth = run_filter(recording, settings, start=start, smooth=True)
    found["iez-smoothed"] = filter_track(smooth, settings, name="iez-smoothed")
    # What the rolling of the sole passes for: 7 deg/h with a zero velocity of 0.01 m/s.
    assert np.linalg.norm(smooth.gyro_bias[-1]) < 5 * DEG / 3600
    for name, track in found.items():
        row = compare(track, short_walk)
        error, off = np.abs(row.heading_error) / DEG, np.hypot(*(row.estimate - row.truth).T)
        walked = np.hypot(*np.diff(row.truth, axis=0).T).sum()
        # An update at every sample is worth what its false bias leaves: docs/iez.md.
        assert error[0] < (0.6 if name.endswith("-paper") else 0.3), name
        assert off[0] < (0.03 if name.endswith("-paper") else 0.01), name
        assert error.max() < WORTH.get(name, 12.0), name
        if name in ("pdr", "iez", "iez-smoothed"):
            # The sole rolls sideways by some mm/s when the velocity is called zero: 2 mrad of the course.
            assert off.max() < 0.004 * walked, name
            assert abs(score(track, short_walk).distance_error_pct) < 0.3, name
    assert error_without_a_start(recording, short_walk) > 1.0  # the feet stand turned: the start is no zero


def error_without_a_start(recording, walk):
    """Heading error (deg) at footfall 0 of a track that was told no start."""
    track = tracks(Reckoning(recording), ["pdr"])["pdr"]
    return abs(compare(track, walk).heading_error[0]) / DEG
