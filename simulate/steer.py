"""Steering along a route: pure pursuit, slowing down for what is sharp, stops, and the slow wander of people.

In the units of the walker (the 1.75 m body: models.subject).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from footfall.conventions import wrap
from footfall.errors import InputError
from footfall.simulate.route import Route

TURN_LIMIT = 1.0  # rad/s
SLOWING = 0.5  # m/s2, before corners and stops
STRAY_LIMIT = 1.5  # m off the route: a stumble
_BEARING_GAIN = 1.5  # 1/s
_SEARCH = 2.0  # m of route that one control step may advance at the most
_LOOK_AHEAD, _LOOK_AHEAD_S = 0.4, 0.9  # m, and s of the present speed: 1.6 m at 1.3 m/s
# Speed (m/s) in bends by their curvature (1/m): radii of 10, 4, 2.5 and 1.5 m, and on the spot.
_BEND_CURVATURE = np.array([0.1, 0.25, 0.4, 0.67, 2.0])
_BEND_SPEED = np.array([2.0, 1.2, 1.0, 0.85, 0.6])


class StrayError(InputError):
    """The walker left its route."""


@dataclass(frozen=True)
class Stop:
    """Stand for `duration` (s) at `distance` (m) along the route."""

    distance: float
    duration: float


def speed_limits(route: Route, pace: float) -> np.ndarray:
    """(n,) m/s at each sample of the route: the pace, less in bends and before them."""
    turning = np.abs(np.diff(route.heading, append=route.heading[-1]))
    spacing = np.diff(route.s, append=route.s[-1] + 1.0)
    # An un-rounded corner is a jump of the heading: as sharp as if taken over half a metre.
    curvature = np.maximum(np.abs(route.curvature), turning / np.maximum(spacing, 0.5))
    limit = np.minimum(pace, np.interp(curvature, _BEND_CURVATURE, _BEND_SPEED))
    for i in range(len(limit) - 2, -1, -1):
        limit[i] = min(limit[i], np.sqrt(limit[i + 1] ** 2 + 2 * SLOWING * spacing[i]))
    return limit


class Pursuit:
    """Follow `route` at `pace`; `progress` is where along it the walker is.

    Parameters
    ----------
    pace : m/s on straights
    stops : where to stand and for how long, in walking order
    wander : m, standard deviation of the slow lateral wander of the aim
    wander_time : s, its time constant (first-order Gauss-Markov)
    dt : s between commands
    rng : the wander's
    """

    def __init__(
        self,
        route: Route,
        pace: float,
        stops: tuple[Stop, ...],
        *,
        wander: float,
        wander_time: float,
        dt: float,
        rng: np.random.Generator,
    ) -> None:
        self.route, self.rng, self.dt = route, rng, dt
        self.spacing = float(route.s[1] - route.s[0])
        self._limit = speed_limits(route, pace)
        self._stops = list(stops)
        self._stood = 0.0
        self._wander, self._decay = wander, np.exp(-dt / wander_time)
        self._offset = wander * float(rng.standard_normal())
        self._row = 0
        self._window = int(_SEARCH / self.spacing) + 1

    @property
    def progress(self) -> float:
        """Distance along the route (m)."""
        return float(self.route.s[self._row])

    @property
    def finished(self) -> bool:
        """Every stop has been stood through."""
        return not self._stops

    def command(
        self, x: float, y: float, heading: float, speed: float, standing: bool
    ) -> tuple[float, float]:
        """Speed (m/s) and turn rate (rad/s) for a walker at (x, y) with commanded heading and speed.

        Raises
        ------
        StrayError
            More than 1.5 m off the route.
        """
        route, row = self.route, self._row
        rows = slice(row, row + self._window)
        distance2 = (route.x[rows] - x) ** 2 + (route.y[rows] - y) ** 2
        nearest = int(np.argmin(distance2))
        self._row = row + nearest
        stray = float(np.sqrt(distance2[nearest]))
        if stray > STRAY_LIMIT:
            raise StrayError(f"the walker strayed {stray:.1f} m off its path at {self.progress:.0f} m")
        self._offset = self._decay * self._offset + self._wander * np.sqrt(1 - self._decay**2) * float(
            self.rng.standard_normal()
        )
        ahead = round((_LOOK_AHEAD + _LOOK_AHEAD_S * speed) / self.spacing)
        aim = self._row + ahead
        last = len(route.s) - 1
        beyond = max(0, aim - last) * self.spacing  # straight on after the route's end
        aim = min(aim, last)
        direction = route.heading[aim]
        aim_x = route.x[aim] + beyond * np.cos(direction) - self._offset * np.sin(direction)
        aim_y = route.y[aim] + beyond * np.sin(direction) + self._offset * np.cos(direction)
        bearing = float(wrap(np.arctan2(aim_y - y, aim_x - x) - heading))
        turn = float(np.clip(_BEARING_GAIN * bearing, -TURN_LIMIT, TURN_LIMIT))
        return self._speed(standing), turn

    def _speed(self, standing: bool) -> float:
        wanted = float(self._limit[self._row])
        if not self._stops:
            return wanted
        stop = self._stops[0]
        left = stop.distance - self.progress
        allowed = np.sqrt(2 * SLOWING * max(left, 0.0))
        if allowed > 0.35:
            return min(wanted, float(allowed))
        if standing:
            self._stood += self.dt
            if self._stood >= stop.duration:
                self._stops.pop(0)
                self._stood = 0.0
        return 0.0
