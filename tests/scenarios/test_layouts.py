"""Paths that seeds draw: each walk has its own, it holds what its kind promises, and can be walked."""

from itertools import pairwise

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.scenarios.layouts import STRIDE_M, DrawnPath, drawn, laid_out
from footfall.scenarios.listing import parameters
from footfall.scenarios.parameters import documents, with_values
from footfall.scenarios.path import MIN_RADIUS_M, Arc, Straight
from footfall.scenarios.scenario import load_scenario
from footfall.scenarios.trial import Trial, setup

SEEDS = range(1, 40)
NAMES = ("rooms", "corridors")


def elements(layout, length_m=300.0):
    spec = DrawnPath(layout=layout, length_m=length_m)
    return [drawn(spec, seed) for seed in SEEDS]


def turns(path):
    """Degrees that lie between two straights, arcs after one another together."""
    found = [0.0]
    for element in path:
        if isinstance(element, Straight):
            found.append(0.0)
        else:
            found[-1] += np.degrees(element.turn)
    return np.array(found[1:-1])


@pytest.mark.parametrize("name", NAMES)
def test_each_seed_has_a_path_of_its_own_and_always_the_same(name):
    scenario = load_scenario(name)
    routes = [scenario.plan(walk).route for walk in range(scenario.seeds.walks)]
    assert len({tuple(route.x[:1000:50]) for route in routes}) == scenario.seeds.walks >= 6
    again = load_scenario(name).plan(3).route
    np.testing.assert_array_equal(again.x, routes[3].x)
    np.testing.assert_array_equal(scenario.path.route.x, routes[0].x)
    for route in routes:
        assert scenario.file.path.length_m < route.length < scenario.file.path.length_m + 60
        assert not route.z.any()


def test_a_trial_walks_the_path_of_its_walks_seed_whatever_its_number():
    made = setup(load_scenario("rooms"), methods=["pdr"])
    plan = Trial(made, 0, 104, 7, 7).plan
    assert plan.seed == 104
    np.testing.assert_array_equal(plan.route.x, laid_out(made.scenario.file.path, 104).route.x)
    moved = load_scenario("rooms").changed("seeds", base=104, walks=1)
    np.testing.assert_array_equal(moved.path.route.x, plan.route.x)


@pytest.mark.parametrize("layout", NAMES)
def test_arcs_can_be_walked_and_both_ends_are_straight(layout):
    for path in elements(layout):
        assert isinstance(path[0], Straight)
        assert isinstance(path[-1], Straight)
        assert path[0].length_m >= 4
        assert path[-1].length_m >= 3
        assert all(one.radius_m >= MIN_RADIUS_M for one in path if isinstance(one, Arc))


def test_rooms_have_short_legs_and_turns_of_three_to_six_strides():
    legs, strides, angles, weaving = [], [], [], 0
    for path in elements("rooms"):
        legs += [one.length_m for one in path[1:-1] if isinstance(one, Straight)]
        angles += list(turns(path[:-1]))
        # The first arc after a straight is the turn; two more are round something.
        firsts = [b for a, b in pairwise(path) if isinstance(a, Straight) and isinstance(b, Arc)]
        strides += [one.radius_m * abs(one.turn) / STRIDE_M for one in firsts]
        weaving += sum(isinstance(one, Arc) for one in path) - len(firsts)
    assert 3 <= min(legs) < 3.5 < 9.5 < max(legs) <= 10
    assert min(strides) > 2.99
    assert np.percentile(strides, 98) < 6.01
    assert min(np.abs(angles)) >= 24.9
    assert weaving / 2 / len(strides) == pytest.approx(1 / 3, abs=0.05)
    assert np.mean(np.array(angles) > 0) == pytest.approx(0.5, abs=0.1)


def test_rooms_stay_in_one_building_and_seven_of_ten_legs_lie_along_its_walls():
    off, far = [], []
    for seed in SEEDS:
        route = laid_out(DrawnPath(layout="rooms", length_m=300.0), seed).route
        straight = np.abs(route.curvature) < 1e-9
        begins = np.flatnonzero(straight[1:] & ~straight[:-1]) + 1
        off += list(np.abs((np.degrees(route.heading[begins]) + 45) % 90 - 45))
        far.append(np.hypot(route.x, route.y).max())
    assert max(far) < 45
    # Of those anywhere, a tenth lies within 4.5 deg of a wall by chance.
    assert np.mean(np.array(off) < 10) == pytest.approx(0.7 + 0.3 * 10 / 45, abs=0.06)


def test_corridors_have_right_angles_and_ways_back():
    found = np.concatenate([turns(path) for path in elements("corridors")])
    found = found[np.abs(found) > 1e-6]  # people are walked round and the line is resumed
    assert np.allclose(np.abs(found) % 90, 0, atol=1e-3)
    assert np.mean(np.abs(found) > 135) == pytest.approx(0.2, abs=0.05)
    lengths = [
        one.length_m for path in elements("corridors") for one in path[:-1] if isinstance(one, Straight)
    ]
    assert min(lengths) >= 4
    assert max(lengths) <= 35


def changed(**keys):
    return load_scenario("rooms").changed("path", **keys)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"layout": "room"}, r"path.layout = 'room': .*'rooms' or 'corridors'"),
        ({"length_m": 5.0}, r"path.length_m = 5.0: expected at least 20"),
        ({"closed": True}, r"unknown key 'path.closed' = True"),
        ({"length_m": 262.0}, r"stops no. 4, at_m = 260: .*path's end at 262 m"),
    ],
)
def test_mistakes_are_named(keys, message):
    with pytest.raises(InputError, match=message):
        changed(**keys)


def test_a_drawn_path_has_addresses_of_its_own_and_none_of_elements():
    base = documents("rooms", methods=["pdr"])
    told = {one.address: one for one in parameters(base)}
    assert told["scenario.path.length_m"].default == 300.0
    assert told["scenario.path.layout"].default == "rooms"
    assert not any(address.startswith(("scenario.path.closed", "scenario.path.elem")) for address in told)
    longer = with_values(base, {"scenario.path.length_m": 320.0}).setup().scenario
    assert longer.path.route.length > 320
    plain = {one.address for one in parameters(documents("straight", methods=["pdr"]))}
    assert "scenario.path.closed" in plain
    assert "scenario.path.layout" not in plain
