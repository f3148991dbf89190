"""Steering along a route: pure pursuit, slowing down for sharp turns, stops, and the slow wander of people.

In the units of the walker (the 1.75 m body: models.subject).
"""

from __future__ import annotations

import math

import numpy as np

from footfall.errors import InputError
from footfall.models.route import Route
from footfall.simulate.plan import Pace, Stop
from footfall.simulate.walker._posture_kernels import SLOWING_SHARE, SPEED_SLEW
from footfall.simulate.walker._steer_kernels import pursue

TURN_LIMIT = 1.0  # rad/s
SLOWING = 0.5  # m/s2, before corners
STOPPING = SLOWING_SHARE * SPEED_SLEW  # m/s2 at which a walker that is told to stop slows down
STRAY_LIMIT = 1.5  # m off the route: a stumble
_BEARING_GAIN = 1.5  # 1/s
_SEARCH = 2.0  # m of route that one control step may advance at the most
_LOOK_AHEAD, _LOOK_AHEAD_S = 0.4, 0.9  # m, and s of the present speed: 1.6 m at 1.3 m/s
# Speed (m/s) in bends by their curvature (1/m): radii of 10, 4, 2.5 and 1.5 m, and on the spot.
_BEND_CURVATURE = np.array([0.1, 0.25, 0.4, 0.67, 2.0])
_BEND_SPEED = np.array([2.0, 1.2, 1.0, 0.85, 0.6])
# People keep their pace: on straights a walker that is slower than told is told to be faster.
_PACE_KEEPING_S, _MOST_HASTE, _FASTEST = 6.0, 0.25, 1.95  # s, m/s, m/s
_LAST_STEP = 0.3  # m, walked after the wish to stop beyond what slowing down takes
_WALKING = 0.6  # m/s told; slower is starting or stopping


class StrayError(InputError):
    """The walker left its route."""


def pace_along(route: Route, pace: float, changes: tuple[Pace, ...]) -> np.ndarray:
    """(n,) m/s at each sample of the route: the first pace, and its changes in walking order."""
    speeds = np.array([pace, *(change.m_s for change in changes)])
    at = [change.at_m for change in changes]
    along: np.ndarray = speeds[np.searchsorted(at, route.s, side="right")]
    return along


def speed_limits(route: Route, pace: np.ndarray) -> np.ndarray:
    """(n,) m/s at each sample of the route: the pace there (n,), less in bends and before slower parts."""
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
    pace : m/s on straights, or (n,) at each sample of the route
    stops : where to stand and for how long, in walking order
    wander : m, standard deviation of the slow lateral wander of the aim
    wander_time : s, its time constant (first-order Gauss-Markov)
    dt : s between commands
    rng : the wander's
    """

    def __init__(
        self,
        route: Route,
        pace: float | np.ndarray,
        stops: tuple[Stop, ...],
        *,
        wander: float,
        wander_time: float,
        dt: float,
        rng: np.random.Generator,
    ) -> None:
        self.route, self.rng, self.dt = route, rng, dt
        self.spacing = float(route.s[1] - route.s[0])
        self._line = np.column_stack([route.x, route.y, route.heading])
        self._pace = np.broadcast_to(pace, route.s.shape)
        self._limit = speed_limits(route, self._pace)
        self._shortfall = 0.0  # m/s, of what is walked against what was told, slowly averaged
        self._last = (float(route.x[0]), float(route.y[0]))
        self._stops = list(stops)
        self._stood, self._stopping = 0.0, False
        self._decay = math.exp(-dt / wander_time)
        self._stir = wander * math.sqrt(1 - self._decay**2)
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

    @property
    def ending(self) -> bool:
        """The route has been walked; only the stop is left."""
        return len(self._stops) <= 1 and self._stopping

    def command(
        self, x: float, y: float, heading: float, speed: float, standing: bool
    ) -> tuple[float, float]:
        """Speed (m/s) and turn rate (rad/s) for a walker at (x, y) with commanded heading and speed.

        Raises
        ------
        StrayError
            More than 1.5 m off the route.
        """
        normal = float(self.rng.standard_normal())
        self._offset = self._decay * self._offset + self._stir * normal
        ahead = round((_LOOK_AHEAD + _LOOK_AHEAD_S * float(speed)) / self.spacing)
        self._row, stray, aim_x, aim_y = pursue(
            self._line, self.spacing, self._row, self._window, x, y, ahead, self._offset
        )
        if speed > _WALKING:
            walked = math.hypot(x - self._last[0], y - self._last[1]) / self.dt
            self._shortfall += (float(speed) - walked - self._shortfall) * self.dt / _PACE_KEEPING_S
        self._last = (float(x), float(y))
        if stray > STRAY_LIMIT:
            raise StrayError(f"the walker strayed {stray:.1f} m off its path at {self.progress:.0f} m")
        bearing = math.remainder(math.atan2(aim_y - y, aim_x - x) - heading, 2 * math.pi)
        turn = min(max(_BEARING_GAIN * bearing, -TURN_LIMIT), TURN_LIMIT)
        told = self._speed(float(speed), standing)
        return told, turn if told > 0 else 0.0  # a walker that stops turns no more

    def _speed(self, speed: float, standing: bool) -> float:
        wanted = float(self._limit[self._row])
        if wanted >= self._pace[self._row]:
            haste = min(max(self._shortfall, -_MOST_HASTE), _MOST_HASTE)
            wanted = min(wanted + haste, max(_FASTEST, wanted))
        if not self._stops:
            return wanted
        stop = self._stops[0]
        # A stop is commanded once, in good time: the walker does not creep towards a line.
        if not self._stopping and stop.at_m - self.progress > speed**2 / (2 * STOPPING) + _LAST_STEP:
            return wanted
        self._stopping = True
        if standing:
            self._stood += self.dt
            if self._stood >= stop.for_s:
                self._stops.pop(0)
                self._stood, self._stopping = 0.0, False
        return 0.0
