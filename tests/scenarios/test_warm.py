"""Kernels are compiled once, before workers start, with the types that walks and trials have."""

import subprocess
import sys
from concurrent.futures import Future
from contextlib import contextmanager

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.scenarios import execute, warm
from footfall.scenarios.execute import execute as perform_all
from footfall.scenarios.scenario import load_scenario
from footfall.scenarios.trial import Trial, setup
from footfall.simulate.cache import plan_key
from tests.helpers.commands import one_document

# What each kernel is compiled for after `warm`, and after a real walk and trial.
FRESH = """
import json, sys
from dataclasses import replace
from pathlib import Path
from footfall.scenarios.scenario import load_scenario
from footfall.scenarios.trial import Trial, perform, setup, walk_of
from footfall.scenarios.warm import warm

def compiled():
    return {f"{name}.{key}": len(kernel.signatures)
            for name, module in list(sys.modules.items()) if name.startswith("footfall.")
            for key, kernel in vars(module).items() if hasattr(kernel, "py_func")}

scenario, methods = load_scenario(sys.argv[1]), ("pdr", "hdr", "iez", "ihde")
trial = Trial(setup(scenario, methods=methods), 0, 3, 7, 7)
warm(trial, walks=True)
before = compiled()
outcome = perform(trial, walk_of(trial, Path(sys.argv[2])), keep=True)
print(json.dumps([before, compiled(), [row.error for row in outcome.rows]]))
"""
SLOPE = """
description = "a short slope"
subjects = ["taller"]
[path]
elements = [
  { kind = "straight", length_m = 6.0 },
  { kind = "straight", length_m = 6.0, grade_percent = 3.0 },
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
base = 3
"""


def test_nothing_is_left_to_compile(tmp_path):
    (tmp_path / "slope.toml").write_text(SLOPE)
    done = subprocess.run(
        [sys.executable, "-c", FRESH, str(tmp_path / "slope.toml"), str(tmp_path)],
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    before, after, errors = one_document(done.stdout)
    assert errors == ["", "", "", ""]
    assert {name: count for name, count in after.items() if before.get(name, 0) != count} == {}
    assert sum(count > 0 for count in after.values()) > 20


def test_the_synthetic_foot_walks_straight_on_and_round_a_corner():
    walk = warm.synthetic(26.0, 200.0)
    still = walk.t < 26
    assert np.ptp(walk.position[still], axis=0).max() < 0.05
    assert np.hypot(*(walk.position[-1] - walk.position[0])[:2]) > 8
    assert np.degrees(walk.footfalls.heading[[0, -1]]) == pytest.approx([0, 90], abs=5)
    assert walk.footfalls.t[0] == pytest.approx(26, abs=0.01)
    assert (np.diff(walk.footfalls.t) > 0.5).all()


@pytest.fixture
def trials(workshop):
    made = setup(load_scenario(workshop / "short.toml"))
    return [Trial(made, number, 3 + number, 7, 7) for number in range(2)]


@pytest.mark.parametrize("known", ["none", "one", "all"])
def test_it_is_done_once_before_any_work_is_given_away(trials, known, tmp_path, monkeypatch):
    """And walks where there is to be walked."""
    done = []

    @contextmanager
    def pool(workers, shared):
        done.append("workers start")
        yield Here(done), [0.0] * shared

    monkeypatch.setattr(execute, "warm", lambda trial, walks: done.append((trial.number, walks)))
    monkeypatch.setattr(execute, "worker_pool", pool)
    monkeypatch.setattr("footfall.simulate.cache.cache_folder", lambda: tmp_path)
    for trial in trials[: ["none", "one", "all"].index(known)]:
        (tmp_path / f"{plan_key(trial.plan, execute.stock_policy())}.parquet").touch()
    told = []
    assert list(perform_all(trials, workers=2, on_progress=lambda now: told.append(now.compiling)))
    assert done[:3] == ["workers start", (0, known != "all"), "given away"]
    assert sum(isinstance(one, tuple) for one in done) == 1
    assert told[0]
    assert not any(told[1:])


class Here:
    """A pool whose jobs come to nothing."""

    def __init__(self, done):
        self.done = done

    def submit(self, job, at, trials, *given):
        self.done.append("given away")
        future = Future()
        future.set_result([InputError("nobody walked")] * len(trials) if job is execute._walk_job else [])
        return future


def test_one_process_compiles_what_it_comes_to(trials, monkeypatch):
    monkeypatch.setattr(execute, "warm", None)
    monkeypatch.setattr(execute, "_here", lambda *_: iter(()))
    assert list(perform_all(trials, workers=1)) == []


def test_methods_of_others_are_left_alone(trials, monkeypatch):
    """They are not asked to navigate a foot that nobody has."""
    tried = []
    monkeypatch.setattr(warm, "perform", lambda trial, walk, keep: tried.append(trial))
    foreign = setup(trials[0].setup.scenario, methods=["pdr", lambda recording, start: None])
    warm.warm(Trial(foreign, 0, 1, 1, 1), walks=False)
    assert [method.name for method in tried[0].setup.methods] == ["pdr"]
