"""The ground under a path: right where the walker treads, smooth around corners, the same to MuJoCo."""

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from footfall.errors import InputError
from footfall.models.body import build_body
from footfall.models.subject import Build
from footfall.scenarios.scenario import load_scenario
from footfall.scenarios.terrain import Terrain, build_terrain, require_one_height
from tests.helpers.paths import arc, build, corner, straight


def beside(route, offset):
    """Points `offset` m to the left of a route."""
    return route.x - offset * np.sin(route.heading), route.y + offset * np.cos(route.heading)


@pytest.fixture(scope="module")
def loop():
    return load_scenario("closed-loop")


def test_a_level_path_has_no_terrain():
    assert build_terrain(build(straight(100.0), corner(90), straight(50.0))) is None


@given(
    st.floats(-8, 8).filter(lambda g: abs(g) > 0.1), st.floats(10, 30), st.floats(-3, 3), st.floats(-90, 90)
)
@settings(max_examples=15)
def test_a_sloping_street_is_level_across_and_follows_its_elevation(grade, transition, offset, turn_deg):
    # The slope begins far from the corner, which only turns the street against the grid.
    turned = [corner(turn_deg)] if abs(turn_deg) > 1 else []
    path = build(
        straight(5.0),
        *turned,
        straight(30.0),
        straight(40.0, grade),
        straight(20.0),
        vertical_transition_m=transition,
    )
    r = path.route
    on_slope = r.s > 12
    error = build_terrain(path).height(*beside(r, offset)) - r.z
    assert np.abs(error[on_slope]).max() < 2e-3


def test_the_loops_ground_is_right_where_the_walker_treads(loop):
    r, pieces = loop.path.route, loop.path.pieces
    tight = np.flatnonzero(np.abs(pieces.curvature) > 0.1)
    from_corner = np.min(
        [np.maximum(pieces.start[i] - r.s, r.s - pieces.start[i] - pieces.length[i]) for i in tight], axis=0
    )
    for offset in (-3, -1.5, 0, 1.5, 3):
        error = np.abs(loop.terrain.height(*beside(r, offset)) - r.z)
        assert error[from_corner > 8].max() < 1e-3
    # In corners too, as far as a walker's feet stray from the path.
    for offset in (-0.4, 0, 0.4):
        assert np.abs(loop.terrain.height(*beside(r, offset)) - r.z).max() < 1e-3


def test_ground_beside_sloping_corners_has_no_cliffs():
    # 5 % up to a right angle, through it and on: inside the corner, points are near to two streets at once.
    path = build(
        straight(20.0),
        straight(40.0, 5.0),
        corner(90, grade=5.0),
        straight(40.0, 5.0),
        straight(20.0),
    )
    heights = build_terrain(path).heights
    assert np.hypot(*np.gradient(heights, 0.5)).max() < 0.35


def test_open_paths_have_ground_beyond_their_ends():
    path = build(straight(20.0), straight(40.0, 5.0), straight(20.0))
    terrain = build_terrain(path)
    x = np.array([-5.0, -2.0, path.route.length + 2, path.route.length + 5])
    assert np.allclose(terrain.height(x, np.zeros(4)), [0, 0, 2, 2], atol=1e-3)


def ray_heights(terrain, x, y):
    """The ground's height as MuJoCo draws it, by rays from above."""
    model = build_body(Build(), timestep=1e-3, looks=True, scenery=terrain)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    above = 100.0
    ground = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, "scenery")
    down = np.array([0.0, 0.0, -1.0])
    return np.array(
        [
            above - mujoco.mj_rayHfield(model, data, ground, np.array([a, b, above]), down, None)
            for a, b in zip(x, y, strict=True)
        ]
    )


def test_heights_are_mujocos_triangles():
    rng = np.random.default_rng(1)
    terrain = Terrain(-3.0, 2.0, 0.5, rng.uniform(0, 0.3, (9, 14)).astype(np.float32))
    x, y = rng.uniform(-2.99, 3.49, 200), rng.uniform(2.01, 5.99, 200)
    assert np.allclose(terrain.height(x, y), ray_heights(terrain, x, y), atol=1e-5)


def test_mujoco_gets_the_loops_ground(loop):
    r = loop.path.route
    rows = np.arange(0, len(r.s), 500)
    assert np.allclose(ray_heights(loop.terrain, r.x[rows], r.y[rows]), r.z[rows], atol=1e-3)


def test_points_off_the_grid_are_refused():
    terrain = Terrain(0.0, 0.0, 1.0, np.zeros((3, 3), dtype=np.float32))
    assert terrain.height(2.0, 2.0) == 0
    with pytest.raises(InputError, match="off the grid"):
        terrain.height(2.01, 1.0)


def figure_of_eight(grade):
    """Straight on, a wide right turn back across the first street; the street climbs past the crossing."""
    return build(
        straight(60.0),
        straight(20.0, grade),
        straight(20.0),
        arc(20.0, -270.0),
        straight(60.0),
        vertical_transition_m=4.0,
    )


def test_a_path_that_crosses_itself_at_another_height_is_refused():
    require_one_height(figure_of_eight(0.0))
    with pytest.raises(InputError, match=r"comes within 3 m of itself at heights of -?\d.\d\d and \d.\d\d m"):
        require_one_height(figure_of_eight(3.0))
    with pytest.raises(InputError, match="comes within 3 m of itself"):
        build_terrain(figure_of_eight(3.0))


def test_the_seam_of_a_closed_path_is_no_crossing(loop):
    require_one_height(loop.path)


def test_too_much_ground_is_refused():
    with pytest.raises(
        InputError, match=r"takes a grid of \d+ x \d+ points, expected 16000000 in all at most"
    ):
        build_terrain(
            build(straight(50.0), straight(50.0, 2.0), straight(50.0), corner(45), straight(5000.0))
        )
