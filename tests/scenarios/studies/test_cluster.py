"""Studies on a real Dask cluster on loopback: workers that die, are other ones or none; no scheduler."""

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.scenarios.evaluate import cases
from footfall.scenarios.execute import execute
from footfall.scenarios.parameters import documents
from footfall.scenarios.studies import cluster as clusters
from footfall.scenarios.studies import sweep as sweeping
from footfall.scenarios.studies.cluster import Cluster
from footfall.scenarios.studies.listening import listened
from footfall.scenarios.studies.spreading import listen_to, perform_trials
from footfall.scenarios.studies.study import Study
from footfall.scenarios.studies.sweep import sweep
from footfall.scenarios.studies.task import StoppedError
from footfall.simulate.cache import cache_folder
from tests.helpers.cluster import Processes

pytest.importorskip("distributed")

NAV = """
import os
import numpy as np
import footfall

def stands(recording, start):
    t = recording.t[[0, -1]]
    return footfall.Track(t, np.tile(start.position, (2, 1)), np.full(2, start.heading))

def kills(recording, start, params={"when": ""}):
    if params["when"] == "poison":
        os.kill(os.getpid(), 9)
    return stands(recording, start)
"""
SMALL = """
description = "small"
scenarios = ["short.toml"]
methods = ["pdr", "hdr"]
[cases]
walks = 1
units = 3
"""
AXES = {"imu": ["nimu", "mtig710", "perfect"], "pdr.tilt_gain": [0.1, 0.3]}


@pytest.fixture(scope="module")
def processes(tmp_path_factory):
    made = Processes(tmp_path_factory.mktemp("cluster"))
    yield made
    made.end()


@pytest.fixture
def place(tmp_path, workshop, monkeypatch):
    """The working folder with the short scenario and methods; tracks and pages are others' matter."""
    (tmp_path / "nav.py").write_text(NAV)
    (tmp_path / "short.toml").write_text((workshop / "short.toml").read_text())
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sweeping, "write_tracks", lambda *given: False)
    monkeypatch.setattr("footfall.scenarios.report.page.write_page", lambda folder: None)
    monkeypatch.setattr(sweeping, "footfalls_folder", lambda: tmp_path / "footfalls")
    return tmp_path


def made(place, **table):
    base = {"description": "d", "scenarios": ["short.toml"], "methods": ["pdr", "hdr", "nav.py:stands"]}
    more = {"cases": {"walks": 1, "units": 20}, "design": {"axes": AXES}}
    return Study("study", base | more | table)


def content(folder):
    return (folder / "results.parquet").read_bytes()


def test_a_worker_that_is_killed_changes_no_byte(place, processes):
    study = made(place)
    *_, calm = sweep(study, place / "calm", 1)
    walks = sorted(cache_folder().glob("*.parquet"))
    hurt = []
    with Cluster(processes.workers(3)) as cluster:
        for now in sweep(study, place / "storm", cluster):
            if now.done >= 20 and not hurt:
                hurt.append(processes.kill_worker())
    assert hurt
    assert (now.stage, now.done, now.failed, now.rows) == ("finished", 60, 0, calm.rows)
    assert content(place / "storm") == content(place / "calm")
    assert sorted(cache_folder().glob("*.parquet")) == walks


def test_a_task_that_kills_its_worker_is_rows_and_costs_no_other_task_its_rows(place, processes):
    methods = ["pdr", {"name": "mine", "use": "nav.py:kills", "params": {"when": "never"}}]
    points = [{"imu": "nimu", "mine.when": "poison"}, {"imu": "mtig710"}, {"imu": "perfect"}]
    design = {"kind": "list", "points": points}
    study = made(place, methods=methods, design=design, cases={"walks": 1, "units": 10})
    with Cluster(processes.workers(3)) as cluster:
        *_, now = sweep(study, place / "out", cluster)
    assert now.stage == "finished"
    rows = study.results(place / "out").table.to_pylist()
    lost = [row for row in rows if row["error"]]
    assert {row["imu"] for row in lost} == {"nimu"}
    assert {(row["stage"], row["error"]) for row in lost} == {
        ("worker", "its worker process was ended: killed, or out of memory")
    }
    assert len(lost) == 20 == len(rows) // 3


def test_without_a_worker_it_says_so_and_stops_resumable(place, processes, monkeypatch):
    processes.workers(0)
    monkeypatch.setattr(clusters, "_ALONE_S", 0.3)
    said = []
    with (
        Cluster(processes.scheduler(), patience_s=1.5, say=said.append) as cluster,
        pytest.raises(StoppedError, match=r"no result for 1.5 s, and no worker is there; in the making: \d"),
    ):
        list(sweep(made(place), place / "out", cluster))
    assert any(text.startswith("no worker is there; waiting for one (") for text in said)
    assert not list((place / "out" / "parts").iterdir())


def test_a_worker_of_another_version_is_refused_whenever_it_comes(place, processes):
    processes.workers(0)
    differs = r"tcp://.*: worker of other versions than this process: footfall 0\.0\.9 there, \d\S+ here"
    with Cluster(processes.scheduler()) as cluster:
        processes.other_worker()
        with pytest.raises(InputError, match=differs):
            list(sweep(made(place), place / "out", cluster))
    with pytest.raises(InputError, match=differs), Cluster(processes.scheduler()):
        pass
    processes.kill_workers()


def test_when_the_scheduler_goes_it_stops_and_goes_on_anywhere(place, processes):
    study, seen = made(place), []

    def note(now):
        seen.append(now.done)
        if now.done == 10:
            processes.kill_scheduler()

    gone = pytest.raises(StoppedError, match=r"the scheduler tcp://.* is gone")
    with Cluster(processes.workers(1)) as cluster, gone:
        list(sweep(study, place / "out", cluster, on_progress=note))
    assert 0 < seen[-1] < 60
    *_, now = sweep(study, place / "out", 1)
    assert (now.stage, now.done) == ("finished", 60)
    *_, calm = sweep(study, place / "calm", 1)
    assert now.rows < calm.rows  # what was done there was not done again
    assert content(place / "out") == content(place / "calm")


def test_no_scheduler_is_a_mistake(monkeypatch):
    monkeypatch.setattr(clusters, "_CONNECT_S", 0.3)
    with (
        pytest.raises(InputError, match=r"tcp://127\.0\.0\.1:9: no scheduler answers"),
        Cluster("tcp://127.0.0.1:9"),
    ):
        pass


def test_trials_and_the_budgets_cases_are_the_same_there(place, processes):
    setup = documents("short.toml", methods=["pdr", "hdr"]).setup()
    trials = cases(setup, walks=1, units=12)
    here = [outcome.rows for outcome in execute(trials, workers=1)]
    seen = []
    with Cluster(processes.workers(2)) as cluster:
        there = perform_trials(trials, workers=cluster, on_progress=lambda now: seen.append(now.done))
        assert [outcome.rows for outcome in there] == here
        mine, theirs = listened(trials, workers=1), listen_to(trials, workers=cluster)
    assert seen[-1] == 12
    for one, other in zip(mine, theirs, strict=True):
        np.testing.assert_array_equal(one.rate, other.rate)


def test_the_command_ends_with_4_where_it_can_go_on_and_with_2_where_it_cannot(place, processes, cli):
    (place / "small.toml").write_text(SMALL)
    address = processes.workers(0)
    processes.scheduler()
    code, _, err = cli(f"sweep small.toml --scheduler {address} --patience 1")
    assert code == 4
    assert "footfall: stopped: no result for 1 s, and no worker is there" in err
    assert "start it again to go on" in err
    code, _, err = cli(f"sweep small.toml --scheduler {address} --workers 2")
    assert code == 2
    assert "leave --workers or --scheduler out" in err
    code, _, err = cli(f"sweep small.toml --scheduler {processes.workers(1)}")
    assert code == 0, err
    assert "6 rows, none failed" in err or "6 rows, none failed" in _
