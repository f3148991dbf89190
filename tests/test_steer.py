"""Pure pursuit on a point that turns as told."""

import numpy as np
import pytest

from footfall.simulate.route import Route
from footfall.simulate.steer import CORNER_SPEED, STRAY_LIMIT, TURN_LIMIT, Pursuit, StrayError
from footfall.simulate.walkers import CONTROL_INTERVAL


def route_of(curvature: np.ndarray, step: float = 0.05) -> Route:
    s = np.arange(len(curvature)) * step
    heading = np.concatenate([[0], np.cumsum(curvature[:-1] * step)])
    middle = heading[:-1] + curvature[:-1] * step / 2
    x = np.concatenate([[0], np.cumsum(np.cos(middle) * step)])
    y = np.concatenate([[0], np.cumsum(np.sin(middle) * step)])
    return Route(s, x, y, np.zeros_like(s), heading, curvature)


def follow(route: Route, wander: float = 0.0, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """A point that walks at the commanded speed and turns at the commanded rate: positions and turn rates."""
    pursuit = Pursuit(route, 1.3, wander, 4.0, np.random.default_rng(seed))
    x = y = heading = 0.0
    points, turns = [], []
    while not pursuit.finished:
        speed, turn = pursuit.command(x, y, heading)
        heading += turn * CONTROL_INTERVAL
        x += speed * np.cos(heading) * CONTROL_INTERVAL
        y += speed * np.sin(heading) * CONTROL_INTERVAL
        points.append((x, y))
        turns.append(turn)
    return np.array(points), np.array(turns)


def off_route(points: np.ndarray, route: Route) -> np.ndarray:
    line = np.column_stack([route.x, route.y])
    return np.array([np.linalg.norm(line - point, axis=1).min() for point in points])


@pytest.mark.parametrize("radius", [2.5, -10.0, 60.0])
def test_it_follows_straights_and_bends(radius: float) -> None:
    bend = np.full(int(abs(radius) * np.pi / 2 / 0.05), 1 / radius)
    route = route_of(np.concatenate([np.zeros(200), bend, np.zeros(200)]))
    points, turns = follow(route)
    assert off_route(points, route).max() < 0.5
    assert np.abs(turns).max() <= TURN_LIMIT


def test_it_slows_down_before_a_sharp_corner_and_not_for_a_wide_bend() -> None:
    corner = route_of(np.concatenate([np.zeros(100), np.full(78, 0.4), np.zeros(100)]))
    pursuit = Pursuit(corner, 1.4, 0.0, 4.0, np.random.default_rng(0))
    assert pursuit.command(0.0, 0.0, 0.0)[0] == 1.4
    assert [pursuit.command(x, 0.0, 0.0)[0] for x in (1.5, 3.0, 4.0)][-1] == CORNER_SPEED
    bend = Pursuit(route_of(np.full(400, 0.05)), 1.4, 0.0, 4.0, np.random.default_rng(0))
    assert bend.command(0.0, 0.0, 0.0)[0] == 1.4


def test_wander_has_the_asked_amplitude() -> None:
    """The aim wanders with the asked spread; the walked line follows it, smoothed."""
    route = route_of(np.zeros(40000))
    straight, _ = follow(route)
    assert np.abs(straight[:, 1]).max() < 1e-9
    points, _ = follow(route, wander=0.2, seed=3)
    assert 0.08 < points[:, 1].std() < 0.25
    again, _ = follow(route, wander=0.2, seed=3)
    np.testing.assert_array_equal(points, again)


def test_straying_is_an_error() -> None:
    pursuit = Pursuit(route_of(np.zeros(400)), 1.3, 0.0, 4.0, np.random.default_rng(0))
    pursuit.command(0.5, STRAY_LIMIT - 0.01, 0.0)
    with pytest.raises(StrayError, match=r"strayed 2\.0 m off its path"):
        pursuit.command(0.6, 2.0, 0.0)


def test_progress_never_jumps_to_a_later_pass() -> None:
    """A route that crosses itself is followed in order."""
    loop = np.concatenate([np.zeros(200), np.full(629, 0.2), np.zeros(200)])  # a full circle of 5 m radius
    route = route_of(loop)
    points, _ = follow(route)
    length = np.hypot(*np.diff(points, axis=0).T).sum()
    assert length == pytest.approx(route.length, rel=0.1)
