"""Parameters are chosen on one side and judged on the other."""

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.hdr.hdr import HdrParams
from footfall.scenarios.judge.statistics import extent, spread
from footfall.scenarios.studies.tune import grid, require_apart, smallest, tune


def test_a_grid_has_every_combination_and_the_last_axis_changes_fastest():
    base = HdrParams(tau_s=5.0)
    found = grid(base, {"i_c_deg_s": (0.01, 0.02), "theta_w_deg_s": (0.2, 0.3, 0.4)})
    pairs = [(0.01, 0.2), (0.01, 0.3), (0.01, 0.4), (0.02, 0.2), (0.02, 0.3), (0.02, 0.4)]
    assert found == [HdrParams.from_degrees(tau_s=5.0, i_c_deg_s=i, theta_w_deg_s=w) for i, w in pairs]
    with pytest.raises(InputError, match="theta"):
        grid(base, {"theta_w": (0.2,)})
    with pytest.raises(InputError, match="theta_w_deg_s"):
        grid(base, {"theta_w_deg_s": (-1.0,)})


def test_the_smallest_error_is_that_of_the_mean_over_the_cases():
    assert smallest([np.array([[1.0, 4.0, 2.5], [9.0, 4.0, 4.5]])]) == 2
    assert smallest([np.ones((2, 3))]) == 0
    assert smallest([np.array([[1.0, 0.0]])]) == 1


def test_groups_count_alike_whatever_their_size():
    """Set 1 is half as bad in one group and a fifth worse in another of hundredfold errors."""
    small, large = np.array([[1.0, 0.5]]), np.array([[100.0, 120.0]] * 5)
    assert smallest([small, large]) == 1
    assert smallest([large]) == 0
    assert smallest([np.array([[1.0, 0.9]]), large]) == 0


def shifted(case, sets):
    """The best set is the case itself."""
    return np.array([abs(case - one) for one in sets]) + 0.1


def test_tuning_chooses_on_one_side_and_judges_on_the_other():
    found = tune(shifted, [1.0, 2.0, 3.0], 2.5, train=[3.0, 3.0, 2.0], test=[1.0, 1.0, 1.0, 5.0])
    assert (found.chosen, found.default) == (3.0, 2.5)
    np.testing.assert_allclose(found.errors, [[2.1, 1.1, 0.1], [2.1, 1.1, 0.1], [1.1, 0.1, 1.1]])
    assert found.figures["train"]["tuned"]["mean"] == pytest.approx(1.3 / 3)
    assert found.figures["train"]["default"]["mean"] == pytest.approx(0.6)
    assert found.figures["test"]["tuned"]["mean"] == pytest.approx(2.1)
    assert found.figures["test"]["default"]["mean"] == pytest.approx((3 * 1.6 + 2.6) / 4)
    assert found.figures["test"]["default"]["median"] == pytest.approx(1.6)


def test_the_default_is_not_chosen_where_it_is_not_among_the_sets():
    assert tune(shifted, [1.0, 2.0], 3.0, train=[3.0], test=[3.0]).chosen == 2.0


def test_what_serves_on_both_sides_is_refused():
    require_apart("unit", range(5), range(5, 9))
    with pytest.raises(InputError, match=r"share a unit \(4\): choose other seeds"):
        require_apart("unit", range(5), range(4, 9))


def test_spread_and_extent():
    values = [1.0, 2.0, 3.0, 4.0, 100.0]
    assert spread(values) == {"mean": 22.0, "median": 3.0, "p90": pytest.approx(61.6)}
    assert extent(values) == {"median": 3.0, "smallest": 1.0, "largest": 100.0}
