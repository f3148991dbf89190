"""The benchmarks of sensitivity: known indices, sheets, what studies cost."""

import json

import pytest

pytest.importorskip("SALib")

from benchmarks.speed import sensitivity as speed
from benchmarks.validation import sensitivity as validation
from footfall.scenarios.parameters import documents, with_values


def test_what_studies_cost(tmp_path):
    speed.main(["--json", str(tmp_path / "cost.json")])
    found = json.loads((tmp_path / "cost.json").read_text())
    assert 0 < found["map_s"] < found["sobol_s"]


def test_known_indices_are_counted():
    found = validation.inside(validation.g, validation.g_known(), seeds=2)
    assert json.loads(json.dumps(found)) == found
    assert found["indices"] == found["inside"] == 16
    assert 0 < found["furthest"] < 1
    wrong = tuple(known + 0.5 for known in validation.g_known())
    assert validation.inside(validation.g, wrong, seeds=1)["inside"] == 0


def test_the_sheets_are_ones_that_can_be_set():
    base = documents("closed-loop", imu="nimu", methods=["pdr"])
    for values in validation.SHEETS.values():
        with_values(base, values).setup()
