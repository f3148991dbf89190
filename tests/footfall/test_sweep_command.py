"""`footfall sweep`: what it says, its exit codes, and what kill -9 and signals leave behind."""

import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from footfall.scenarios.studies import rows as rows_module
from footfall.scenarios.studies.study import stock_studies
from footfall.tables import replacing
from tests.helpers.commands import expect_one_sentence, one_document

NAV = """
import time
import numpy as np
import footfall

def slow(recording, start):
    time.sleep(0.05)
    t = recording.t[[0, -1]]
    return footfall.Track(t, np.tile(start.position, (2, 1)), np.full(2, start.heading))

def refuses(recording, start):
    raise ValueError("I do not like it")
"""
STUDY = """
description = "a small study"
scenarios = ["short.toml"]
methods = ["pdr", "nav.py:slow"]
[cases]
walks = 1
units = 8
[design.axes]
"pdr.tilt_gain" = [0.1, 0.3]
"""


@pytest.fixture
def place(tmp_path, workshop, monkeypatch):
    """The working folder, with a small study in it."""
    (tmp_path / "short.toml").write_text((workshop / "short.toml").read_text())
    (tmp_path / "nav.py").write_text(NAV)
    (tmp_path / "small.toml").write_text(STUDY)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_what_comes_with_footfall_is_listed(cli):
    code, out, _ = cli("sweep list")
    assert code == 0
    assert all(name in out for name in stock_studies())
    told = one_document(cli("sweep list --json")[1])
    assert sorted(told) == list(stock_studies())


def files(place):
    """Everything that lies there; Python may keep a method's bytecode."""
    return sorted(path for path in place.rglob("*") if "__pycache__" not in path.parts)


def test_a_plan_tells_the_cost_and_does_nothing(place, cli):
    before = files(place)
    code, out, _ = cli("sweep small.toml --plan")
    assert code == 0
    assert "small: 1 scenario x 2 tilt gain x 8 units x (pdr + slow): 32 rows" in out
    assert "walks 1, 1 of them in the cache; 8 recordings; 16 reckonings; 32 rows; about" in out
    told = one_document(cli("sweep small.toml --plan --units 3 --json")[1])
    assert told["rows"] == 12
    assert told["left"]["recordings"] == 3
    assert files(place) == before


def test_a_sweep_and_its_second_start(place, cli):
    code, out, err = cli("sweep small.toml --workers 1 --set pdr.bias_s=20 --units 4")
    assert code == 0, err
    assert "Done in" in out
    assert "16 rows, none failed" in out
    again = "footfall sweep small.toml --units 4 --set 'pdr.bias_s=20'"
    assert f"Again: {again}   (nothing is left to do)" in out
    assert one_document((place / "out" / "small" / "study.json").read_text())["command"] == again
    code, out, err = cli("sweep small.toml --workers 1 --set pdr.bias_s=20 --units 4 --json")
    assert code == 0
    assert "nothing is left to do" in err
    told = one_document(out)
    assert (told["rows"], told["failed"], told["name"]) == (16, 0, "small")


def test_a_line_tells_now_and_then_how_far_it_is_where_there_is_no_terminal(place, cli, monkeypatch):
    monkeypatch.setattr("footfall.cli.sweep._EVERY_S", 0.0)
    code, _, err = cli("sweep small.toml --workers 1 --units 12")
    assert code == 0
    assert "small: 0%, navigating, 0 of 12 recordings" in err
    assert re.search(r"small: 8\d%, navigating, 10 of 12 recordings", err)
    assert "finishing" not in err


def test_failed_rows_are_told_and_strict_is_strict(place, cli):
    (place / "small.toml").write_text(STUDY.replace('"nav.py:slow"', '"nav.py:refuses"'))
    code, out, _ = cli("sweep small.toml --workers 1 --units 2")
    assert code == 0
    assert "8 rows, of which 4 failed:" in out
    assert "  4  refuses, nimu, short, walk 1: nav.py:refuses" in out
    assert "I do not like it" in out
    assert cli("sweep small.toml --workers 1 --units 2 --strict")[0] == 1
    (place / "small.toml").write_text(STUDY.replace('["pdr", "nav.py:slow"]', '["nav.py:refuses"]'))
    code, _, err = cli("sweep small.toml --workers 1 --units 2")
    assert code == 2
    assert "small.toml: all 4 rows failed, as: " in err


@pytest.mark.parametrize(
    ("line", "culprit"),
    [
        ("sweep nothing.toml", "study 'nothing.toml': neither a stock study"),
        ("sweep small.toml --set pdr.tilt=3", r"small\.toml: pdr\.tilt: unknown; did you mean"),
        ("sweep small.toml --set pdr.tilt_gain=0.2", "an axis, and set for the whole study, too"),
        ("sweep small.toml --out nav.py --units 1", "nav.py"),
        ("sweep short.toml", "unknown key|missing"),
        ("sweep small.toml --units 0", "units"),
    ],
)
def test_mistakes_are_one_sentence(place, cli, line, culprit):
    code, out, err = cli(line)
    last = err.strip().splitlines()[-1] + "\n"
    expect_one_sentence(code, out, last, culprit)
    assert not (place / "out").exists()


def test_a_full_disk_is_exit_code_4(place, cli, monkeypatch):
    def full(rows, path):
        with replacing(path):
            raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr("footfall.scenarios.studies.parts.write_rows", full)
        code, _, err = cli("sweep small.toml --workers 1 --units 2")
    assert code == 4
    assert "stopped: " in err
    assert "No space left on device" in err
    assert cli("sweep small.toml --workers 1 --units 2")[0] == 0
    assert rows_module.read_rows(place / "out" / "small" / "results.parquet").num_rows == 8


# Processes of their own


def start(place, *options):
    line = [sys.executable, "-m", "footfall", "sweep", "small.toml", "--units", "60", *options]
    return subprocess.Popen(line, cwd=place, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


def parts(place):
    return sorted(place.glob("out/small/parts/*.parquet"))


def wait_for(what, process):
    """Until something holds; not for ever, whatever is broken."""
    for _ in range(6000):
        if what() or process.poll() is not None:
            return
        time.sleep(0.02)
    raise AssertionError("nothing came of it")


def children(process):
    """Processes that one has started; on Linux alone."""
    told = Path(f"/proc/{process.pid}/task/{process.pid}/children")
    return [int(one) for one in told.read_text().split()] if told.is_file() else []


def alive(pid):
    try:
        return "Z" not in Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1][:3]
    except OSError:
        return False


def test_a_log_tells_how_a_sweep_ended(place, cli):
    assert cli("--log my.log sweep small.toml --workers 1")[0] == 0
    last, ended = (place / "my.log").read_text(encoding="utf-8").splitlines()[-2:]
    assert re.search(r"INFO small: 100%, finished, (\d+) of \1 recordings", last), last
    assert " INFO ended after " in ended


def test_kill_9_at_any_moment_changes_no_bit_and_leaves_no_process(place, cli):
    rng = random.Random(5)
    for more in (0, 1, 2):
        done = {file.name for file in parts(place)}
        process = start(place, "--workers", "2")
        wait_for(lambda done=done, more=more: len(parts(place)) >= len(done) + more, process)
        time.sleep(rng.random() * 0.3)
        left = children(process)
        process.kill()
        process.communicate()
        wait_for(lambda left=left: not any(map(alive, left)), start_nothing())
        assert {file.name for file in parts(place)} >= done
    assert cli("sweep small.toml --units 60 --workers 1")[0] == 0
    results = place / "out" / "small" / "results.parquet"
    stormy = results.read_bytes()
    assert not list(place.glob("out/small/**/*.tmp"))
    shutil.rmtree(place / "out")
    assert cli("sweep small.toml --units 60 --workers 1")[0] == 0
    assert results.read_bytes() == stormy


def start_nothing():
    """A process that never ends by itself, as far as `wait_for` is concerned."""

    class Nothing:
        def poll(self):
            return None

    return Nothing()


@pytest.mark.skipif(os.name != "posix", reason="signals")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_lets_the_running_tasks_end(place, number):
    process = start(place, "--workers", "2")
    wait_for(lambda: len(parts(place)) > 0, process)
    process.send_signal(number)
    _, err = process.communicate()
    assert process.returncode == 130, err
    assert "finishing the running tasks" in err
    assert "recordings are done; start it again to go on" in err
    assert 0 < len(parts(place)) < 6
    assert not (place / "out" / "small" / "results.parquet").exists()
