"""Pedestrian dead reckoning with a foot-mounted IMU (HDR paper, section 4).

Zero velocity at each footfall corrects the velocity alone, the accelerometers bound the tilt, and heading
is the gyro's own: nothing here observes it, so nothing may touch it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from footfall.conventions import BIAS_TIME, heading_of
from footfall.errors import InputError
from footfall.late import late
from footfall.pdr.attitude import quaternion_of, turned
from footfall.pdr.footfalls import Footfalls
from footfall.pdr.rest import Rest, static_bias
from footfall.pdr.stance import Detector, StanceParams, Stances, ThresholdDetector, compact, find_stances
from footfall.pdr.strapdown import ORIGIN
from footfall.pdr.strides import Strides, Sums, integrals, strides_of
from footfall.recording import Recording
from footfall.settings import require, setting

_detection, _kernels = late("footfall.pdr._detection"), late("footfall.pdr._kernels")

MIN_LEVEL = math.sin(math.radians(10.0))


@dataclass(frozen=True)
class StartPose:
    """Where the walk starts: the IMU at rest, at the last sample averaged for the static bias (`Rest.last`).

    Attributes
    ----------
    position : m
    heading : rad, of the IMU's x axis
    """

    position: tuple[float, float, float] = ORIGIN
    heading: float = 0.0

    def as_dict(self) -> dict[str, Any]:
        """For metadata."""
        return {"position_m": [float(value) for value in self.position], "heading_rad": float(self.heading)}

    @classmethod
    def of(cls, meta: Mapping[str, Any]) -> StartPose:
        """What a simulated recording's metadata say of its start; the origin and heading 0 where none do."""
        try:
            x, y, z = (float(value) for value in meta["start"]["position_m"])
            start = cls((x, y, z), float(meta["start"]["heading_rad"]))
        except (KeyError, TypeError, ValueError):
            return cls()
        return start if all(map(math.isfinite, (x, y, z, start.heading))) else cls()


@dataclass(frozen=True)
class PdrParams:
    """Dead reckoning's settings.

    Attributes
    ----------
    bias_s : s, T_bias at rest before the walk
    tilt_gain : share of the tilt error seen over a stride that is corrected at its end
    max_gap_s : s, longest hole between samples that is bridged (the next sample is held over it)
    stance : how moments of rest become stances
    detector : what rest is
    """

    bias_s: float = setting(BIAS_TIME, unit="s", gt=0)
    tilt_gain: float = setting(0.2, ge=0, le=1)
    max_gap_s: float = setting(0.25, unit="s", ge=0, le=math.inf)
    stance: StanceParams = field(default_factory=StanceParams)
    detector: Detector = field(default_factory=ThresholdDetector)

    def __post_init__(self) -> None:
        require("pdr", self)


@dataclass(frozen=True)
class Detected:
    """When the foot is at rest: what every reckoning of a recording begins with.

    Attributes
    ----------
    rest : the still start
    score : (n,) the detector's of each sample, at rest below 1
    stances : from the still start on, as indices of samples
    """

    rest: Rest
    score: np.ndarray
    stances: Stances


def level_attitude(force: np.ndarray) -> np.ndarray:
    """Attitude (4,) in which `force` points up and the body's x axis has heading 0.

    Raises
    ------
    InputError
        The x axis is within 10 degrees of vertical, so that it has no heading.
    """
    up = force / np.linalg.norm(force)
    forward = np.array([1.0, 0.0, 0.0]) - up[0] * up
    level = float(np.linalg.norm(forward))
    if level < MIN_LEVEL:
        raise InputError(
            f"at rest the IMU's x axis is {math.degrees(math.asin(level)):.1f} deg from vertical, "
            f"expected at least {math.degrees(math.asin(MIN_LEVEL)):.0f} deg, or it has no heading",
            "recording",
        )
    forward /= level
    return quaternion_of(np.array([forward, np.cross(up, forward), up]))


def dead_reckon(
    recording: Recording,
    params: PdrParams | None = None,
    start: StartPose | None = None,
    found: Detected | None = None,
) -> Footfalls:
    """Dead-reckon a recording that begins at rest.

    Parameters
    ----------
    recording : at least `params.bias_s` seconds at rest, then a walk
    start : where the IMU rests before the walk; what it does from there on is navigated
    found : what `detect` found, where it is known already

    Returns
    -------
    Footfalls
        Row 0 is footfall 0, the last reset of the still start, then one row a stance.

    Raises
    ------
    InputError
        No rest at the start, no stride after it, or a hole in the samples that is too long.

    Notes
    -----
    From one instant of zero velocity to the next, a stride of duration T:

    - attitude, velocity and position are integrated with the static bias removed (HDR Eq. 2);
    - the velocity v that is left at the end must be zero: v is taken back linearly in time, which takes
      v T / 2 from the displacement (ZUPT on the velocity only);
    - the same v says how far the attitude was tilted: the mean force over a stride that begins and ends
      at rest points up, so the tilt error is (v_y, -v_x, 0) / (g T), of which `tilt_gain` is corrected.
      The paper bounds tilt with the accelerometers during footfall; there the foot still turns and
      accelerates, which biases that tilt by a degree, while a whole stride is free of it.
    - the vertical component of every correction is zero: heading is the gyro's alone. It is read at
      footfalls only: in swing the foot pitches through the vertical, where heading means nothing.

    The raw rate is the increment of that heading over T_i, not an integral of the body's or the world's
    vertical rate, which a coning foot drives away by degrees a stride.
    """
    params, start = params or PdrParams(), start or StartPose()
    found = found or detect(recording, params)
    rest, stances, resets = found.rest, found.stances, found.stances.resets
    quaternion, position, sums = _kernels.reckon(
        compact(recording.t),
        compact(recording.gyro),
        compact(recording.accel),
        rest.gyro_bias,
        level_attitude(rest.force),
        resets,
        params.tilt_gain,
    )
    made = Sums(recording.t[resets], sums, integrals(recording.t, recording.temperature, resets))
    strides = strides_of(made, stances.footfalls, rest.force, start_temperature(recording, rest))
    at = stances.footfalls
    return placed(made.t[at], quaternion[at], position[at], start, strides)


def placed(
    t: np.ndarray, quaternion: np.ndarray, position: np.ndarray, start: StartPose, strides: Strides
) -> Footfalls:
    """Footfalls from what was reckoned from the rest at heading 0 and the origin: put where the rest was.

    Stamps (n,), attitudes (n, 4) and positions (n, 3). Between the rest and row 0 the foot may turn on the
    ground, more slowly than any detector tells from rest: row 0 is where that leaves it.
    """
    position = turned(position, start.heading) + np.asarray(start.position)
    return replace(Footfalls.at(t, position, heading_of(quaternion) + start.heading), strides=strides)


def start_temperature(recording: Recording, rest: Rest) -> float:
    """Mean temperature (degC) of the still start; NaN where the sensor reports none."""
    if recording.temperature is None:
        return math.nan
    return float(np.mean(recording.temperature[1 : rest.last + 1]))


def detect(recording: Recording, params: PdrParams, rest: Rest | None = None) -> Detected:
    """Find the still start and the stances after it.

    rest : where the walk begins, where that is known already

    Raises
    ------
    InputError
        No rest at the start, no stride after it, or a hole in the samples that is too long.
    """
    rest = rest or static_bias(recording, params.bias_s)
    score = scores(recording, rest, params.detector, still=rest.last)
    stances = _stances_after(rest, find_stances(recording.t[1:], score[1:], params.stance))
    if len(stances.footfalls) < 2:
        raise InputError(f"no stride found after the {params.bias_s:g} s at rest", "recording")
    refuse_gaps(recording.t, int(stances.resets[0]), int(stances.resets[-1]), params.max_gap_s)
    return Detected(rest=rest, score=score, stances=stances)


def scores(recording: Recording, rest: Rest, detector: Detector, still: int) -> np.ndarray:
    """(n,) the detector's scores; of row 0, which is before the record, that of row 1.

    still : rows 1 to `still` are at rest, whatever the detector thinks of them
    """
    gyro = _detection.less(compact(recording.gyro)[1:], rest.gyro_bias)
    score = np.empty(len(recording.t))
    score[1:] = detector(recording.t[1:], gyro, recording.accel[1:])
    np.minimum(score[1 : still + 1], 0.5, out=score[1 : still + 1])
    score[0] = score[1]
    return score


def _stances_after(rest: Rest, found: Stances) -> Stances:
    """Stances from the still start on: reset 0 ends its averaged part, footfall 0 is its last reset."""
    resets, footfalls = found.resets + 1, found.footfalls
    later = resets > rest.last
    skipped = int(np.count_nonzero(~later))
    resets = np.concatenate([[rest.last], resets[later]])
    # Not below 0: the foot may leave straight from the averaged part.
    footfalls = np.maximum(footfalls - skipped + 1, 0)
    return Stances(resets=resets, footfalls=footfalls)


def refuse_gaps(t: np.ndarray, first: int, last: int, max_gap_s: float) -> None:
    """Raise InputError where samples first..last are further apart than `max_gap_s`."""
    step = np.diff(t[first : last + 1])
    worst = int(np.argmax(step))
    if step[worst] > max_gap_s:
        raise InputError(
            f"no samples for {step[worst]:.3g} s after t = {t[first + worst]:.6g} s, "
            f"dead reckoning bridges at most {max_gap_s:g} s",
            "recording",
        )
