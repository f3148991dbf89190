"""Verdicts over cases that are given."""

import math

import numpy as np
import pytest

from footfall.scenarios.judge.gate import METRICS, Gate
from footfall.scenarios.judge.verdict import decide, figure, weigh

METRIC = "heading_error_mean_deg"


def gate(**keys):
    return Gate.model_validate({"name": "a gate", "method": "hdr", **keys})


def scores(values):
    return {metric: np.array(values, dtype=float) for metric in METRICS}


def verdict(values, others=None, **keys):
    found = weigh(gate(**keys), scores(values), None if others is None else scores(others), 10)
    return decide([found])[0]


TEN = np.array([7, 3, 10, 1, 9, 2, 8, 4, 6, 5.0])


def test_a_median_by_hand():
    """The second of ten from either end bounds the median: 2 and 9."""
    found = verdict(TEN, at_most=9)
    assert (found.verdict, found.reason) == ("pass", "")
    assert (found.estimate, found.low, found.high, found.limit, found.unit) == (5.5, 2, 9, 9, "deg")
    assert (found.metric, found.statistic, found.cases, found.scatter) == (METRIC, "median", 10, None)
    assert verdict(TEN, at_most=1.9).verdict == "fail"
    left = verdict(TEN, at_most=8.9)
    assert left.verdict == "undecided"
    assert left.reason == "10 cases cannot tell 5.50 deg from 8.90 deg; about 20 would"
    assert left.needed == 20  # of 13 in 8 of 10 parts, P(B >= 10) = 4.6 %
    assert verdict(TEN, at_most=2).verdict == "undecided"


def test_an_estimate_on_the_limit_is_never_decided():
    found = verdict(TEN, at_most=5.5)
    assert (found.verdict, found.needed) == ("undecided", None)
    assert found.reason.endswith("; the estimate lies on the limit: no number will")


def test_failures_are_infinitely_bad():
    found = verdict([1.0] * 15 + [math.inf] * 5, at_most=2)
    assert (found.verdict, found.estimate, found.high) == ("pass", 1.0, 1.0)
    found = verdict([1.0] * 3 + [math.inf] * 17, at_most=2)
    assert (found.verdict, found.estimate) == ("fail", math.inf)


def test_an_upper_quantile_is_gated_at_its_share():
    """All of 29 are below their own p90 in 0.9^29 = 4.7 %, all of 28 in 5.2 %."""
    assert verdict(np.ones(29), statistic="p90", at_most=2).verdict == "pass"
    assert verdict(np.ones(28), statistic="p90", at_most=2).verdict == "undecided"
    assert verdict(np.r_[np.ones(20), np.full(9, 3.0)], statistic="p90", at_most=2).verdict == "fail"


def test_a_share_below_a_value():
    """9 of 10 below 10: the lower bound of Clopper and Pearson is 60.6 %."""
    found = verdict(TEN, statistic="share_below", below=10, at_least_percent=60)
    assert found.verdict == "pass"
    assert (found.estimate, found.unit, found.limit) == (90, "%", 60)
    assert found.low == pytest.approx(60.58, abs=0.01)
    assert verdict(TEN, statistic="share_below", below=10, at_least_percent=61).verdict == "undecided"
    assert verdict(TEN, statistic="share_below", below=2, at_least_percent=50).verdict == "fail"


def test_a_comparison_is_of_ratios():
    rng = np.random.default_rng(1)
    theirs = np.exp(rng.normal(size=60))
    scattered = theirs * np.exp(rng.normal(0, 0.05, 60))
    found = verdict(scattered, theirs, against="pdr")
    assert found.verdict == "pass"
    assert found.unit == "%"
    assert abs(found.estimate) < 3
    assert found.scatter == pytest.approx(0.05, abs=0.02)
    assert verdict(1.2 * scattered, theirs, against="pdr").verdict == "fail"
    assert verdict(1.2 * scattered, theirs, against="pdr", margin_percent=40).verdict == "pass"
    found = verdict(1.2 * theirs, theirs, against="pdr")
    assert (found.estimate, found.low, found.high) == pytest.approx((20, 20, 20))
    assert verdict(0.4 * theirs, theirs, against="pdr", margin_percent=-50).verdict == "pass"
    assert verdict(theirs, theirs, against="pdr", margin_percent=-50).verdict == "fail"


def test_the_same_bits_pass_without_statistics():
    found = verdict([1.0, math.inf], [1.0, math.inf], against="pdr")
    assert (found.verdict, found.reason) == ("pass", "identical")
    assert verdict([1.0, 2.0], [1.0, np.nextafter(2, 3)], against="pdr").verdict == "undecided"


def test_a_case_that_both_fail_is_left_out():
    inf = math.inf
    found = verdict([inf] * 4 + [1.0] * 10, [inf] * 4 + [1.001] * 10, against="pdr")
    assert (found.verdict, found.cases, found.left_out) == ("pass", 10, 4)
    found = verdict([inf] * 10 + [1.0] * 2, [1.0] * 12, against="pdr")
    assert (found.verdict, found.estimate, found.left_out) == ("fail", inf, 0)
    found = verdict([1.0] * 12, [inf] * 10 + [1.0] * 2, against="pdr")
    assert (found.verdict, found.estimate) == ("pass", -100)
    found = verdict([inf, inf, 1.0], [inf, inf, 1.1], against="pdr")
    assert found.verdict == "undecided"


def test_what_moved():
    keys = {"statistic": "same", "against": "b.parquet", "tolerance_percent": 0.1}
    found = verdict([1.0, 2.0, math.inf], [1.0, 2.0, math.inf], **keys)
    assert (found.verdict, found.reason, found.estimate, found.unit) == ("pass", "identical", 0, "cases")
    assert verdict([1.0, 2.001], [1.0, 2.0], **keys).verdict == "pass"
    assert verdict([1.0, 2.001], [1.0, 2.0], **keys).reason == ""
    found = verdict([1.0, 2.003], [1.0, 2.0], **keys)
    assert found.verdict == "fail"
    assert found.reason == "1 of 2 cases moved, heading_error_mean_deg of one by 0.15 %"
    assert verdict([1.0, math.inf], [1.0, 2.0], **keys).reason == "1 of 2 cases moved, one of them failed"
    assert verdict([1.0, 2.0], [1.0, math.inf], **keys).verdict == "fail"
    # Of every score, unless one is named.
    own, other = scores([1.0, 2.0]), scores([1.0, 2.0]) | {"position_rmse_m": np.array([1.0, 2.1])}
    assert decide([weigh(gate(**keys), own, other, 0)])[0].metric == "every score"
    assert decide([weigh(gate(**keys), own, other, 0)])[0].verdict == "fail"
    assert decide([weigh(gate(**keys, metric=METRIC), own, other, 0)])[0].verdict == "pass"
    # 0.1 % of nothing is nothing: below 0.01 deg a score counts as 0.01 deg.
    assert verdict([0.0], [0.000009], **keys, metric=METRIC).verdict == "pass"
    assert verdict([0.0], [0.000011], **keys, metric=METRIC).verdict == "fail"


def test_one_of_many_gates_fails_by_holm():
    """One of ten beyond the median has a chance of 11 in 1024: enough for 4 gates, and not for 5."""
    high = weigh(gate(at_most=1.5), scores(TEN), None, 10)
    passing = weigh(gate(at_most=20), scores(TEN), None, 10)
    for others, expected in ((0, "fail"), (3, "fail"), (4, "undecided")):
        found = decide([high, *[passing] * others])
        assert found[0].verdict == expected
        assert all(one.verdict == "pass" for one in found[1:])
    assert found[0].reason == (
        "10 cases lie beyond the limit, but by chance one of 5 gates may (Holm); about 20 would"
    )
    same = weigh(gate(statistic="same", against="b.parquet"), scores(TEN), scores(TEN), 10)
    assert decide([high, *[same] * 9])[0].verdict == "fail"  # where nothing is left to chance


def test_figures():
    assert [figure(value) for value in (0.123, 9.87, 12.34, 123.4, math.inf)] == [
        "0.12", "9.87", "12.3", "123", "inf"
    ]  # fmt: skip
    assert [figure(value, signed=True) for value in (0.123, -4.26, 19.4, -math.inf)] == [
        "+0.12", "-4.3", "+19", "-inf"
    ]  # fmt: skip
