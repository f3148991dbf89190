"""The benchmarks of gates run, and what they print is what they say."""

import json

import numpy as np
import pytest

from benchmarks.speed import gates as speed
from benchmarks.validation import gate_statistics, own_gates
from tests.helpers.feet import round_a_block, walk_instead


@pytest.fixture(autouse=True)
def feet(monkeypatch):
    walk_instead(monkeypatch, round_a_block(3))


def test_what_gates_promise_is_measured(tmp_path, capsys):
    out = tmp_path / "out.json"
    gate_statistics.main(["--draws", "300", "--units", "6", "--runs", "1", "--json", str(out)])
    found = json.loads(out.read_text())
    assert len(found["coverage"]) == 24
    assert all(share > 0.9 for one in found["coverage"].values() for share in one.values())
    assert found["unchanged"] == {"pass": 2, "undecided": 0, "fail": 0}
    assert set(found["power"]["+20%, 60"]) == {"fail", "undecided", "pass"}
    assert "Coverage" in capsys.readouterr().out


def test_power_is_of_the_change_and_the_margin():
    quiet = gate_statistics.power(np.array([-0.01, 0.0, 0.01]), 200, 1)
    assert quiet["+0%, 20"]["pass"] == 1
    assert quiet["+20%, 20"]["fail"] == 1
    assert quiet["+0%, 5"]["pass"] == 1


def test_own_gates_and_defects_are_judged(tmp_path, monkeypatch):
    monkeypatch.setattr(own_gates, "DEFECTS", own_gates.DEFECTS[:1])
    out = tmp_path / "out.json"
    own_gates.main(["--quick", "--only", "turning", "--processes", "1", "--json", str(out)])
    found = json.loads(out.read_text())
    assert list(found["own"]) == ["turning"]
    rest = [
        one for one in found["defects"]["a stride time 2 % too long"] if one["name"].startswith("HDR at rest")
    ]
    assert [one["verdict"] for one in rest] == ["fail"]


def test_a_gate_is_timed_with_and_without_footfalls_that_are_kept(tmp_path):
    out = tmp_path / "out.json"
    speed.main(["--units", "6", "--processes", "1", "--json", str(out)])
    seconds = json.loads(out.read_text())["seconds"]
    assert set(seconds) == {"recordings anew", "footfalls kept"}
