"""The filter over hypotheses: what it must do whatever its settings, on feet whose drift is known."""

from dataclasses import replace

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.hdr.hypotheses.filter import Given, Hypotheses, beliefs, given
from footfall.hdr.hypotheses.params import HypothesesParams
from footfall.hdr.hypotheses.smoother import smoothed
from footfall.hdr.hypotheses.track import UNITS, hypotheses_track
from footfall.hdr.methods import METHODS
from tests.helpers.drifting_feet import DEG, drift_of, feet, turned, without

FEW = HypothesesParams(hypotheses=40)
BLOCK = np.concatenate([np.zeros(80), [90 * DEG], np.zeros(80), [-90 * DEG], np.zeros(80)])
BOTH = pytest.mark.parametrize("method", [beliefs, smoothed], ids=["causal", "smoothed"])


def varied(n=90, seed=4):
    """Straights, corners, curves, a rest, a short stride, loads and a temperature."""
    rng = np.random.default_rng(seed)
    turns = np.zeros(n)
    turns[20], turns[21], turns[45:70] = 50 * DEG, 30 * DEG, 2.5 * DEG
    walked = feet(turns, 0.05 * DEG, seed=seed, rests={35: 20.0})
    loads = rng.normal(0, 1, 27) + rng.normal(0, 0.1, (n + 1, 27))
    loads[40:] += 4 * rng.normal(0, 1, 27)
    loads[0] = loads[35] = 0.0
    warm = 20 - 0.05 * walked.t
    strides = replace(
        walked.strides,
        loads=loads,
        temperature=warm,
        rest_temperature=np.where(walked.strides.rest_s > 0, warm, np.nan),
    )
    position = walked.position.copy()
    position[60:] -= 0.8 * (position[60] - position[59])
    return replace(walked, strides=strides, position=position)


def error(footfalls, found, drift):
    """Of the heading, less that at the start (n,) rad."""
    return found.heading - footfalls.heading + drift_of(footfalls, drift)


@pytest.mark.parametrize("reference", [None, 100 * DEG], ids=["learned", "known"])
def test_footfall_by_footfall_it_gives_the_numbers_of_the_whole(reference):
    walked, params = turned(varied(), 2.0), replace(FEW, reference=reference)
    numbers, loads = given(walked)
    one = Hypotheses(params)
    found = [one.update(Given(*row, load)) for row, load in zip(numbers, loads, strict=True)]
    for name, values in beliefs(walked, params)._asdict().items():
        told = np.array([getattr(each, name) for each in found])
        np.testing.assert_allclose(told, values, rtol=0, atol=1e-9, err_msg=name)


@BOTH
@pytest.mark.parametrize("drift", [0.0, 0.05 * DEG, -0.09 * DEG])
def test_round_a_block_the_drift_is_taken_out(method, drift):
    walked = feet(BLOCK, drift)
    found = method(walked)
    assert np.abs(error(walked, found, drift))[20:].mean() < 1.5 * DEG
    assert (
        np.abs(drift_of(walked, drift)).max() >= 3 * np.abs(error(walked, found, drift)).max() or drift == 0
    )
    assert abs(found.drift_rate[-1] - drift) < 0.02 * DEG


@BOTH
def test_without_drift_it_costs_nothing(method):
    walked = feet(BLOCK)
    assert np.abs(method(walked).heading - walked.heading).max() < 0.8 * DEG


def test_a_corner_is_a_turn_and_a_bend_a_curve():
    walked = feet(
        np.concatenate([np.zeros(60), [80 * DEG], np.zeros(60), np.full(40, 3 * DEG), np.zeros(60)])
    )
    found = beliefs(walked)
    assert found.straight[50] > 0.9
    assert found.turn[61] > 0.9
    assert found.curve[150] > 0.9
    assert found.straight[-1] > 0.8
    np.testing.assert_allclose(found.straight + found.curve + found.turn, 1.0, atol=1e-9)


def test_a_sudden_bend_is_no_drift_though_it_is_as_slow():
    """0.3 deg/s for a minute after a long straight: HDR would take most of it away."""
    turns = np.concatenate([np.zeros(150), np.full(60, 0.3 * 1.05 * DEG), np.zeros(100)])
    walked = feet(turns, 0.02 * DEG)
    final = abs(error(walked, beliefs(walked), 0.02 * DEG)[-1])
    assert final < 4 * DEG < 60 * 0.3 * DEG / 4


@BOTH
def test_the_start_heading_turns_all_and_changes_nothing(method):
    walked = varied()
    ahead, left = method(walked, FEW), method(turned(walked, 2.0), FEW)
    np.testing.assert_allclose(left.heading, ahead.heading + 2.0, atol=1e-9)
    np.testing.assert_allclose(left.heading_sd, ahead.heading_sd, atol=1e-9)
    np.testing.assert_allclose(left.curve, ahead.curve, atol=1e-9)


@BOTH
def test_a_known_direction_tells_the_drift_from_the_first_street_on(method):
    """Half a street: where its direction is learned, where it began and how fast it drifts stay mixed."""
    drift, building = 0.3 * DEG, 30 * DEG
    walked = turned(feet(np.zeros(16), drift), building + 90 * DEG)
    known = HypothesesParams(reference=building, bias=0.3 * DEG, along_first=0.9, beside=0.3 * DEG)
    off = [
        np.abs(error(walked, method(walked, params), drift)).mean()
        for params in (known, replace(known, reference=None))
    ]
    assert off[0] < 0.7 * off[1]


def test_hindsight_knows_the_direction_too():
    """After few strides, of which one sequence tells, the end is the same with hindsight and without."""
    walked = turned(feet(np.zeros(6), 0.3 * DEG), 120 * DEG)
    params = HypothesesParams(
        reference=30 * DEG,
        bias=0.3 * DEG,
        along_first=0.99,
        beside=0.1 * DEG,
        straight_first=0.999,
        scales=(1.0,),
    )
    ends = [method(walked, params).heading[-1] for method in (beliefs, smoothed)]
    assert ends[0] == pytest.approx(ends[1], abs=0.2 * DEG)


@BOTH
def test_a_known_direction_of_another_building_costs_little(method):
    walked = feet(BLOCK, 0.05 * DEG)
    wrong = HypothesesParams(reference=35 * DEG)
    assert np.abs(error(walked, method(walked, wrong), 0.05 * DEG))[20:].mean() < 1.5 * DEG


@BOTH
def test_left_is_as_right(method):
    walked = varied()
    left, right = method(walked, FEW), method(turned(walked, 0.0, mirror=True), FEW)
    np.testing.assert_allclose(right.heading, -left.heading, atol=1e-9)
    np.testing.assert_allclose(right.heading_sd, left.heading_sd, atol=1e-9)
    np.testing.assert_allclose(right.turn, left.turn, atol=1e-9)


@BOTH
def test_a_constant_bias_changes_nothing_on_a_straight(method):
    found = [method(feet(np.zeros(400), drift)).heading for drift in (0.0, 0.06 * DEG)]
    drift = drift_of(feet(np.zeros(400)), 0.06 * DEG)
    assert drift[-1] > 25 * DEG
    assert np.abs(found[1] - found[0])[-50:].max() < 1.2 * DEG


def test_a_slower_clock_is_the_same_walk():
    """Every time twice as long, and every constant with a time in it as it should be."""
    walked = feet(BLOCK, 0.05 * DEG, rests={100: 20.0})
    s = walked.strides
    slow = replace(
        feet(BLOCK, 0.05 * DEG, rests={100: 20.0}),
        t=2 * walked.t,
        interval=2 * walked.interval,
        rate=walked.rate / 2,
        strides=replace(s, moving=2 * s.moving, rest_s=2 * s.rest_s, rest_rate=s.rest_rate / 2),
    )
    half = HypothesesParams(
        random_walk=FEW.random_walk / 2**0.5,
        bias=FEW.bias / 2,
        bias_walk=FEW.bias_walk / 2**1.5,
        bias_walk_blind=FEW.bias_walk_blind / 2**1.5,
        flicker=FEW.flicker / 2,
        flicker_s=FEW.flicker_s * 2,
        warmth=FEW.warmth / 2,
        wander_s=tuple(2 * value for value in FEW.wander_s),
        hypotheses=40,
    )
    np.testing.assert_allclose(beliefs(slow, half).heading, beliefs(walked, FEW).heading, atol=1e-9)
    np.testing.assert_allclose(smoothed(slow, half).heading_sd, smoothed(walked, FEW).heading_sd, atol=1e-9)


@BOTH
def test_missed_footfalls_cost_little(method):
    walked = feet(BLOCK, 0.08 * DEG)
    gappy = without(walked, [5, 30, 31, 60, 100, 101, 102, 140, 180, 220])
    assert np.abs(error(gappy, method(gappy), 0.08 * DEG))[20:].mean() < 2 * DEG


@BOTH
def test_ten_minutes_of_standing_tell_the_drift(method):
    drift = 0.05 * DEG
    walked = feet(BLOCK, drift, rests={40: 600.0})
    found = method(walked)
    assert drift * 600 > 20 * DEG
    assert np.abs(error(walked, found, drift)).max() < 3 * DEG
    assert found.heading_sd[40] < 4 * DEG


def test_the_change_of_temperature_is_what_drifts():
    """A drift that grows with the cold while a long curve hides it, and that was learned before."""
    n = 500
    cold = -20 * (1 - np.exp(-np.arange(n + 1) / 200))
    drift = 0.006 * DEG * cold
    walked = feet(np.concatenate([np.zeros(250), np.full(n - 250, 0.8 * DEG)]), drift)
    told = replace(walked, strides=replace(walked.strides, temperature=20 + cold))
    off = [abs(error(walked, beliefs(each), drift)[-1]) for each in (told, walked)]
    assert off[0] < 4 * DEG
    assert off[0] < 0.7 * off[1]


def test_loads_foretell_a_drift_that_changes_with_the_gait():
    """Two paces in turn, of which the second drifts otherwise by a constant share of its load."""
    n = 400
    rng = np.random.default_rng(5)
    paces = np.where(np.arange(n + 1) // 100 % 2 == 0, 1.0, 2.0)
    loads = paces[:, None] * rng.normal(0, 3.0, 27)
    loads[0] = 0.0
    sd = FEW.constants.load_sd
    matrix = 1.5 * sd * np.sign(loads[1]) / np.sqrt(27)
    drift = loads @ matrix
    assert np.ptp(drift[1:]) > 0.03 * DEG
    walked = feet(np.concatenate([np.zeros(300), np.full(100, 1.0 * DEG)]), drift)
    told = replace(walked, strides=replace(walked.strides, loads=loads))
    off = [abs(error(walked, beliefs(each), drift)[-1]) for each in (told, walked)]
    assert off[0] < 2 * DEG < off[1]


@BOTH
def test_few_footfalls_are_few(method):
    for count in (1, 2):
        walked = feet(np.zeros(count))
        found = method(walked)
        assert np.isfinite(np.array(found)).all()
        assert np.abs(found.heading - walked.heading).max() < 0.1 * DEG
    one = feet(np.zeros(1))
    alone = type(one)(**{name: values[:1] for name, values in vars(one).items() if name != "strides"})
    assert method(alone).heading.tolist() == alone.heading.tolist()


def test_on_a_straight_known_to_be_one_the_rate_is_that_of_least_squares():
    """HDR's assumption, that all is straight, and a bias without any prior: what is left is a regression."""
    drift = 0.03 * DEG
    walked = feet(np.zeros(120), drift, scatter=0.5 * DEG)
    only = HypothesesParams(
        random_walk=1e-9,
        bias=1.0,
        bias_walk=0.0,
        bias_walk_blind=0.0,
        flicker=0.0,
        warmth=0.0,
        scales=(1.0,),
        wander_m=(1e-9,),
        wander_s=(1.0,),
        straight_curve=(1e-12,),
        place_m=1e-9,
        meander=0.0,
        straight_turn=(1e-12,),
        turn_straight=(0.6,),
        straight_first=1 - 1e-9,
    )
    found = beliefs(walked, only)
    course = np.unwrap(np.arctan2(*np.diff(walked.position[:, :2], axis=0).T[::-1]))
    middle = walked.t[1:] - walked.interval[1:] / 2
    slope = np.polyfit(middle, course, 1)[0]
    assert found.drift_rate[-1] == pytest.approx(slope, rel=2e-3)
    assert found.straight[-1] == pytest.approx(1.0, abs=1e-6)


def test_what_is_undecided_is_told():
    """A bend as slow as a drift may be either: two headings, both with weight, and an SD that spans them."""
    found = beliefs(feet(np.concatenate([np.zeros(40), np.full(120, 0.12 * DEG)]), 0.02 * DEG))
    assert 0.1 < found.second_weight[-1] < 0.9
    assert 0.1 < found.curve[-1] < 0.9
    assert abs(found.second_heading[-1] - found.heading[-1]) > 5 * DEG
    assert found.heading_sd[-1] > 5 * DEG > 3 * found.heading_sd[40]


def test_the_sd_covers_the_error_of_many_gyros():
    """Biases drawn from the prior itself: normalised errors are of variance one."""
    rng = np.random.default_rng(8)
    ratios = []
    for seed in range(12):
        drift = rng.normal(0, np.hypot(FEW.bias, FEW.flicker))
        walked = feet(np.zeros(60), drift, seed=seed)
        found = beliefs(walked, replace(FEW, scales=(1.0,)))
        ratios.append(error(walked, found, drift)[-1] / found.heading_sd[-1])
    assert 0.1 < np.mean(np.square(ratios)) < 2.2  # chi-square of 12: 2.2 has a chance of 1 %


def test_footfalls_of_no_samples_will_do():
    walked = replace(feet(BLOCK, 0.05 * DEG), strides=None)
    assert np.abs(error(walked, beliefs(walked), 0.05 * DEG))[20:].mean() < 2 * DEG


@pytest.mark.parametrize("name", ["hypotheses", "hypotheses-smooth"])
def test_it_is_a_method_on_footfalls(name):
    method = METHODS[name]
    assert method.needs == "footfalls"
    assert method.params == HypothesesParams()
    assert method.with_params({"bias_deg_s": 0.1}).params.bias == pytest.approx(0.1 * DEG)


def test_the_track_is_turned_and_tells_its_evidence():
    walked = feet(BLOCK, 0.1 * DEG)
    track = hypotheses_track(walked)
    assert set(track.evidence) == set(track.units) == set(UNITS)
    true = feet(BLOCK, 0.0)
    off = np.linalg.norm(track.position - true.position, axis=1)[-1]
    assert off < 0.2 * np.linalg.norm(walked.position - true.position, axis=1)[-1]


@pytest.mark.parametrize(
    ("values", "reason"),
    [
        ({"wander_m": (0.1,)}, "expected as many of each"),
        ({"scales": ()}, "scales: expected at least one"),
        ({"hypotheses": 16}, "expected 40 or more, four for each habit and scale"),
        ({"turn": -1.0}, "turn = -1.0 rad, expected a positive number"),
    ],
)
def test_what_cannot_be_is_refused(values, reason):
    with pytest.raises(InputError, match=reason):
        HypothesesParams(**values)


def test_bad_footfalls_are_refused():
    one = Hypotheses(FEW)
    one.update(Given(0.0, 0.0, 0.0, 0.0, 0.0))
    with pytest.raises(InputError, match="interval of 0"):
        one.update(Given(0.0, 1.0, 0.0, 0.0, 0.0))
    with pytest.raises(InputError, match="not finite"):
        one.update(Given(1.0, np.nan, 0.0, 0.0, 0.0))
    walked = feet(np.zeros(5))
    with pytest.raises(InputError, match="not positive"):
        beliefs(replace(walked, interval=0 * walked.interval))


def two_buildings(off):
    """Turns of corridors at right angles, and of as many that lie `off` (rad) beside them."""
    rng = np.random.default_rng(3)
    legs = [np.zeros(9) for _ in range(28)]
    for leg in legs:
        leg[0] = rng.choice([-1.0, 1.0]) * 90 * DEG
    legs[14][0] += off
    return np.concatenate([np.zeros(8), *legs])


@BOTH
def test_where_directions_change_new_ones_are_learned(method):
    drift = 0.04 * DEG
    walked = feet(two_buildings(12 * DEG), drift)
    off = [error(walked, method(walked, HypothesesParams(along_anew=a)), drift)[-60:] for a in (0.4, 1e-9)]
    assert np.abs(off[0]).mean() < 1.5 * DEG
    assert np.abs(off[0]).mean() < np.abs(off[1]).mean()


def test_habits_are_lists_of_one_length():
    with pytest.raises(InputError, match="wander_m, wander_s, straight_curve, straight_turn, turn_straight"):
        HypothesesParams(straight_turn=(0.01,))
