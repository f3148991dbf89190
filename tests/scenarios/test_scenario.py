"""Scenarios: the stock ones are what they say, a user's own works the same, and mistakes are named."""

import numpy as np
import pytest

from footfall.models.imu import load_spec
from footfall.models.mount import MOUNTS
from footfall.scenarios.path import MIN_RADIUS_M
from footfall.scenarios.scenario import (
    load_scenario,
    stock_scenarios,
)
from footfall.simulate.plan import Gait

LONG_NAMES = ("closed-loop", "closed-loop-gentle", "curving", "straight", "turning")
IHDE_NAMES = ("ihde-test1", "ihde-test2", "ihde-test3")


def test_the_stock_scenarios():
    assert {*LONG_NAMES, *IHDE_NAMES} <= set(stock_scenarios())


@pytest.mark.parametrize(("name", "length"), list(zip(IHDE_NAMES, (202, 90, 455), strict=True)))
def test_the_ihde_papers_paths_are_as_long_as_stated_and_end_at_their_start(name, length):
    scenario = load_scenario(name)
    route, closure = scenario.path.route, scenario.path.closure
    assert route.length == pytest.approx(length, abs=0.03)
    assert closure.gap_m < 1e-3
    assert scenario.seeds.walks >= 20
    assert scenario.imu == "mtig710"


def test_the_ihde_papers_headings():
    """Right angles alone; two of them, a curve and 254 deg; and all directions of a track."""

    def degrees(name):
        route = load_scenario(name).path.route
        return np.degrees(route.heading[np.abs(route.curvature) < 1e-9])

    assert set(np.round(degrees("ihde-test1"), 6)) == {-270.0, -180.0, -90.0, 0.0, 90.0}
    # Read off the paper's text and Figure 7; solved for closure.
    assert sorted(set(np.round(degrees("ihde-test2")))) == [0, 90, 254]
    assert sorted(set(np.round(degrees("ihde-test3"), 6))) == [0, 180, 360]


@pytest.mark.parametrize("name", LONG_NAMES)
def test_stock_scenarios_are_1800_m_and_walkable(name):
    scenario = load_scenario(name)
    route = scenario.path.route
    assert scenario.name == name
    assert route.length == pytest.approx(1800, abs=0.01)
    assert np.abs(route.curvature).max() <= 1 / MIN_RADIUS_M + 1e-12
    assert 1.0 <= scenario.gait.pace_m_s <= 1.5
    assert min(scenario.gait.wander_m) > 0
    assert scenario.path.closed == (name in ("closed-loop", "closed-loop-gentle", "turning"))
    load_spec(scenario.imu)


@pytest.mark.parametrize("name", ["closed-loop", "closed-loop-gentle", "turning"])
def test_loops_close(name):
    closure = load_scenario(name).path.closure
    assert closure.gap_m < 1e-3
    assert abs(closure.heading_deg) < 1e-3
    assert abs(closure.climb_m) < 1e-3


@pytest.mark.parametrize(
    ("name", "radii"), [("closed-loop", [150, -150, 180]), ("closed-loop-gentle", [300])]
)
def test_the_loops_east_street_curves_and_climbs_and_the_west_street_falls(name, radii):
    path = load_scenario(name).path
    pieces, route = path.pieces, path.route
    wide = (pieces.curvature != 0) & (np.abs(pieces.curvature) < 0.1)
    assert 1 / pieces.curvature[wide] == pytest.approx(radii)
    assert pieces.length[wide].sum() == pytest.approx(460)
    x, heading = (
        np.interp(pieces.start, route.s, route.x),
        np.interp(pieces.start + 5, route.s, route.heading),
    )
    # Up in the east and nowhere else; down to the south in the west.
    assert pieces.grade[wide] == pytest.approx(0.03, rel=0.1)
    assert x[wide].min() > 350
    west = pieces.grade < 0
    assert pieces.grade[west] == pytest.approx(-0.03, rel=0.1)
    assert np.degrees(heading[west]) == pytest.approx(270, abs=3)
    assert np.abs(x[west]).max() < 30
    assert not pieces.grade[~wide & ~west].any()


def test_curving_bends_both_ways_from_10_to_300_m():
    pieces = load_scenario("curving").path.pieces
    radii = 1 / pieces.curvature[pieces.curvature != 0]
    for side in (radii[radii > 0], -radii[radii < 0]):
        assert [side.min(), side.max()] == pytest.approx([10, 300])
    assert pieces.length[pieces.curvature == 0].sum() < 200


def test_turning_turns_at_right_angles():
    pieces = load_scenario("turning").path.pieces
    turns = np.degrees(pieces.curvature * pieces.length)[pieces.curvature != 0]
    assert np.abs(turns) == pytest.approx(90)
    assert {True, False} == set((turns > 0).tolist())
    assert len(turns) == 14


def test_a_plan_holds_what_the_file_says():
    scenario = load_scenario("closed-loop")
    plans = [scenario.plan(walk) for walk in range(3)]
    assert [plan.seed for plan in plans] == [1, 2, 3]
    assert [plan.subject.name for plan in plans] == ["reference", "shorter", "reference"]
    assert plans[0].route is scenario.path.route
    assert plans[0].ground is plans[1].ground is scenario.terrain
    assert (plans[0].gait, plans[0].rate_hz) == (Gait(pace_m_s=1.5, wander_m=0.1, wander_time_s=4.0), 200)
    assert (plans[0].mount, plans[0].mount.foot) == (MOUNTS["medial"], "right")


@pytest.mark.parametrize("name", ["closed-loop", "closed-loop-gentle"])
def test_the_loops_five_walks_are_on_five_winter_days(name):
    """From one room into five colds, 25 K below it in the mean; further walks begin again."""
    scenario = load_scenario(name)
    days = [scenario.temperature_of(walk) for walk in range(5)]
    assert {day.start for day in days} == {20.0}
    outdoors = [day.ambient[0] for day in days]
    assert len(set(outdoors)) == 5
    assert -9 <= min(outdoors) < max(outdoors) < 0
    assert np.mean(outdoors) == -5
    assert [scenario.temperature_of(walk) for walk in range(5, 10)] == days


def test_swaying_sways_more_from_walk_to_walk_on_one_straight():
    """From the sway at the footfall rate alone to a wide, slow one; then over again."""
    scenario = load_scenario("swaying")
    route = scenario.path.route
    assert not route.curvature.any()
    assert route.length == pytest.approx(900)
    plans = [scenario.plan(walk) for walk in range(4)]
    assert [(plan.gait.wander_m, plan.gait.wander_time_s) for plan in plans] == [
        (0.0, 4.0),
        (0.1, 4.0),
        (0.3, 8.0),
        (0.0, 4.0),
    ]
    assert len({plan.subject.name for plan in plans}) == 1
    assert scenario.seeds.walks == 3


def test_a_plan_holds_pauses_and_changes_of_pace():
    plan = load_scenario("errands").plan(0)
    assert [stop.at_m for stop in plan.stops] == [60.0, 210.0, 375.0, 560.0]
    assert [(pace.at_m, pace.m_s) for pace in plan.paces] == [(215.0, 1.5), (265.0, 1.1), (440.0, 1.3)]


def test_level_scenarios_have_no_terrain():
    assert load_scenario("turning").plan(0).ground is None
