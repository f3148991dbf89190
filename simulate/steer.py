"""Steering along a route by pure pursuit, with the slow wander of people."""

from __future__ import annotations

import numpy as np

from footfall.conventions import wrap
from footfall.errors import InputError
from footfall.simulate.route import Route
from footfall.simulate.walkers import CONTROL_INTERVAL

LOOK_AHEAD = 1.6  # m
TURN_LIMIT = 0.7  # rad/s
CORNER_SPEED = 1.0  # m/s while turning faster than _SHARP_TURN
_SHARP_TURN = 0.35  # rad/s
_BEARING_GAIN = 1.5  # 1/s
_SEARCH = 2.0  # m of route that one control step may advance at the most
STRAY_LIMIT = 1.5  # m off the route: a stumble


class StrayError(InputError):
    """The walker left its route."""


class Pursuit:
    """Follow `route` at `pace`; `progress` is where along it the walker is.

    Parameters
    ----------
    pace : m/s on straights
    wander : m, standard deviation of the slow lateral wander of the aim
    wander_time : s, its time constant (first-order Gauss-Markov)
    rng : the wander's
    """

    def __init__(
        self, route: Route, pace: float, wander: float, wander_time: float, rng: np.random.Generator
    ) -> None:
        self.route, self.pace, self.rng = route, pace, rng
        self.spacing = float(route.s[1] - route.s[0])
        self._wander, self._decay = wander, np.exp(-CONTROL_INTERVAL / wander_time)
        self._offset = wander * float(rng.standard_normal())
        self._row = 0
        self._window = int(_SEARCH / self.spacing) + 1
        self._ahead = round(LOOK_AHEAD / self.spacing)

    @property
    def progress(self) -> float:
        """Distance along the route (m)."""
        return float(self.route.s[self._row])

    @property
    def finished(self) -> bool:
        """The walker has no more route to look ahead to."""
        return self._row + self._ahead >= len(self.route.s) - 1

    def command(self, x: float, y: float, heading: float) -> tuple[float, float]:
        """Speed (m/s) and turn rate (rad/s) for a walker at (x, y) with commanded heading.

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
        aim = min(self._row + self._ahead, len(route.s) - 1)
        aim_x = route.x[aim] - self._offset * np.sin(route.heading[aim])
        aim_y = route.y[aim] + self._offset * np.cos(route.heading[aim])
        bearing = float(wrap(np.arctan2(aim_y - y, aim_x - x) - heading))
        turn = float(np.clip(_BEARING_GAIN * bearing, -TURN_LIMIT, TURN_LIMIT))
        # Slow down before a corner, not in it.
        curvature = np.abs(route.curvature[self._row : aim + 1]).max()
        speed = min(self.pace, CORNER_SPEED) if curvature * self.pace > _SHARP_TURN else self.pace
        return speed, turn
