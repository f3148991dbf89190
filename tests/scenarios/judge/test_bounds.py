"""Bounds of quantiles and shares: by hand, against each other, and how often they hold."""

import math
import warnings

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from footfall.scenarios.judge.bounds import (
    ALPHA,
    chance_of_so_few,
    chance_of_so_many,
    deciding,
    fewest,
    holm,
    log_ratios,
    quantile,
    quantile_bounds,
    share_bounds,
)

VALUES = st.one_of(st.integers(0, 6).map(float), st.floats(0, 10), st.just(math.inf))
CASES = st.lists(VALUES, min_size=1, max_size=70).map(np.array)
SHARES = st.sampled_from([0.5, 0.75, 0.9, 0.95])


def test_the_median_of_ten_by_hand():
    """B of 10 and 1/2: P(B <= 1) = 11 / 1024 = 1.1 %, P(B <= 2) = 56 / 1024 = 5.5 %. So the second value from
    either end is a bound at 95 %, and the third is none."""
    values = np.array([7, 3, 10, 1, 9, 2, 8, 4, 6, 5.0])
    assert quantile_bounds(values, 0.5) == (5.5, 2.0, 9.0)
    assert quantile_bounds(values, 0.5, alpha=56 / 1024) == (5.5, 3.0, 8.0)
    # Limit 9: nine of ten are within, which so many are by chance in 11 of 1024. Limit 8.9: eight, in 56.
    assert chance_of_so_many(9, 10, 0.5) == pytest.approx(11 / 1024)
    assert chance_of_so_many(8, 10, 0.5) == pytest.approx(56 / 1024)
    # Limit 1: one of ten is within, so few by chance in 11 of 1024.
    assert chance_of_so_few(1, 10, 0.5) == pytest.approx(11 / 1024)
    assert chance_of_so_few(2, 10, 0.5) == pytest.approx(56 / 1024)


def test_so_many_cases_have_an_upper_bound():
    """0.5^5 = 3.1 %, 0.9^29 = 4.7 %, 0.95^59 = 4.8 %."""
    assert [fewest(share) for share in (0.5, 0.75, 0.9, 0.95)] == [5, 11, 29, 59]
    assert fewest(0.5, 0.5**6) == 6
    for share in (0.5, 0.75, 0.9, 0.95):
        n = fewest(share)
        assert quantile_bounds(np.arange(float(n)), share).high == n - 1
        assert math.isinf(quantile_bounds(np.arange(float(n - 1)), share).high)


def test_the_bounds_of_a_share_are_those_of_clopper_and_pearson():
    """9 of 10: the lower bound p solves 10 p^9 (1 - p) + p^10 = 5 %; the upper one 1 - p^10 = 5 %."""
    estimate, low, high = share_bounds(9, 10)
    assert estimate == 0.9
    assert 10 * low**9 * (1 - low) + low**10 == pytest.approx(ALPHA)
    assert 1 - high**10 == pytest.approx(ALPHA)
    assert share_bounds(10, 10) == (1.0, pytest.approx(ALPHA ** (1 / 10)), 1.0)
    assert share_bounds(0, 10) == (0.0, 0.0, pytest.approx(1 - ALPHA ** (1 / 10)))


@given(
    st.lists(VALUES, min_size=1, max_size=70).map(np.array), SHARES, VALUES, st.sampled_from([0.05, 0.0125])
)
def test_a_limit_is_beyond_a_bound_where_the_count_says_so(values, share, limit, alpha):
    _, low, high = quantile_bounds(values, share, alpha)
    within, n = int((values <= limit).sum()), len(values)
    assert (low > limit) == (chance_of_so_few(within, n, share) <= alpha)
    if not math.isinf(limit):
        assert (high <= limit) == (chance_of_so_many(within, n, share) <= alpha)


@given(CASES, SHARES)
def test_the_estimate_lies_between_its_bounds(values, share):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        estimate, low, high = quantile_bounds(values, share)
        assert low <= estimate <= high
        assert not math.isnan(estimate)
        if np.isfinite(values).all():
            assert estimate == pytest.approx(np.quantile(values, share))


def test_a_quantile_beside_infinities():
    inf = math.inf
    assert quantile(np.array([1.0, 2.0, inf]), 0.5) == 2.0
    assert quantile(np.array([1.0, inf, 2.0, inf]), 0.5) == inf
    assert quantile(np.array([-inf, inf]), 0.5) == inf
    assert quantile(np.array([-inf, -inf, 1.0, 3.0]), 0.75) == 1.5


LAWS = {
    "lognormal": (lambda rng, shape: np.exp(rng.normal(size=shape)), 1.0, math.exp(1.2815515655446004)),
    "tied": (lambda rng, shape: rng.integers(0, 4, size=shape).astype(float), 1.0, 3.0),
    "infinite": (
        lambda rng, shape: np.where(rng.random(shape) < 0.3, math.inf, rng.random(shape)),
        0.5 / 0.7,
        math.inf,
    ),
    "heavy-tailed": (lambda rng, shape: np.abs(rng.standard_cauchy(shape)), 1.0, math.tan(0.45 * math.pi)),
}


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("n", [5, 20, 60])
def test_each_bound_holds_in_95_of_100_draws(law, n):
    """1,000 draws: a bound that holds in 95 % is seen to hold in less than 93 % once in 500 tests."""
    draw, median, p90 = LAWS[law]
    samples = draw(np.random.default_rng(7), (1000, n))
    for share, truth in ((0.5, median), (0.9, p90)):
        low, high = np.transpose([quantile_bounds(sample, share)[1:] for sample in samples])
        assert (low <= truth).mean() >= 0.93
        assert (high >= truth).mean() >= 0.93


def test_so_many_cases_would_decide():
    """36 of 60 within the limit: of 70, 42 are P(B >= 42) = 6.0 %, of 80, 48 are P(B >= 48) = 4.6 %."""
    assert deciding(36, 60, 0.5, 0.05, 0.05) == 80
    assert deciding(24, 60, 0.5, 0.05, 0.05) == 80
    assert deciding(24, 60, 0.5, 0.05, 0.025) > 80
    assert deciding(31, 60, 0.5, 0.05, 0.05) > 1000
    assert deciding(30, 60, 0.5, 0.05, 0.05) is None
    assert deciding(20, 20, 0.9, 0.05, 0.05) == 30


def test_ratios_of_failures_and_of_next_to_nothing():
    inf = math.inf
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = log_ratios(
            np.array([2.0, 0.0, inf, 1.0, inf, 0.0]), np.array([1.0, 0.02, 1.0, inf, inf, 0.0]), 0.01
        )
    np.testing.assert_allclose(found, [math.log(2), -math.log(2), inf, -inf, math.nan, 0.0])


def test_holm_by_hand():
    """0.01 of three counts as 0.03, 0.03 of the two that are left as 0.06, and 0.04 not as less than that."""
    assert holm([0.01, 0.04, 0.03]) == pytest.approx([0.03, 0.06, 0.06])
    assert holm([0.5, 0.9]) == [1.0, 1.0]
    assert holm([]) == []
