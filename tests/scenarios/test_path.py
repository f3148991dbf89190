"""Paths: lengths, headings, curvature, heights and closure against closed forms; every refusal."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from footfall.errors import InputError
from footfall.scenarios.path import MAX_LENGTH_M, PathSpec, build_path, elevation, plan
from tests.helpers.paths import arc, build, corner, straight

lengths = st.floats(10, 200)
# Straights are long enough for the widest corner at both ends: 2 x 3 m x tan 50 deg.
corners = st.builds(corner, st.floats(5, 100).flatmap(lambda a: st.sampled_from([a, -a])), st.floats(2.5, 3))
arcs = st.builds(arc, st.floats(5, 300), st.floats(1, 180).flatmap(lambda a: st.sampled_from([a, -a])))
straights = st.builds(straight, lengths)
paths = st.lists(straights | arcs | corners, min_size=1, max_size=12)


def tangent(element):
    return element["radius_m"] * math.tan(abs(math.radians(element["turn_deg"])) / 2)


@given(paths)
def test_length_is_straights_and_arcs_less_what_corners_take_from_straights(elements):
    expected = 0.0
    for i, element in enumerate(elements):
        if element["kind"] == "straight":
            expected += element["length_m"]
        else:
            expected += element["radius_m"] * abs(math.radians(element["turn_deg"]))
        if element["kind"] == "corner":
            beside = elements[max(i - 1, 0) : i] + elements[i + 1 : i + 2]
            expected -= tangent(element) * sum(other["kind"] == "straight" for other in beside)
    route = build(*elements).route
    assert route.length == pytest.approx(expected, abs=1e-9)
    assert np.allclose(np.diff(route.s), route.length / (len(route.s) - 1), atol=1e-9)
    assert np.diff(route.s).max() <= 0.1 + 1e-9


@given(paths)
def test_heading_is_the_sum_of_turns_and_the_integral_of_curvature(elements):
    path = build(*elements)
    turns = sum(math.radians(element.get("turn_deg", 0.0)) for element in elements)
    assert path.route.heading[-1] == pytest.approx(turns, abs=1e-9)
    assert path.pieces.curvature @ path.pieces.length == pytest.approx(turns, abs=1e-9)
    assert (path.route.heading[0], path.route.x[0], path.route.y[0]) == (0, 0, 0)


@given(paths, st.data())
def test_pose_is_the_integral_of_heading_and_heading_that_of_curvature(elements, data):
    pieces = build(*elements).pieces
    i = data.draw(st.integers(0, len(pieces.length) - 1))
    at = pieces.start[i] + pieces.length[i] * data.draw(st.floats(0.1, 0.9))
    h = 1e-3 * pieces.length[i]
    x, y, heading, curvature = plan(pieces, np.array([at - h, at, at + h]))
    # A central difference of an arc is its chord: short by the sinc of half the angle, and no more.
    sinc = np.sinc(curvature[1] * h / np.pi)
    assert (x[2] - x[0]) / (2 * h) == pytest.approx(np.cos(heading[1]) * sinc, abs=1e-8)
    assert (y[2] - y[0]) / (2 * h) == pytest.approx(np.sin(heading[1]) * sinc, abs=1e-8)
    assert (heading[2] - heading[0]) / (2 * h) == pytest.approx(curvature[1], abs=1e-8)


@given(paths)
def test_the_route_has_no_gaps(elements):
    path = build(*elements)
    edges = path.pieces.start[1:]
    before, after = plan(path.pieces, edges - 1e-9), plan(path.pieces, edges)
    for a, b in zip(before[:3], after[:3], strict=True):
        assert np.allclose(a, b, atol=1e-7)


@given(paths, st.floats(-179, 179).filter(lambda turn: abs(turn) > 1e-6))
def test_closure_does_not_depend_on_the_first_heading(elements, turn_deg):
    # What follows an arc of 5 m radius is the same path, turned: its own displacement keeps its size.
    plain = build(straight(20.0), *elements)
    led = build(arc(5.0, turn_deg or 1.0), straight(20.0), *elements)
    a, b = led.route.x[-1], led.route.y[-1]
    lead = led.pieces.length[0]
    x, y, heading, _ = plan(led.pieces, np.array([lead]))
    assert math.hypot(a - x[0], b - y[0]) == pytest.approx(plain.closure.gap_m, abs=1e-8)
    assert math.remainder(
        math.radians(led.closure.heading_deg - plain.closure.heading_deg) - heading[0], math.tau
    ) == pytest.approx(0, abs=1e-9)


@given(paths)
def test_walked_backwards_a_path_is_as_long_and_ends_as_far_away(elements):
    there, back = build(*elements), build(*elements[::-1])
    assert back.route.length == pytest.approx(there.route.length, abs=1e-8)
    assert back.closure.gap_m == pytest.approx(there.closure.gap_m, abs=1e-8)


def test_a_corner_rounds_its_vertex_so_that_stated_lengths_hold():
    path = build(straight(40.0), corner(90), straight(30.0), corner(-60, 4.0), straight(20.0))
    end = np.array([40.0, 30.0]) + 20 * np.array([math.cos(math.radians(30)), math.sin(math.radians(30))])
    assert [path.route.x[-1], path.route.y[-1]] == pytest.approx(end.tolist(), abs=1e-9)
    # The rounded vertex lies r (1 / cos(a/2) - 1) from the path.
    nearest = np.hypot(path.route.x - 40, path.route.y).min()
    assert nearest == pytest.approx(2.5 * (math.sqrt(2) - 1), abs=1e-3)


def test_an_arc_beside_a_corner_keeps_its_length_and_its_angle():
    path = build(straight(40.0), corner(50), arc(150.0, 49.6563))
    assert path.pieces.length[2] == pytest.approx(math.radians(49.6563) * 150)
    # It begins at the corner's tangent point, r tan(a/2) beyond the vertex.
    x, y, heading, _ = plan(path.pieces, path.pieces.start[2:])
    beyond = 2.5 * math.tan(math.radians(25))
    expected = [40 + beyond * math.cos(math.radians(50)), beyond * math.sin(math.radians(50))]
    assert [x[0], y[0]] == pytest.approx(expected)
    assert math.degrees(heading[0]) == pytest.approx(50)


def test_an_arc_may_be_given_by_length_and_side():
    by_length = {"kind": "arc", "radius_m": 80.0, "length_m": 60.0, "side": "right"}
    a, b = build(by_length).route, build(arc(80.0, -math.degrees(60 / 80))).route
    assert a.length == pytest.approx(60)
    assert np.allclose(np.stack([a.x, a.y, a.heading]), np.stack([b.x, b.y, b.heading]))


def test_a_full_circle_closes():
    closure = build(arc(20.0, 360.0), closed=True).closure
    assert [closure.gap_m, closure.heading_deg, closure.climb_m] == pytest.approx([0, 0, 0], abs=1e-12)


def test_a_corner_at_either_end_of_a_closed_path_trims_the_straight_at_the_other():
    square = [straight(50.0), corner(90)] * 4
    for elements, straights in ((square, slice(0, None, 2)), (square[::-1], slice(1, None, 2))):
        path = build(*elements, closed=True)
        assert path.closure.gap_m < 1e-12
        assert np.allclose(path.pieces.length[straights], 45)
    with pytest.raises(InputError, match=r"path.closed = true: the path ends at .* from its start"):
        build(*square[:-2], straight(49.0), corner(90), closed=True)


# Heights


@given(st.lists(st.tuples(st.floats(15, 100), st.floats(-8, 8)), min_size=1, max_size=6), st.floats(2, 30))
def test_climb_is_the_sum_of_grade_times_length(stretches, transition):
    path = build(
        straight(20.0),
        *(straight(*stretch) for stretch in stretches),
        straight(20.0),
        vertical_transition_m=transition,
    )
    climb = sum(length * grade / 100 for length, grade in stretches)
    assert path.closure.climb_m == pytest.approx(climb, abs=1e-9)


@given(st.floats(-8, 8), st.floats(2, 30))
def test_grade_changes_linearly_over_the_transition_and_is_exact_beyond(grade, transition):
    path = build(straight(50.0), straight(100.0, grade), straight(50.0), vertical_transition_m=transition)
    r, h = path.route, 1e-3
    ahead, behind = (elevation(path.pieces, transition, r.s + step) for step in (h, -h))
    slope = (ahead - behind) / (2 * h)
    expected = np.interp(
        r.s,
        [50 - transition / 2, 50 + transition / 2, 150 - transition / 2, 150 + transition / 2],
        [0, grade / 100, grade / 100, 0],
    )
    # At a kink of the grade the difference quotient is off by (change of its slope) h / 4.
    assert np.allclose(slope, expected, atol=abs(grade) / 100 / transition * h)
    assert r.z[0] == 0


def test_a_level_path_has_no_height_at_all():
    path = build(straight(100.0), corner(90), arc(20.0, 90))
    assert path.level
    assert not path.route.z.any()


# Refusals


@pytest.mark.parametrize(
    ("elements", "message"),
    [
        ([arc(1.4, 90)], r"path.elements no. 1, radius_m = 1.4: .* less than 1.5 m"),
        (
            [straight(50), arc(1.0, 90), straight(50)],
            r"path.elements no. 2, radius_m = 1: .* 1.5 m",
        ),
        (
            [straight(50), corner(90), straight(4.9), corner(90), straight(50)],
            r"path.elements no. 3, length_m = 4.9: too short for its corners, which take 5.000 m",
        ),
        ([straight(1.0), corner(170)], r"path.elements no. 1, length_m = 1: too short"),
        ([straight(MAX_LENGTH_M), straight(1.0)], r"path.elements: 50001 m in all, expected 50000 m at most"),
        ([straight(50, 3.0)], r"begins with 0 m of level ground, expected 5 m at least"),
        ([straight(20), straight(50, 3.0), straight(4)], r"ends with 4 m of level ground, expected 5 m"),
    ],
)
def test_what_cannot_be_walked_is_refused(elements, message):
    with pytest.raises(InputError, match=message):
        build(*elements)


def test_the_walkers_minimum_radius_is_an_argument():
    spec = PathSpec(elements=[arc(1.0, 90)])
    assert build_path(spec, min_radius_m=0.5).route.length == pytest.approx(math.pi / 2)
    with pytest.raises(InputError, match=r"radius_m = 1: .* less than 1.5 m"):
        build_path(spec)


def test_a_corner_need_not_be_rounded():
    path = build(straight(10.0), corner(90, 0.0), straight(10.0))
    off = np.minimum(np.hypot(path.route.y, 0 * path.route.y), np.hypot(path.route.x - 10, 0 * path.route.x))
    assert off.max() < 0.03
    assert path.route.length == pytest.approx(20.0, abs=0.05)
    assert path.route.heading[-1] == pytest.approx(math.pi / 2)


@pytest.mark.parametrize(
    ("last", "message"),
    [
        (straight(51.0), r"ends at \(0.000, -1.000\) m, 1.000 m from its start, expected 0.05 m at most"),
        (straight(50.0, 0.5), r"the path ends 0.225 m above its start, expected 0.05 m at most"),
    ],
)
def test_a_closed_path_must_close(last, message):
    sides = [straight(25.0), corner(90), straight(50.0), corner(90), straight(50.0), corner(90)]
    with pytest.raises(InputError, match=message):
        build(*sides, last, corner(90), straight(25.0), closed=True)


def test_a_closed_path_must_end_in_its_first_heading():
    elements = [straight(20.0), corner(-90), arc(20.0, 270.0)]
    path = build(*elements)
    with pytest.raises(InputError, match=r"ends -?180.000 deg off the heading of its start"):
        build(*elements, closed=True, closure_tolerance_m=path.closure.gap_m + 1)


@pytest.mark.parametrize(
    "element",
    [
        straight(-1.0),
        straight(0.0),
        straight(math.nan),
        straight(math.inf),
        straight("50"),
        straight(True),
        straight(50.0, 8.1),
        arc(-20.0, 90),
        arc(20.0, 0.0),
        arc(20.0, math.nan),
        corner(0.0),
        corner(180.0),
        corner(-200.0),
        {"kind": "arc", "radius_m": 20.0},
        {"kind": "arc", "radius_m": 20.0, "length_m": 10.0},
        {"kind": "arc", "radius_m": 20.0, "length_m": 10.0, "side": "up"},
        {"kind": "arc", "radius_m": 20.0, "length_m": 10.0, "side": "left", "turn_deg": 30.0},
        {"kind": "arc", "radius_m": 20.0, "turn_deg": 30.0, "side": "left"},
        {"kind": "stairs", "length_m": 5.0},
        {"length_m": 5.0},
        straight(5.0) | {"radius_m": 5.0},
    ],
)
def test_elements_that_make_no_sense_are_refused(element):
    with pytest.raises(ValidationError):
        PathSpec(elements=[element])


def test_a_path_needs_elements():
    with pytest.raises(ValidationError):
        PathSpec(elements=[])
