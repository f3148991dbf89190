"""Pure pursuit on a point that turns as told."""

import numpy as np
import pytest

from footfall.models.route import Route
from footfall.simulate.walker.steering import (
    SLOWING,
    STOPPING,
    STRAY_LIMIT,
    TURN_LIMIT,
    Pace,
    Pursuit,
    Stop,
    StrayError,
    pace_along,
    speed_limits,
)

DT = 0.03


def route_of(curvature: np.ndarray, step: float = 0.05) -> Route:
    s = np.arange(len(curvature)) * step
    heading = np.concatenate([[0], np.cumsum(curvature[:-1] * step)])
    middle = heading[:-1] + curvature[:-1] * step / 2
    x = np.concatenate([[0], np.cumsum(np.cos(middle) * step)])
    y = np.concatenate([[0], np.cumsum(np.sin(middle) * step)])
    return Route(s, x, y, np.zeros_like(s), heading, curvature)


def pursuit_of(route: Route, *stops: Stop, wander: float = 0.0, seed: int = 0) -> Pursuit:
    rng = np.random.default_rng(seed)
    return Pursuit(route, 1.3, stops, wander=wander, wander_time=4.0, dt=DT, rng=rng)


def follow(pursuit: Pursuit, share: float = 1.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A point that turns as told, and walks at a share of the speed told: points, turn rates, speeds told."""
    x = y = heading = speed = 0.0
    points, turns, speeds = [], [], []
    for _ in range(100_000):
        told, turn = pursuit.command(x, y, heading, speed, speed == 0.0)
        # Told to stop it slows down as a walker does; otherwise it obeys at once.
        speed = max(0.0, speed - STOPPING * DT) if told == 0.0 else told
        if pursuit.progress >= pursuit.route.length - 0.1:
            break
        heading += turn * DT
        x += share * speed * np.cos(heading) * DT
        y += share * speed * np.sin(heading) * DT
        points.append((x, y))
        turns.append(turn)
        speeds.append(speed)
    return np.array(points), np.array(turns), np.array(speeds)


def off_route(points: np.ndarray, route: Route) -> np.ndarray:
    line = np.column_stack([route.x, route.y])
    return np.array([np.linalg.norm(line - point, axis=1).min() for point in points])


@pytest.mark.parametrize("radius", [1.5, 2.5, -10.0, 60.0])
def test_it_follows_straights_and_bends(radius: float) -> None:
    bend = np.full(int(abs(radius) * np.pi / 2 / 0.05), 1 / radius)
    route = route_of(np.concatenate([np.zeros(200), bend, np.zeros(200)]))
    points, turns, _ = follow(pursuit_of(route))
    assert off_route(points, route).max() < 0.5
    assert np.abs(turns).max() <= TURN_LIMIT
    assert np.linalg.norm(points[-1] - [route.x[-1], route.y[-1]]) < 0.5


def test_an_unrounded_corner_is_taken_slowly_and_closely() -> None:
    jump = np.zeros(401)
    route = route_of(jump)
    heading = np.where(np.arange(401) < 200, 0.0, np.pi / 2)
    x = np.minimum(route.s, 10.0)
    y = np.maximum(route.s - 10.0, 0.0)
    corner = Route(route.s, x, y, route.z, heading, jump)
    points, _, speeds = follow(pursuit_of(corner))
    assert off_route(points, corner).max() < 0.5
    before = (points[:, 0] > 9.3) & (points[:, 1] < 0.2)
    assert before.any()
    assert speeds[before].max() < 1.1
    assert speeds.max() == pytest.approx(1.3, abs=1e-6)


def test_speed_limits_brake_in_time_and_never_exceed_the_pace() -> None:
    corner = route_of(np.concatenate([np.zeros(400), np.full(78, 0.4), np.zeros(400)]))
    limit = speed_limits(corner, np.full(len(corner.s), 1.4))
    assert limit.max() == 1.4
    assert limit[400:478].max() <= 1.0
    slowing = np.diff(limit[:401] ** 2) / np.diff(corner.s[:401]) / 2
    assert slowing.min() > -SLOWING - 1e-9
    assert speed_limits(route_of(np.full(400, 0.05)), np.full(400, 1.4)).min() == 1.4


def test_paces_change_where_they_are_told_and_slowing_down_begins_before() -> None:
    street = route_of(np.zeros(2001))
    pace = pace_along(street, 1.0, (Pace(30.0, 1.6), Pace(70.0, 0.8)))
    at = np.searchsorted(street.s, [0.0, 29.9, 30.1, 69.9, 70.1, 100.0])
    np.testing.assert_array_equal(pace[at], [1.0, 1.0, 1.6, 1.6, 0.8, 0.8])
    limit = speed_limits(street, pace)
    assert (limit <= pace).all()
    early = street.s > 70 - (1.6**2 - 0.8**2) / (2 * SLOWING)
    np.testing.assert_array_equal(limit[~early], pace[~early])
    rng = np.random.default_rng(0)
    pursuit = Pursuit(street, pace, (), wander=0.0, wander_time=4.0, dt=DT, rng=rng)
    points, _, speeds = follow(pursuit)
    x = points[:, 0]
    for begin, end, told in ((5, 29, 1.0), (45, 67, 1.6), (75, 95, 0.8)):
        assert speeds[(x > begin) & (x < end)] == pytest.approx(told, abs=0.02)


@pytest.mark.parametrize("share", [0.9, 1.05])
def test_whoever_is_slower_than_told_is_told_to_be_faster(share: float) -> None:
    points, _, _ = follow(pursuit_of(route_of(np.zeros(1600))), share)
    walked = np.hypot(*np.diff(points, axis=0).T) / DT
    assert walked[:20].mean() == pytest.approx(1.3 * share, rel=0.01)
    assert walked[-300:].mean() == pytest.approx(1.3, rel=0.01)


def test_it_stands_where_and_as_long_as_told() -> None:
    route = route_of(np.zeros(800))
    points, _, speeds = follow(pursuit_of(route, Stop(0.0, 3.0), Stop(20.0, 5.0)))
    still = speeds == 0
    assert still[: int(3.0 / DT) - 1].all()
    on_the_way = still & (points[:, 0] > 1) & (points[:, 0] < 39)
    assert on_the_way.sum() * DT == pytest.approx(5.0, abs=0.1)
    np.testing.assert_allclose(points[on_the_way, 0], 20.0, atol=0.4)


def test_wander_has_the_asked_amplitude() -> None:
    """The aim wanders with the asked spread; the walked line follows it, smoothed."""
    route = route_of(np.zeros(40000))
    straight, _, _ = follow(pursuit_of(route))
    assert np.abs(straight[:, 1]).max() < 1e-9
    points, _, _ = follow(pursuit_of(route, wander=0.2, seed=3))
    assert 0.08 < points[:, 1].std() < 0.25
    again, _, _ = follow(pursuit_of(route, wander=0.2, seed=3))
    np.testing.assert_array_equal(points, again)


def test_straying_is_an_error() -> None:
    pursuit = pursuit_of(route_of(np.zeros(400)))
    pursuit.command(0.5, STRAY_LIMIT - 0.01, 0.0, 1.3, False)
    with pytest.raises(StrayError, match=r"strayed 2\.0 m off its path"):
        pursuit.command(0.6, 2.0, 0.0, 1.3, False)


def test_progress_never_jumps_to_a_later_pass() -> None:
    """A route that crosses itself is followed in order."""
    loop = np.concatenate([np.zeros(200), np.full(629, 0.2), np.zeros(200)])  # a full circle of 5 m radius
    route = route_of(loop)
    points, _, _ = follow(pursuit_of(route))
    length = np.hypot(*np.diff(points, axis=0).T).sum()
    assert length == pytest.approx(route.length, rel=0.1)
