"""One foot's strides from its IMU alone: the same reading of a simulated foot and of a real one.

How the sensor sits on the foot, when the foot is on the ground and where it goes is found from the signals:
whatever this gets wrong it gets wrong on both sides of a comparison. Axes, rates and forces are the foot's: x
forward, y left, z up when it stands flat.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from scipy.integrate import cumulative_trapezoid, trapezoid
from scipy.interpolate import CubicSpline
from scipy.signal import butter, sosfiltfilt
from scipy.spatial.transform import Rotation

from footfall.conventions import GRAVITY
from footfall.errors import InputError
from footfall.pdr.stance import StanceParams, ThresholdDetector, find_stances
from footfall.pdr.strapdown import integrate
from footfall.recording import Recording

RATE_HZ = 200.0
BANDWIDTH_HZ = 50.0
REST_S = 1.0  # at the start of every recording
STRAIGHT_RAD = np.radians(10.0)  # a stride that turns by more is none of a straight walk
N_PHASE = 200
CROSSING_PHASE = 0.72  # where in the normalised stride the pitch rate crosses zero: heel strike is near 0
SEAM_PHASE = 0.36
STILL_RATE = 0.6  # rad/s
QUIET_S = 0.100
_SWING_RATE = 2.0  # rad/s, about the pitch axis
_NORMAL = (0.8, 1.25)  # of the median stride's duration: others start, stop or hesitate


@dataclass(frozen=True)
class Signals:
    """An IMU's samples at `RATE_HZ`.

    Attributes
    ----------
    gyro : (n, 3) rad/s, accel : (n, 3) m/s2, specific force
    """

    gyro: np.ndarray
    accel: np.ndarray


@dataclass(frozen=True)
class Stride:
    """One stride, from the middle of one stance to the middle of the next.

    Attributes
    ----------
    first, last : rows of the two middles
    crossing : row (not whole) at which the pitch rate changes from push-off to swing
    push_off, swing : rows of the two peaks of the pitch rate
    duration : s, from the last stride's crossing to this one's; nan where that one is missing
    turn : rad, change of the foot's heading
    step : (3,) m, displacement in the foot's frame at `first`, levelled: forward, left, up
    up : (k, 3) the vertical in the foot's frame, at rows `first`..`last`
    """

    first: int
    last: int
    crossing: float
    push_off: int
    swing: int
    duration: float
    turn: float
    step: np.ndarray
    up: np.ndarray


@dataclass(frozen=True)
class Foot:
    """A foot's signals in its own axes (x forward, y left, z up when flat; a right foot) and its strides.

    `strides` are the steady ones: straight, of ordinary duration, neither the first nor the last of a walk.
    """

    signals: Signals
    strides: tuple[Stride, ...]


def matched(recording: Recording, bandwidth_hz: float = BANDWIDTH_HZ) -> Signals:
    """Samples of any rate, brought to one bandwidth and one rate.

    A second-order Butterworth low-pass forwards and backwards (no delay; -3 dB at `bandwidth_hz` in all) at
    the recording's own rate, then a spline onto the common grid.

    Parameters
    ----------
    recording : dropped samples are bridged by a straight line
    bandwidth_hz : Hz; where the recording has less, nothing is filtered
    """
    t, interval = recording.t, recording.interval
    even = np.arange(t[0], t[-1], interval)
    values = np.hstack([recording.gyro, recording.accel])
    values = np.column_stack([np.interp(even, t, column) for column in values.T])
    if bandwidth_hz < 0.5 / interval:
        # Two passes halve the power at `bandwidth_hz` if one takes 1.5 dB there: its own corner lies higher.
        # The digital filter is the analog one on frequencies tan(pi f T) (bilinear transform).
        analog = np.tan(np.pi * bandwidth_hz * interval) / (np.sqrt(2) - 1) ** 0.25
        corner = np.arctan(analog) / (np.pi * interval)
        values = sosfiltfilt(butter(2, corner, fs=1 / interval, output="sos"), values, axis=0)
    grid = np.arange(even[0], even[-1], 1 / RATE_HZ)
    values = CubicSpline(even, values)(grid)
    return Signals(values[:, :3], values[:, 3:])


def middles(signals: Signals) -> np.ndarray:
    """(m,) rows: the quietest instant of each stance."""
    t = np.arange(len(signals.gyro)) / RATE_HZ
    found = find_stances(t, ThresholdDetector()(t, signals.gyro, signals.accel), StanceParams())
    return found.resets[found.footfalls]


def aligned(signals: Signals) -> Signals:
    """Turn the sensor's axes into the foot's.

    Up is the mean specific force at mid-stance, when the sole is flat. The pitch axis is the horizontal
    direction of the largest rates (first principal component). It points left where the toes turn down, at
    push-off, further than up before the landing. The static bias of the first second is taken off the gyro.

    Raises
    ------
    InputError
        There are too few stances for a walk.
    """
    rows = middles(signals)
    if len(rows) < 4:
        raise InputError(f"{len(rows)} stances found, expected a walk", "recording")
    gyro = signals.gyro - signals.gyro[: int(REST_S * RATE_HZ)].mean(axis=0)
    half = int(QUIET_S / 2 * RATE_HZ)
    up = np.mean([signals.accel[row - half : row + half + 1].mean(axis=0) for row in rows[1:-1]], axis=0)
    up /= np.linalg.norm(up)
    level = gyro - np.outer(gyro @ up, up)
    left = np.linalg.eigh(level.T @ level)[1][:, -1]
    left -= (left @ up) * up
    left /= np.linalg.norm(left)
    pitch = gyro @ left
    turned = [np.cumsum(pitch[a:b]) for a, b in pairwise(rows)]
    if np.median([angle.max() + angle.min() for angle in turned]) < 0:
        left = -left
    axes = np.array([np.cross(left, up), left, up])
    return Signals(gyro @ axes.T, signals.accel @ axes.T)


def mirrored(signals: Signals) -> Signals:
    """A left foot's signals as a right foot's: rates are mirrored as axial vectors, forces as polar ones."""
    return Signals(signals.gyro * [-1, 1, -1], signals.accel * [1, -1, 1])


def swings(signals: Signals, first: int, last: int) -> bool:
    """A stride, with a push-off before its swing, and not a shuffle before a stop."""
    pitch = signals.gyro[first : last + 1, 1]
    swing = int(np.argmin(pitch))
    return bool(pitch[swing] < -_SWING_RATE and pitch[: swing + 1].max() > _SWING_RATE)


def stride_of(signals: Signals, first: int, last: int) -> Stride:
    """Read one stride between two middles of stance.

    Its attitude is the gyro's, relative to the start; the mean specific force over a stride that begins and
    ends at rest says which way is up. The displacement is de-drifted linearly in the velocity.
    """
    gyro, accel = signals.gyro[first : last + 1], signals.accel[first : last + 1]
    pitch = gyro[:, 1]
    swing = int(np.argmin(pitch))
    push_off = int(np.argmax(pitch[: swing + 1]))
    before = push_off + int(np.flatnonzero(pitch[push_off : swing + 1] > 0)[-1])
    crossing = first + before + pitch[before] / (pitch[before] - pitch[before + 1])

    t = np.arange(len(gyro)) / RATE_HZ
    # A sample of a resampled signal is an instant's value; strapdown wants means over intervals.
    rate = np.concatenate([gyro[:1], (gyro[1:] + gyro[:-1]) / 2])
    since = Rotation.from_quat(integrate(t, rate, accel).quaternion, scalar_first=True)
    force = since.apply(accel)
    up = trapezoid(force, axis=0)
    up /= np.linalg.norm(up)
    forward = np.array([1.0, 0, 0]) - up[0] * up
    forward /= np.linalg.norm(forward)
    level = np.array([forward, np.cross(up, forward), up])
    velocity = cumulative_trapezoid(force - GRAVITY * up, t, axis=0, initial=0)
    velocity -= np.outer(t / t[-1], velocity[-1])
    ahead = level @ since[-1].apply([1.0, 0, 0])
    return Stride(
        first=first,
        last=last,
        crossing=crossing,
        push_off=first + push_off,
        swing=first + swing,
        duration=np.nan,
        turn=float(np.arctan2(ahead[1], ahead[0])),
        step=level @ trapezoid(velocity, t, axis=0),
        up=since.inv().apply(up),
    )


def read_foot(recording: Recording, bandwidth_hz: float = BANDWIDTH_HZ, *, left: bool = False) -> Foot:
    """The steady strides in a recording of a foot-mounted IMU that begins at rest, however it is mounted.

    Parameters
    ----------
    bandwidth_hz : Hz, of the low-pass by which recordings are made alike (`matched`)
    left : the foot is a left one, and is mirrored

    Raises
    ------
    InputError
        There are too few stances for a walk, or fewer than two steady strides.
    """
    return strides_of(matched(recording, bandwidth_hz), left=left)


def strides_of(signals: Signals, *, left: bool = False) -> Foot:
    """As `read_foot`, of signals that are matched."""
    signals = aligned(signals)
    if left:
        signals = mirrored(signals)
    rows = middles(signals)
    found = [stride_of(signals, a, b) for a, b in pairwise(rows) if swings(signals, a, b)]
    times = np.diff([stride.crossing for stride in found]) / RATE_HZ
    found = [replace(stride, duration=float(time)) for stride, time in zip(found[1:], times, strict=True)]
    usual = np.median(times)
    steady = [
        stride
        for stride in found[1:-1]
        if abs(stride.turn) < STRAIGHT_RAD and _NORMAL[0] < stride.duration / usual < _NORMAL[1]
    ]
    if len(steady) < 2:
        raise InputError(
            f"{len(rows)} stances but {len(steady)} steady, straight strides, expected 2 or more", "recording"
        )
    return Foot(signals, tuple(steady))


def normalised(foot: Foot) -> np.ndarray:
    """(strides, N_PHASE, 8) gyro x, y, z and norm (rad/s), accel x, y, z and norm (m/s2) over the stride.

    A stride is laid so that its crossing lies at `CROSSING_PHASE`, and stretched linearly by its duration. It
    begins and ends at `SEAM_PHASE`, in the middle of the stance, where nothing happens.
    """
    gyro, accel = foot.signals.gyro, foot.signals.accel
    norms = (np.linalg.norm(values, axis=1)[:, None] for values in (gyro, accel))
    columns = np.hstack([gyro, next(norms), accel, next(norms)]).T
    rows, phase = np.arange(len(gyro)), np.arange(N_PHASE) / N_PHASE
    phase += phase < SEAM_PHASE  # what is shown before the seam comes after the swing
    out = []
    for stride in foot.strides:
        at = stride.crossing + (phase - CROSSING_PHASE) * stride.duration * RATE_HZ
        out.append(np.column_stack([np.interp(at, rows, column) for column in columns]))
    return np.array(out)
