"""Maps of an error over two parameters."""

import json

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.hdr.methods import METHODS, find_method
from footfall.scenarios.parameters import documents
from footfall.scenarios.report.map import draw_map
from footfall.scenarios.studies.factors import Factor
from footfall.scenarios.studies.map import ErrorMap, error_map, factor_about, is_compiled, ranged
from footfall.scenarios.studies.points import Worn, evaluate_points

X, Y = "hdr.theta_w_deg_s", "hdr.i_c_deg_s"
TWO = Worn(walks=1, units=2)


@pytest.fixture(scope="module")
def base(workshop):
    return documents(str(workshop / "short.toml"), methods=["hdr"])


def test_a_compiled_map_is_the_chain_pair_by_pair(base):
    x, y = Factor(X, 0.1, 1.0), Factor(Y, 0.002, 0.02, log=True)
    found = error_map(base, x, y, cases=TWO, over="mean", steps=3, workers=1)
    assert found.scores.shape == (3, 3)
    np.testing.assert_allclose(found.xs, [0.1, 0.55, 1.0])
    np.testing.assert_allclose(found.ys, [0.002, 0.02 / np.sqrt(10), 0.02])
    points = [{X: x, Y: y} for y in found.ys for x in found.xs] + [{}]
    full = evaluate_points(base, points, TWO.deal, "heading_error_mean_deg", workers=1).errors[0].mean(axis=1)
    np.testing.assert_allclose(found.scores.ravel(), full[:-1], rtol=1e-6)
    assert found.default == (0.25, 0.007, pytest.approx(full[-1], rel=1e-6))
    assert found.cases == 2
    row, column = np.argwhere(found.scores == found.scores.min())[0]
    assert found.best == (found.xs[column], found.ys[row], found.scores.min())


def test_a_map_of_another_method_runs_in_full(workshop):
    base = documents(str(workshop / "short.toml"), methods=["hde-2010"])
    x, y = (factor_about(base.methods[0], f"hde-2010.{name}") for name in ("i_c_deg", "theta_w_deg_s"))
    found = error_map(base, x, y, cases=Worn(walks=1, units=1), steps=2, workers=1)
    assert np.isfinite(found.scores).all()


def test_where_a_range_lies_if_none_is_told():
    found = factor_about(METHODS["hdr"], X)
    assert (found.low, found.high, found.log) == (0.0625, 1.0, True)
    assert ranged(found, -1.0, 2.0) == Factor(X, -1.0, 2.0, log=False)
    with pytest.raises(InputError, match="say from where to where"):
        factor_about(METHODS["hdr-basic"], "hdr-basic.theta_w_deg_s")
    with pytest.raises(InputError, match=r"did you mean hdr\.theta_w_deg_s"):
        factor_about(METHODS["hdr"], "hdr.theta_w")


def test_which_methods_are_compiled():
    assert is_compiled(METHODS["hdr"], "heading_error_mean_deg")
    assert is_compiled(find_method("hdr", name="mine"), "heading_error_final_deg")
    assert not is_compiled(METHODS["hdr"], "position_rmse_m")
    assert not is_compiled(METHODS["iez"], "heading_error_mean_deg")


def test_the_command(cli, here):
    line = (
        "map hdr.theta_w_deg_s hdr.i_c_deg_s --scenario short.toml --walks 1 --units 2 --workers 1 --steps 4"
    )
    code, printed, told = cli(f"{line} --x 0.1..1.0 --figure map.png --json")
    assert code == 0, told
    found = json.loads(printed)
    assert found["x"] == {"address": X, "values": pytest.approx([0.1, 0.215, 0.464, 1.0], abs=1e-3)}
    assert np.shape(found["scores"]) == (4, 4)
    assert (here / "map.png").stat().st_size > 10_000
    code, printed, _ = cli(line)
    assert code == 0
    assert "best: " in printed
    assert "default: " in printed


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        ("hdr.tau_s hdr.tau_s", "given twice"),
        ("hdr.tau_s iez.sigma_velocity", "two parameters of one method"),
        ("hdr.tau_s hdr.theta", "did you mean"),
        ("hdr.tau_s hdr.i_c_deg_s --x 1", "expected FROM..TO"),
        ("hdr.tau_s hdr.i_c_deg_s --x 4..1", "expected FROM..TO"),
        ("hdr.tau_s hdr.i_c_deg_s --x -4..1", "tau_s"),
        ("hdr.tau_s hdr.i_c_deg_s --metric heading", "metric"),
        ("hdr.tau_s hdr.i_c_deg_s --over max", "expected one of median, mean, p90"),
        ("iez.initial hdr.i_c_deg_s", "one method"),
    ],
)
def test_mistakes_are_told_before_any_work(cli, here, words, reason):
    code, printed, told = cli(f"map {words} --scenario short.toml --walks 1")
    assert (code, printed) == (2, "")
    assert reason in told
    assert told.count("\n") == 1


def test_a_map_with_failures_is_drawn(tmp_path):
    scores = np.array([[1.0, 2.0], [np.inf, 4.0]])
    x, y = Factor(X, 0.1, 1.0), Factor(Y, 0.1, 1.0, log=True)
    found = ErrorMap("hdr", x, y, np.array([0.1, 1.0]), np.array([0.1, 1.0]), scores, (0.2, 0.3, 2.0), 5)
    draw_map(found, "heading_error_mean_deg", "median", "straight", tmp_path / "map.png")
    assert (tmp_path / "map.png").stat().st_size > 10_000
