"""Tracks judged without a walk: against footprints, and against their own start."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from footfall.errors import InputError
from footfall.pdr.track import Track
from footfall.scenarios.judge.reference import (
    Footprints,
    laid_on,
    matches,
    read_footprints,
    score_closure,
    score_footprints,
)
from footfall.scenarios.judge.rigid import rigid_fit

PLACE = np.array([[0.0, 0], [1, 0.1], [2, 0], [3, 0.5], [3, 2], [2, 3], [0, 4]])
T = 1.1 * np.arange(len(PLACE))
TRACK = Track(T, np.column_stack([PLACE, np.linspace(0, 5, len(PLACE))]), np.zeros(len(PLACE)))


def turned(points, angle, shift=(0.0, 0.0)):
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s], [-s, c]]) + shift


@given(st.integers(0, 2**32 - 1), st.floats(-np.pi, np.pi))
def test_a_rigid_fit_undoes_turn_and_shift_and_nothing_else(seed, angle):
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(12, 2))
    moved = turned(points, angle, rng.normal(size=2))
    fit = rigid_fit(points, moved)
    assert np.cos(fit.turn - angle) == pytest.approx(1)
    np.testing.assert_allclose(fit(points), moved, atol=1e-9)
    for other in (points * [1, -1], 2 * points):  # a mirror image stays one
        assert np.abs(rigid_fit(other, moved)(other) - moved).max() > 0.1


def test_a_rigid_fit_is_the_best_there_is():
    rng = np.random.default_rng(3)
    a, b = rng.normal(size=(2, 20, 2))

    def rms(points):
        return np.sqrt(np.mean(np.sum((points - b) ** 2, axis=1)))

    best = rms(rigid_fit(a, b)(a))
    for turn in np.radians(np.arange(0, 360, 2)):
        for shift in ((0.0, 0.0), (0.05, 0.0), (0.0, -0.05)):
            points = turned(a - a.mean(axis=0), turn) + b.mean(axis=0) + shift
            assert best <= rms(points) + 1e-12


@given(st.floats(-3, 3))
def test_footprints_may_lie_in_any_frame(angle):
    prints = Footprints(T + 0.2, turned(PLACE, angle, (40.0, -3.0)))
    found = score_footprints(TRACK, prints)
    assert found.footprint_rmse_m == pytest.approx(0, abs=1e-9)
    assert (found.footprints, found.matched, found.footfalls) == (7, 7, 7)


def test_one_print_aside_is_told_in_metres():
    """One of n prints is aside by d: the best shift takes d / n from it and gives it to the others."""
    n, d = 101, 0.3
    along = np.column_stack([np.arange(n), np.zeros(n)])
    track = Track(np.arange(float(n)), np.column_stack([along, np.zeros(n)]), np.zeros(n))
    off = along.copy()
    off[n // 2, 0] += d
    found = score_footprints(track, Footprints(track.t, off))
    assert found.footprint_rmse_m == pytest.approx(d * np.sqrt(n - 1) / n, rel=1e-3)
    assert found.footprint_largest_m == pytest.approx(d * (n - 1) / n, rel=1e-3)


def test_footprints_belong_to_the_footfall_nearest_in_time():
    stamps = np.array([0.4, 1.2, 4.6, 20.0])
    rows, of = matches(TRACK, Footprints(stamps, PLACE[:4]))
    assert rows.tolist() == [0, 1, 4]
    assert of.tolist() == [0, 1, 2]
    alone = Footprints(np.array([0.59, 10.0 + 0.61]), PLACE[:2])
    assert len(matches(replace(TRACK, t=T + np.where(T > 0, 3.4, 0)), alone)[1]) == 1
    found = score_footprints(TRACK, Footprints(np.append(T[1:], 30.0), np.vstack([PLACE[1:], [9, 9]])))
    assert (found.footprints, found.matched) == (7, 6)
    assert found.footprint_rmse_m == pytest.approx(0, abs=1e-9)


def test_footprints_of_other_times_are_refused():
    with pytest.raises(InputError, match=r"1 of 3 footprints have a footfall within 0\.6 s"):
        score_footprints(TRACK, Footprints(np.array([0.0, 100.0, 200.0]), PLACE[:3]))


def test_a_track_is_laid_on_its_footprints_whole():
    """Rows without a footprint move with the others."""
    prints = Footprints(T[:4], turned(PLACE[:4], 0.7, (1.0, 2.0)))
    np.testing.assert_allclose(laid_on(TRACK, prints)(PLACE), turned(PLACE, 0.7, (1.0, 2.0)), atol=1e-9)


def test_closure_is_the_way_back_to_the_start_on_the_plane():
    steps = np.hypot(*np.diff(PLACE, axis=0).T)
    found = score_closure(TRACK)
    assert found.return_error_m == pytest.approx(4.0)
    assert found.distance_m == pytest.approx(steps.sum())
    assert found.return_error_pct == pytest.approx(400 / steps.sum())
    assert score_closure(replace(TRACK, position=TRACK.position + np.array([5.0, 6.0, 7.0]))) == found
    with pytest.raises(InputError, match="does not move"):
        score_closure(replace(TRACK, position=np.ones((7, 3))))


def test_footprints_are_read_from_csv(tmp_path):
    path = tmp_path / "prints.csv"
    path.write_text("t,x,y,note\n0.5,1,2,0\n1.5,2,2.5,0\n2.5,3,2,0\n")
    found = read_footprints(path)
    np.testing.assert_array_equal(found.t, [0.5, 1.5, 2.5])
    np.testing.assert_array_equal(found.position, [[1, 2], [2, 2.5], [3, 2]])


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("t,x\n0,1\n", "column 'y' is missing"),
        ("t,x,y\n0,1,2\n1,2,3\n", "expected at least 3 footprints"),
        ("t,x,y\n0,1,2\n1,2,3\n1,2,4\n", "with increasing t"),
        ("t,x,y\n0,1,2\n1,2,\n2,2,4\n", "y is not finite at row 1"),
    ],
)
def test_footprints_that_are_none_are_refused(tmp_path, text, sentence):
    path = tmp_path / "prints.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=sentence) as caught:
        read_footprints(path)
    assert str(caught.value).startswith(str(path))
