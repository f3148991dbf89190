"""Gates as tests: the plug-in that comes with Footfall, in test suites of others."""

import subprocess
import sys

import pytest

from footfall.scenarios.studies.gate import gate
from tests.helpers.feet import round_a_block, walk_instead
from tests.helpers.places import ROOT

HEAD = '[cases]\nscenario = "straight"\nunits = 6\n'
HALF = '[[gates]]\nname = "half"\nmethod = "hdr"\nat_most = 15\n'
TIGHT = '[[gates]]\nname = "tight"\nmethod = "hdr"\nat_most = 0.0001\n'
OPEN = '[[gates]]\nname = "open"\nmethod = "hdr"\nagainst = "pdr"\nmargin_percent = {margin}\n'
TESTS = """
import pytest

@pytest.mark.footfall_gate("gates.toml")
def test_accuracy():
    print("the body is run")
"""


class Watching:
    """What a run of pytest reports: test -> outcome and text, and its warnings."""

    def __init__(self):
        self.outcomes, self.texts, self.warnings = {}, {}, []

    def pytest_runtest_logreport(self, report):
        name = report.nodeid.rpartition("::")[2]
        if report.when == "call" or report.failed:
            self.outcomes[name] = report.outcome if report.when == "call" else "error"
            self.texts[name] = report.longreprtext + report.capstdout

    def pytest_warning_recorded(self, warning_message):
        # Several runs in one process find the plug-in imported, which pytest may tell.
        if warning_message.category is not pytest.PytestAssertRewriteWarning:
            self.warnings.append(str(warning_message.message))


@pytest.fixture(scope="module")
def block():
    return round_a_block(3)


@pytest.fixture
def suite(tmp_path, monkeypatch, block):
    """Run a test suite of these files; its walks are those of a synthetic foot."""
    walk_instead(monkeypatch, block)

    def run(tests=TESTS, gates=HEAD + HALF + TIGHT, *options):
        # Of a name that no other such suite had in this process.
        (tmp_path / f"test_{tmp_path.name}.py").write_text(tests, encoding="utf-8")
        (tmp_path / "gates.toml").write_text(gates, encoding="utf-8")
        (tmp_path / "pytest.ini").write_text("[pytest]\n", encoding="utf-8")
        watching = Watching()
        always = ("-p", "_footfall_pytest", "-p", "no:cacheprovider", "--strict-markers")
        where = (str(tmp_path), f"--rootdir={tmp_path}", "-c", str(tmp_path / "pytest.ini"))
        watching.code = pytest.main(
            [*always, *where, "--import-mode=importlib", *options], plugins=[watching]
        )
        return watching

    return run


@pytest.fixture
def on_the_limit(tmp_path, monkeypatch, block):
    """A gate whose limit is its estimate."""
    walk_instead(monkeypatch, block)
    file = tmp_path / "limit.toml"
    file.write_text(HEAD + OPEN.format(margin=10), encoding="utf-8")
    return HEAD + OPEN.format(margin=gate(file)[0].estimate)


def test_one_test_a_gate_and_its_body_where_that_passes(suite):
    found = suite()
    assert found.outcomes == {"test_accuracy[half]": "passed", "test_accuracy[tight]": "failed"}
    assert "the body is run" in found.texts["test_accuracy[half]"]
    told = found.texts["test_accuracy[tight]"]
    assert told.startswith("fail: tight: ")
    assert told.endswith("limit <= 0.0001 deg")
    assert "the body is run" not in told


def test_a_body_can_fail(suite):
    found = suite(TESTS.replace('print("the body is run")', "assert False"))
    assert found.outcomes["test_accuracy[half]"] == "failed"


def test_undecided_fails(suite, on_the_limit):
    found = suite(TESTS, on_the_limit)
    assert found.outcomes == {"test_accuracy[open]": "failed"}
    assert found.texts["test_accuracy[open]"].startswith("undecided: open: ")
    assert found.warnings == []


def test_undecided_may_warn(suite, on_the_limit):
    found = suite(TESTS, on_the_limit + TIGHT, "-o", "footfall_undecided=warn")
    assert found.outcomes == {"test_accuracy[open]": "passed", "test_accuracy[tight]": "failed"}
    (warning,) = found.warnings
    assert warning.startswith("undecided: open: ")


def test_the_option_is_checked(suite, capsys):
    found = suite(TESTS, HEAD + HALF, "-o", "footfall_undecided=ignore")
    assert found.code == pytest.ExitCode.USAGE_ERROR
    assert "footfall_undecided = ignore: expected fail or warn" in capsys.readouterr().err


CASES = """
import numpy as np, pytest
from footfall.hdr.methods import track

def mine(recording, start):
    return track(recording, "pdr", start)

@pytest.mark.footfall_gate("gates.toml", units=5, methods={"mine": mine})
def test_cases(footfall_cases):
    assert len(footfall_cases) == 5
    assert {row.method for row in footfall_cases} == {"mine"}
    assert np.isfinite(footfall_cases.values("heading_error_mean_deg")).all()

def test_without(footfall_cases):
    pass
"""


def test_cases_can_be_asked_and_methods_given(suite):
    found = suite(CASES, HEAD + HALF.replace("hdr", "mine"))
    assert found.outcomes == {"test_cases[half]": "passed", "test_without": "error"}
    assert "footfall_cases: the test has no mark footfall_gate" in found.texts["test_without"]


def test_a_file_is_judged_once(suite, monkeypatch):
    """Five gates, one round of cases."""
    rounds = []
    monkeypatch.setattr(
        "footfall.scenarios.studies.gate.gate", lambda made: rounds.append(made) or gate(made)
    )
    gates = "".join(HALF.replace("half", f"half {number}") for number in range(5))
    found = suite(TESTS, HEAD + gates)
    assert list(found.outcomes.values()) == ["passed"] * 5
    assert len(rounds) == 1


def test_a_mistake_in_the_file_is_told_when_tests_are_collected(suite, capsys):
    found = suite(TESTS, HEAD + HALF.replace("at_most", "at_mots"))
    assert found.code != 0
    assert found.outcomes == {}
    out, err = capsys.readouterr()
    assert "at_mots" in out + err


def test_a_project_without_gates_does_not_load_footfall(tmp_path):
    code = """
import sys, pytest
assert pytest.main(["--collect-only", "-q", "-p", "_footfall_pytest", "-p", "no:cacheprovider"]) == 5
print("loaded:", sorted(name for name in sys.modules if "footfall" in name))
"""
    found = subprocess.run(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        env={"PYTHONPATH": str(ROOT), "PATH": ""},
        capture_output=True,
        text=True,
    )
    assert found.returncode == 0, found.stderr
    assert found.stdout.splitlines()[-1] == "loaded: ['_footfall_pytest']"
