"""The benchmarks of sensitivity: known indices, crossings of curves, sheets that are scaled."""

import json

import numpy as np
import pytest

pytest.importorskip("SALib")

from benchmarks.speed import sensitivity as speed
from benchmarks.validation import sensitivity as validation
from benchmarks.validation import without_hdr
from footfall.scenarios.parameters import documents, with_values
from footfall.scenarios.studies.budget import CAUSE_OF


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


def test_where_curves_cross():
    factors = without_hdr.FACTORS
    assert without_hdr.crossing(np.log(factors / 0.2)) == pytest.approx(0.2)
    assert without_hdr.crossing(np.ones(len(factors))) is None
    assert without_hdr.crossing(-np.ones(len(factors))) == pytest.approx(factors[-1])


def test_curves_are_held_against_the_full_chain_at_its_own_factors() -> None:
    """A curve that grows with the factor's logarithm is read between its points; 0.03 is none of them."""
    curve, full = 10 + np.log(without_hdr.FACTORS), 10 + np.log(without_hdr.CHECKED)
    found = without_hdr.deviations(curve, full / [1.0, 0.8, 1.25])
    np.testing.assert_allclose(found, [0.0, -0.2, 0.25], atol=1e-12)


def test_a_sheet_is_scaled_as_a_whole():
    base = documents("straight", imu="nimu", methods=["pdr"])
    values = without_hdr.scaled_sheet(base, 3.0)
    scaled = with_values(base, values).setup().spec.gyro
    own = base.setup().spec.gyro
    assert scaled.white == pytest.approx(3 * own.white)
    assert scaled.temperature_sigma == pytest.approx(3 * own.temperature_sigma)
    assert scaled.bandwidth == own.bandwidth
    assert {address.rpartition(".")[2] for address in values} < set(CAUSE_OF)


def test_the_figure(tmp_path):
    rng = np.random.default_rng(1)
    errors = {name: np.exp(rng.normal(size=(len(without_hdr.FACTORS), 5))) for name in ("pdr", "hdr")}
    made = {"errors": errors, "full": {name: [1.0, 2.0, 3.0] for name in errors}}
    found = {name: {**made, "as_nimu": 0.2, "no_help": None} for name in ("straight", "turning")}
    without_hdr.draw(found, tmp_path / "without.png")
    assert (tmp_path / "without.png").stat().st_size > 20_000
