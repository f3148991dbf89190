"""Scores against closed forms; what they must not depend on; the paper's table."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from footfall.errors import InputError
from footfall.pdr.track import Track
from footfall.scenarios.judge.papers import (
    HDR_TABLE_2,
    HDR_TABLE_2_MEAN,
    UNCORRECTED_AVERAGE_RANGE,
    UNCORRECTED_FINAL_RANGE,
)
from footfall.scenarios.judge.score import Score, compare, improvement, mean_score, require_align, score
from footfall.simulate.walk import TrueFootfalls, Walk
from tests.helpers.synthetic import synthetic_walk


def planar_walk(heading, distance=1.4, interval=1.1):
    """A foot that slides: (m,) headings at its footfalls, a stride of `distance` along each but the first."""
    heading = np.asarray(heading, dtype=float)
    m = len(heading)
    steps = distance * np.column_stack([np.cos(heading[1:]), np.sin(heading[1:]), np.zeros(m - 1)])
    position = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    fall = np.arange(m) * interval
    t = np.linspace(0, fall[-1], 10 * (m - 1) + 1)
    yaw = np.interp(t, fall, heading)
    zero = np.zeros((len(t), 3))
    return Walk(
        t=t,
        position=np.column_stack([np.interp(t, fall, position[:, axis]) for axis in range(3)]),
        quaternion=np.column_stack([np.cos(yaw / 2), 0 * t, 0 * t, np.sin(yaw / 2)]),
        velocity=zero,
        gyro=zero,
        accel=zero,
        contact=np.ones(len(t)),
        stance=np.ones(len(t), dtype=bool),
        footfalls=TrueFootfalls(fall, position, heading),
    )


def reckoned(walk, error, scale=1.0):
    """The track of someone whose heading is off by `error` (m,) and whose strides by a factor."""
    heading = walk.footfalls.heading + error
    stride = scale * np.linalg.norm(np.diff(walk.footfalls.position[:, :2], axis=0), axis=1)
    step = stride * np.exp(1j * heading[1:])
    at = np.concatenate([[0], np.cumsum(step)]) + complex(*walk.footfalls.position[0, :2])
    return Track(walk.footfalls.t, np.column_stack([at.real, at.imag, 0 * at.real]), heading)


def truth_as_track(walk):
    return Track(walk.footfalls.t, walk.footfalls.position, walk.footfalls.heading)


def figures(result):
    return list(result.as_dict().values())


turns = st.lists(st.floats(-1.5, 1.5), min_size=5, max_size=40).map(np.cumsum)


@given(turns)
def test_the_truth_scores_nought(heading):
    walk = planar_walk(heading)
    assert figures(score(truth_as_track(walk), walk)) == pytest.approx([0] * 6, abs=1e-9)


def test_the_truth_of_a_coning_foot_scores_nought_anywhere_in_its_stances():
    walk = synthetic_walk(strides=40, turn=0.2)
    for delay in (0.0, 0.05, 0.1):
        track = replace(truth_as_track(walk), t=walk.footfalls.t + delay)
        assert figures(score(track, walk)) == pytest.approx([0] * 6, abs=1e-6)


@given(st.floats(-400, 400).filter(lambda d: abs(d) > 1), st.integers(50, 200))
def test_constant_drift_gives_a_mean_of_half_the_final_error_even_beyond_a_turn(final_deg, strides):
    walk = planar_walk(np.zeros(strides + 1))
    drift = np.radians(final_deg) * np.arange(strides + 1) / strides
    result = score(reckoned(walk, drift), walk)
    assert result.heading_error_final_deg == pytest.approx(abs(final_deg))
    assert result.heading_error_mean_deg == pytest.approx(abs(final_deg) / 2)
    assert result.distance_error_pct == pytest.approx(0, abs=1e-9)
    # The track is a polygon with equal turns e: its strides sum to e^(ie) (1 - e^(ine)) / (1 - e^(ie)).
    e = drift[1]
    end = 1.4 * np.exp(1j * e) * (1 - np.exp(1j * strides * e)) / (1 - np.exp(1j * e))
    assert result.position_error_final_m == pytest.approx(abs(end - 1.4 * strides))
    assert result.return_error_pct == pytest.approx(100 * abs(end / (1.4 * strides) - 1))


def test_a_drift_of_a_turn_and_a_half_is_counted_in_full_on_a_loop():
    walk = planar_walk(np.linspace(0, 2 * math.pi, 201))
    result = score(reckoned(walk, np.radians(np.linspace(0, -540, 201))), walk)
    assert result.heading_error_final_deg == pytest.approx(540)
    assert result.heading_error_mean_deg == pytest.approx(270)


@given(turns, st.floats(0.8, 1.2))
def test_a_scale_error_stretches_everything_about_the_start(heading, scale):
    walk = planar_walk(heading)
    result = score(reckoned(walk, 0.0, scale), walk)
    off = abs(scale - 1) * np.linalg.norm(walk.footfalls.position[:, :2], axis=1)
    travelled = 1.4 * (len(heading) - 1)
    expected = [0, 0, 100 * off[-1] / travelled, 100 * (scale - 1), math.sqrt(np.mean(off**2)), off[-1]]
    assert figures(result) == pytest.approx(expected, abs=1e-9)


def elsewhere(track, turn, x, y, whole_turns=0):
    """The track turned about the origin and shifted."""
    c, s = math.cos(turn), math.sin(turn)
    return replace(
        track,
        position=track.position @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) + [x, y, 3.0],
        heading=track.heading + turn + whole_turns * math.tau,
    )


@given(turns, st.floats(-3, 3), st.floats(-50, 50), st.floats(-50, 50), st.integers(-2, 2))
def test_a_track_is_compared_as_it_is(heading, turn, x, y, whole_turns):
    """The truth from a wrong start: every row is wrong by that, row 0 as well. Whole turns are no error."""
    walk = planar_walk(heading)
    moved = elsewhere(truth_as_track(walk), turn, x, y, whole_turns)
    result, row = score(moved, walk), compare(moved, walk)
    assert row.heading_error == pytest.approx(np.full(len(heading), turn))
    assert result.heading_error_mean_deg == pytest.approx(math.degrees(abs(turn)))
    assert result.heading_error_final_deg == pytest.approx(math.degrees(abs(turn)))
    place = walk.footfalls.position[:, 0] + 1j * walk.footfalls.position[:, 1]
    off = np.abs(place * np.exp(1j * turn) + complex(x, y) - place)
    assert result.position_error_final_m == pytest.approx(off[-1], abs=1e-9)
    assert result.position_rmse_m == pytest.approx(math.sqrt(np.mean(off**2)), abs=1e-9)
    np.testing.assert_array_equal(row.estimate, moved.position[:, :2])


@pytest.mark.parametrize("align", ["start", "yaw", "rigid"])
@given(
    turns, st.floats(-3, 3), st.floats(-50, 50), st.floats(-50, 50), st.integers(-2, 2), st.integers(0, 99)
)
def test_an_aligned_track_may_start_anywhere(align, heading, turn, x, y, whole_turns, seed):
    walk = planar_walk(heading)
    track = reckoned(walk, np.cumsum(np.random.default_rng(seed).normal(0, 0.1, len(heading))), 1.02)
    assume(np.ptp(walk.position[:, :2], axis=0).max() > 2)  # on the spot any turn is as good
    expected = figures(score(track, walk, align))
    moved = elsewhere(track, turn, x, y, whole_turns)
    assert figures(score(moved, walk, align)) == pytest.approx(expected, abs=1e-6)


def test_each_alignment_fits_what_it_says_and_no_more():
    walk = planar_walk(np.linspace(0, 2, 40))
    track = elsewhere(reckoned(walk, np.linspace(0.1, 0.7, 40), 1.02), 0.4, 3.0, -2.0)
    start, yaw, rigid = (compare(track, walk, align) for align in ("start", "yaw", "rigid"))
    for row in (start, yaw):
        np.testing.assert_allclose(row.estimate[0], row.truth[0], atol=1e-12)
    assert start.heading_error[0] == pytest.approx(0, abs=1e-12)
    assert yaw.heading_error[0] != pytest.approx(0, abs=1e-2)
    np.testing.assert_allclose(rigid.estimate.mean(axis=0), rigid.truth.mean(axis=0), atol=1e-12)

    def rms(turn, shift, row):
        about = row.truth[0] if row is yaw else row.truth.mean(axis=0)
        c, s = math.cos(turn), math.sin(turn)
        off = (row.estimate - about) @ np.array([[c, s], [-s, c]]) + about + shift - row.truth
        return math.sqrt(np.mean(np.sum(off**2, axis=1)))

    for row, align in ((yaw, "yaw"), (rigid, "rigid")):
        best = rms(0.0, 0.0, row)
        assert score(track, walk, align).position_rmse_m == pytest.approx(best)
        assert all(rms(turn, 0.0, row) > best for turn in (-0.01, 0.01))
        # Headings turn with the places.
        turned = row.heading_error - compare(track, walk).heading_error
        assert np.ptp(turned) < 1e-9
        step = np.diff(track.position[:2, :2], axis=0) @ [1, 1j]
        assert np.angle((np.diff(row.estimate[:2], axis=0) @ [1, 1j]) / step) == pytest.approx(turned[0])
    assert all(rms(0.0, shift, rigid) > rms(0, 0, rigid) for shift in ([0.01, 0], [0, -0.01]))
    assert score(track, walk, "rigid").position_rmse_m < score(track, walk, "yaw").position_rmse_m
    assert score(track, walk, "yaw").position_rmse_m < score(track, walk, "start").position_rmse_m


def test_a_wrapped_heading_is_as_good_as_a_continuous_one():
    walk = planar_walk(np.linspace(0, 12, 60))
    track = reckoned(walk, np.linspace(0, 2, 60))
    wrapped = replace(track, heading=np.angle(np.exp(1j * track.heading)))
    assert figures(score(wrapped, walk)) == pytest.approx(figures(score(track, walk)))


def test_missed_footfalls_do_not_disturb_the_count_of_turns():
    walk = planar_walk(np.arange(60) * 1.2)  # 11 turns, nearly on the spot
    kept = np.flatnonzero(np.arange(60) % 4 == 0)
    track = reckoned(walk, np.linspace(0, 1, 60))
    sparse = Track(track.t[kept], track.position[kept], track.heading[kept])
    assert compare(sparse, walk).heading_error == pytest.approx(np.linspace(0, 1, 60)[kept])


def test_a_quaternion_and_its_negative_are_one_attitude():
    walk = synthetic_walk(strides=20, turn=0.1)
    signs = np.where(np.arange(len(walk.t)) % 2, -1.0, 1.0)[:, None]
    track = replace(truth_as_track(walk), t=walk.footfalls.t + 0.0013)  # between samples
    flipped = replace(walk, quaternion=walk.quaternion * signs)
    assert figures(score(track, flipped)) == pytest.approx(figures(score(track, walk)), abs=1e-9)


# Means and improvement


def test_means_and_improvement():
    bad, good = Score(85, 197, 20, 1, 100, 300), Score(12, 21, 2, -1, 10, 30)
    assert mean_score([bad, good]) == Score(48.5, 109, 11, 0, 55, 165)
    gain = improvement(bad, good)
    assert gain.mean == pytest.approx(85 / 12)
    assert gain.final == pytest.approx(197 / 21)
    perfect = Score(0, 0, 0, 0, 0, 0)
    assert improvement(bad, perfect).mean == math.inf
    assert improvement(perfect, perfect).final == 1
    with pytest.raises(InputError, match="no walks"):
        mean_score([])


def test_scores_are_plain_numbers_for_json():
    walk = planar_walk(np.zeros(20))
    result = score(reckoned(walk, np.linspace(0, 1, 20)), walk)
    assert Score(**json.loads(json.dumps(result.as_dict()))) == result


# Refusals


def test_an_alignment_that_there_is_none_of_is_refused():
    with pytest.raises(InputError, match=r"align = 'se3': expected one of none, start, yaw, rigid"):
        require_align("se3")


@pytest.mark.parametrize(
    ("alter", "message"),
    [
        (lambda k: Track(k.t[:1], k.position[:1], k.heading[:1]), r"track: 1 rows, expected at least 2"),
        (lambda k: replace(k, t=k.t - 1), r"-1.00 to 32.00 s lies outside the walk, .* 0.00 to 33.00 s"),
        (lambda k: replace(k, t=k.t + 1), r"1.00 to 34.00 s lies outside the walk"),
        (lambda k: Track(k.t[:20], k.position[:20], k.heading[:20]), r"0.00 to 20.90 s covers only a part"),
        (lambda k: Track(k.t[9:], k.position[9:], k.heading[9:]), r"9.90 to 33.00 s covers only a part"),
        (lambda k: replace(k, t=k.t[::-1]), r"t does not increase at row 1"),
        (
            lambda k: replace(k, heading=np.where(k.t > 10, np.nan, k.heading)),
            r"heading is not finite at row 10",
        ),
        (lambda k: replace(k, position=np.full_like(k.position, np.inf)), r"position is not finite at row 0"),
    ],
)
def test_tracks_that_cannot_be_judged_are_refused(alter, message):
    walk = planar_walk(np.full(31, 0.1) * np.arange(31))
    with pytest.raises(InputError, match=message):
        score(alter(truth_as_track(walk)), walk)


def test_a_walk_that_goes_nowhere_has_no_percentages():
    walk = planar_walk(np.zeros(5), distance=0.0)
    with pytest.raises(InputError, match="does not move"):
        score(truth_as_track(walk), walk)


def test_a_sensors_clock_may_run_off_a_little():
    walk = planar_walk(np.zeros(31))
    track = truth_as_track(walk)
    assert score(replace(track, t=track.t * (1 + 1e-3)), walk).heading_error_final_deg == pytest.approx(
        0, abs=1e-9
    )


# The paper


def test_the_papers_means_and_improvements_follow_from_its_walks():
    for mode in ("uncorrected", "hdr"):
        for figure in ("final", "average"):
            values = [getattr(getattr(row, mode), figure) for row in HDR_TABLE_2]
            assert getattr(getattr(HDR_TABLE_2_MEAN, mode), figure) == pytest.approx(np.mean(values), abs=0.5)
    for row in (*HDR_TABLE_2, HDR_TABLE_2_MEAN):
        for figure in ("final", "average"):
            ratio = getattr(row.uncorrected, figure) / getattr(row.hdr, figure)
            assert getattr(row.improvement, figure) == pytest.approx(ratio, rel=0.04)


def test_the_papers_range_is_that_of_its_walks():
    finals = [row.uncorrected.final for row in HDR_TABLE_2]
    averages = [row.uncorrected.average for row in HDR_TABLE_2]
    assert (min(finals), max(finals)) == UNCORRECTED_FINAL_RANGE
    assert (min(averages), max(averages)) == UNCORRECTED_AVERAGE_RANGE
