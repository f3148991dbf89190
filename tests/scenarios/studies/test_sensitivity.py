"""Sensitivity studies: their file, both fidelities, and what they print and write."""

import json

import numpy as np
import pyarrow.parquet as pq
import pytest

pytest.importorskip("SALib")

from footfall.errors import InputError
from footfall.scenarios.report.sensitivity import sensitivity_document, write_sensitivity
from footfall.scenarios.studies import sensitivity as studied
from footfall.scenarios.studies.check import Check
from footfall.scenarios.studies.sensitivity import Watch, perform_study
from footfall.scenarios.studies.sensitivity_file import build_study, read_study, stock_studies
from tests.helpers.pages import Page

G = "imu.gyro.g_sensitivity_sigma_deg_s_g"
STUDY = f"""
description = "what costs"
scenario = "short.toml"
methods = ["hdr"]
fidelity = "budget"
[cases]
walks = 1
units = 3
[parameters]
"{G}" = {{ from = 0.06, to = 0.3, scale = "log", label = "g-sensitivity" }}
"hdr.theta_w_deg_s" = {{ from = 0.2, to = 1.0 }}
[morris]
trajectories = 4
[sobol]
samples = 16
at_most = 32
"""


@pytest.fixture
def file(here):
    (here / "costs.toml").write_text(STUDY)
    return here / "costs.toml"


def changed(file, before, after):
    text = file.read_text()
    assert before in text
    file.write_text(text.replace(before, after))
    return str(file)


def test_a_study_from_its_file_to_its_folder(file, cli, here):
    code, printed, told = cli("sensitivity costs.toml --workers 1 --json")
    assert code == 0, told
    found = json.loads(printed)
    assert found == json.loads((here / "out/costs/sensitivity.json").read_text())
    assert (found["name"], found["scenario"], list(found["methods"])) == ("costs", "short", ["hdr"])
    assert found["parameters"][G] == {
        "label": "g-sensitivity", "unit": "deg/s/g", "from": 0.06, "to": 0.3, "scale": "log"
    }  # fmt: skip
    assert found["cases"] == [[3, unit, unit] for unit in (1000, 1001, 1002)]
    own = found["methods"]["hdr"]
    assert set(own["morris"]) == {G, "hdr.theta_w_deg_s"}
    assert [step["samples"] for step in own["sobol"]["steps"]] == [16, 32]
    assert len(own["check"]["full"]) == 10
    assert "hdr: the budget beside the full chain" in told
    points = pq.read_table(here / "out/costs/points.parquet").to_pydict()
    assert points["design"] == ["morris"] * 12 + ["sobol"] * 128
    assert min(points[G]) >= 0.06
    page = Page(here / "out/costs/report.html")
    (chart,) = page.charts("method-0")
    own = own["sobol"]["steps"][-1]["parameters"]
    ranked = sorted(own, key=lambda name: -own[name]["total"]["value"])
    labels = [found["parameters"][name].get("label") or name for name in ranked]
    assert [label for _, label in chart["x"]["ticks"]] == labels
    _, drawn, _ = page.trace("method-0", "total")
    np.testing.assert_allclose(drawn, [own[name]["total"]["value"] for name in ranked], rtol=1e-6)
    for name in ("indices.png", "effects.png"):
        assert (here / "out/costs" / name).read_bytes()[:4] == b"\x89PNG"

    code, printed, told = cli("sensitivity costs.toml --workers 1")
    assert code == 0
    for word in ("g-sensitivity", "Morris", "Sobol", "interplay", "not converged", "N = 32, 128 points"):
        assert word in printed, word


def test_both_fidelities_agree_on_dead_reckoning(file):
    """In the mean and in the order of the points; the sheet's own values are met to the digit."""
    changed(file, "units = 3", "units = 6")
    text = file.read_text().replace('"hdr"', '"pdr"').replace("hdr.theta_w_deg_s", "imu.gyro.flicker_deg_h")
    file.write_text(text.replace("from = 0.2, to = 1.0", "from = 20, to = 200").replace("= 16", "= 32"))
    (budget,) = perform_study(read_study(str(file)), Watch(workers=1)).answers
    assert budget.check.mean_off < 0.1
    changes = {"fidelity": "full", "sobol": None}
    (full,) = perform_study(read_study(str(file), changes), Watch(workers=1)).answers
    assert full.check is None
    assert full.nominal == pytest.approx(budget.nominal, rel=1e-6)
    ratio = np.log(budget.scores["morris"] / full.scores["morris"])
    assert np.abs(ratio).mean() < 0.15
    assert np.corrcoef(np.log([budget.scores["morris"], full.scores["morris"]]))[0, 1] > 0.9


def test_methods_side_by_side(file, cli, here):
    """The same figures as each method by itself has: the recordings are the same."""
    changed(file, "units = 3", "units = 6")
    both = read_study(str(file), {"methods": ["pdr", "hdr"], "sobol": {"samples": 64, "at_most": 64}})
    pdr, hdr = perform_study(both, Watch(workers=1)).answers
    one = perform_study(read_study(str(file), {"sobol": {"samples": 64, "at_most": 64}}), Watch(workers=1))
    assert hdr.sobol == one.answers[0].sobol
    assert pdr.sobol.total[1].value == 0  # of HDR's threshold
    assert pdr.nominal != hdr.nominal
    changes = {"methods": ["pdr", "hdr"], "fidelity": "full", "sobol": None, "morris": {"trajectories": 2}}
    full = perform_study(read_study(str(file), changes), Watch(workers=1))
    assert full.answers[1].nominal == pytest.approx(hdr.nominal, rel=1e-6)
    assert full.answers[0].morris[1].mu_star == 0
    assert len(list(full.rows())) == 12
    write_sensitivity(full, sensitivity_document(full, "x"), here)
    assert (here / "indices.png").is_file()
    assert not (here / "effects.png").exists()  # six points show nothing
    changed(file, '["hdr"]', '["pdr", "hdr"]')
    code, printed, told = cli("sensitivity costs.toml --workers 1")
    assert code == 0, told
    assert "Total indices" in printed


def test_in_python(file):
    from footfall.studies import sensitivity

    found = sensitivity(file, Watch(workers=1), sobol={"samples": 16, "at_most": 16}, morris=None)
    total = found.total("hdr")
    assert list(total) == [G, "hdr.theta_w_deg_s"]
    assert total[G] == found.answers[0].sobol.total[0]
    with pytest.raises(InputError, match="did you mean hdr"):
        found.of("hd")


def test_the_unit_as_a_factor(file):
    study = read_study(str(file), {"units_as_factor": True, "morris": None})
    assert study.factors[-1].values == (1000, 1001, 1002)
    found = perform_study(study, Watch(workers=1))
    assert found.answers[0].check.shares.shape == (10, 2)  # over all units
    rows = list(found.rows())
    assert {row["unit"] for row in rows} == {1000, 1001, 1002}
    assert len(found.answers[0].sobol.total) == 3


def test_a_budget_that_is_too_far_off_is_refused_after_it_was_shown(file, monkeypatch):
    wrong = lambda study, heard: lambda shares: np.full((len(shares), 1), 1e3)  # noqa: E731
    monkeypatch.setattr(studied, "_budget", wrong)
    seen = []
    with pytest.raises(
        InputError, match=r'of hdr by \d+ % in the mean over 8 points, more than 15 %: use fidelity = "full"'
    ):
        perform_study(read_study(str(file)), Watch(workers=1, on_check=seen.append))
    assert seen[0].mean_off > 0.15


def test_the_check_is_of_sizes():
    inside = np.full((2, 1), 0.5)
    check = Check("hdr", inside, np.array([2.0, 4.0]), np.array([2.4, 3.2]))
    np.testing.assert_allclose(check.off, [0.2, -0.2])
    assert check.mean_off == pytest.approx(0.2)
    with pytest.raises(InputError, match="20 %"):
        check.require()
    Check("hdr", inside, np.array([2.0, 4.0]), np.array([2.2, 3.6])).require()


@pytest.mark.parametrize(("at", "name"), [(0.0, "all low"), (1.0, "all high")])
def test_one_end_that_is_too_far_off_is_enough(at, name):
    """However near all others are; where two ranges meet at their ends, and not where one does."""
    shares = np.array([[0.5, 0.5], [0.3, 0.2], [at, at]])
    full = np.array([10.0, 10.0, 4.17])
    check = Check("hdr", shares, full, np.array([10.0, 10.0, 6.04]))
    assert check.mean_off == 0
    with pytest.raises(
        InputError, match=rf"of hdr by \+45 % \(6\.04 for 4\.17\) with {name} of the ranges, more than 15 %"
    ):
        check.require()
    Check("hdr", shares, full, np.array([10.0, 10.0, 4.17 * 0.86])).require()
    with pytest.raises(InputError, match="-16 %"):
        Check("hdr", shares, full, np.array([10.0, 10.0, 4.17 * 0.84])).require()
    Check("hdr", np.array([[0.5, 0.5], [at, 0.2]]), full[:2], np.array([10.0, 12.0])).require()


@pytest.mark.parametrize(
    ("before", "after", "reason"),
    [
        ("samples = 16", "samples = 20", "power of 2"),
        ('"hdr"', '"hrd"', "hrd"),
        ('methods = ["hdr"]', 'methods = ["hdr"]\nmetric = "error"', "metric"),
        ("hdr.theta_w_deg_s", "hdr.theta", "hdr.theta: unknown; did you mean theta_w_deg_s"),
        ("from = 0.2", "from = -0.2", "theta_w_deg_s = -0.2"),
        ("hdr.theta_w_deg_s", "imu.gyro.bandwidth_hz", "not proportional"),
        ("from = 0.2, to = 1.0", "values = [0.2, 0.3]", "no lists"),
        ("[morris]", "[moris]", "moris"),
        ("short.toml", "shrt.toml", "shrt"),
        ('fidelity = "budget"', 'fidelity = "fast"', "fidelity"),
        ('["hdr"]', '["iez"]', "'hdr' is not among iez"),
    ],
)
def test_what_is_wrong_in_a_file_is_told_in_one_sentence(file, cli, here, before, after, reason):
    changed(file, before, after)
    code, printed, told = cli("sensitivity costs.toml --workers 1")
    assert code == 2
    assert printed == ""
    assert reason in told
    assert told.count("\n") == 1
    assert not (here / "out").exists()


def test_a_study_asks_something_of_several_parameters(file):
    text = file.read_text()
    with pytest.raises(InputError, match=r"neither \[morris\] nor \[sobol\]"):
        build_study("x", {"description": "x", "scenario": "short.toml", "parameters": {}}, "x")
    file.write_text(text[: text.index('"hdr.theta')] + text[text.index("[morris]") :])
    with pytest.raises(InputError, match="at least 2"):
        read_study(str(file))


def test_the_stock_studies_are_listed(cli):
    code, printed, _ = cli("sensitivity list --json")
    assert code == 0
    assert set(json.loads(printed)) == set(stock_studies())


def test_no_such_study(cli):
    code, _, told = cli("sensitivity nothing")
    assert code == 2
    assert "study 'nothing': neither a stock study nor a TOML file" in told
