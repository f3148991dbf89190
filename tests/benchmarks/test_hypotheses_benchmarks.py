"""The benchmarks of the filter over hypotheses: what they make up, and how they count harm."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.papers import ihde_hypotheses
from benchmarks.validation import _hard_feet, hypotheses_figures, hypotheses_wander, hypotheses_ways
from benchmarks.validation.hypotheses_wander import Case, harm, walked
from footfall.hdr.hypotheses.filter import Beliefs

STEADY = Case("right angles", 0.0, 6.0, 0.0, 3)


@pytest.mark.parametrize("path", hypotheses_wander.PATHS)
def test_made_up_feet_follow_their_path(path):
    """Without wander and drift courses scatter by what a foot's place and the stride's direction do."""
    feet, drifted = walked(replace(STEADY, path=path))
    assert not drifted.any()
    course = np.unwrap(np.arctan2(*np.diff(feet.position[:, :2], axis=0).T[::-1]))
    off = np.angle(np.exp(1j * (course - feet.heading[1:])))
    assert np.degrees(off.std()) == pytest.approx(np.hypot(0.5, np.degrees(0.012 * 2**0.5 / 1.4)), rel=0.15)
    assert np.linalg.norm(np.diff(feet.position, axis=0), axis=1) == pytest.approx(1.4)


def test_made_up_corners_are_what_they_are_called():
    def corners(path):
        turns = np.degrees(np.diff(walked(replace(STEADY, path=path))[0].heading))
        first = np.flatnonzero(np.abs(turns) > 1)[::2]
        return np.abs(turns[first] + turns[first + 1])

    assert corners("right angles") == pytest.approx(90.0)
    odd = corners("odd angles")
    assert 25 <= odd.min() <= odd.max() <= 155
    assert odd.std() > 10


def test_wander_is_as_wide_and_as_slow_as_it_is_told():
    noise = hypotheses_wander.gauss_markov(np.random.default_rng(1), 200_000, 0.3, 5.0)
    assert noise.std() == pytest.approx(0.3, rel=0.03)
    kept = np.corrcoef(noise[:-1], noise[1:])[0, 1]
    assert kept == pytest.approx(np.exp(-1.08 / 5), abs=0.01)
    wide = walked(replace(STEADY, path="straight", wander_m=0.3))[0].position[:, 1]
    narrow = walked(replace(STEADY, path="straight", wander_m=0.05))[0].position[:, 1]
    assert np.diff(wide).std() > 3 * np.diff(narrow).std()


def test_the_gyro_is_as_good_as_its_share_of_the_priors():
    poor, good = (walked(replace(STEADY, sensor=sensor)) for sensor in (1.0, 0.1))
    assert good[1] == pytest.approx(0.1 * poor[1])
    assert (poor[0].heading - good[0].heading) == pytest.approx(0.9 * poor[1])


def test_harm_counts_who_ends_or_walks_worse_by_more_than_a_degree():
    none, way = np.array([[1.0, 2.0]] * 4), np.array([[1.9, 2.9], [2.1, 0.0], [0.0, 3.1], [0.0, 0.0]])
    assert harm(np.stack([none, way], axis=1), 1) == 50.0


def test_what_is_told_of_the_tests_is_the_direction_and_a_bias_that_stays():
    told, close = ihde_hypotheses.told(), ihde_hypotheses.followed(0.03, 0.2, 1.0, 0.2)
    assert told.reference == close.reference == 0.0
    for params in (told, close):
        assert params.bias * max(params.scales) == pytest.approx(np.radians(0.3))
    assert close.wander_m == (0.03,)
    assert np.degrees(close.beside) == pytest.approx(0.2)


def test_figures_are_drawn_of_units(tmp_path):
    rng, t = np.random.default_rng(2), np.arange(200) * 1.1
    errors = {method: rng.normal(0, 3, 200) for method in hypotheses_figures.SHOWN}
    sds = {method: np.full(200, 3.0) for method in hypotheses_figures.OWN}
    chances = rng.dirichlet([1, 1, 1], 200).T
    one = hypotheses_figures.Worn(t, errors, sds, chances, np.cumsum(rng.normal(1, 1, (200, 2)), axis=0))
    hypotheses_figures.fans({"a": [one, one], "b": [one]}, tmp_path / "fans.png")
    hypotheses_figures.modes(one, tmp_path / "modes.png")
    hypotheses_figures.honesty({"a": [one]}, tmp_path / "sd.png")
    assert all((tmp_path / f"{name}.png").stat().st_size > 10_000 for name in ("fans", "modes", "sd"))


def test_ways_act_on_the_correction_by_its_size_and_sd():
    feet, _ = walked(replace(STEADY, path="straight"))
    n = len(feet.heading)
    correction, sd = np.linspace(-0.4, 0.4, n), np.full(n, 0.1)
    columns = dict.fromkeys(Beliefs._fields, np.zeros(n))
    found = Beliefs(**{**columns, "heading": feet.heading + correction, "heading_sd": sd})
    made = {
        "part": hypotheses_ways.in_part(feet, found, 0.8),
        "sd": hypotheses_ways.by_sd(feet, found),
        "beyond": hypotheses_ways.beyond_sd(feet, found, 2.0),
    }
    left = {name: heading - feet.heading for name, heading in made.items()}
    assert left["part"] == pytest.approx(0.8 * correction)
    assert left["sd"][-1] == pytest.approx(0.4 * 0.16 / (0.16 + 0.01))
    assert left["sd"][0] == pytest.approx(-left["sd"][-1])
    assert left["beyond"] == pytest.approx(np.where(np.abs(correction) > 0.2, correction, 0.0))


def test_a_cell_of_ways_tells_errors_and_who_is_worse_than_uncorrected():
    none = [[4.0, 8.0, np.nan], [2.0, 2.0, np.nan]]
    way = [[1.0, 2.0, 1.0], [3.1, 2.9, -2.0]]
    found = np.stack([none, way], axis=1)
    assert hypotheses_ways.told(found, 0) == "3.0 / 5.0; 3.8"
    assert hypotheses_ways.told(found, 1) == "2.0 / 2.5; 2.9; 50 / 0 %; 2.5"


@pytest.mark.parametrize("make", [_hard_feet.steady_bias, _hard_feet.cooling_on_a_curve])
def test_hard_feet_follow_their_path_behind_a_drift_that_is_known(make):
    feet, drifted = make(3)
    path = feet.heading - drifted
    middle = 0.5 * (drifted[1:] + drifted[:-1])
    course = np.unwrap(np.arctan2(*np.diff(feet.position[:, :2], axis=0).T[::-1])) - middle
    assert np.abs(np.degrees(course - path[1:])).mean() < 1.5
    assert np.degrees(drifted[-1]) == pytest.approx(
        300 * 1.05 * 0.05 if make is _hard_feet.steady_bias else -39.9, rel=0.01
    )
