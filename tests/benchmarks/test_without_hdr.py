"""How good a sensor must be to do without HDR: crossings of curves, accuracy, sheets that are scaled."""

import numpy as np
import pytest

from benchmarks.validation import without_hdr
from footfall.scenarios.parameters import documents, with_values
from footfall.scenarios.studies.budget import CAUSE_OF


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
