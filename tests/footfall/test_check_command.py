"""`footfall check`: what it prints, and how it ends."""

import shlex
import sys

import numpy as np
import pytest

from footfall.cli.terminal import words_of
from footfall.hdr import check as module
from footfall.hdr.check import synthetic_case
from footfall.hdr.methods import METHODS
from footfall.scenarios.beginnings import beginnings
from footfall.scenarios.scenario import stock_scenarios
from tests.helpers.commands import one_document

NAV = """
from footfall.pdr.reckoning import dead_reckon
from footfall.hdr.tracks import pdr_track

def good(recording, start):
    return pdr_track(dead_reckon(recording, start=start))

def lost(recording, start):
    return good(recording, type(start)())

def broken(recording, start):
    return {}["[red]gain[/red]"]

def turned(footfalls, start):
    return pdr_track(footfalls)
"""

PICKY = """
def picky(recording, start):
    if "subject" in str(recording.meta):
        raise ValueError("a simulated person")
    return good(recording, start)
"""

PROGRAM = """
import json, sys
import numpy as np
rows = np.fromfile(sys.argv[1], "<f8").reshape(-1, 7)
if len(rows) < 100:
    sys.exit("too short")
start = json.load(open(sys.argv[3]))
t, psi = rows[:, 0], start["heading_rad"]
way = 1.4 * np.maximum(t - 26, 0)
x, y, z = start["position_m"]
with open(sys.argv[2], "w") as file:
    file.write("t,x,y,z,heading\\n")
    for i in range(0, len(t), 200):
        print(t[i], x + way[i] * np.cos(psi), y + way[i] * np.sin(psi), z, psi, sep=",", file=file)
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    (tmp_path / "nav.py").write_text(NAV)
    (tmp_path / "program.py").write_text(PROGRAM)
    monkeypatch.chdir(tmp_path)
    made = {seed: synthetic_case(seed) for seed in (1, 2)}
    monkeypatch.setattr(module, "synthetic_case", lambda seed: made[seed])
    return tmp_path


@pytest.fixture
def in_this_process(monkeypatch):
    """No new process, whose start takes seconds; tests/hdr/test_check.py has it."""
    monkeypatch.setattr(module, "_pickles", lambda method, one, other: None)


def test_a_good_method_passes_twelve_checks(cli, folder):
    code, out, err = cli("check nav.py:good")
    assert (code, err) == (0, "")
    assert "good: 12 of 12 checks passed" in out
    assert out.count(" passed") == 13


def test_a_failed_check_is_told_with_its_reason_and_ends_with_1(cli, folder, in_this_process):
    code, out, err = cli("check nav.py:lost --json")
    document = one_document(out)
    assert (code, err) == (1, "")
    assert (document["method"], document["passed"]) == ("lost", False)
    failed = {one["name"]: one["reason"] for one in document["checks"] if not one["passed"]}
    assert set(failed) == {"starts where it is told", "turns with its start"}
    assert failed["starts where it is told"].endswith("m from where it is told that it rests")
    assert len(document["checks"]) == 12


def test_what_a_method_says_is_printed_as_it_is(cli, folder, in_this_process):
    code, out, _ = cli("check nav.py:broken")
    assert code == 1
    assert "0 of 12 checks passed" in out
    assert "[red]gain" in out.replace("\n", "")
    assert out.count("not tried") == 11


def test_footfalls_are_given_to_what_needs_them(cli, folder, in_this_process):
    assert cli("check nav.py:turned --needs footfalls")[0] == 0
    assert cli("check nav.py:turned")[0] == 1


def test_a_program_is_checked(cli, folder):
    line = f"check --command '{sys.executable} program.py {{recording}} {{track}} {{start}}'"
    code, out, _ = cli(line)
    assert code == 0, out
    code, out, _ = cli(line.replace("{start}", "{params}") + " --json")
    assert code == 1
    assert "KeyError: 'heading_rad'" in one_document(out)["checks"][0]["reason"]


@pytest.mark.parametrize(
    "line", ["./nav --in {recording} --out {track}", "nav 'a b' \"c d\" e\\ f '' # g,h;i>j", "nav '#'"]
)
def test_a_program_is_given_in_the_words_of_a_shell(line):
    assert words_of(line, "\\") == shlex.split(line)


def test_where_paths_have_backslashes_they_stay():
    words = words_of(r'C:\nav\nav.exe "C:\my files\nav.py" {recording} --out={track}', "")
    assert words == [r"C:\nav\nav.exe", r"C:\my files\nav.py", "{recording}", "--out={track}"]


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        ("check", "check: expected either a method or --command"),
        ("check pdr --command 'true {recording} {track}'", "check: expected either a method or --command"),
        ("check hdx", "method 'hdx' is unknown; did you mean hdr?"),
        ("check nav.py", "nav.py: say which of its names: nav.py:NAME"),
        ("check --command 'true'", "true: {recording} is missing in 'true'"),
        ('check --command "true \'"', "--command: No closing quotation"),
        (
            "check --command 'true {recording} {track}' --format mat",
            "true: format 'mat', expected f64, csv, parq",
        ),
        ("check nav.py:good --needs all", "nav.py:good: needs = 'all', expected"),
    ],
)
def test_a_mistake_is_told_in_one_sentence(cli, folder, line, sentence):
    code, out, err = cli(line)
    assert (code, out) == (2, "")
    assert err.startswith(f"footfall: {sentence}")


def test_a_full_check_runs_on_the_beginnings_of_walks(cli, here, monkeypatch, in_this_process):
    (case,) = beginnings(["short.toml"], minutes=0.5)
    assert (case.name, case.recording.t[-1]) == ("short", 30.0)
    track = METHODS["pdr"].track(module.Reckoning(case.recording, case.start))
    np.testing.assert_allclose(track.position[0], case.start.position, atol=0.005)
    asked = []

    def of_short_walks(names, on_walk):
        asked.extend(names)
        return beginnings(["short.toml"], on_walk=on_walk)

    monkeypatch.setattr("footfall.scenarios.beginnings.beginnings", of_short_walks)
    (here / "nav.py").write_text(NAV + PICKY)
    assert cli("check nav.py:picky")[0] == 0
    code, out, _ = cli("check nav.py:picky --full --json")
    assert code == 1
    assert "short: nav.py:picky: ValueError: a simulated person" in one_document(out)["checks"][0]["reason"]
    assert tuple(asked) == stock_scenarios()
