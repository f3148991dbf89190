"""What iez_false_bias.py measures: how a foot that is not still makes a gyro bias.

The filter is linear in what drives it. With a perfect IMU only one thing does: at every update the foot's
velocity is called zero and is not. So the foot's own velocity is told to the filter instead of zero, all but
one part of it; the bias that comes out is what that part is taken for.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from footfall.conventions import heading_of
from footfall.hdr.methods import Reckoning
from footfall.pdr.filter import _kernels as kernels
from footfall.pdr.filter._plain import PlainFilter, cross
from footfall.pdr.filter.ins import ZERO_VELOCITY, Alignment, FilterSettings, InertialFilter
from footfall.pdr.filter.layout import ATTITUDE, GYRO_BIAS, STATE, VELOCITY
from footfall.pdr.filter.run import align, run_filter, updates
from footfall.pdr.strapdown import integrate
from footfall.runs import runs

PAPER = FilterSettings.paper()


@dataclass(frozen=True)
class Motion:
    """How the foot moves, in the frame of the stride that brought it there (forward, left, up).

    Attributes
    ----------
    velocity : (n, 3) m/s
    heading : (n,) rad, of the IMU in the world; direction : (n,) rad, of the stride
    still : (n,) the detector calls it still; place : (n,) 0..1, how far into its still run
    turned : share of the still velocity's square that rate x lever explains, with the lever that fits best
    """

    velocity: np.ndarray
    heading: np.ndarray
    direction: np.ndarray
    still: np.ndarray
    place: np.ndarray
    turned: float


@dataclass(frozen=True)
class Feet:
    """A recording, reckoned; `turn` (n,) rad is the reference's heading at the footfalls, if there is one."""

    name: str
    reckoning: Reckoning
    turn: np.ndarray | None = None

    @cached_property
    def motion(self) -> Motion:
        """From strapdown between instants of zero velocity, at whose ends it is taken to zero linearly."""
        recording, found = self.reckoning.recording, self.reckoning.detected
        resets = found.stances.resets
        n = len(recording.t)
        velocity, quaternion = np.zeros((n, 3)), np.zeros((n, 4))
        quaternion[:, 0] = 1.0
        now = InertialFilter(FilterSettings(), align(recording, found, self.reckoning.start))
        rate = recording.gyro - found.rest.gyro_bias
        for a, b in pairwise(resets):
            part = slice(a, b + 1)
            gyro, accel = recording.gyro[part] - now.gyro_bias, recording.accel[part] - now.accel_bias
            path = integrate(recording.t[part], gyro, accel, quaternion=now.quaternion)
            share = (recording.t[part] - recording.t[a]) / (recording.t[b] - recording.t[a])
            velocity[part] = path.velocity - share[:, None] * path.velocity[-1]
            quaternion[part] = path.quaternion
            rows = slice(a + 1, b + 1)
            update = np.zeros(b - a, dtype=int)
            update[-1] = ZERO_VELOCITY
            now.advance(recording.t[rows], recording.gyro[rows], recording.accel[rows], update)
        score = found.score
        place = np.zeros(n)
        for start, stop in runs(score < 1.0):
            place[start:stop] = (np.arange(stop - start) + 0.5) / (stop - start)
        still = (score < 1.0) & (np.arange(n) > resets[0]) & (np.arange(n) <= resets[-1])
        direction = self._directions(n)
        body = np.einsum("nji,nj->ni", _matrices(quaternion), velocity)[still]
        turning = _crosses(rate[still]).reshape(-1, 3)
        left = body.ravel() - turning @ np.linalg.lstsq(turning, body.ravel(), rcond=None)[0]
        return Motion(
            velocity=_into(direction, velocity),
            heading=heading_of(quaternion),
            direction=direction,
            still=still,
            place=place,
            turned=float(1 - (left**2).sum() / (body**2).sum()),
        )

    def _directions(self, n: int) -> np.ndarray:
        """(n,) rad, where the stride into the nearest footfall went."""
        strides = np.diff(self.reckoning.footfalls.position[:, :2], axis=0)
        toward = np.unwrap(np.arctan2(strides[:, 1], strides[:, 0]))
        stances = self.reckoning.detected.stances
        at = stances.resets[stances.footfalls]
        nearest = np.searchsorted((at[1:] + at[:-1]) / 2, np.arange(n))
        return toward[np.clip(nearest - 1, 0, len(toward) - 1)]

    def heading_error_deg(self, settings: FilterSettings) -> tuple[float, float]:
        """Mean of the absolute heading error, and the last, against the reference or else PDR's heading."""
        r = self.reckoning
        found = run_filter(r.recording, settings, r.pdr, r.start, found=r.detected).footfalls
        reference = r.footfalls.heading if self.turn is None else self.turn
        error = np.degrees(found.heading - reference)
        error -= 360 * round(error[0] / 360)
        return float(np.abs(error).mean()), float(error[-1])

    def false_bias_deg_s(self, settings: FilterSettings) -> float:
        """The gyro bias (deg/s) that the filter's heading error comes to over the time walked."""
        t = self.reckoning.footfalls.t
        return -self.heading_error_deg(settings)[1] / (t[-1] - t[0])


def drive(
    feet: Feet, settings: FilterSettings, told: Callable[[Motion], np.ndarray], seconds: float = math.inf
) -> float:
    """Gyro bias about the vertical (deg/s) that the filter ends with when it is told a velocity.

    Parameters
    ----------
    told : the velocity (n, 3) m/s in the strides' frame that the updates say; the filter's own is all zero
    seconds : from the start of the walk on
    """
    r, motion = feet.reckoning, feet.motion
    recording, found = r.recording, r.detected
    now = InertialFilter(settings, align(recording, found, r.start))
    first = found.rest.last + 1
    update = updates(recording.t, found, 2 * r.pdr.stance.reset_s)
    velocity = told(motion)
    none = np.empty((0, 0))
    x, p = now._x, now._p
    variance = settings.sigma_velocity**2
    for k in range(first, _end(feet, seconds)):
        gyro, accel = recording.gyro[k], recording.accel[k]
        dt = recording.t[k] - recording.t[k - 1]
        kernels.propagate(x, p, none, gyro, accel, dt, now._noise, now._gap)
        if update[k]:
            # The stride's direction, as far as the filter's heading is off.
            turned = motion.direction[k] + now.heading - motion.heading[k]
            say = _back(turned, velocity[k])
            x[STATE["velocity"]] -= say
            kernels.rest(x, p, gyro, accel, variance, 0.0, settings.velocity_turns, now._up)
            x[STATE["velocity"]] += say
    return math.degrees(_vertical(now.quaternion) @ (now.gyro_bias - found.rest.gyro_bias))


def all_but(part: Callable[[Motion], np.ndarray]) -> Callable[[Motion], np.ndarray]:
    """The foot's velocity without a part of it, which is called zero."""
    return lambda motion: motion.velocity - part(motion)


def axis(which: int) -> Callable[[Motion], np.ndarray]:
    """The velocity along one axis of the stride: 0 forward, 1 left, 2 up."""
    return lambda motion: motion.velocity * np.eye(3)[which]


def third(which: int) -> Callable[[Motion], np.ndarray]:
    """The velocity in one third of each still run."""
    return lambda motion: motion.velocity * (np.minimum(3 * motion.place, 2).astype(int) == which)[:, None]


PARTS: dict[str, Callable[[Motion], np.ndarray]] = {
    "all of it": lambda motion: motion.velocity,
    "forward": axis(0),
    "sideways": axis(1),
    "upward": axis(2),
    "first third of the still time": third(0),
    "middle third": third(1),
    "last third": third(2),
}


class Without(PlainFilter):
    """The paper's filter less one of two ways from the velocity to the gyro bias about the vertical.

    A bias b turns the strides: seen from a frame that turns with it, a foot which has come the distance L
    has got the velocity b L sideways. That is P(v, b). And it turns that frame: the heading error, which
    grew with b, turns whatever velocity there is at the update. That is P(v, psi).
    """

    def __init__(self, settings: FilterSettings, start: Alignment, way: str) -> None:
        super().__init__(settings, start)
        self.way = way

    def _updated(self, h: np.ndarray, z: np.ndarray, sd: float, error: np.ndarray, turns: bool) -> np.ndarray:
        turning = cross(self.velocity)
        if self.way == "heading":
            h = h.copy()
            h[:, ATTITUDE] = turning
        if self.way == "bias":
            into, back = np.eye(len(error)), np.eye(len(error))
            into[VELOCITY, ATTITUDE], back[VELOCITY, ATTITUDE] = turning, -turning
            p = into @ self.covariance @ into.T
            bias = np.zeros(len(error))
            bias[GYRO_BIAS] = self.attitude[2]
            with_bias = p @ bias
            less = np.zeros(len(error))
            less[VELOCITY] = with_bias[VELOCITY] / (bias @ with_bias)
            without = back @ (np.eye(len(error)) - np.outer(less, bias))
            self.covariance = without @ p @ without.T
        return super()._updated(h, z, sd, error, turns)


def without(feet: Feet, way: str, seconds: float, settings: FilterSettings = PAPER) -> float:
    """False bias (deg/s) of the paper's filter without one way: "bias", "heading", or "" for none."""
    r = feet.reckoning
    recording, found = r.recording, r.detected
    now = Without(settings, align(recording, found, r.start), way)
    update = updates(recording.t, found, 2 * r.pdr.stance.reset_s)
    for k in range(found.rest.last + 1, _end(feet, seconds)):
        now.take(recording.t[k], recording.gyro[k], recording.accel[k], int(update[k]))
    return math.degrees(now.attitude[2] @ (now.gyro_bias - found.rest.gyro_bias))


def _end(feet: Feet, seconds: float) -> int:
    """The sample that ends the first `seconds` of the walk, or the walk."""
    t, resets = feet.reckoning.recording.t, feet.reckoning.detected.stances.resets
    return min(int(np.searchsorted(t, t[resets[0]] + seconds)), int(resets[-1]) + 1)


@dataclass(frozen=True)
class Coupling:
    """What the covariance makes of a gyro bias b about the vertical within one swing.

    t : (n,) s from lift-off; sideways : (n,) m, the velocity P(v, b) / P(b, b) that one rad/s of it gives, in
    the frame that turns with it; distance : (n,) m, how far the foot has come
    """

    t: np.ndarray
    sideways: np.ndarray
    distance: np.ndarray


def coupling(feet: Feet, stride: int, settings: FilterSettings = PAPER) -> Coupling:
    """The cross-covariance in a stride's swing."""
    r, motion = feet.reckoning, feet.motion
    recording, found = r.recording, r.detected
    at = found.stances.resets[found.stances.footfalls]
    moving = np.flatnonzero(~motion.still[at[stride] : at[stride + 1]]) + at[stride]
    first, last = int(moving[0]), int(moving[-1]) + 1
    update = updates(recording.t, found, 2 * r.pdr.stance.reset_s)
    now = InertialFilter(settings, align(recording, found, r.start))
    rows = slice(found.rest.last + 1, first)
    now.advance(recording.t[rows], recording.gyro[rows], recording.accel[rows], update[rows])
    sideways, distance, place, up = [], [], now.position, _vertical(now.quaternion)
    for k in range(first, last):
        one = slice(k, k + 1)
        now.advance(recording.t[one], recording.gyro[one], recording.accel[one], np.zeros(1, dtype=int))
        p = now.covariance
        turned = motion.direction[last] + now.heading - motion.heading[k]
        ahead = np.array([math.cos(turned), math.sin(turned), 0.0])
        with_bias = (p[VELOCITY] + cross(now.velocity) @ p[ATTITUDE])[:, GYRO_BIAS] @ up
        left = np.array([-ahead[1], ahead[0], 0.0])
        sideways.append(left @ with_bias / (up @ p[GYRO_BIAS, GYRO_BIAS] @ up))
        distance.append(ahead @ (now.position - place))
    t = recording.t[first:last]
    return Coupling(t - t[0], np.array(sideways), np.array(distance))


def _vertical(quaternion: np.ndarray) -> np.ndarray:
    """The vertical in the body."""
    return np.array(kernels.matrix(tuple(quaternion)))[6:9]


def _matrices(quaternion: np.ndarray) -> np.ndarray:
    w, x, y, z = quaternion.T
    return np.moveaxis(np.array(kernels.matrix((w, x, y, z))).reshape(3, 3, -1), -1, 0)


def _crosses(v: np.ndarray) -> np.ndarray:
    """[v x] (n, 3, 3)."""
    zero = np.zeros(len(v))
    x, y, z = v.T
    return np.moveaxis(np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]]), -1, 0)


def _into(direction: np.ndarray, v: np.ndarray) -> np.ndarray:
    """World vectors (n, 3) in frames turned by (n,) rad."""
    c, s = np.cos(direction), np.sin(direction)
    return np.column_stack([c * v[:, 0] + s * v[:, 1], -s * v[:, 0] + c * v[:, 1], v[:, 2]])


def _back(direction: float, v: np.ndarray) -> np.ndarray:
    c, s = math.cos(direction), math.sin(direction)
    return np.array([c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]])
