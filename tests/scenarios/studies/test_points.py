"""Points of a study by the full chain, and what many cases come to."""

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.scenarios.parameters import documents, with_values
from footfall.scenarios.studies import points as studied
from footfall.scenarios.studies.factors import Factor
from footfall.scenarios.studies.points import (
    Worn,
    evaluate_points,
    over_cases,
    require_allowed,
    require_finite,
    require_metric,
)
from footfall.scenarios.trial import perform, walk_of

FLICKER, TAU = "imu.gyro.flicker_deg_h", "hdr.tau_s"
METRIC = "heading_error_mean_deg"


@pytest.fixture(scope="module")
def base(workshop):
    return documents(str(workshop / "short.toml"), methods=["hdr"])


def by_hand(base, point, units=2):
    setup = with_values(base, point).setup()
    found = []
    for trial in Worn(walks=1, units=units).deal(setup):
        found.append(perform(trial, walk_of(trial)).rows[0].require().heading_error_mean_deg)
    return found


def test_points_are_what_the_chain_gives_one_by_one(base):
    points = [{FLICKER: 300.0, TAU: 4.0}, {}, {TAU: 12.0}, {FLICKER: 300.0, TAU: 4.0}, {FLICKER: 300.0}]
    found = evaluate_points(base, points, Worn(walks=1, units=2).deal, METRIC, workers=1)
    np.testing.assert_array_equal(found.errors, [[by_hand(base, point) for point in points]])
    assert found.failures == {}
    assert len(np.unique(found.errors)) == 8


def test_what_differs_in_the_method_alone_is_recorded_once(base, monkeypatch):
    seen = []

    def execute(trials, **_):
        seen.extend(trials)
        return iter(())

    monkeypatch.setattr(studied, "perform_trials", execute)
    monkeypatch.setattr(studied, "TOGETHER", 3)
    points = [{TAU: float(tau)} for tau in range(1, 6)] + [{FLICKER: 9.0}, {TAU: 1.0}]
    with pytest.raises(ValueError, match="longer"):
        evaluate_points(base, points, Worn(walks=1, units=2).deal, METRIC)
    assert [len(trial.setup.methods) for trial in seen] == [3, 3, 2, 2, 1, 1]
    assert [method.params.tau_s for method in seen[0].setup.methods] == [1.0, 2.0, 3.0]
    assert len({id(trial.setup.scenario) for trial in seen}) == 1


def test_each_point_may_have_a_case_of_its_own(base):
    points = [{TAU: 5.0}, {TAU: 5.0}, {}]
    deal = Worn(walks=1, units=2).deal
    found = evaluate_points(base, points, deal, METRIC, which=np.array([1, 0, 1]), workers=1)
    five, own = by_hand(base, {TAU: 5.0}), by_hand(base, {})
    np.testing.assert_array_equal(found.errors, [[[five[1]], [five[0]], [own[1]]]])


def test_a_case_that_fails_is_infinite_and_tells_why(base):
    refused = {"pdr.bias_s": 100.0}
    found = evaluate_points(base, [{}, refused], Worn(walks=1, units=2).deal, METRIC, workers=1)
    assert np.isfinite(found.errors[0, 0]).all()
    assert np.isinf(found.errors[0, 1]).all()
    ((reason, count),) = found.failures.items()
    assert "stands still" in reason
    assert count == 2


def test_signed_errors_count_by_their_size(base):
    found = evaluate_points(base, [{}], Worn(walks=1, units=2).deal, "distance_error_pct", workers=1)
    assert (found.errors > 0).all()


def test_median_mean_and_p90():
    errors = np.array([[5.0, 1.0, 3.0, 2.0, 4.0], [np.inf, 1.0, np.inf, 2.0, 3.0], [np.inf] * 5])
    np.testing.assert_array_equal(over_cases(errors, "median"), [3.0, 3.0, np.inf])
    np.testing.assert_array_equal(over_cases(errors, "mean"), [3.0, np.inf, np.inf])
    np.testing.assert_allclose(over_cases(errors, "p90"), [4.6, np.inf, np.inf])
    rng = np.random.default_rng(1)
    values = rng.random((3, 20))
    np.testing.assert_allclose(over_cases(values, "p90"), np.percentile(values, 90, axis=1))
    np.testing.assert_allclose(over_cases(values, "median"), np.median(values, axis=1))


def test_a_median_bears_half_of_the_cases_and_no_more():
    errors = np.full((2, 20), np.inf)
    errors[0, :11] = 1.0
    errors[1, :10] = 1.0
    np.testing.assert_array_equal(over_cases(errors, "median"), [1.0, np.inf])


def test_the_corner_that_fails_is_named():
    noise, other = Factor("imu.gyro.flicker_deg_h", 1.0, 100.0, log=True), Factor("hdr.tau_s", 0.0, 10.0)
    shares = np.array([[0.1, 0.9], [0.8, 0.1], [0.9, 0.9], [1.0, 0.5]])
    values = np.array([1.0, np.inf, np.inf, np.inf])
    with pytest.raises(InputError) as told:
        require_finite(values, shares, (noise, other), {"it fell": 3, "no footfalls": 40})
    assert str(told.value) == (
        "3 of 4 points have no score, all with imu.gyro.flicker_deg_h from 39.81 to 100: "
        "too many of their cases failed (no footfalls)"
    )
    require_finite(np.ones(4), shares, (noise, other), {})


def test_a_metric_that_is_none_and_a_range_that_is_refused(base):
    with pytest.raises(InputError, match="did you mean heading_error_mean_deg"):
        require_metric("heading_eror_mean_deg")
    require_allowed(base, [Factor(TAU, 1.0, 9.0)])
    with pytest.raises(InputError, match=r"hdr\.tau_s = -1"):
        require_allowed(base, [Factor(TAU, -1.0, 9.0)])
    with pytest.raises(InputError, match=r"hdr\.tau"):
        require_allowed(base, [Factor("hdr.tau", 1.0, 9.0)])
