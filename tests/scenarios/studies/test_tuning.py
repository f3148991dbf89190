"""Tuning on some cases and judging on others: what is chosen, what is said, what is written."""

import json
import tomllib

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.scenarios.parameters import parsed
from footfall.scenarios.studies import tuning as studied
from footfall.scenarios.studies.tuning import Tuned, judged, perform_tuning
from footfall.scenarios.studies.tuning_file import read_tuning

METRIC = "heading_error_mean_deg"
STUDY = """
scenario = "short.toml"
method = "hdr"
trials = 32
[train]
walks = 1
seed = 3
units = 4
[test]
walks = 1
seed = 4
units = 6
first_unit = 2000
[parameters]
"hdr.theta_w_deg_s" = { from = 0.1, to = 1.0, scale = "log" }
"hdr.i_c_deg_s" = { from = 0.002, to = 0.02, scale = "log" }
"""
IEZ = """
[parameters]
"iez.sigma_velocity" = { from = 0.001, to = 0.1, scale = "log" }
"iez.gyro_bias_sd_deg_s" = { values = [0.1, 0.5] }
"""


@pytest.fixture
def file(here):
    (here / "tuning.toml").write_text(STUDY)
    return str(here / "tuning.toml")


def test_from_a_file_to_values_that_other_commands_take(file, cli, here):
    code, printed, told = cli("tune tuning.toml --workers 1 --json")
    assert code == 0, told
    found = json.loads(printed)
    assert found == json.loads((here / "out/tuning/tuning.json").read_text())
    assert found["tried"] == 33
    assert found["cases"]["train"] == [[3, 1000 + i, 1000 + i] for i in range(4)]
    assert {walk for walk, _, _ in found["cases"]["test"]} == {4}
    train = found["errors"]["train"]
    assert np.median(train["tuned"]) < np.median(train["default"])
    assert len(found["errors"]["test"]["tuned"]) == 6
    written = tomllib.loads((here / "out/tuning/tuned.toml").read_text())
    assert written == {"set": found["tuned"]}
    assert found["verdict"]["advice"] in (here / "out/tuning/tuned.toml").read_text()
    assert (here / "out/tuning/tuning.png").stat().st_size > 10_000
    assert parsed(["@out/tuning/tuned.toml", "pdr.tilt_gain=0.3"]) == {**found["tuned"], "pdr.tilt_gain": 0.3}
    line = "track rec.parquet -o tuned.parquet --set"
    assert cli(f"{line} @out/tuning/tuned.toml")[0] == 0
    assert (here / "tuned.parquet").read_bytes() != (here / "hdr.parquet").read_bytes()

    code, printed, told = cli("tune tuning.toml --workers 1 --train 1000..1003")
    assert code == 0
    for word in ("train", "test", "default", "tuned", "p90", found["verdict"]["advice"].split(" (")[0]):
        assert word in printed, word
    assert "--set @out/tuning/tuned.toml" in told


def test_a_list_and_a_range_by_optuna_and_on_after_an_end(file, here, monkeypatch):
    pytest.importorskip("optuna")
    text = (
        STUDY[: STUDY.index("[parameters]")].replace('"hdr"', '"iez"').replace("trials = 32", "trials = 10")
    )
    (here / "tuning.toml").write_text(text + IEZ)
    asked = []

    def errors(points, cases):
        """The best velocity is 0.02, whatever the bias."""
        asked.extend(points)
        own = [abs(np.log(point.get("iez.sigma_velocity", 0.05) / 0.02)) + 0.1 for point in points]
        return np.repeat(np.array(own)[:, None], len(cases), axis=1)

    monkeypatch.setattr(studied, "_in_full", lambda *_: errors)
    first = perform_tuning(read_tuning(file), folder=here)
    assert first.tried == 11
    assert abs(np.log(first.chosen["iez.sigma_velocity"] / 0.02)) < abs(np.log(0.05 / 0.02))
    assert first.chosen["iez.gyro_bias_sd_deg_s"] in (0.1, 0.5)
    assert first.better
    before = len(asked)
    again = perform_tuning(read_tuning(file), folder=here)
    assert again.chosen == first.chosen
    assert len(asked) == before + 2  # nothing but the test's
    more = perform_tuning(read_tuning(file, {"trials": 14}), folder=here)
    assert more.tried == 15
    assert len(asked) - before - 2 - 2 <= 10
    other = perform_tuning(read_tuning(file, {"seed": 2}))
    assert other.chosen != first.chosen


def test_a_verdict_says_better_worse_or_that_nobody_knows(file):
    tuning = read_tuning(file)
    rng = np.random.default_rng(3)
    default = np.exp(rng.normal(2.0, 0.5, 40))

    def tuned(factor, scatter=0.1):
        test = np.stack([default, default * np.exp(rng.normal(np.log(factor), scatter, 40))])
        return Tuned(tuning, {}, 2, test, test, judged(test, METRIC))

    assert tuned(0.7).better
    assert "take it" in tuned(0.7).advice
    assert not tuned(1.3).better
    assert tuned(1.3).advice.endswith("worse): keep the default")
    assert not tuned(1.0, 0.4).better
    assert tuned(1.0, 0.4).advice.endswith("undecided): keep the default")
    assert not tuned(1.0, 0.0).better
    assert tuned(1.0, 0.0).advice == "nothing is better than the default: keep it"


def test_a_case_that_only_the_tuned_values_lose_counts_against_them():
    default = np.full(20, 5.0)
    own = np.full(20, 4.0)
    own[:12] = np.inf
    assert judged(np.stack([default, own]), METRIC).verdict != "pass"


@pytest.mark.parametrize(
    ("before", "after", "reason"),
    [
        ("seed = 4", "seed = 3", "share a walk seed (3)"),
        ("first_unit = 2000", "first_unit = 1002", "share a unit (1002)"),
        ("hdr.i_c_deg_s", "hdr.ic", "hdr.ic"),
        ("[test]", "[tests]", "test"),
        ("trials = 32", "trials = 1", "trials"),
        ("short.toml", "none.toml", "none.toml"),
    ],
)
def test_what_cannot_be_tuned_is_told(file, cli, here, before, after, reason):
    (here / "tuning.toml").write_text(STUDY.replace(before, after))
    code, printed, told = cli("tune tuning.toml --workers 1")
    assert (code, printed) == (2, "")
    assert reason in told
    assert told.count("\n") == 1
    assert not (here / "out").exists()


@pytest.mark.parametrize("text", ["1000", "1044..1000", "a..b", "-1..4"])
def test_seeds_of_units_are_a_range(file, cli, text):
    code, _, told = cli(f"tune tuning.toml --train={text}")
    assert code == 2
    assert "expected the seeds of units FROM..TO" in told


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        ("[other]\na = 1", "expected a table"),
        ("[set.hdr]\ntau_s = 1", "expected a table"),
        ("set = 3", "expected a table"),
    ],
)
def test_a_file_of_values_has_a_table_of_them(tmp_path, content, reason):
    (tmp_path / "x.toml").write_text(content)
    with pytest.raises(InputError, match=reason):
        parsed([f"@{tmp_path / 'x.toml'}"])


def test_values_of_a_file_and_by_hand_do_not_collide(tmp_path):
    (tmp_path / "x.toml").write_text('[set]\n"hdr.tau_s" = 5')
    with pytest.raises(InputError, match=r"hdr\.tau_s is given twice"):
        parsed(["hdr.tau_s=4", f"@{tmp_path / 'x.toml'}"])
    with pytest.raises(InputError, match="given twice"):
        parsed([f"@{tmp_path / 'x.toml'}", "hdr.tau_s=4"])
    with pytest.raises(InputError, match="cannot be read"):
        parsed(["@nowhere.toml"])
