"""The benchmarks run, and what they compute is what they say."""

import json
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks import _common
from benchmarks.papers import _hdr_cases, _hdr_page, hdr_table2
from benchmarks.speed import walker as walker_speed
from benchmarks.validation import imu_truth, robustness, scatter, starts, stock_units, stops
from footfall.errors import InputError
from footfall.hdr.hdr import HdrParams, headings
from footfall.hdr.method import Method
from footfall.hdr.methods import METHODS
from footfall.models.subject import LIMITS
from footfall.scenarios.scenario import load_scenario
from footfall.scenarios.trial import Trial, perform, setup
from footfall.simulate.walk import TrueFootfalls
from footfall.simulate.walking import FallError
from tests.helpers.places import ROOT

SCENARIO = """
description = "a corner and a slope"
subjects = ["reference"]
[path]
vertical_transition_m = 4.0
elements = [
  { kind = "straight", length_m = 10.0 },
  { kind = "corner", turn_deg = 60.0, radius_m = 2.5 },
  { kind = "straight", length_m = 6.0 },
  { kind = "straight", length_m = 6.0, grade_percent = 2.0 },
  { kind = "straight", length_m = 6.0 },
]
[gait]
pace_m_s = 1.3
[temperature]
indoors_degC = 20.0
outdoors_degC = -5.0
[sensor]
imu = "nimu"
calibration_s = 26.0
[seeds]
base = 1
walks = 2
units = [7, 8]
"""


@pytest.fixture(autouse=True)
def own_cache(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Walks are cached in a folder of their own."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))


@pytest.fixture
def short(tmp_path: Path) -> str:
    """A scenario that is walked in half a minute."""
    path = tmp_path / "short.toml"
    path.write_text(SCENARIO, encoding="utf-8")
    return str(path)


def test_imu_truth_runs_and_meets_its_targets(short: str, tmp_path: Path) -> None:
    out = tmp_path / "out.json"
    imu_truth.main(["--scenario", short, "--metres", "12", "--processes", "1", "--json", str(out)])
    errors = {error["rate_hz"]: error for error in json.loads(out.read_text())["errors"]}
    assert errors[1000.0]["largest_mm"] < 1
    assert errors[200.0]["largest_mm"] < 2


def test_walker_speed_accounts_for_every_second(short: str, tmp_path: Path) -> None:
    """That MuJoCo alone repeats the walk to the last bit is checked inside."""
    out = tmp_path / "out.json"
    walker_speed.main(["--scenario", short, "--metres", "8", "--json", str(out)])
    found = json.loads(out.read_text())["cpu_s"]
    assert set(found) == {"level", "slopes"}
    labels = {label for label, _, _ in walker_speed.WATCHED} | {"MuJoCo", walker_speed.REST}
    for row in found.values():
        assert all(row[label] > 0 for label in labels)
        assert sum(row[label] for label in labels) == pytest.approx(row["whole"])
        assert row["share in MuJoCo"] == pytest.approx(row["MuJoCo"] / row["whole"])


def test_errors_of_a_batch_are_the_scores_of_its_tracks(short_walk, monkeypatch) -> None:
    monkeypatch.setattr("footfall.simulate.cache.cached_walk", lambda plan, **keys: short_walk)
    sets = [HdrParams(), HdrParams.from_degrees(i_c_deg_s=0.02, theta_w_deg_s=1.0)]
    wide = METHODS["hdr"].renamed("wide").with_params({"i_c_deg_s": 0.02, "theta_w_deg_s": 1.0})
    trial = Trial(setup(load_scenario("straight"), methods=["pdr", "hdr", wide]), 0, 1, 3, 3)
    (case,) = _hdr_cases.dead_reckoned([trial], 1, "")
    scores = perform(trial, short_walk).scores
    pdr, *expected = [(one.heading_error_final_deg, one.heading_error_mean_deg) for one in scores.values()]
    np.testing.assert_allclose(case.uncorrected_deg(), pdr, atol=1e-9)
    np.testing.assert_allclose(case.corrected_deg(headings([case.footfalls], sets)[0]), expected, atol=1e-9)
    np.testing.assert_allclose(hdr_table2.average_deg(case, sets), np.array(expected)[:, 1], atol=1e-9)


def test_hdr_is_tuned_and_judged_on_different_walks_and_units(short: str, tmp_path: Path) -> None:
    out, figure = tmp_path / "out.json", tmp_path / "figure.png"
    few = ["--walks", "2", "--units", "4", "--tuning-walks", "1", "--tuning-units", "3", "--processes", "1"]
    page = tmp_path / "page.md"
    marks = ("hdr", "hdr noise", "hdr mounts")
    page.write_text("".join(f"<!-- table {name} -->\n<!-- end -->\n" for name in marks))
    few += ["--noises", "2", "--mounts", "medial", "--page", str(page)]
    hdr_table2.main([short, *few, "--json", str(out), "--figure", str(figure)])
    document = json.loads(out.read_text())
    grid = np.array(document["tuning_average_deg"])
    assert grid.shape == (len(document["i_c_deg_s"]), len(document["theta_w_deg_s"]))
    groups = document["judged"]["short"]
    for group, units in (("all units drawn", 4), ("the scenario's own", 2)):
        assert (groups[group]["units"], groups[group]["recordings"]) == (units, 3 * units)
    moved = document["judged"]["short, medial"]["all units drawn"]["methods"]["uncorrected"]
    found = groups["all units drawn"]["methods"]["uncorrected"]
    assert moved != found
    assert figure.stat().st_size > 10_000
    shown = f"{found['over_all']['average']['mean']:.1f} / {found['over_all']['final']['mean']:.1f}"
    text = page.read_text()
    assert f"| 12 recordings of 4 units, all units drawn | uncorrected | {shown} |" in text
    assert f"| short | uncorrected | {shown} |" in text
    assert "| short, medial | uncorrected |" in text

    row, column = np.unravel_index(np.argmin(grid), grid.shape)
    theta_w = document["theta_w_deg_s"][column]
    best = HdrParams.from_degrees(
        i_c_deg_s=document["i_c_deg_s"][row], theta_w_deg_s=np.inf if theta_w is None else theta_w
    )
    assert document["chosen"] == hdr_table2.name_of(best)


def test_errors_are_summed_up_over_units_and_noises() -> None:
    """Two noises of three units: over all six, from noise to noise, and how far one unit's lie apart."""
    final = np.array([[10.0, 20.0, 60.0], [30.0, 20.0, 10.0]])
    found = _hdr_page.summary(np.stack([final, final / 10], axis=-1), np.ones((2, 3), bool))
    assert found.over_all["final"]["mean"] == 25
    assert found.over_all["average"]["median"] == 2
    assert found.by_noise["final"]["mean"] == {"median": 25, "smallest": 20, "largest": 30}
    assert found.by_noise["final"]["median"] == {"median": 20, "smallest": 20, "largest": 20}
    assert found.unit["final"] == 20  # of 20, 0 and 50
    some = _hdr_page.summary(np.stack([final, final], axis=-1), np.array([[1, 0, 0], [1, 1, 0]], dtype=bool))
    assert some.over_all["final"]["mean"] == 20
    assert some.by_noise["final"]["mean"] == {"median": 17.5, "smallest": 10, "largest": 25}
    assert some.unit["final"] == 10  # of 20 and 0


def test_each_unit_is_heard_through_its_own_noise_and_more(short: str) -> None:
    worn = setup(load_scenario(short), methods=["pdr"])
    trials = _common.dealt(worn, 2, 1, (7, 8), 2)
    far = _common.NOISE_STEP
    assert [(one.unit_seed, one.noise_seed) for one in trials] == [
        *((7, 7 + far * noise) for noise in range(3)),
        *((8, 8 + far * noise) for noise in range(3)),
    ]
    assert {(one.unit_seed, one.number, one.walk_seed) for one in trials} == {(7, 1, 2), (8, 0, 1)}
    cases = _hdr_cases.dead_reckoned(trials, 1, "walking")
    assert [case.trial for case in cases] == trials
    found = _common.outcomes(trials, 1, "trials")
    errors = [_common.heading_errors_deg(one.rows[0]) for one in found]
    assert len(set(errors)) == len(errors)
    np.testing.assert_allclose([case.uncorrected_deg() for case in cases], errors, atol=1e-9)


def test_a_walk_without_an_end_is_named_and_left_out(
    short: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], short_walk
) -> None:
    def falls(plan, **keys):
        if plan.seed == 2:
            raise FallError("short: the walker fell at 17 m")
        return short_walk

    monkeypatch.setattr("footfall.simulate.cache.cached_walk", falls)
    trials = _common.dealt(setup(load_scenario(short), methods=["pdr"]), 2, 1, (7, 8, 9))
    assert [one.trial.unit_seed for one in _common.outcomes(trials, 1, "")] == [8]
    assert "left out, 2 recordings: short: the walker fell at 17 m" in capsys.readouterr().err
    assert [case.trial.unit_seed for case in _hdr_cases.dead_reckoned(trials, 1, "")] == [8]
    assert "left out, 2 recordings" in capsys.readouterr().err


def test_what_a_method_refuses_is_no_figure(short: str, monkeypatch: pytest.MonkeyPatch, short_walk) -> None:
    def refuses(reckoning, params):
        raise InputError("no")

    monkeypatch.setattr("footfall.simulate.cache.cached_walk", lambda plan, **keys: short_walk)
    worn = setup(load_scenario(short), methods=[Method("bad", "", refuses)])
    with pytest.raises(InputError, match="no"):
        _common.outcomes(_common.dealt(worn, 1, 1, (7,)), 1, "")


@pytest.mark.parametrize("clash", [["--tuning-unit-seed", "1003"], ["--tuning-walk-seed", "2"]])
def test_a_seed_on_both_sides_is_refused(short: str, clash: list[str]) -> None:
    with pytest.raises(SystemExit, match="share"):
        hdr_table2.main([short, "--units", "4", *clash])


def test_units_fit_to_the_papers_whole_degrees() -> None:
    for final, fits in ((101.4, False), (101.6, True), (307.4, True), (307.6, False)):
        assert stock_units.judge(0, 0, np.array([final, 80.0]), 5).fits == fits


@given(st.data())
def test_units_are_kept_by_the_stated_rule(data: st.DataObject) -> None:
    errors = st.tuples(st.floats(60, 350), st.floats(20, 160))
    drawn = [
        stock_units.judge(unit, unit % 5, np.array(data.draw(errors)), 5)
        for unit in range(data.draw(st.integers(1, 40)))
    ]
    kept = stock_units.keep(drawn)
    assert len({one.walk for one in kept}) == len({one.part for one in kept}) == len(kept)
    for one in drawn:
        # In whole degrees, as the paper gives its own.
        assert one.fits == (102 <= round(one.final) <= 307 and 34 <= round(one.average) <= 145)
        before = [other for other in kept if other.unit < one.unit]
        free = all(other.walk != one.walk and other.part != one.part for other in before)
        assert (one in kept) == (one.fits and free)


def test_units_that_do_not_fit_are_not_kept(short: str, tmp_path: Path) -> None:
    """Half a minute of drift is far below the paper's."""
    out = tmp_path / "out.json"
    arguments = ["--scenario", short, "--units", "2", "--most", "4", "--processes", "1", "--json", str(out)]
    assert stock_units.main(arguments) == 1
    document = json.loads(out.read_text())
    assert document["kept"] == []
    assert [(one["unit"], one["walk"]) for one in document["drawn"]] == [(0, 0), (1, 1), (2, 0), (3, 1)]


def test_robustness_reads_a_known_gait(short: str) -> None:
    """Footfalls laid beside the route by hand, with a known sway, stance yaw and rhythm."""
    plan = load_scenario(short).plan(0)
    route = plan.route
    rows = np.arange(0, len(route.s), int(1.3 / (route.s[1] - route.s[0])))
    sway = 0.05 * np.where(np.arange(len(rows)) % 2, 1, -1)
    aside = np.column_stack([-np.sin(route.heading[rows]), np.cos(route.heading[rows])])
    position = np.column_stack([route.x[rows], route.y[rows]]) + (sway - 0.1)[:, None] * aside
    yaw = np.radians(2) * np.where(np.arange(len(rows)) % 2, 1, -1)
    falls = TrueFootfalls(1.1 * np.arange(len(rows)), position, route.heading[rows] + yaw + 0.1)
    found = robustness.gait(plan, falls)
    assert found.stride_s == pytest.approx(1.1)
    assert found.stride_sd_ms == pytest.approx(0, abs=1e-9)
    assert found.stance_yaw_sd_deg == pytest.approx(2, rel=0.05)
    assert found.lateral_rms_m == pytest.approx(0.05, rel=0.05)


def test_stops_read_a_foot_that_comes_to_rest() -> None:
    """Stands but the first, each from the moment the foot is down; shorter stances are steps."""
    t = np.arange(0, 20, 0.005)
    stance = (t < 2) | ((t > 3) & (t < 3.6)) | ((t > 5) & (t < 10)) | (t > 12)
    rate = np.where(t < 12, 8 * np.exp(-np.maximum(t - 5, 0)), 0.3)
    truth = SimpleNamespace(t=t, stance=stance, gyro=np.radians(rate)[:, None] * [0.6, 0.0, -0.8])
    found = stops.rates_in_stands(truth)
    fading = 8 * np.exp(-np.array(stops.AFTER_S))
    np.testing.assert_allclose(found, [fading, [0.3] * 3], rtol=0.02)


def test_a_stop_on_a_slope_is_one() -> None:
    """The ground rises as the place says, and who walks there stands twice and does not fall."""
    place = stops.Place(5.0, "across")
    ground = place.ground()
    assert np.gradient(ground.heights, axis=0) == pytest.approx(0.05, abs=1e-6)
    assert np.gradient(ground.heights, axis=1) == pytest.approx(0.0, abs=1e-6)
    found = stops.stop((place, 1, False))
    assert not found.fell
    assert len(found.rates) >= 2


def test_an_extreme_person_is_at_a_limit_in_everything() -> None:
    people = [stops.plan(stops.Place(0.0, ""), seed, extreme=True).subject for seed in range(20)]
    for key, limits in LIMITS.items():
        assert {getattr(person, key) for person in people} == set(limits)


def test_a_first_step_is_cut_where_a_foot_leaves_the_ground() -> None:
    """The right foot leaves at 0.7 s and lands at 1.1 s; what either does after that is no matter.

    Its heel rises from 0.6 s on. A foot that is off the ground for less than 0.1 s has not left it.
    """
    t = np.arange(2000) / 1000
    yaw, pitch, load = np.zeros((3, 2, 2000))
    load[:] = 0.5
    load[0, (t >= 0.7) & (t < 1.1)] = 0.0
    load[0, (t >= 0.3) & (t < 0.39)] = 0.1  # not loaded for a moment: what it does then does not count
    load[1, t >= 1.2] = 0.0
    yaw[0] = np.interp(t, [0.5, 0.7, 0.8], [0, -1.5, -20])
    yaw[0, 350] = 30.0
    pitch[0] = np.interp(t, [0, 0.2, 0.4, 0.6, 0.7], [0, 1.0, -0.5, -2.0, -12.0])
    pitch[0, 599] = -1.9  # the last run of samples in which the toes only sink begins here
    pitch[1] = np.interp(t, [0.8, 1.0, 1.1, 1.3], [0, 0.7, 0.2, -30])
    yaw[1] = np.interp(t, [1.0, 1.1, 1.2], [0, 0.4, 9])
    right, left = starts.set_out("start", yaw, pitch, load, 0.001)
    assert (right.side, right.first, left.side, left.first) == ("r", True, "l", False)
    assert right.twist == pytest.approx(1.5, abs=0.02)
    assert right.up == pytest.approx(1.0)
    assert right.down == pytest.approx(1.99, abs=0.02)
    assert left.twist == pytest.approx(0.4, abs=0.02)
    assert left.up == pytest.approx(0.7)


def test_a_last_step_is_cut_where_a_landed_foot_lies_flat() -> None:
    """Toes-up of the heel that strikes does not count; the foot that lands last is told."""
    t = np.arange(4000) / 1000
    yaw, pitch, load = np.zeros((3, 2, 4000))
    load[:] = 0.5
    load[0, t < 1.0] = load[1, t < 0.6] = 0.0
    pitch[0] = np.interp(t, [1.0, 1.2, 1.4], [15.0, 0.0, 0.0])
    pitch[1] = np.interp(t, [0.6, 2.0, 3.0], [0.0, -1.2, 0.0])
    yaw[0] = np.interp(t, [1.0, 1.2, 2.0], [9.0, 2.0, 0.0])
    right, left = starts.last_step(yaw, pitch, load)
    assert (right.side, right.first, left.side, left.first) == ("r", True, "l", False)
    assert right.up == pytest.approx(3.0, abs=0.1)
    assert right.twist == pytest.approx(2.0 + 7 / 5, abs=0.1)
    assert (left.twist, left.up) == (0, 0)
    assert left.down == pytest.approx(1.2)


def test_starts_tell_every_foot_at_every_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """One person sets out, stops, stands, walks on and stops, uphill."""
    monkeypatch.setattr(starts, "PLACES", {"5 % uphill": (0.05, 0.0)})
    monkeypatch.setattr(starts, "METRES", 6.0)
    monkeypatch.setattr(starts, "AT", 3.0)
    out = tmp_path / "out.json"
    starts.main(["--people", "1", "--processes", "1", "--json", str(out)])
    assert "1 walks, 0 falls" in capsys.readouterr().out
    (one,) = json.loads(out.read_text())["starts"]
    assert (one["place"], one["fell"], len(one["led"])) == ("5 % uphill", False, 2)
    kinds = [(moved["kind"], moved["first"]) for moved in one["moved"]]
    assert sorted(kinds[:2]) == [("start", False), ("start", True)]
    assert sorted(kinds[2:4]) == [("restart", False), ("restart", True)]
    assert {moved["side"] for moved in one["moved"]} == {"r", "l"}
    assert all(0 <= moved[key] < 5 for moved in one["moved"][:2] for key in ("twist", "up", "down"))
    ground = starts.plan("5 % uphill", 1).ground
    assert np.gradient(ground.heights, axis=1) == pytest.approx(0.05, abs=1e-6)


def test_a_fall_is_reported_and_not_averaged(
    short: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    walked = robustness.walk

    def falls_with_seed_2(plan):
        if plan.seed == 2:
            raise FallError("short: the walker fell at 17 m")
        return walked(plan)

    monkeypatch.setattr(robustness, "walk", falls_with_seed_2)
    out = tmp_path / "out.json"
    robustness.main([short, "--seeds", "2", "--no-cache", "--processes", "1", "--json", str(out)])
    printed = capsys.readouterr().out
    assert "1 of 2" in printed
    assert "seed 2: short: the walker fell at 17 m" in printed
    good, bad = json.loads(out.read_text())["walks"]
    assert 0.9 < good["speed_m_s"] < 1.5
    assert bad["stumble"]
    assert "speed_m_s" not in bad


def test_a_script_runs_from_the_shell_over_two_processes(short: str, tmp_path: Path) -> None:
    options = [short, "--seeds", "2", "--metres", "10", "--no-cache"]
    command = [sys.executable, "-m", "benchmarks.validation.robustness", *options]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT)
    assert "2 of 2" in done.stdout


def test_scatter_is_that_of_the_strides_in_the_middle(capsys: pytest.CaptureFixture[str]) -> None:
    """Strides turn by +-0.02 rad, feet by +-0.03 rad; what sets out and stops is left out."""
    n = 41
    side = np.where(np.arange(n) % 2 == 0, 1.0, -1.0)
    x, y = 1.4 * np.arange(n), 0.5 * 1.4 * np.tan(0.02) * side
    heading, t = 0.5 + 0.03 * side, 1.1 * np.arange(n) + 0.01 * side
    y[:2], heading[-2:] = 5.0, 2.0
    falls = TrueFootfalls(t, np.column_stack([x, y, 0 * x]), heading)
    course, yaw, stride = scatter.scatter(falls)
    assert course == pytest.approx(np.degrees(0.02), rel=0.02)
    assert yaw == pytest.approx(np.degrees(0.03), rel=0.02)
    assert stride == pytest.approx(20.0, rel=0.02)
    scatter.report([scatter.Scatter("reference", 1.3, 0.1, 1, course, yaw, stride)])
    assert "1.2 (1.2 to 1.2)" in capsys.readouterr().out
