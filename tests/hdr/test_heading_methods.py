"""HDE, IHDE, iHDE and HDR in the filter: what they make of straights, curves, corners and drift."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from footfall.conventions import wrap
from footfall.errors import InputError
from footfall.hdr.directions import DirectionParams, Directions
from footfall.hdr.hde import Hde, Hde2010Params, HdeParams, hde_2010
from footfall.hdr.ihde import Ihde, IhdeParams, evaluate, reference
from footfall.hdr.ihde_plus import IhdePlus, IhdePlusParams
from footfall.hdr.jimenez import FilterHdr, FilterHdrParams, Jimenez, JimenezParams
from tests.helpers.synthetic_foot import footfalls
from tests.helpers.walked_steps import told_step, walked

DEG = math.pi / 180
T = 1.1


def ask(corrector, headings, stride_time=T):
    """Ask about strides of 1.4 m along these headings (rad), with the foot along them too; what it said."""
    strides = [1.4 * np.array([math.cos(heading), math.sin(heading), 0.0]) for heading in headings]
    places = np.cumsum(strides, axis=0)
    return [
        corrector(told_step(i, float(heading), stride_time, place, stride))
        for i, (heading, place, stride) in enumerate(zip(headings, places, strides, strict=True), start=1)
    ]


def column(corrector, name):
    return np.array([getattr(row, name) for row in corrector.rows])


# IHDE, footfall by footfall


@given(st.lists(st.floats(-0.1, 0.1), min_size=5, max_size=5), st.floats(0.8, 1.6), st.floats(-9, 9))
def test_the_evaluation_is_the_papers(headings, stride_time, turned):
    """Eq. 20 to 24, and no heading is special."""
    params = IhdeParams()
    found = evaluate([heading + turned for heading in headings], stride_time, params)
    std = np.std(headings, ddof=1)
    mu1 = 1 / (1 + np.exp(params.k1 * std - params.a))
    mu2 = 1 / (1 + params.b * abs(stride_time - params.gamma_t) ** (2 * params.c))
    e = params.w1 * mu1 + params.w2 * mu2
    assert found[:4] == pytest.approx((std, mu1, mu2, e), abs=2e-3)
    assert found.enabled == (found.evaluation > params.gamma2)


def test_on_a_straight_along_a_direction_the_innovation_leads_to_it():
    """Eq. 26 and 27 with delta = truth - estimate: what is to be added to the heading."""
    for quarter in range(-4, 5):
        corrector = Ihde()
        said = ask(corrector, quarter * 90 * DEG + 3 * DEG + np.array([0.1, -0.1, 0.1, -0.1, 0.1]) * DEG)
        assert said[:4] == [None] * 4  # no window yet
        assert said[4] == pytest.approx((-3.1 * DEG, corrector.params.sigma))
        assert corrector.rows[5].dominant == 1
        assert float(wrap(corrector.rows[5].reference - quarter * 90 * DEG)) == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("fallback", [True, False])
def test_beside_the_directions_the_mean_heading_or_nothing(fallback):
    corrector = Ihde(IhdeParams(fallback=fallback))
    headings = (30 + np.array([0.5, -0.5, 0.5, -0.5, 1.0])) * DEG
    last = ask(corrector, headings)[-1]
    if fallback:
        assert last == pytest.approx((headings.mean() - headings[-1], corrector.params.sigma), abs=1e-5)
    else:
        assert last is None
    row = corrector.rows[-1]
    assert (row.enabled, row.dominant) == (1, 0)
    assert math.isnan(row.innovation) == (not fallback)


def test_diagonals_count_where_there_are_eight_directions():
    headings = np.full(5, 43 * DEG)
    four = Ihde(IhdeParams(fallback=False))
    eight = Ihde(IhdeParams(fallback=False, directions=DirectionParams(8)))
    assert ask(four, headings)[-1] is None
    assert ask(eight, headings)[-1] == pytest.approx((2 * DEG, eight.params.sigma))


@given(st.floats(-4.9, 4.9), st.floats(-50, 50))
def test_directions_may_lie_anywhere(off, turned):
    """A building turned by any angle is corrected as one that lies along the axes."""
    said = [
        ask(Ihde(IhdeParams(directions=DirectionParams(4, by * DEG))), np.full(5, (90 + off + by) * DEG))[-1]
        for by in (0.0, turned)
    ]
    assert said[0] == pytest.approx(said[1], abs=1e-9)
    assert said[0][0] == pytest.approx(-off * DEG, abs=1e-9)


def test_curves_and_corners_are_let_alone_and_leave_evidence():
    """Eq. 25 feeds 0 where En = 0, which would claim that the heading is right; here nothing is said."""
    straight, turned = np.zeros(10), np.full(10, 90 * DEG)
    corrector = Ihde()
    said = ask(corrector, np.concatenate([straight, turned]))
    silent = np.array([one is None for one in said])
    assert not silent[4:10].any()
    assert silent[10:14].all()  # the corner is in the window
    assert not silent[14:].any()
    arc = Ihde()
    assert ask(arc, 3 * DEG * np.arange(40)) == [None] * 40
    assert (column(arc, "evaluation")[6:] < 0.6).all()
    assert column(arc, "scatter")[6:] == pytest.approx(3 * DEG * math.sqrt(2.5))
    assert np.isnan(column(arc, "innovation")).all()


def test_an_unusual_rhythm_counts_against():
    usual, odd = Ihde(), Ihde()
    ask(usual, np.zeros(5))
    ask(odd, np.zeros(5), stride_time=2.0)
    straight = usual.rows[-1].straight
    assert usual.rows[-1].evaluation == pytest.approx(0.8 * straight + 0.2)
    assert odd.rows[-1].evaluation == pytest.approx(0.8 * straight + 0.2 / (1 + 500 * 0.9**4))
    strict = Ihde(IhdeParams(gamma2=0.9))
    assert ask(strict, np.zeros(5), stride_time=2.0)[-1] is None


def test_a_direction_must_be_near():
    directions, params = Directions(DirectionParams()), IhdeParams()
    assert reference(91 * DEG, directions, params) == pytest.approx((90 * DEG, True))
    assert reference(96 * DEG, directions, params) == pytest.approx((96 * DEG, False))


def test_learned_directions_take_the_foots_angle_along():
    """A foot that points 3 deg outwards of corridors that lie at 20 deg."""
    corrector = Ihde(IhdeParams(fallback=False, directions=DirectionParams(4, None)))
    rng = np.random.default_rng(0)
    corridors = np.repeat([20, 110, 20, -70], 20) * DEG
    said = ask(corrector, corridors - 3 * DEG + 0.5 * DEG * rng.standard_normal(80))
    assert said[:8] == [None] * 8  # five to fill the window, and five of those
    given_ = [one[0] for one in said[20:] if one is not None]
    assert len(given_) > 40
    assert np.mean(given_) == pytest.approx(0, abs=0.3 * DEG)


# HDE


@given(st.floats(-50, 50))
def test_hde_always_knows_the_nearest_direction(heading):
    corrector = Hde()
    ((innovation, sd),) = ask(corrector, [heading])
    assert abs(innovation) <= 45 * DEG + 1e-9
    assert float(wrap(4 * (heading + innovation))) == pytest.approx(0, abs=1e-6)
    assert sd == corrector.params.sigma


@pytest.mark.parametrize("drift_deg_s", [0.2, -0.1])
def test_the_controller_of_2010_holds_a_drift_that_it_can_keep_up_with(drift_deg_s):
    params = Hde2010Params()
    found = hde_2010(footfalls(np.full(400, drift_deg_s * DEG), T), params)
    per_stride = abs(drift_deg_s) * DEG * T
    assert np.abs(found.heading).max() <= params.i_c + per_stride + 1e-12
    assert np.abs(np.diff(found.correction)).max() <= params.i_c + 1e-12


def test_the_controller_of_2010_is_overrun_by_a_drift_beyond_its_step():
    params = Hde2010Params(i_c=0.1 * DEG, theta_w=math.inf)
    found = hde_2010(footfalls(np.full(100, 0.2 * DEG), T), params)
    assert found.heading[-1] == pytest.approx(100 * (0.2 * T - 0.1) * DEG, rel=0.02)


def test_the_controller_of_2010_rests_in_a_turn_and_not_in_a_curve():
    rate = np.concatenate([np.zeros(20), np.full(2, 45 * DEG / T), np.zeros(20)])
    found = hde_2010(footfalls(rate, T))
    assert (found.attenuator[21:23] == 0).all()
    np.testing.assert_allclose(found.heading[-1], 90 * DEG, atol=Hde2010Params().i_c)
    # What IHDE was made for: a curve of 2 deg a stride is corrected as if it were drift.
    curve = hde_2010(footfalls(np.full(20, 2 * DEG / T), T))
    assert (curve.attenuator[1:] > 0.8).all()
    assert curve.correction[-1] < -3 * DEG


@given(st.integers(0, 999))
def test_the_controller_of_2010_has_no_favourite_side(seed):
    rate = np.random.default_rng(seed).normal(0, 2 * DEG, 60)
    left, right = hde_2010(footfalls(rate, T)), hde_2010(footfalls(-rate, T))
    np.testing.assert_allclose(left.correction, -right.correction, atol=1e-12)


def test_the_controller_of_2010_learns_no_directions():
    with pytest.raises(InputError, match="only filters learn directions"):
        hde_2010(footfalls(np.zeros(9)), Hde2010Params(directions=DirectionParams(reference=None)))


# Jimenez


def test_hdr_in_the_filter_says_that_small_changes_were_none():
    corrector = FilterHdr()
    said = ask(corrector, np.array([0.0, 1.0, 2.0, 10.0]) * DEG)
    assert said[:2] == [None, None]
    assert said[2] == pytest.approx((-1.5 * DEG, 0.1))
    assert said[3] is None
    assert column(corrector, "change")[1:] == pytest.approx(
        np.array([np.nan, np.nan, 1.5, 8.5]) * DEG, nan_ok=True
    )


@given(st.floats(-44, 44))
def test_ihde_trusts_a_direction_the_less_the_further_it_is(off):
    corrector = Jimenez()
    innovation, sd = ask(corrector, np.full(5, off * DEG))[-1]
    params = corrector.params
    assert innovation == pytest.approx(-off * DEG, abs=1e-9)
    assert sd == pytest.approx(params.sigma * (1 + (off * DEG / params.scale) ** 2))


def test_ihde_is_silent_where_one_heading_stands_out():
    corrector = Jimenez()
    assert ask(corrector, np.array([0, 0, 10, 0, 0]) * DEG)[-1] is None
    assert corrector.rows[-1].straight == 0
    assert corrector.rows[-1].spread == pytest.approx(8 * DEG, abs=0.1 * DEG)


@pytest.mark.parametrize(
    ("corrector", "sigma"), [(Hde, 12), (Ihde, 4), (Jimenez, 4), (FilterHdr, math.degrees(0.1))]
)
def test_how_far_each_is_trusted_unless_told(corrector, sigma):
    assert ask(corrector(), np.zeros(8))[-1][1] == pytest.approx(sigma * DEG)


@pytest.mark.parametrize(
    ("corrector", "params"),
    [(Hde, HdeParams), (Ihde, IhdeParams), (Jimenez, JimenezParams), (IhdePlus, IhdePlusParams)],
)
@pytest.mark.parametrize("source", ["yaw", "course", "both"])
def test_each_goes_by_the_heading_that_it_is_told(corrector, params, source):
    """Along a corridor by a foot that points 4 deg outwards: the yaw alone takes that for an error."""
    made = corrector(params(heading=source))
    said = [made(step) for step in walked(np.zeros(12), 4 * DEG)]
    assert said[-1][0] == pytest.approx(-4 * DEG if source == "yaw" else 0.0, abs=1e-9)
    assert made.params.heading == source
    assert params().heading == "course"


@pytest.mark.parametrize("corrector", [Ihde, Jimenez, IhdePlus])
def test_headings_before_a_correction_are_no_scatter(corrector):
    """The filter is put right by 10 deg on a straight: a method that is told of it sees one straight."""
    made = corrector()
    for step in walked(np.full(12, -10 * DEG)):
        made(step)
    made.applied(10 * DEG)
    after = [made(step) for step in walked(np.zeros(3))]
    assert after[0] is not None
    assert after[0][0] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: IhdeParams(window=1), "ihde: window = 1"),
        (lambda: IhdeParams(k1=-1.0), "ihde: k1 = -1.0 1/rad, expected a positive"),
        (lambda: IhdeParams(sigma=0.0), "ihde: sigma = 0.0 rad, expected a positive"),
        (lambda: IhdeParams(w2=math.nan), "ihde: w2 = nan, expected 0 or more"),
        (lambda: HdeParams(sigma=math.inf), "hde: sigma = inf rad, expected a positive"),
        (lambda: Hde2010Params(i_c=-0.1), "hde-2010: i_c = -0.1 rad"),
        (lambda: Hde2010Params(theta_w=0.0), "hde-2010: theta_w = 0.0 rad/s"),
        (lambda: FilterHdrParams(memory=0), "hdr-filter: memory = 0"),
        (lambda: FilterHdrParams(gate=math.nan), "hdr-filter: gate = nan"),
        (lambda: FilterHdrParams(sigma=-1.0), "hdr-filter: sigma = -1.0"),
        (lambda: JimenezParams(window=0), "ihde-jimenez: window = 0"),
        (lambda: JimenezParams(scale=0.0), "ihde-jimenez: scale = 0.0 rad"),
    ],
)
def test_impossible_parameters_are_refused(make, message):
    with pytest.raises(InputError, match=message):
        make()
