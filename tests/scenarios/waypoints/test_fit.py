"""Points to a path: known paths are found again from their own points, noisy ones within their noise."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from footfall.errors import InputError
from footfall.scenarios.path import Arc, Corner, Straight
from footfall.scenarios.scenario import load_scenario
from footfall.scenarios.waypoints.fit import circle_through, fit, simplified
from footfall.scenarios.waypoints.scenario import told, trace, write_scenario
from tests.helpers.paths import arc, build, straight


def file_of(points, folder):
    file = folder / "points.csv"
    file.write_text("x,y\n" + "".join(f"{x},{y}\n" for x, y in points), encoding="utf-8")
    return file


def kinds(found):
    return [element.kind for element in found.elements]


def test_corners_of_a_polyline():
    found = fit(np.array([(5, 5), (5, 55), (35, 55), (35, 25)]), 0.5)
    assert kinds(found) == ["straight", "corner", "straight", "corner", "straight"]
    assert [e.length_m for e in found.elements if isinstance(e, Straight)] == [50, 30, 30]
    assert [e.turn_deg for e in found.elements if isinstance(e, Corner)] == [-90, -90]
    assert found.heading == pytest.approx(math.pi / 2)
    assert not found.closed


def test_a_running_track_is_two_straights_and_two_half_circles(tmp_path):
    t = np.linspace(-np.pi / 2, np.pi / 2, 40)
    bend = 36 * np.column_stack([np.cos(t), np.sin(t)])
    points = np.vstack([[(0, 0), (50, 0)], bend + np.array((100, 36)), np.array((0, 36)) - bend, [(0, 0)]])
    found = trace(file_of(points, tmp_path))
    assert kinds(found) == ["straight", "arc", "straight", "arc"]
    arcs = [e for e in found.elements if isinstance(e, Arc)]
    assert [(a.radius_m, a.turn_deg) for a in arcs] == [pytest.approx((36, 180), abs=1e-3)] * 2
    assert found.path.closed
    assert found.off.max() < 0.05
    assert told(found) == ("closed path of 426 m: 2 straights, 2 arcs; at most 0.0 m off the 83 points")


@settings(max_examples=40, deadline=None)
@given(
    st.floats(10, 60),
    st.floats(50, 200),
    st.floats(50, 200),
    st.sampled_from([-1, 1]),
    st.sampled_from([-1, 1]),
)
def test_a_path_is_found_again_from_its_points(radius, turn, other, side, second):
    """Straights and arcs of any turn, seen from elsewhere, by points 1 m apart."""
    path = build(
        *(straight(40.0), arc(radius, side * turn), straight(30.0)),
        *(arc(1.5 * radius, second * other), straight(25.0)),
    )
    points = np.column_stack([path.route.x, path.route.y])[::10]
    seen = np.column_stack([70 - points[:, 1], points[:, 0] - 30])
    found = fit(seen, 0.05)
    assert kinds(found) == ["straight", "arc", "straight", "arc", "straight"]
    _, first, between, last, _ = found.elements
    assert (first.turn_deg, last.turn_deg) == pytest.approx((side * turn, second * other), abs=3)
    assert (first.radius_m, last.radius_m) == pytest.approx((radius, 1.5 * radius), rel=0.06)
    assert between.length_m == pytest.approx(30, abs=2)
    assert found.heading == pytest.approx(math.pi / 2, abs=0.05)


def test_noise_of_a_receiver_is_not_walked(tmp_path):
    """A rectangle of 60 m x 40 m in points 1 m apart, each 0.5 m off."""
    rng = np.random.default_rng(3)
    sides = [np.linspace(a, b, int(math.dist(a, b)), endpoint=False) for a, b in (
        ((0, 0), (60, 0)), ((60, 0), (60, 40)), ((60, 40), (0, 40)), ((0, 40), (0, 0)))]  # fmt: skip
    points = np.vstack([*sides, [(0, 0)]])
    found = trace(file_of(points + rng.normal(0, 0.5, points.shape), tmp_path), tolerance=3.0)
    turns = [e.turn_deg for e in found.elements if isinstance(e, Corner)]
    assert turns == [pytest.approx(90, abs=6)] * 4
    assert found.path.route.length == pytest.approx(200 - 4 * (2 - math.pi / 2) * 1.5, rel=0.02)


def test_an_octagon_of_streets_is_no_circle():
    angles = np.radians(45) * np.arange(9)
    found = fit(100 * np.column_stack([np.cos(angles), np.sin(angles)]), 1.0)
    assert set(kinds(found)) == {"straight", "corner"}
    assert sum(e.turn_deg for e in found.elements if isinstance(e, Corner)) == pytest.approx(360)


def test_a_coarse_curve_is_one_within_its_tolerance():
    """Chords of 40 deg on a circle of 10 m are 0.6 m inside of it."""
    angles = np.radians(40) * np.arange(6)
    points = 10 * np.column_stack([np.sin(angles), 1 - np.cos(angles)])
    assert kinds(fit(points, 0.7)) == ["arc"]
    assert "arc" not in kinds(fit(points, 0.5))


def test_the_map_lies_on_the_path_where_it_begins_at_a_corner(tmp_path):
    square = np.array([(0, 0), (0, -50), (50, -50), (50, 0), (0, 0)])
    found = trace(file_of(square, tmp_path))
    # A corner of 1.5 m passes its vertex by (sqrt 2 - 1) 1.5 m.
    np.testing.assert_allclose(found.off, (math.sqrt(2) - 1) * 1.5, atol=0.01)


def test_corners_make_room_for_each_other():
    found = fit(np.array([(0, 0), (20, 0), (20, 1), (0, 1.0)]), 0.1)
    radii = [e.radius_m for e in found.elements if isinstance(e, Corner)]
    assert radii == [pytest.approx(0.49, abs=0.01)] * 2
    build(*(e.model_dump(exclude_defaults=True) | {"kind": e.kind} for e in found.elements))


@pytest.mark.parametrize(
    ("points", "reason"),
    [
        ([(1, 1), (1, 1)], "all points lie at one place"),
        ([(0, 0), (50, 0), (50, 0), (0, 0.1)], "point no. 2: the way turns back on itself"),
        ([(0, 0), (20, 0), (20, 0.06), (5, 0.06)], "point no. 2: 0.06 m to the next turn, too near"),
    ],
)
def test_what_cannot_be_walked_is_told(points, reason):
    with pytest.raises(InputError, match=reason):
        fit(np.array(points, dtype=float), 0.01)


def test_the_scenario_is_written_and_read(tmp_path):
    file = file_of([(0, 0), (0, 50), (30, 50)], tmp_path)
    found = trace(file)
    write_scenario(found, file, tmp_path / "mine.toml")
    text = (tmp_path / "mine.toml").read_text(encoding="utf-8")
    assert "along x, 0 deg clockwise from north" in text
    mine = load_scenario(tmp_path / "mine.toml")
    assert mine.path.route.length == found.path.route.length
    assert mine.file.description == "79 m along the points of points.csv"


def test_the_pieces():
    kept = simplified(np.array([(0, 0), (1, 0.1), (2, 0), (3, 2), (4, 0), (5, 0.0)]), 0.5)
    assert kept.tolist() == [0, 2, 3, 4, 5]
    centre, radius = circle_through(np.array([(10, 9), (7, 12), (4, 9), (7, 6.0)]))
    assert (*centre, radius) == pytest.approx((7, 9, 3))
