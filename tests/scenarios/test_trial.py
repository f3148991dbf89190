"""The atom and how it is spread: rows as the chain by hand gives them, shared walks, failures as rows."""

import os
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

import footfall
from footfall.errors import InputError
from footfall.hdr.methods import METHODS, Reckoning, find_method
from footfall.models.imu import draw_unit, load_spec
from footfall.pdr.reckoning import PdrParams
from footfall.scenarios import execute as executing
from footfall.scenarios import trial as trials
from footfall.scenarios.evaluate import cases, evaluate
from footfall.scenarios.execute import execute
from footfall.scenarios.judge.score import Score, score
from footfall.scenarios.parameters import documents, with_values
from footfall.scenarios.scenario import build_scenario, load_scenario
from footfall.scenarios.trial import Trial, find, perform, recording_of, setup, start_pose, walk_of
from footfall.simulate import cache
from footfall.simulate.episode import FallError
from footfall.simulate.identity import mount_name, walk_identity
from footfall.simulate.record import record
from tests.helpers.synthetic import synthetic_walk


def stands_still(recording, start):
    """A method that never leaves its start."""
    t = recording.t[[0, -1]]
    return footfall.Track(t, np.tile(start.position, (2, 1)), np.full(2, start.heading))


def refuses(recording, start):
    raise ValueError("I do not like it")


@pytest.fixture(scope="module")
def short(workshop):
    return load_scenario(workshop / "short.toml")


@pytest.fixture(scope="module")
def one(short):
    """A trial, and its walk."""
    trial = Trial(setup(short, methods=["pdr", "hdr"]), 1, walk_seed=4, unit_seed=8, noise_seed=9)
    return trial, walk_of(trial)


def test_rows_are_what_the_chain_by_hand_gives(one):
    trial, walk = one
    outcome = perform(trial, walk)
    recording = record(walk, draw_unit(load_spec("nimu"), 8), seed=9)
    given = Reckoning(recording, start_pose(walk), PdrParams())
    for row, name in zip(outcome.rows, ("pdr", "hdr"), strict=True):
        track = METHODS[name].track(given)
        assert (row.method, row.score, row.footfalls) == (name, score(track, walk), len(track))
        assert (row.stage, row.error) == ("", "")
        assert (row.scenario, row.subject, row.imu) == ("short", "shorter", "nimu")
        assert (row.walk_seed, row.unit_seed, row.noise_seed) == (4, 8, 9)
        assert (row.walk_sha, row.recording_sha) == (walk.sha, recording.sha)
        assert row.as_dict()["heading_error_mean_deg"] == row.require().heading_error_mean_deg
    assert outcome.kept is None
    assert outcome.scores["hdr"] == outcome.rows[1].score


def test_what_is_kept_is_what_was_scored(one):
    trial, walk = one
    outcome = perform(trial, walk, keep=True)
    assert outcome.rows == perform(trial, walk).rows
    assert outcome.kept.walk is walk
    np.testing.assert_array_equal(outcome.kept.recording.gyro, recording_of(trial, walk).gyro)
    assert {name: score(track, walk) for name, track in outcome.kept.tracks.items()} == outcome.scores


def test_content_tells_recordings_and_walks_apart(one):
    trial, walk = one
    first = perform(trial, walk).rows[0]
    other = perform(replace(trial, noise_seed=10), walk).rows[0]
    assert first.walk_sha == other.walk_sha
    assert first.recording_sha != other.recording_sha
    assert len(first.walk_sha) == 64
    shifted = replace(walk, position=walk.position + 1e-12)
    assert shifted.sha != walk.sha


def test_settings_reach_every_stage(one):
    trial, walk = one
    base = documents("closed-loop", methods=["pdr", "iez", "ihde"])
    for values, changed in (
        ({"pdr.tilt_gain": 0.5}, {"pdr", "iez", "ihde"}),  # the filter's vertical is dead reckoning's
        ({"pdr.detector": "shoe"}, {"pdr", "iez", "ihde"}),
        ({"filter.sigma_velocity": 0.2}, {"ihde"}),
        ({"iez.sigma_velocity": 0.2}, {"iez"}),
        ({"imu.gyro.flicker_deg_h": 300.0}, {"pdr", "iez", "ihde"}),
        ({"unit.gyro.scale": [0.0, 0.0, 0.05]}, {"pdr", "iez", "ihde"}),
    ):
        made = {}
        for name, given in (("before", {}), ("after", values)):
            told = with_values(base, given).setup()
            own = replace(told, scenario=trial.setup.scenario)
            made[name] = perform(replace(trial, setup=own), walk).scores
        assert {name for name in made["after"] if made["after"][name] != made["before"][name]} == changed


def test_effects_that_are_switched_off_are_not_heard(one):
    trial, walk = one
    silent = replace(trial.setup, without=("white", "flicker"))
    recording = recording_of(replace(trial, setup=silent), walk)
    assert recording.meta["without"] == ["flicker", "white"]
    assert np.std(np.diff(recording.gyro[:1000], axis=0)) < 0.5 * np.std(
        np.diff(recording_of(trial, walk).gyro[:1000], axis=0)
    )


# Failures


def test_a_method_that_fails_is_a_row_and_the_others_go_on(one):
    trial, walk = one
    made = replace(trial.setup, methods=find(["pdr", refuses, "hdr"]))
    first, second, third = perform(replace(trial, setup=made), walk).rows
    assert first.score is not None
    assert third.score is not None
    assert (second.method, second.score, second.stage) == ("refuses", None, "track")
    assert "I do not like it" in second.error
    assert second.as_dict()["heading_error_mean_deg"] is None
    with pytest.raises(InputError, match="I do not like it"):
        second.require()


def test_a_rest_that_is_too_short_fails_every_method_of_its_recording(one):
    trial, walk = one
    late = replace(trial.setup, pdr=PdrParams(bias_s=30.0))
    rows = perform(replace(trial, setup=late), walk).rows
    assert [row.stage for row in rows] == ["record", "record"]
    assert "stands still for 26 s, less than the 30 s" in rows[0].error


def test_two_methods_of_one_name_are_refused():
    with pytest.raises(InputError, match="method 'hdr' is given twice"):
        find(["hdr", "pdr", "hdr"])
    pair = find(["hdr", find_method("hdr", name="mine")])
    assert [method.name for method in pair] == ["hdr", "mine"]


@pytest.mark.parametrize("workers", [1, 2])
def test_a_walk_that_falls_is_rows_while_the_rest_goes_on(short, workers):
    pushed = setup(short.changed("disturbance", push_Ns=30.0, every_s=1.0))
    todo = [*cases(pushed, units=2, walks=1), *cases(setup(short), units=2, walks=1)]
    outcomes = list(execute(todo, workers=workers))
    assert all(outcome.trial is trial for outcome, trial in zip(outcomes, todo, strict=True))
    for outcome in outcomes[:2]:
        assert {row.stage for row in outcome.rows} == {"walk"}
        assert "fell" in outcome.rows[0].error
        assert outcome.rows[0].walk_sha == ""
    assert all(row.score for outcome in outcomes[2:] for row in outcome.rows)


# Over the cores


def test_walks_are_shared_by_whatever_changes_no_walk(short, monkeypatch, tmp_path):
    walked = []
    real = cache.cached_walk

    def counted(plan, **keys):
        walked.append(plan.seed)
        return real(plan, **keys)

    monkeypatch.setattr(cache, "cached_walk", counted)
    called = replace(short.document, name="called otherwise")
    settings = [
        setup(short, methods=["pdr"]),
        setup(short, imu="perfect", methods=["hdr"]),
        setup(build_scenario(called), methods=["pdr"]),
        setup(short.changed("sensor", bias_shift_deg_s=1.0), methods=["pdr"]),
    ]
    worn = [(number, unit) for number in (0, 1) for unit in (5, 6)]
    todo = [Trial(made, number, 3 + number, unit, unit) for made in settings for number, unit in worn]
    outcomes = list(execute(todo, workers=1))
    assert sorted(walked) == [3, 4]
    assert all(outcome.trial is trial for outcome, trial in zip(outcomes, todo, strict=True))
    assert len({outcome.rows[0].walk_sha for outcome in outcomes}) == 2
    assert [outcome.rows[0].scenario for outcome in outcomes[8:12]] == ["called otherwise"] * 4
    slower = setup(short.changed("gait", pace_m_s=1.1), methods=["pdr"])
    list(execute([Trial(slower, 0, 3, 5, 5)], workers=1))
    assert sorted(walked) == [3, 3, 4]


@pytest.fixture
def passes(monkeypatch):
    """The plans that were walked in each pass of the physics, by a walker whose every walk is synthetic."""
    found, walk = [], synthetic_walk(strides=12)

    def walks(plans, policy, on_progress):
        found.append([(mount_name(plan.mount), plan.rate_hz, plan.seed) for plan in plans])
        if plans[0].seed == 5:
            raise FallError("the walker fell")
        for plan in plans:
            yield replace(walk, meta=walk.meta | walk_identity(plan, policy).as_dict())

    monkeypatch.setattr(cache, "walks", walks)
    return found


def mounted(short, seeds):
    """Trials of two mounts, one of them at two rates, on walks of these seeds."""
    worn = [{"mount": "instep"}, {"mount": "shank"}, {"mount": "shank", "rate_hz": 100.0}]
    made = [setup(short.changed("sensor", **one), imu="perfect", methods=["pdr"]) for one in worn]
    return [Trial(one, 0, seed, 7, 7) for seed in seeds for one in made]


def test_mounts_and_rates_of_the_same_steps_are_walked_at_once(short, passes, tmp_path, monkeypatch):
    monkeypatch.setattr(cache, "cache_folder", lambda: tmp_path)
    outcomes = list(execute(mounted(short, [3, 4]), workers=1))
    assert passes == [
        [("instep", 200.0, seed), ("shank", 200.0, seed), ("shank", 100.0, seed)] for seed in (3, 4)
    ]
    assert [outcome.rows[0].error for outcome in outcomes] == [""] * 6


def test_a_worker_walks_them_at_once_and_falls_but_once(short, passes, tmp_path):
    assert executing._walk_job(0, mounted(short, [3]), tmp_path) == [None] * 3
    assert [len(walked) for walked in passes] == [3]
    refused = executing._walk_job(0, mounted(short, [5]), tmp_path)
    assert [str(error) for error in refused] == ["the walker fell"] * 3
    assert len(passes) == 2


def test_two_processes_give_what_one_gives(short, monkeypatch):
    monkeypatch.setattr(executing, "CHUNK", 2)
    todo = cases(setup(short), units=5)
    one = [outcome.rows for outcome in execute(todo, workers=1)]
    two = [outcome.rows for outcome in execute(todo, workers=2)]
    assert one == two
    assert len({row.recording_sha for rows in two for row in rows}) == 5


def test_footfalls_that_are_kept_give_the_same_rows_without_a_recording(short, tmp_path, monkeypatch):
    made = with_values(documents("closed-loop"), {"hdr.theta_w_deg_s": 0.5}).setup()
    todo = cases(setup(short), units=3)
    before = [outcome.rows for outcome in execute(todo, workers=1)]
    assert [outcome.rows for outcome in execute(todo, workers=1, store=tmp_path)] == before
    assert len(list(tmp_path.rglob("*.npz"))) == 3
    recorded = []
    real = trials.record
    monkeypatch.setattr(trials, "record", lambda *given, **keys: recorded.append(1) or real(*given, **keys))
    assert [outcome.rows for outcome in execute(todo, workers=1, store=tmp_path)] == before
    assert not recorded
    # Other parameters of a method need no recording; another noise, sheet or tilt gain does.
    wide = [replace(one, setup=replace(one.setup, methods=made.methods)) for one in todo]
    assert [outcome.rows[0] for outcome in execute(wide, workers=1, store=tmp_path)] == [
        rows[0] for rows in before
    ]
    assert not recorded
    tilted = replace(todo[0].setup, pdr=PdrParams(tilt_gain=0.4))
    for other in (
        replace(todo[0], noise_seed=77),
        replace(todo[0], unit_seed=77),
        replace(todo[0], setup=tilted),
        replace(todo[0], setup=replace(todo[0].setup, without=("white",))),
        replace(todo[0], setup=replace(todo[0].setup, unit={"gyro.scale": [0.0, 0.0, 0.1]})),
    ):
        (found,) = execute([other], workers=1, store=tmp_path)
        assert found.rows == perform(other, walk_of(other)).rows
    assert len(recorded) == 10
    # A damaged file is made again; methods on samples ask nothing of it.
    next(tmp_path.rglob("*.npz")).write_bytes(b"PK")
    assert [outcome.rows for outcome in execute(todo, workers=1, store=tmp_path)] == before
    files = len(list(tmp_path.rglob("*.npz")))
    list(execute(cases(setup(short, methods=["iez"]), units=1), workers=1, store=tmp_path))
    assert len(list(tmp_path.rglob("*.npz"))) == files


def test_units_are_dealt_to_the_walks_or_worn_on_all(short):
    dealt = cases(setup(short), units=5)
    worn = [(0, 1000), (0, 1002), (0, 1004), (1, 1001), (1, 1003)]
    assert [(one.number, one.unit_seed) for one in dealt] == worn
    assert [one.walk_seed for one in dealt] == [3, 3, 3, 4, 4]
    crossed = cases(setup(short), units=2, walks=3, seed=20, crossed=True)
    assert [(one.walk_seed, one.unit_seed) for one in crossed] == [
        (seed, unit) for seed in (20, 21, 22) for unit in (1000, 1001)
    ]


def test_a_script_without_a_main_guard_is_told(tmp_path):
    file = tmp_path / "script.py"
    file.write_text("import footfall\nfootfall.evaluate('pdr', 'straight', units=2, walks=2, workers=2)\n")
    done = subprocess.run([sys.executable, str(file)], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "InputError: a worker ended at once: a script must call this below `if __name__" in done.stderr


def end_at_once():
    os.kill(os.getpid(), 9)


def test_a_worker_that_is_killed_is_told_as_such():
    told = pytest.raises(InputError, match="a worker process was ended: killed, or out of memory")
    with told, executing.worker_pool(1) as (pool, _):
        pool.submit(end_at_once).result()


# In one line


def test_a_function_is_scored_in_one_line(workshop):
    rows = evaluate([stands_still, "pdr"], str(workshop / "short.toml"), units=3, workers=1)
    assert [row.method for row in rows] == ["stands_still", "pdr"] * 3
    assert len(rows.of("pdr")) == 3
    assert np.isfinite(rows.values("position_rmse_m")).all()
    assert (rows.of("stands_still").values("position_error_final_m") > 20).all()
    assert (rows.of("pdr").values("position_error_final_m") < 2).all()
    assert str(rows).startswith("stands_still: 3 trials, heading_error_mean_deg ")
    told = evaluate("pdr", str(workshop / "short.toml"), units=3, workers=1)
    assert told.rows == rows.of("pdr").rows


def test_a_lambda_is_called_in_this_process_and_a_mistake_is_a_row(workshop):
    rows = evaluate(lambda recording, start: None, str(workshop / "short.toml"), units=2, workers=2)
    assert len(rows.failures) == 2
    assert np.isnan(rows.values("heading_error_mean_deg")).all()
    assert "2 failed" in str(rows)


def test_values_by_address_reach_the_trial(workshop):
    wide = evaluate("hdr", str(workshop / "short.toml"), units=2, values={"hdr.i_c_deg_s": 0.0}, workers=1)
    none = evaluate("pdr", str(workshop / "short.toml"), units=2, workers=1)
    np.testing.assert_allclose(
        wide.values("heading_error_mean_deg"), none.values("heading_error_mean_deg"), atol=1e-9
    )


def test_rows_are_a_table(workshop):
    pandas = pytest.importorskip("pandas")
    rows = evaluate("pdr", str(workshop / "short.toml"), units=2, workers=1)
    table = rows.to_pandas()
    assert isinstance(table, pandas.DataFrame)
    assert list(table["unit_seed"]) == [1000, 1001]
    assert {*Score.__dataclass_fields__, "recording_sha", "method"} <= set(table.columns)
