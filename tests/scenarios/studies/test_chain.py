"""Studies through the whole chain, on one short walk: rows, failures, workers that are killed, tracks."""

import json
import os
from dataclasses import replace

import numpy as np
import pytest

from footfall.hdr.method import Method
from footfall.pdr.track import read_track
from footfall.scenarios import trial as trials
from footfall.scenarios.evaluate import evaluate
from footfall.scenarios.studies.local import spread
from footfall.scenarios.studies.plan import cost_of, plan_of, walk_seconds
from footfall.scenarios.studies.study import Study
from footfall.scenarios.studies.sweep import sweep
from footfall.scenarios.studies.task import do
from footfall.simulate.cache import cached_walk
from footfall.simulate.identity import mount_name, walk_identity
from footfall.tables import read_table
from tests.helpers.study import study
from tests.helpers.synthetic import synthetic_walk

SCORES = ("heading_error_mean_deg", "position_rmse_m", "return_error_pct")
NAV = """
import os
import numpy as np
import footfall

def stands(recording, start):
    t = recording.t[[0, -1]]
    return footfall.Track(t, np.tile(start.position, (2, 1)), np.full(2, start.heading))

def refuses(recording, start):
    raise ValueError("I do not like it")

def kills(recording, start, params={"flag": ""}):
    if not os.path.exists(params["flag"]):
        if params["flag"]:
            open(params["flag"], "w").close()
        os.kill(os.getpid(), 9)
    return stands(recording, start)
"""


@pytest.fixture
def place(tmp_path, workshop, monkeypatch):
    """A folder of one's own, with the short scenario and some methods."""
    (tmp_path / "nav.py").write_text(NAV)
    (tmp_path / "short.toml").write_text((workshop / "short.toml").read_text())
    monkeypatch.setenv("XDG_CACHE_HOME", os.environ["XDG_CACHE_HOME"])
    return tmp_path


@pytest.fixture(autouse=True)
def pages(monkeypatch):
    """Folders whose page was written."""
    written = []
    monkeypatch.setattr("footfall.scenarios.report.page.write_page", written.append)
    return written


@pytest.fixture
def store(tmp_path, monkeypatch):
    """Footfalls of this test alone."""
    folder = tmp_path / "footfalls"
    monkeypatch.setattr("footfall.scenarios.studies.sweep.footfalls_folder", lambda: folder)
    return folder


def made(place, **table):
    base = {"description": "d", "scenarios": ["short.toml"], "methods": ["pdr", "hdr"]}
    return Study("study", base | {"cases": {"walks": 1, "units": 2}} | table, place)


def finished(study, folder, executor=1, **keys):
    *_, now = sweep(study, folder, executor, **keys)
    assert now.stage == "finished"
    return study.results(folder).to_pylist()


def boom(reckoning, params):
    raise ZeroDivisionError("by zero")


def test_rows_are_what_one_call_gives_at_each_point(place, store):
    axes = {"pdr.tilt_gain": [0.1, 0.4], "hdr.theta_w_deg_s": [0.1, 0.6], "imu": ["nimu", "mtig710"]}
    rows = finished(made(place, design={"axes": axes}), place / "out")
    assert len(rows) == 2 * 2 * 2 * 3
    for imu, tilt, theta in (("nimu", 0.4, 0.1), ("mtig710", 0.1, 0.6)):
        values = {"pdr.tilt_gain": tilt, "hdr.theta_w_deg_s": theta}
        told = evaluate(
            ["pdr", "hdr"], str(place / "short.toml"), units=2, walks=1, imu=imu, values=values, workers=1
        )
        for row in told:
            (mine,) = (
                one
                for one in rows
                if (one["method"], one["unit_seed"], one["imu"]) == (row.method, row.unit_seed, imu)
                and one["pdr.tilt_gain"] == tilt
                and one["hdr.theta_w_deg_s"] in (None, theta)
            )
            assert mine["recording_sha"] == row.recording_sha
            assert mine["footfalls"] == row.footfalls
            for name in SCORES:
                assert mine[name] == getattr(row.score, name)


def test_only_what_must_is_done_again(place, store, monkeypatch):
    recorded = []
    real = trials.record
    monkeypatch.setattr(trials, "record", lambda *given, **keys: recorded.append(1) or real(*given, **keys))
    monkeypatch.setattr("footfall.scenarios.studies.sweep.write_tracks", lambda *given: False)
    one = {"axes": {"pdr.tilt_gain": [0.1, 0.4], "hdr.theta_w_deg_s": [0.1, 0.6]}}
    before = finished(made(place, design=one), place / "out")
    assert len(recorded) == 2  # one a unit, for two tilt gains and all methods
    assert len(list(store.rglob("*.npz"))) == 4
    other = {"axes": {"pdr.tilt_gain": [0.1, 0.4], "hdr.theta_w_deg_s": [0.1, 0.3, 0.6]}}
    after = finished(made(place, design=other), place / "other")
    assert len(recorded) == 2  # of footfalls that are kept
    assert [row for row in after if row["hdr.theta_w_deg_s"] != 0.3] == before
    # A method on samples is not given footfalls; those that are made on its way are kept.
    finished(made(place, methods=["hdr", "iez"], set={"pdr.tilt_gain": 0.25}), place / "samples")
    assert len(recorded) == 4
    assert len(list(store.rglob("*.npz"))) == 6
    finished(made(place, set={"pdr.tilt_gain": 0.25}), place / "again")
    assert len(recorded) == 4


def test_failures_are_rows_with_their_stage_and_reason_and_surprises_leave_a_traceback(place, store):
    study = made(place, methods=["pdr", "nav.py:refuses", "nav.py:stands"], set={"imu": "nimu"})
    study = Study(study.name, study.table, study.folder, "", (Method("boom", "", boom),))
    rows = finished(study, place / "out")
    told = {row["method"]: (row["stage"], row["error"]) for row in rows}
    assert told["pdr"] == told["stands"] == ("", "")
    assert told["refuses"][0] == "track"
    assert "I do not like it" in told["refuses"][1]
    assert told["boom"] == ("track", "ZeroDivisionError: by zero")
    (file,) = (place / "out" / "errors").iterdir()
    assert file.read_text().count("ZeroDivisionError: by zero") == 2
    assert "unit 1001" in file.read_text()
    assert all((row["heading_error_mean_deg"] is None) == bool(row["stage"]) for row in rows)


def test_what_breaks_outside_of_any_trial_is_rows_with_a_traceback(place, store, monkeypatch):
    def broken(trial, folder):
        raise MemoryError("a walk of 9 GB")

    with monkeypatch.context() as patch:
        patch.setattr("footfall.scenarios.studies.task.hold", broken)
        rows = finished(made(place), place / "out")
    told = {(row["stage"], row["error"]) for row in rows}
    assert told == {("worker", "MemoryError: a walk of 9 GB")}
    (file,) = (place / "out" / "errors").iterdir()
    assert "in broken" in file.read_text()
    assert all(row["stage"] == "" for row in finished(made(place), place / "out", retry_failed=True))
    assert not list((place / "out" / "errors").iterdir())


def test_a_walk_that_falls_is_rows_while_the_rest_goes_on(place, store):
    pushed = (place / "short.toml").read_text() + "\n[disturbance]\npush_Ns = 30.0\nevery_s = 1.0\n"
    (place / "pushed.toml").write_text(pushed)
    rows = finished(made(place, scenarios=["pushed.toml", "short.toml"]), place / "out")
    told = {(row["scenario"], row["stage"]) for row in rows}
    assert told == {("pushed", "walk"), ("short", "")}
    assert all("fell" in row["error"] for row in rows if row["scenario"] == "pushed")


def test_tracks_are_those_of_the_best_the_median_and_the_worst(place, store, pages):
    study = made(place, cases={"walks": 1, "units": 4})
    rows = finished(study, place / "out")
    folder = place / "out" / "tracks"
    told = json.loads((folder / "index.json").read_text())
    assert [(one["method"], one["which"]) for one in told] == [
        (method, which) for which in ("median", "worst", "best") for method in ("hdr", "pdr")
    ]
    for one in told:
        errors = sorted(row["heading_error_mean_deg"] for row in rows if row["method"] == one["method"])
        assert one["heading_error_mean_deg"] == errors[{"best": 0, "median": 1, "worst": 3}[one["which"]]]
        track = read_track(folder / one["file"])
        truth, _ = read_table(folder / one["truth"])
        heading = np.interp(track.t, truth["t"], truth["heading"])
        assert np.degrees(np.abs(track.heading - heading)).mean() == pytest.approx(
            one["heading_error_mean_deg"], abs=0.6
        )
        assert track.meta["method"] == one["method"]
    before = {file: file.stat().st_mtime_ns for file in folder.iterdir()}
    (place / "out" / "report.html").write_text("a page")
    finished(study, place / "out")
    assert {file: file.stat().st_mtime_ns for file in folder.iterdir()} == before
    assert pages == [place / "out"]  # nothing to say anew
    finished(made(place, cases={"walks": 1, "units": 3}), place / "out")
    assert pages == [place / "out"] * 2


def test_a_task_may_be_given_its_walk(place):
    (task,) = plan_of(made(place)).tasks
    walk = cached_walk(next(task.trials())[0][0].plan)
    again = do(task, walks=place / "nowhere", walk=walk)
    assert again.rows == do(task).rows
    assert not (place / "nowhere").exists()
    assert again.seconds["all"] >= again.seconds["record"] > 0


def test_a_worker_that_is_killed_costs_nothing_but_time(place, store):
    """Once from outside, as it were; and one that is killed whenever it is tried."""
    cases = {"walks": 1, "units": 12}
    flag = place / "flag"
    once = {"use": "nav.py:kills", "params": {"flag": str(flag)}}
    study = made(place, methods=["pdr", once], cases=cases)
    flag.write_text("")
    finished(study, place / "calm")
    flag.unlink()
    finished(study, place / "storm", 2)
    assert flag.exists()
    results = [(place / name / "results.parquet").read_bytes() for name in ("calm", "storm")]
    assert results[0] == results[1]
    # Where one sheet's recordings always kill it, the other's go on.
    points = [{"imu": "nimu"}, {"imu": "mtig710", "kills.flag": ""}]
    table = study.table | {"design": {"kind": "list", "points": points}, "cases": cases | {"units": 2}}
    rows = finished(Study("always", table, place), place / "always", 2)
    assert {(row["imu"], row["stage"]) for row in rows} == {("nimu", ""), ("mtig710", "worker")}
    (told,) = {row["error"] for row in rows if row["stage"]}
    assert told == "its worker process was ended: killed, or out of memory"


def test_a_study_of_mounts_walks_once(monkeypatch, tmp_path):
    passes, walk = [], synthetic_walk(strides=12)

    def walks(plans, policy, on_progress):
        passes.append([mount_name(plan.mount) for plan in plans])
        on_progress(1.0)
        for plan in plans:
            yield replace(walk, meta=walk.meta | walk_identity(plan, policy).as_dict())

    monkeypatch.setattr("footfall.simulate.cache.walks", walks)
    axes = {"scenario.sensor.mount": ["instep", "heel", "shank"]}
    made = study(design={"kind": "grid", "axes": axes}, cases={"walks": 2, "units": 2})
    plan = plan_of(made)
    assert cost_of(plan, plan.tasks).walks == 6
    alone = plan_of(study(cases={"walks": 2, "units": 2}))
    assert walk_seconds(plan.walks.values()) == walk_seconds(alone.walks.values())
    told = []
    done = list(
        spread(plan.tasks, workers=1, walks=tmp_path, tick=lambda metres, _: told.append(dict(metres)))
    )
    assert passes == [["instep", "heel", "shank"]] * 2
    assert [row.error for one in done for row in one.rows] == [""] * 12
    assert {len(metres) for metres in told if metres} == {3}  # progress of all three at once
