"""What HDR's equations imply, exactly, with intervals that vary."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from footfall.errors import InputError
from footfall.hdr.hdr import Footfall, Hdr, HdrParams, HdrStep, headings, trace
from tests.helpers.synthetic_foot import footfalls

DEG = np.pi / 180
TINY = 1e-12

seeds = st.integers(0, 2**32 - 1)
sets = st.builds(
    HdrParams.from_degrees,
    tau_s=st.floats(0, 15),
    i_c_deg_s=st.floats(0, 0.02),
    theta_w_deg_s=st.floats(0.05, 1.0),
)


def strides(seed, n=80):
    """Rates of a person who sways, drifts and turns a corner, and intervals that scatter."""
    rng = np.random.default_rng(seed)
    rate = rng.normal(rng.uniform(-0.3, 0.3), 2.0, n) * DEG
    rate[30:33] += 30 * DEG
    return footfalls(rate, rng.uniform(0.8, 1.6, n))


def delag(rate, interval, tau):
    """HDR Eq. 10a-10b of rates whose row 0 is the start."""
    for _ in range(2):
        rate = rate + np.concatenate([[0.0], tau / interval[1:] * np.diff(rate)])
    return rate


@given(seeds, sets)
def test_delagging_undoes_the_double_low_pass_filter(seed, params):
    walk = strides(seed)
    found = trace(walk, params)
    np.testing.assert_allclose(delag(found.twice, walk.interval, params.tau_s), walk.rate, atol=TINY)


@given(seeds, sets)
def test_the_corrected_rate_is_the_raw_one_plus_the_delagged_integrator(seed, params):
    walk = strides(seed)
    found = trace(walk, params)
    expected = walk.rate + delag(found.integrator, walk.interval, params.tau_s)
    np.testing.assert_allclose(found.delagged, expected, atol=TINY)


def test_it_is_not_the_raw_rate_plus_the_integrator():
    found = trace(strides(1))
    assert np.abs(found.delagged - found.raw - found.integrator).max() > 0.1 * DEG


@given(seeds, sets)
def test_heading_correction_in_closed_form(seed, params):
    """sum(T delag(I)) = sum(T I) + 2 tau I_N + tau^2 (I_N - I_{N-1}) / T_N."""
    walk = strides(seed)
    found = trace(walk, params)
    tau, integrator, interval = params.tau_s, found.integrator, walk.interval
    expected = np.sum(interval * integrator) + 2 * tau * integrator[-1]
    expected += tau**2 * (integrator[-1] - integrator[-2]) / interval[-1]
    assert found.heading[-1] - walk.heading[-1] == pytest.approx(expected, abs=TINY)


@given(seeds, sets)
def test_a_controller_that_never_acts_changes_nothing(seed, params):
    walk = strides(seed)
    idle = trace(walk, HdrParams(params.tau_s, 0.0, params.theta_w))
    np.testing.assert_allclose(idle.heading, walk.heading, atol=TINY)


@given(seeds, sets)
def test_left_and_right_are_alike(seed, params):
    walk = strides(seed)
    mirrored = footfalls(-walk.rate[1:], walk.interval[1:])
    np.testing.assert_array_equal(trace(mirrored, params).heading, -trace(walk, params).heading)


@given(seeds, sets)
def test_bounds_of_attenuator_and_increment(seed, params):
    found = trace(strides(seed), params)
    assert ((found.attenuator >= 0) & (found.attenuator <= 1)).all()
    assert (np.abs(np.diff(found.integrator)) <= found.attenuator[1:] * params.i_c + 1e-18).all()


@given(seeds, st.floats(0, 0.5))
def test_the_basic_controller_is_equations_4_and_5(seed, i_c_deg_s):
    walk = strides(seed)
    i_c = i_c_deg_s * DEG
    integrator = rate = 0.0
    heading = [0.0]
    for raw, interval in zip(walk.rate[1:], walk.interval[1:], strict=True):
        integrator -= np.sign(rate) * i_c  # Eq. 4b
        rate = raw + integrator  # Eq. 5
        heading.append(heading[-1] + rate * interval)  # Eq. 3
    np.testing.assert_allclose(trace(walk, HdrParams.basic(i_c)).heading, heading, atol=TINY)


@given(
    st.lists(st.tuples(seeds, st.integers(2, 120)), min_size=1, max_size=4),
    st.lists(sets, min_size=1, max_size=5),
)
def test_batch_equals_streaming_for_ragged_walks_and_mixed_sets(walks, params):
    walks = [strides(seed, n) for seed, n in walks]
    params = [*params, HdrParams.basic(), HdrParams()]
    found = headings(walks, params)
    for walk, per_set in zip(walks, found, strict=True):
        assert per_set.shape == (len(params), len(walk))
        for one, heading in zip(params, per_set, strict=True):
            controller = Hdr(one)
            streamed = [
                controller.update(Footfall(*row)).heading
                for row in zip(walk.interval[1:], walk.rate[1:], strict=True)
            ]
            np.testing.assert_allclose(heading[1:], streamed, rtol=0, atol=TINY)


@pytest.mark.parametrize(
    ("values", "match"),
    [
        ({"tau_s": -1.0}, "tau_s = -1"),
        ({"tau_s": float("inf")}, "tau_s = inf"),
        ({"i_c": -0.1}, "i_c = -0.1"),
        ({"i_c": float("nan")}, "i_c = nan"),
        ({"theta_w": 0.0}, "theta_w = 0"),
        ({"theta_w": float("nan")}, "theta_w = nan"),
    ],
)
def test_settings_that_make_no_sense_are_refused(values, match):
    with pytest.raises(InputError, match=match):
        HdrParams(**values)


def test_an_interval_that_is_not_positive_is_refused():
    with pytest.raises(InputError, match="interval of 0"):
        Hdr().update(Footfall(0.0, 0.1))
    for stride in range(3):
        interval = np.ones(3)
        interval[stride] = 0.0
        with pytest.raises(InputError, match="not positive"):
            headings([footfalls(np.zeros(3), interval)], [HdrParams()])


def test_degrees_only_at_the_edge():
    params = HdrParams.from_degrees(i_c_deg_s=0.007, theta_w_deg_s=0.25)
    assert params == HdrParams()
    assert params.theta_w == pytest.approx(0.25 * DEG)
    assert HdrParams.from_degrees() == params
    assert HdrParams.from_degrees(tau_s=3.0).tau_s == 3.0


def test_before_the_first_footfall_every_state_is_zero_and_nothing_is_attenuated():
    walk = strides(3)
    first = HdrStep(*(column[0] for column in trace(walk)))
    assert first == HdrStep() == (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def test_the_basic_controller_has_neither_filter_nor_attenuator():
    """Section 2 of the paper: the same increment, on the raw rate, however fast it turns."""
    assert HdrParams.basic() == HdrParams(tau_s=0.0, i_c=HdrParams().i_c, theta_w=np.inf)
