"""Error-state filter of a foot-mounted IMU: strapdown, zero-velocity updates, and what else is observed.

The framework of Foxlin (2005) as Deng et al. (2018) write it down (section 2, "IEZ"): the filter estimates
the errors of the strapdown, delta = truth - estimate, and puts them right at once.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from footfall.conventions import GRAVITY
from footfall.errors import InputError
from footfall.late import late
from footfall.pdr.filter.layout import (
    ACCEL_BIAS,
    ATTITUDE,
    G_SENSITIVITY,
    GYRO_BIAS,
    STATE,
    STATES,
    Measurement,
    error_slices,
)
from footfall.pdr.filter.states import States, heading
from footfall.pdr.stance import compact
from footfall.pdr.strapdown import ORIGIN
from footfall.settings import require, setting

kernels = late("footfall.pdr.filter._kernels")

MOVING, ZERO_VELOCITY, ZERO_RATE = 0, 1, 2


@dataclass(frozen=True)
class FilterSettings:
    """What the filter believes and which errors it estimates.

    The default is what walking feet allow: one update a stance, which leaves the heading to the gyro.
    `paper()` is the filter of the paper.

    Attributes
    ----------
    update : "stance": zero velocity once a stance, at its quietest instant (and every `StanceParams.reset_s`
        while standing still); "sample": at every sample that the detector calls still, as in the paper
    sigma_velocity : m/s, of the zero velocity. A sole rolls: the foot moves alike at every stance when it is
        called still, and what is granted less than this passes for a gyro bias (docs/iez.md)
    velocity_turns : True lets zero velocity correct the heading and the gyro bias about the vertical, as in
        the paper. A bias b turns a stride of length L sideways by b L, so that every velocity which a foot
        has to the side when it is called still passes for a bias. False leaves them what they are, and the
        gain is that of a filter that knows them: else their growing variance would be put into the tilt.
        The vertical is that of `Alignment.vertical`, one direction of the body for the whole walk
    accel_noise, gyro_noise : m/s2/sqrt(Hz), rad/s/sqrt(Hz), of the samples; far above a data sheet's, because
        the shocks of walking meet scale factors and finite bandwidth
    accel_bias_walk, gyro_bias_walk : m/s2/sqrt(s), rad/s/sqrt(s), growth of the biases
    tilt_sd, heading_sd : rad, at the start; what the accelerometers' biases add to the tilt is added
    accel_bias_sd, gyro_bias_sd : m/s2, rad/s, at the start
    estimate_accel_bias, estimate_gyro_bias : False freezes the bias at what the start said
    zaru : zero angular rate at the updates of a still period; never in a stride's stance, which turns
    sigma_rate : rad/s, of the zero rate
    g_sensitivity : estimate the gyro's g-sensitivity too, nine more states (Bancroft and Lachapelle 2012)
    g_sensitivity_sd : rad/s per m/s2, of each of them at the start
    gap_s : s, a longer interval between samples is a gap: its sample is held over it, as if force and rate
        deviated from it by `gap_accel` (m/s2) and `gap_gyro` (rad/s) all the time
    """

    update: Literal["stance", "sample"] = "stance"
    sigma_velocity: float = setting(0.05, unit="m/s", gt=0)
    velocity_turns: bool = False
    accel_noise: float = setting(0.03, unit="m/s2/sqrt(Hz)", ge=0)
    gyro_noise: float = setting(0.002, unit="rad/s/sqrt(Hz)", ge=0)
    accel_bias_walk: float = setting(1e-4, unit="m/s2/sqrt(s)", ge=0)
    gyro_bias_walk: float = setting(1e-5, unit="rad/s/sqrt(s)", ge=0)
    tilt_sd: float = setting(math.radians(0.1), unit="rad", ge=0)
    heading_sd: float = setting(0.0, unit="rad", ge=0)
    accel_bias_sd: float = setting(0.05, unit="m/s2", ge=0)
    gyro_bias_sd: float = setting(math.radians(0.1), unit="rad/s", ge=0)
    estimate_accel_bias: bool = True
    estimate_gyro_bias: bool = True
    zaru: bool = False
    sigma_rate: float = setting(math.radians(0.5), unit="rad/s", gt=0)
    g_sensitivity: bool = False
    g_sensitivity_sd: float = setting(math.radians(0.1) / GRAVITY, unit="rad/s/(m/s2)", ge=0)
    gap_s: float = setting(0.05, unit="s", ge=0)
    gap_accel: float = setting(10.0, unit="m/s2", ge=0)
    gap_gyro: float = setting(3.0, unit="rad/s", ge=0)

    def __post_init__(self) -> None:
        if self.update not in ("stance", "sample"):
            raise InputError(f'filter: update = {self.update!r}, expected "stance" or "sample"')
        require("filter", self)  # no sigma of 0: nothing is known exactly
        for name in ("zaru", "g_sensitivity"):
            if getattr(self, name) and not self.estimate_gyro_bias:
                raise InputError(f"filter: {name} needs estimate_gyro_bias, which is off")

    @classmethod
    def paper(cls) -> FilterSettings:
        """The paper's filter: zero velocity at every still sample, biases free (Deng et al., section 2.2).

        The paper states no noise. These are the constants in use with it (OpenShoe, at 250 Hz): 0.5 m/s2 and
        0.5 deg/s per sample, 0.01 m/s, and at the start 0.1 deg, 0.3 m/s2 and 0.3 deg/s.
        """
        per_sample = 1 / math.sqrt(250.0)
        return cls(
            update="sample",
            sigma_velocity=0.01,
            velocity_turns=True,
            accel_noise=0.5 * per_sample,
            gyro_noise=math.radians(0.5) * per_sample,
            accel_bias_sd=0.3,
            gyro_bias_sd=math.radians(0.3),
        )

    @property
    def layout(self) -> Mapping[str, slice]:
        """Where each estimated error stands in the error state and its covariance."""
        return error_slices(self.g_sensitivity)

    @property
    def states(self) -> int:
        """Length of the error state."""
        return max(part.stop for part in self.layout.values())


@dataclass(frozen=True)
class Alignment:
    """What is known before the first sample.

    Attributes
    ----------
    t : s, the stamp that the state belongs to
    quaternion : (4,) body to world, scalar first
    gyro_bias : (3,) rad/s, measured at rest
    force : (3,) m/s2, measured at rest
    position : m
    vertical : (3,) direction of the body that is vertical in the mean over a stride; None: that of the rest,
        which needs no look ahead
    """

    t: float
    quaternion: np.ndarray
    gyro_bias: np.ndarray
    force: np.ndarray
    position: tuple[float, float, float] = ORIGIN
    vertical: np.ndarray | None = None

    @property
    def up(self) -> tuple[float, float, float]:
        """`vertical` as a unit vector, that of the rest where nobody told another."""
        vector = self.force if self.vertical is None else self.vertical
        x, y, z = (np.asarray(vector, dtype=float) / np.linalg.norm(vector)).tolist()
        return x, y, z


class InertialFilter:
    """Strapdown and error-state Kalman filter that take samples as they come.

    Splitting the samples between calls changes nothing. Covariances are kept of the present only.

    Parameters
    ----------
    settings : what it believes
    start : at rest; everything is counted from there
    """

    def __init__(self, settings: FilterSettings, start: Alignment) -> None:
        self.settings = settings
        self.t = float(start.t)
        self._x = np.zeros(STATES)
        for name in ("quaternion", "position", "gyro_bias"):
            self._x[STATE[name]] = getattr(start, name)
        self._p = initial_covariance(settings, start)
        self._noise = np.square(
            [
                settings.accel_noise,
                settings.gyro_noise,
                settings.accel_bias_walk if settings.estimate_accel_bias else 0.0,
                settings.gyro_bias_walk if settings.estimate_gyro_bias else 0.0,
            ]
        )
        self._sample = np.zeros(3), np.asarray(start.force, dtype=float)
        self._up = start.up
        self._gap = np.array([settings.gap_s, settings.gap_accel, settings.gap_gyro])
        self._variances = (settings.sigma_velocity**2, settings.sigma_rate**2 if settings.zaru else 0.0)

    def advance(
        self,
        t: np.ndarray,
        gyro: np.ndarray,
        accel: np.ndarray,
        update: np.ndarray,
        transition: np.ndarray | None = None,
        stops: Sequence[int] | np.ndarray = (),
    ) -> States:
        """Take the samples that follow.

        Parameters
        ----------
        t : (n,) s, increasing, after `self.t`; a sample is the mean over the interval that its stamp ends
        gyro, accel : (n, 3) rad/s, m/s2
        update : (n,) int, what is known at the end of each sample: `MOVING` nothing, `ZERO_VELOCITY`,
            `ZERO_RATE` both (with `settings.zaru`; else the velocity alone)
        transition : (states, states) is multiplied from the left by the samples' transition; for smoothers
        stops : increasing places in t; -1 is before the first of them

        Returns
        -------
        What is known at each of `stops`, after its update.
        """
        k, before = len(stops), self.t
        states = np.empty((k, STATES)), np.empty((k, *self._p.shape))
        kernels.run(
            self._x,
            self._p,
            np.empty((0, 0)) if transition is None else transition,
            before,
            compact(t),
            compact(gyro),
            compact(accel),
            np.ascontiguousarray(update, dtype=np.int64),
            self._noise,
            self._gap,
            self._variances,
            self.settings.velocity_turns,
            self._up,
            np.array(stops, dtype=np.int64),
            *states,
        )
        if len(t):
            self.t = float(t[-1])
            self._sample = np.array(gyro[-1], dtype=float), np.array(accel[-1], dtype=float)
        return States(np.append(t, before)[np.array(stops, dtype=np.int64)], *states)

    def rest(self, update: int = ZERO_VELOCITY) -> np.ndarray:
        """Take in that the foot is at rest now, at the last sample; as `advance` does for its `update`.

        Returns
        -------
        (states,) the error that was put right.
        """
        velocity, rate = self._variances
        rate = rate if update == ZERO_RATE else 0.0
        turns = self.settings.velocity_turns
        return np.asarray(kernels.rest(self._x, self._p, *self._sample, velocity, rate, turns, self._up))

    def update(self, measurement: Measurement) -> np.ndarray:
        """Take in any measurement of the error state.

        Returns
        -------
        (states,) the error that was put right.
        """
        return np.asarray(kernels.update(self._x, self._p, measurement))

    def correct_heading(self, innovation: float, sd: float) -> np.ndarray:
        """Take in that the heading is wrong by `innovation` (rad, truth - estimate), known to `sd` (rad).

        Returns
        -------
        (states,) the error that was put right.

        Notes
        -----
        The paper's row [0 0 1] (Eq. 28) holds at zero pitch only; for a body x axis e it is
        [-e_z e_x, -e_z e_y, e_x^2 + e_y^2] / (e_x^2 + e_y^2) on the attitude error.
        """
        if not (math.isfinite(innovation) and 0 < sd < math.inf):
            raise InputError(
                f"filter: heading innovation {innovation} rad, SD {sd} rad; expected finite numbers, SD > 0"
            )
        n = self.settings.states
        return self.update(kernels.heading_off(self._x, n, float(innovation), float(sd) ** 2))

    def state(self) -> States:
        """What is known now."""
        return States(np.array([self.t]), self._x[None].copy(), self._p[None].copy())

    def snapshot(self) -> InertialFilter:
        """A copy that goes its own way."""
        copy = object.__new__(InertialFilter)
        copy.__dict__ = self.__dict__ | {"_x": self._x.copy(), "_p": self._p.copy()}
        return copy

    def moved(self, error: np.ndarray, covariance: np.ndarray) -> InertialFilter:
        """A copy with `error` (states,) put right and another covariance (states, states)."""
        copy = self.snapshot()
        kernels.inject(copy._x, error)
        copy._p = 0.5 * (covariance + covariance.T)
        return copy

    @property
    def quaternion(self) -> np.ndarray:
        """(4,) body to world, scalar first."""
        return self._x[STATE["quaternion"]].copy()

    @property
    def velocity(self) -> np.ndarray:
        """(3,) m/s, world."""
        return self._x[STATE["velocity"]].copy()

    @property
    def position(self) -> np.ndarray:
        """(3,) m, world."""
        return self._x[STATE["position"]].copy()

    @property
    def heading(self) -> float:
        """Of the IMU's x axis, rad from -pi to pi; means something at rest only."""
        return float(heading(*self._x[STATE["quaternion"]].tolist()))

    @property
    def heading_sd(self) -> float:
        """Standard deviation of the heading (rad)."""
        return math.sqrt(kernels.heading_variance(self._x, self._p))

    @property
    def accel_bias(self) -> np.ndarray:
        """(3,) m/s2, body."""
        return self._x[STATE["accel_bias"]].copy()

    @property
    def gyro_bias(self) -> np.ndarray:
        """(3,) rad/s, body."""
        return self._x[STATE["gyro_bias"]].copy()

    @property
    def g_sensitivity(self) -> np.ndarray:
        """(3, 3) rad/s per m/s2; rows gyro, columns force."""
        return self._x[STATE["g_sensitivity"]].reshape(3, 3).copy()

    @property
    def covariance(self) -> np.ndarray:
        """(states, states) of delta = truth - estimate, in the order of `FilterSettings.layout`."""
        return self._p.copy()


def initial_covariance(settings: FilterSettings, start: Alignment) -> np.ndarray:
    """Covariance (states, states) of an alignment at rest.

    Position and velocity are known. An accelerometer bias b tilts the levelled attitude by (-b_y, b_x, 0) / g
    in the navigation frame, and the gyro bias was measured together with the g-sensitivity's share of it:
    both pairs start correlated, or the first strides would be spent on finding out.
    """
    p = np.zeros((settings.states, settings.states))
    p[ATTITUDE, ATTITUDE] = np.diag([settings.tilt_sd**2, settings.tilt_sd**2, settings.heading_sd**2])
    if settings.estimate_accel_bias:
        attitude = np.array(kernels.matrix(tuple(start.quaternion))).reshape(3, 3)
        tilt = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]) @ attitude / GRAVITY
        variance = settings.accel_bias_sd**2
        p[ATTITUDE, ATTITUDE] += variance * tilt @ tilt.T
        p[ATTITUDE, ACCEL_BIAS] = variance * tilt
        p[ACCEL_BIAS, ATTITUDE] = variance * tilt.T
        p[ACCEL_BIAS, ACCEL_BIAS] = variance * np.eye(3)
    if settings.estimate_gyro_bias:
        p[GYRO_BIAS, GYRO_BIAS] = settings.gyro_bias_sd**2 * np.eye(3)
    if settings.g_sensitivity:
        variance = settings.g_sensitivity_sd**2
        share = np.kron(np.eye(3), start.force)  # rate = share @ g-sensitivity
        p[GYRO_BIAS, GYRO_BIAS] += variance * share @ share.T
        p[GYRO_BIAS, G_SENSITIVITY] = -variance * share
        p[G_SENSITIVITY, GYRO_BIAS] = -variance * share.T
        p[G_SENSITIVITY, G_SENSITIVITY] = variance * np.eye(share.shape[1])
    return p


def frozen(settings: FilterSettings) -> FilterSettings:
    """The same with both biases left as the start said: nine states."""
    return replace(
        settings, estimate_accel_bias=False, estimate_gyro_bias=False, zaru=False, g_sensitivity=False
    )


def about_vertical(quaternion: np.ndarray, turn: float) -> np.ndarray:
    """Attitude (4,) turned by `turn` (rad) about the world's vertical."""
    about = (math.cos(turn / 2), 0.0, 0.0, math.sin(turn / 2))
    return np.array(kernels.multiply(about, tuple(quaternion)))
