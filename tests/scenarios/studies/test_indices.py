"""Sensitivity of functions whose indices are known, and what is said of them."""

import sys

import numpy as np
import pytest

pytest.importorskip("SALib")

from footfall.errors import InputError
from footfall.scenarios.studies.extra import needed
from footfall.scenarios.studies.indices import (
    Index,
    Sobol,
    morris,
    morris_design,
    not_told_apart,
    sobol,
    sobol_design,
    sobol_until,
)

A = np.array([0.0, 1.0, 4.5, 9.0])  # of Sobol's g: the first factor matters most


def ishigami(x):
    """Ishigami and Homma (1990) with a = 7 and b = 0.1."""
    one, two, three = (np.pi * (2 * x - 1)).T
    return np.sin(one) + 7 * np.sin(two) ** 2 + 0.1 * three**4 * np.sin(one)


def ishigami_known():
    a, b = 7.0, 0.1
    first = 0.5 * (1 + b * np.pi**4 / 5) ** 2
    second, both = a**2 / 8, b**2 * np.pi**8 * (1 / 18 - 1 / 50)
    whole = first + second + both
    return np.array([first, second, 0.0]) / whole, np.array([first + both, second, both]) / whole


def g(x):
    """Saltelli and Sobol (1995)."""
    return np.prod((np.abs(4 * x - 2) + A) / (1 + A), axis=1)


def g_known():
    own = 1 / (3 * (1 + A) ** 2)
    whole = np.prod(1 + own) - 1
    return own / whole, np.array([v * np.prod(1 + np.delete(own, i)) for i, v in enumerate(own)]) / whole


@pytest.mark.parametrize(
    ("function", "known", "factors"), [(ishigami, ishigami_known(), 3), (g, g_known(), 4)]
)
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_every_known_index_lies_inside_its_interval(function, known, factors, seed):
    both = lambda x: np.column_stack([np.ones(len(x)), function(x)])  # noqa: E731
    *_, (idle, found) = sobol_until(both, factors, samples=1024, at_most=1024, widest=0.1, seed=seed)
    assert idle.widest == 0
    for indices, true in zip((found.first, found.total), known, strict=True):
        for index, value in zip(indices, true, strict=True):
            assert index.low <= value <= index.high
            assert 0 <= index.half < 0.15
    assert found.interplay == pytest.approx(known[1].sum() - 1, abs=0.1)


def test_the_known_indices_are_those_of_the_literature():
    np.testing.assert_allclose(ishigami_known(), [[0.3139, 0.4424, 0], [0.5576, 0.4424, 0.2437]], atol=1e-4)


def test_samples_double_until_the_intervals_are_narrow_and_no_point_is_asked_twice():
    asked = []

    def function(points):
        asked.append(points)
        return ishigami(points)[:, None]

    found = list(sobol_until(function, 3, samples=64, at_most=4096, widest=0.12, seed=3))
    counts = [one.samples for (one,) in found]
    assert counts[:3] == [16, 32, 64]
    assert counts[2:] == [64 * 2**i for i in range(len(counts) - 2)]
    assert found[-1][0].widest <= 0.12 < found[-2][0].widest
    np.testing.assert_array_equal(np.concatenate(asked), sobol_design(3, counts[-1], 3))
    assert found[-1][0] == sobol(3, ishigami(sobol_design(3, counts[-1], 3)), 3)


def test_samples_end_where_they_must():
    one = lambda x: ishigami(x)[:, None]  # noqa: E731
    found = list(sobol_until(one, 3, samples=64, at_most=200, widest=1e-6, seed=3))
    assert [step.samples for (step,) in found] == [16, 32, 64, 128]


def test_the_same_seed_gives_the_same_figures():
    values = ishigami(sobol_design(3, 64, 0))
    assert sobol(3, values, 0) == sobol(3, values, 0)
    assert sobol(3, values, 0) != sobol(3, values, 1)
    assert not np.array_equal(sobol_design(3, 64, 0), sobol_design(3, 64, 1))


def test_morris_finds_size_and_bend():
    """A straight factor has one effect everywhere, a bent one several, an idle one none."""
    points = morris_design(3, 20, 5)
    assert points.shape == (80, 3)
    found = morris(points, 3 * points[:, 0] + (points[:, 1] - 0.5) ** 2, 5)
    assert found[0].mu_star == pytest.approx(3.0)
    assert found[0].half == pytest.approx(0, abs=1e-9)
    assert found[0].sigma == pytest.approx(0, abs=1e-9)
    assert found[1].sigma > 0.1
    assert (found[2].mu_star, found[2].sigma) == (0, 0)


def test_what_depends_on_nothing():
    assert sobol(2, np.full(64, 3.0), 0) == Sobol(16, (Index(0, 0),) * 2, (Index(0, 0),) * 2)


def test_a_negative_index_inside_its_interval_is_nothing():
    assert Index(-0.01, 0.02).shown == 0
    assert Index(-0.03, 0.02).shown == -0.03
    assert Index(0.01, 0.02).shown == 0.01


def test_the_sum_of_totals_beyond_one_is_interplay():
    found = Sobol(64, (Index(0.3, 0.01),), (Index(0.8, 0.02), Index(0.5, 0.04)))
    assert found.interplay == pytest.approx(0.3)
    assert found.widest == 0.04


def test_groups_that_are_not_told_apart():
    """b meets a and c, which do not meet each other."""
    a, b, c, d = Index(0.9, 0.2), Index(0.6, 0.2), Index(0.3, 0.2), Index(0.0, 0.05)
    assert not_told_apart([c, a, d, b]) == [(1, 3), (3, 0)]
    assert not_told_apart([a, Index(0.95, 0.2), b]) == [(1, 0, 2)]
    assert not_told_apart([a, d]) == []


def test_a_missing_library_is_told_with_the_line_that_installs_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "SALib.sample.sobol", None)
    with pytest.raises(InputError, match=r"needs SALib.*pip install 'footfall\[study\]'"):
        needed("SALib.sample.sobol")
