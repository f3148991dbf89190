"""`footfall run`: what it computes, prints and leaves in its folder."""

import json
import math
import os
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from footfall.errors import InputError
from footfall.hdr import methods
from footfall.models.imu import TemperatureProfile, draw_unit, load_spec
from footfall.recording import read_recording
from footfall.scenarios.judge.score import score
from footfall.scenarios.report.document import run_document
from footfall.scenarios.report.results import results_folder, write_results
from footfall.scenarios.run import OTHER_NOISES_FROM, OTHER_UNITS_FROM, parts, perform_run
from footfall.scenarios.scenario import load_scenario
from footfall.scenarios.trial import reckoning, setup, start_pose
from footfall.simulate.record import record
from footfall.simulate.walk import read_walk
from footfall.tables import read_table
from tests.helpers.commands import SCORES, content, expect_one_sentence, one_document

FIGURES = {"maps.png", "heading_error.png", "drift_budget.png", "filtered_rates.png", "controller.png"}


def files_of(walk, *methods):
    return {f"walk-{walk}{part}.parquet" for part in ("", ".footfalls", ".recording", ".drift")} | {
        f"walk-{walk}.{method}.parquet" for method in methods
    }


def short_part(workshop):
    """One walk of the short scenario, two further units and three further noises."""
    made = setup(load_scenario(workshop / "short.toml"), methods=("pdr", "hdr", "hdr-basic"))
    return parts(made, walks=1, other_units=2, noises=3)


@pytest.fixture(scope="module")
def done(workshop):
    """What it gave."""
    (result,) = perform_run(short_part(workshop), workers=1)
    return result


# What is to be done


def test_seeds_units_and_subjects_of_the_walks(workshop):
    scenario = load_scenario(workshop / "short.toml")

    def own(scenario=scenario, imu=None, **keys):
        return [part.own for part in parts(setup(scenario, imu=imu), **keys)]

    assert [(one.number, one.walk_seed, one.unit_seed) for one in own(other_units=5)] == [
        (0, 3, 3),
        (1, 4, 4),
    ]
    chosen = scenario.changed("seeds", units=[70, 90])
    assert [one.unit_seed for one in own(chosen, walks=3)] == [70, 90, 70]
    # The chosen units belong to the scenario's own sheet and walks.
    assert [one.unit_seed for one in own(chosen, imu="perfect")] == [3, 4]
    assert [(one.walk_seed, one.unit_seed) for one in own(chosen, seed=20)] == [(20, 20), (21, 21)]
    assert [one.plan.subject.name for one in own()] == ["reference", "shorter"]
    assert [one.plan.seed for one in own(seed=20)] == [20, 21]


@pytest.mark.parametrize(("walks", "units"), [(1, 3), (2, 5), (4, 3), (3, 0)])
def test_every_other_unit_is_scored_once(workshop, walks, units):
    todo = parts(setup(load_scenario(workshop / "short.toml")), walks=walks, other_units=units)
    others = [one for part in todo for one in part.others]
    assert sorted(one.unit_seed for one in others) == list(range(OTHER_UNITS_FROM, OTHER_UNITS_FROM + units))
    assert all(one.noise_seed == one.unit_seed for one in others)
    assert all(one.walk_seed == part.own.walk_seed for part in todo for one in part.others)
    assert max(len(part.others) for part in todo) - min(len(part.others) for part in todo) <= 1


def test_one_unit_has_one_noise_unless_asked_and_every_further_noise_is_of_one_walk(workshop):
    scenario = load_scenario(workshop / "short.toml")
    todo = parts(setup(scenario.changed("seeds", units=[70, 90])), walks=3, noises=4)
    assert [part.own.noise_seed for part in todo] == [part.own.unit_seed for part in todo] == [70, 90, 70]
    assert [[one.unit_seed for one in part.noises] for part in todo] == [[70] * 4, [90] * 4, [70] * 4]
    seeds = [one.noise_seed for part in todo for one in part.noises]
    assert sorted(seeds) == list(range(OTHER_NOISES_FROM, OTHER_NOISES_FROM + 12))
    assert [part.noises for part in parts(setup(scenario))] == [(), ()]


def test_a_rest_that_is_too_short_is_refused_before_anything_is_walked(workshop):
    scenario = load_scenario(workshop / "short.toml").changed("sensor", calibration_s=20.0)
    with pytest.raises(InputError, match=r"calibration_s = 20: a run averages .*bias_time_s = 25 s"):
        parts(setup(scenario))


# What is computed


def test_the_scores_are_those_of_the_tracks_against_the_walk(done):
    assert list(done.scores) == list(done.tracks) == ["pdr", "hdr", "hdr-basic"]
    for name, track in done.tracks.items():
        assert done.scores[name] == score(track, done.walk)
    assert len(done.others) == 2
    assert all(list(other) == list(done.tracks) for other in done.others)
    assert done.others[0]["pdr"] != done.others[1]["pdr"]


def test_further_units_and_noises_are_what_their_recordings_give(workshop, done):
    """A further unit in its own noise; the walk's own unit in further noise; each in the walk's cold."""
    (part,) = short_part(workshop)
    cold = part.own.setup.scenario.temperature_of(0)
    further = [(one.unit_seed, one.noise_seed) for one in (*part.others, *part.noises)]
    assert len(done.noises) == 3
    for (unit, noise), found in zip(further, [*done.others, *done.noises], strict=True):
        recording = record(done.walk, draw_unit(load_spec("nimu"), unit), seed=noise, temperature=cold)
        assert found["hdr"] == score(methods.track(recording, "hdr", start_pose(done.walk)), done.walk)
    assert len({found["pdr"].heading_error_final_deg for found in (*done.noises, done.scores)}) == 4


def test_each_walk_is_recorded_in_its_own_cold(workshop):
    days = (TemperatureProfile.step(20.0, 20.0), TemperatureProfile.step(20.0, -30.0))
    scenario = replace(load_scenario(workshop / "short.toml"), temperatures=days)
    todo = parts(setup(scenario, methods=("pdr",)), other_units=2, noises=1)
    first, second = perform_run(todo, workers=1)
    assert [done.recording.meta["temperature"]["ambient"] for done in (first, second)] == [(20.0,), (-30.0,)]
    assert np.ptp(first.recording.temperature) == 0
    assert second.recording.temperature[-1] < 19
    # The same unit in the same noise of the same walk is turned otherwise where it is warm.
    warm = setup(replace(scenario, temperatures=days[:1]), methods=("pdr",))
    (_, again) = perform_run(parts(warm, other_units=2, noises=1), workers=1)
    for name in ("scores", "others", "noises"):
        assert getattr(again, name) != getattr(second, name)


def test_the_drift_budget_explains_the_uncorrected_heading(done):
    """Its causes sum up to the drift, which integrates to PDR's heading error within half a degree."""
    np.testing.assert_allclose(sum(done.budget.causes.values()), done.budget.total, atol=1e-12)
    turned = np.degrees(np.sum(done.budget.total * done.budget.interval))
    assert abs(turned) == pytest.approx(done.scores["pdr"].heading_error_final_deg, abs=0.5)


def test_a_run_tells_rest_shift_and_the_paths_direction(workshop):
    """Ten of 26 s of rest are averaged, the unit's bias shifts afterwards, and the path begins along x."""
    scenario = load_scenario(workshop / "short.toml")
    scenario = scenario.changed("sensor", bias_time_s=10.0, bias_shift_deg_s=0.3, imu="perfect")
    made = setup(scenario, methods=["pdr", "ihde"])
    (result,) = perform_run(parts(made, walks=1), workers=1)
    shift = scenario.unit_bias_shift(result.trial.unit_seed)
    assert result.recording.meta["bias_shift"] == shift
    assert np.sign(result.budget.total.mean()) == np.sign(shift)
    walked = result.tracks["pdr"].t[-1] - 26
    assert result.scores["pdr"].heading_error_final_deg == pytest.approx(0.3 * walked, rel=0.3)
    told = reckoning(made, result.walk, result.recording)
    assert (told.pdr.bias_s, told.directions.reference) == (10.0, 0.0)
    assert told.start == start_pose(result.walk, 10.0)
    assert told.guided.gyro_bias_sd == pytest.approx(math.radians(0.3))
    sure = setup(scenario.changed("sensor", bias_shift_deg_s=0.0))
    assert sure.guided.gyro_bias_sd == pytest.approx(math.radians(0.1))
    assert result.tracks["ihde"].meta["params"]["directions"]["reference"] == 0.0


def test_a_start_that_is_no_rest_is_refused(done):
    with pytest.raises(InputError, match=r"stands still for 26 s, less than the 27 s of T_bias"):
        start_pose(done.walk, 27.0)


@pytest.mark.parametrize("workers", [1, 2])
def test_progress_runs_to_the_end_of_the_path_and_through_the_trials(workshop, workers):
    scenario = load_scenario(workshop / "short.toml")
    todo = parts(setup(scenario), walks=1, other_units=2, noises=1)
    said = []

    def report(now):
        said.append((tuple(now.metres), now.done))
        assert (len(now.walks), now.trials) == (1, 4)

    perform_run(todo, workers=workers, use_cache=False, on_progress=report)
    metres = [at for (at,), _ in said]
    assert metres == sorted(metres)
    assert metres[-1] == scenario.path.route.length
    assert len({at for at in metres if 0 < at < metres[-1]}) > 1
    assert [done for _, done in said] == sorted(done for _, done in said)
    assert said[-1][1] == 4


def test_workers_give_what_one_process_gives(workshop, done):
    """In order, to the last bit."""
    made = setup(load_scenario(workshop / "short.toml"), methods=("pdr", "hdr", "hdr-basic"))
    first, second = perform_run(parts(made, other_units=4), workers=2)
    assert [result.trial.number for result in (first, second)] == [0, 1]
    assert first.scores == done.scores
    assert first.others[0] == done.others[0]
    np.testing.assert_array_equal(first.recording.gyro, done.recording.gyro)
    assert second.walk.meta["subject"] == "shorter"


# What is left in the folder


def test_one_walk_in_the_folder_and_on_the_terminal(cli, here):
    code, out, err = cli("run short.toml --walks 1 --units 2 --noises 3 --out new/deep")
    assert code == 0
    assert err == "Scores, walks, tracks and figures are in new/deep; look at new/deep/report.html\n"
    assert max(map(len, out.splitlines())) <= 80
    folder = here / "new" / "deep"
    assert set(os.listdir(folder)) == files_of(1, "pdr", "hdr") | FIGURES | {"scores.json", "report.html"}
    scores = one_document((folder / "scores.json").read_text())
    (row,) = scores["walks"]
    for name in ("pdr", "hdr"):
        assert set(row["methods"][name]) == SCORES
        errors = row["methods"][name]
        assert f"{errors['heading_error_mean_deg']:.1f} / {errors['heading_error_final_deg']:.1f}" in out
        assert scores["mean"][name] == pytest.approx(errors)
    assert scores["other_units"]["count"] == 2
    assert "2 other units" in out
    assert scores["other_noises"]["count"] == row["other_noises"]["count"] == 3
    assert "3 other noise seeds" in out
    for figure in FIGURES:
        with Image.open(folder / figure) as image:
            assert image.width > 600
            assert np.std(np.asarray(image.convert("L"))) > 5  # not blank


def test_the_files_are_what_the_commands_make(cli, here):
    """The walk, recording and tracks of a run are those of walk, record and track with the same seeds."""
    assert cli("run short.toml --walks 1 --noises 0 --units 0 --out out")[0] == 0
    assert cli("record walk.parquet --unit-seed 3 -o rec.parquet")[0] == 0
    walk, theirs = read_walk("out/walk-1.parquet"), read_walk("walk.parquet")
    np.testing.assert_array_equal(walk.gyro, theirs.gyro)
    np.testing.assert_array_equal(walk.footfalls.heading, theirs.footfalls.heading)
    recording = read_recording("out/walk-1.recording.parquet")
    np.testing.assert_array_equal(recording.gyro, read_recording("rec.parquet").gyro)
    # The start is the recording's own.
    assert cli("track out/walk-1.recording.parquet --method pdr -o pdr.parquet")[0] == 0
    assert cli("score pdr.parquet walk.parquet --json")[0] == 0
    (ours, told), (alone, again) = read_table("out/walk-1.pdr.parquet"), read_table("pdr.parquet")
    for name, values in ours.items():
        np.testing.assert_array_equal(values, alone[name])
    # What was read is told of a file, and what is plausible of its track.
    assert again == told | {name: again[name] for name in ("read", "plausibility")}
    drift, _ = read_table("out/walk-1.drift.parquet")
    assert {"t", "interval", "temperature", "white", "total"} <= set(drift)


def test_the_same_seed_gives_the_same_scores_to_the_last_byte(cli, here):
    """Walked anew, walked anew again, and by way of the cache."""
    for folder, options in (("a", "--no-cache"), ("b", "--no-cache"), ("c", ""), ("c", "")):
        assert (
            cli(f"run short.toml --walks 1 --units 1 --noises 1 --seed 11 {options} --out {folder}")[0] == 0
        )
    first = (here / "a" / "scores.json").read_bytes()
    for folder in "bc":
        assert (here / folder / "scores.json").read_bytes() == first
    assert cli("run short.toml --walks 1 --noises 0 --units 1 --seed 12 --out e")[0] == 0
    assert json.loads((here / "e" / "scores.json").read_text())["mean"] != json.loads(first)["mean"]


def test_the_json_on_standard_output_is_the_file(cli, here):
    code, out, _ = cli("run short.toml --walks 1 --units 0 --noises 0 --imu perfect --methods pdr --json")
    assert code == 0
    document = one_document(out)
    assert document == json.loads((here / "out" / "short" / "scores.json").read_text())
    told = {"scenario", "description", "command", "distance_m", "duration_s", "versions", "walks", "mean"}
    assert set(document) == told
    assert document["description"] == "thirty metres round one corner"
    assert document["command"] == (
        "footfall run short.toml --walks 1 --imu perfect --methods pdr --units 0 --noises 0"
    )
    assert (document["scenario"], document["walks"][0]["imu"]) == ("short", "perfect")
    assert document["distance_m"] == pytest.approx(30, abs=3)
    assert document["mean"]["pdr"]["heading_error_final_deg"] < 0.2
    assert abs(document["mean"]["pdr"]["distance_error_pct"]) < 1
    assert set(os.listdir(here / "out" / "short")) == files_of(1, "pdr") | {
        "maps.png",
        "heading_error.png",
        "drift_budget.png",
        "scores.json",
        "report.html",
    }


def test_a_later_run_leaves_nothing_of_an_earlier_one_and_all_of_its_users(cli, here):
    assert cli("run short.toml --walks 2 --noises 0 --units 0 --out new")[0] == 0
    for name in ("notes.txt", "walk-1.mine.parquet", "walk-2.png"):
        (here / "new" / name).write_text("mine")
    assert cli("run short.toml --walks 1 --noises 0 --units 0 --methods pdr --out new")[0] == 0
    left = files_of(1, "pdr") | FIGURES - {"filtered_rates.png", "controller.png"}
    left |= {"scores.json", "report.html"}
    assert set(os.listdir(here / "new")) == left | {"notes.txt", "walk-1.mine.parquet", "walk-2.png"}


def test_a_later_run_leaves_nothing_of_an_earlier_ones_own_methods(cli, here):
    """Whose names the scores tell."""
    options = "--walks 1 --noises 0 --units 0 --out new"
    assert cli(f"run short.toml --methods pdr,quick=hdr {options}")[0] == 0
    assert (here / "new" / "walk-1.quick.parquet").exists()
    (here / "new" / "walk-1.slow.parquet").write_text("its user's")
    assert cli(f"run short.toml --methods pdr {options}")[0] == 0
    assert not (here / "new" / "walk-1.quick.parquet").exists()
    assert (here / "new" / "walk-1.slow.parquet").exists()


def test_a_results_folder_is_taken_away_again_where_the_work_fails(tmp_path):
    (tmp_path / "old").mkdir()
    (tmp_path / "old" / "kept.txt").touch()
    before = content(tmp_path)

    def fail(folder, leaving=None):
        with results_folder(folder):
            assert folder.is_dir()
            if leaving:
                (folder / leaving).touch()
            raise KeyboardInterrupt

    for folder in (tmp_path / "old", tmp_path / "old" / "a" / "b", tmp_path / "new"):
        with pytest.raises(KeyboardInterrupt):
            fail(folder)
        assert content(tmp_path) == before
    with pytest.raises(KeyboardInterrupt):
        fail(tmp_path / "new", leaving="someone-elses.txt")
    assert os.listdir(tmp_path / "new") == ["someone-elses.txt"]


@pytest.mark.parametrize("trouble", ["a folder in the way", "a full disk", "an interrupt"])
def test_results_are_written_all_or_none(done, tmp_path, monkeypatch, trouble):
    (tmp_path / "scores.json").write_text("an earlier run's")
    expected = InputError
    if trouble == "a folder in the way":
        (tmp_path / "maps.png").mkdir()
        message = r"maps\.png: a folder stands where a result is to be written"
    else:
        error = OSError(28, "No space left on device") if trouble == "a full disk" else KeyboardInterrupt()

        def fail(*_):
            raise error

        monkeypatch.setattr("footfall.scenarios.report.results.run_figures", fail)
        message = r"cannot be written \(No space left on device\)"
        if trouble == "an interrupt":
            expected, message = KeyboardInterrupt, None
    before = content(tmp_path)
    with pytest.raises(expected, match=message):
        write_results([done], run_document("short", [done]), tmp_path)
    assert content(tmp_path) == before


def test_what_was_set_reaches_the_scores_and_is_told(cli, here):
    options = "--walks 1 --units 0 --noises 0 --methods pdr,hdr --json"
    _, plain, _ = cli(f"run short.toml {options}")
    code, out, _ = cli(
        f"run short.toml {options} --set hdr.theta_w_deg_s=0.01 --bias-time 20 --detector shoe "
        "--only scale --out other"
    )
    assert code == 0
    first, second = one_document(plain), one_document(out)
    assert "settings" not in first
    assert second["command"] == (
        "footfall run short.toml --walks 1 --methods pdr,hdr --units 0 --noises 0 --detector shoe "
        "--bias-time 20.0 --only scale --set hdr.theta_w_deg_s=0.01"
    )
    assert second["settings"] == {"pdr.detector": "shoe", "pdr.bias_s": 20.0, "hdr.theta_w_deg_s": 0.01}
    assert "scale" not in second["without"]
    assert {"white", "flicker"} <= set(second["without"])
    for method in ("pdr", "hdr"):
        assert first["mean"][method] != second["mean"][method]


@pytest.mark.parametrize(
    ("options", "culprit"),
    [
        ("--set hdr.theta=1", r"hdr\.theta: unknown; did you mean .*theta_w_deg_s"),
        ("--set iez.sigma_velocity=1", "method 'iez' is not among hdr, pdr"),
        ("--set nothing", "--set nothing: expected ADDRESS=VALUE"),
        ("--without white --only flicker", "--without and --only: expected one of them"),
        ("--only nothing", "effect 'nothing' does not exist"),
        ("--directions 4", "none of pdr, hdr goes by dominant directions"),
        ("--bias-time 40", r"calibration_s = 26: a run averages .* = 40 s"),
        ("--detector best", "detector 'best' is unknown"),
        ("--methods pdr,pdr=hdr", "'pdr'"),
    ],
)
def test_a_setting_that_cannot_be_is_one_sentence_before_anything_is_walked(cli, here, options, culprit):
    before = content(here)
    expect_one_sentence(*cli(f"run short.toml {options}"), culprit)
    assert content(here) == before
