"""From a recording to footfalls by the error-state filter, stance by stance, open to heading corrections."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from footfall.conventions import wrap
from footfall.errors import InputError
from footfall.late import late
from footfall.pdr.filter.ins import (
    MOVING,
    ZERO_RATE,
    ZERO_VELOCITY,
    Alignment,
    FilterSettings,
    InertialFilter,
    about_vertical,
)
from footfall.pdr.filter.smooth import Node, smoothed
from footfall.pdr.filter.states import States
from footfall.pdr.footfalls import Footfalls
from footfall.pdr.reckoning import Detected, PdrParams, StartPose, detect, level_attitude
from footfall.pdr.stance import compact
from footfall.recording import Recording
from footfall.runs import runs

strapdown = late("footfall.pdr._kernels")

STRIDES = 10  # whose mean is the vertical; the look ahead of a filter that is not causal in them


@dataclass(frozen=True)
class Step:
    """A footfall as the filter sees it, after its zero-velocity update.

    Attributes
    ----------
    index : of the footfall; 0 is the still start, the corrector is asked from 1 on
    t : s
    heading : rad, unwrapped, of the IMU's x axis
    stride_time : s since the footfall before
    still_time : s that the foot is at rest around this footfall
    position : (3,) m
    stride : (3,) m, displacement from the footfall before, as that was after its correction
    heading_sd : rad, the filter's standard deviation of `heading`
    covariance : (states, states) of delta = truth - estimate, ordered by `FilterSettings.layout`; read-only
    temperature : degC, that the IMU reports at this footfall; None where it reports none
    """

    index: int
    t: float
    heading: float
    stride_time: float
    still_time: float
    position: np.ndarray
    stride: np.ndarray
    heading_sd: float
    covariance: np.ndarray
    temperature: float | None = None


class Corrector(Protocol):
    """A heading method: asked once a footfall, in order.

    Returns the innovation (rad, truth - estimate: what to add to the heading) and its standard deviation
    (rad), or None where it knows nothing. A corrector that has a method `applied(turned)` is told after each
    correction by how much (rad) it turned the filter's heading, to turn by the same what it remembers.
    """

    def __call__(self, step: Step) -> tuple[float, float] | None: ...


@dataclass(frozen=True)
class Filtered:
    """What the filter makes of a recording.

    Attributes
    ----------
    footfalls : with the filter's positions and headings, corrections included
    accel_bias, gyro_bias : (n, 3) m/s2, rad/s, body, at each footfall
    heading_sd : (n,) rad
    innovation : (n,) rad, what the corrector said; NaN where it said nothing
    """

    footfalls: Footfalls
    accel_bias: np.ndarray
    gyro_bias: np.ndarray
    heading_sd: np.ndarray
    innovation: np.ndarray


def align(
    recording: Recording,
    found: Detected,
    start: StartPose,
    tilt_gain: float = PdrParams.tilt_gain,
    strides: int = STRIDES,
) -> Alignment:
    """Level by the mean force at rest, heading as given, gyro bias as measured.

    tilt_gain, strides : of `walking_vertical`
    """
    rest = found.rest
    return Alignment(
        t=float(recording.t[rest.last]),
        quaternion=about_vertical(level_attitude(rest.force), start.heading),
        gyro_bias=rest.gyro_bias,
        force=rest.force,
        position=start.position,
        vertical=walking_vertical(recording, found, tilt_gain, strides),
    )


def walking_vertical(
    recording: Recording, found: Detected, tilt_gain: float, strides: int = STRIDES
) -> np.ndarray:
    """(3,) mean direction of the vertical in the body over the first `strides`, from dead reckoning.

    A bias turns the heading by its part along this direction, and tilts the foot by the rest of it. So zero
    velocity, which sees tilt, sees the rest only. So many strides are looked at before the filter sets out.
    """
    rest, places = found.rest, found.stances.footfalls
    ends = places[:-1][:strides] + 1  # strides only, not what lies between the resets of a still period
    resets = found.stances.resets[: ends[-1] + 1]
    rows = slice(0, resets[-1] + 1)
    samples = (compact(column[rows]) for column in (recording.t, recording.gyro, recording.accel))
    _, _, sums = strapdown.reckon(*samples, rest.gyro_bias, level_attitude(rest.force), resets, tilt_gain)
    vertical = sums[ends, :3].sum(axis=0)
    return np.asarray(vertical / np.linalg.norm(vertical))


def run_filter(
    recording: Recording,
    settings: FilterSettings | None = None,
    pdr: PdrParams | None = None,
    start: StartPose | None = None,
    corrector: Corrector | None = None,
    *,
    found: Detected | None = None,
    smooth: bool = False,
) -> Filtered:
    """Filter a recording that begins at rest.

    Parameters
    ----------
    pdr : still start, stances and detector; `tilt_gain` serves to find `walking_vertical`
    start : where the IMU rests before the walk, `found.rest.last`; what it does from there on is filtered
    corrector : a heading method, asked at every footfall after footfall 0
    found : what `detect` found, where it is known already
    smooth : run back over the record too (Rauch, Tung, Striebel); needs one update a stance

    Raises
    ------
    InputError
        No rest at the start, no stride after it, a hole in the samples that is too long, or smoothing of
        per-sample updates.
    """
    settings, pdr, start = settings or FilterSettings(), pdr or PdrParams(), start or StartPose()
    by_stance = settings.update == "stance"
    if smooth and not by_stance:
        raise InputError('filter: smoothing needs update = "stance", one update a stance')
    found = found or detect(recording, pdr)
    stances, resets = found.stances, found.stances.resets
    update = updates(recording.t, found, None if by_stance else 2 * pdr.stance.reset_s)
    now = InertialFilter(settings, align(recording, found, start, pdr.tilt_gain))
    if corrector is None and not smooth:
        first, footfalls = found.rest.last + 1, resets[stances.footfalls]
        rows = slice(first, footfalls[-1] + 1)
        states = _advance(now, recording, rows, update, stops=footfalls - first)
        return _filtered(states, start, np.full(len(footfalls), np.nan))
    return _filtered(*_step_by_step(now, recording, found, update, corrector, smooth, start))


def _step_by_step(
    now: InertialFilter,
    recording: Recording,
    found: Detected,
    update: np.ndarray,
    corrector: Corrector | None,
    smooth: bool,
    start: StartPose,
) -> tuple[States, StartPose, np.ndarray]:
    """Footfall by footfall, with a heading method or smoothed; returns what `_filtered` takes."""
    resets, places = found.stances.resets, found.stances.footfalls
    still_time = _still_time(recording.t, found.score, resets[places])
    kept: list[States] = []
    nodes = [Node.first(now)] if smooth else []  # one a reset; the first is the rest
    heading, innovation = start.heading, np.full(len(places), np.nan)
    applied = getattr(corrector, "applied", lambda turned: None)
    for i, row in enumerate(resets[places]):
        for reset in range(places[i - 1] + 1 if i else 1, places[i] + 1):
            rows = slice(resets[reset - 1] + 1, resets[reset] + 1)
            if smooth:
                nodes.append(_node(now, recording, rows, update))
            else:
                _advance(now, recording, rows, update)
        heading += float(wrap(now.heading - heading))
        if i > 0 and corrector is not None:
            said = corrector(_step(i, now, kept[-1], heading, still_time[i], recording, row))
            if said is not None:
                innovation[i] = said[0]
                put_right = now.correct_heading(*said)
                turned = float(wrap(now.heading - heading))
                heading += turned
                applied(turned)
                if smooth:
                    nodes[-1] = nodes[-1].with_also(put_right, now)
        kept.append(now.state())
    if smooth:
        after = smoothed(nodes)
        kept = [after[k].state() for k in places]
    return States.joined(kept), start, innovation


def _step(
    index: int,
    now: InertialFilter,
    before: States,
    heading: float,
    still_time: float,
    recording: Recording,
    row: int,
) -> Step:
    """What a corrector is told; `before` is the footfall before, as corrected."""
    covariance = now.covariance
    covariance.setflags(write=False)
    warmth = recording.temperature
    return Step(
        index=index,
        t=now.t,
        heading=heading,
        stride_time=now.t - float(before.t[0]),
        still_time=float(still_time),
        position=now.position,
        stride=now.position - before.position[0],
        heading_sd=now.heading_sd,
        covariance=covariance,
        temperature=None if warmth is None else float(warmth[row]),
    )


def run_filters(
    recordings: Sequence[Recording],
    settings: FilterSettings | None = None,
    pdr: PdrParams | None = None,
    starts: Sequence[StartPose] | None = None,
    *,
    threads: int | None = None,
) -> list[Filtered]:
    """`run_filter` of many recordings at once, in order: the compiled part runs beside Python's lock.

    Parameters
    ----------
    starts : one for each recording
    threads : at once (default: what Python finds fit)
    """
    starts = [StartPose()] * len(recordings) if starts is None else starts
    if len(starts) != len(recordings):
        raise InputError(f"filter: {len(recordings)} recordings, but {len(starts)} starts")
    with ThreadPoolExecutor(threads) as pool:
        return list(pool.map(lambda one, at: run_filter(one, settings, pdr, at), recordings, starts))


def _advance(
    now: InertialFilter,
    recording: Recording,
    rows: slice,
    update: np.ndarray,
    stops: Sequence[int] | np.ndarray = (),
) -> States:
    """Advance to the end of `rows`."""
    return now.advance(
        recording.t[rows], recording.gyro[rows], recording.accel[rows], update[rows], stops=stops
    )


def _node(now: InertialFilter, recording: Recording, rows: slice, update: np.ndarray) -> Node:
    """Advance to the end of `rows`, where an update is, and keep what smoothing needs."""
    transition = np.eye(now.settings.states)
    moving = np.full(rows.stop - rows.start, MOVING)
    now.advance(recording.t[rows], recording.gyro[rows], recording.accel[rows], moving, transition)
    before = now.covariance
    put_right = now.rest(int(update[rows.stop - 1]))
    return Node(now.snapshot(), before, transition, put_right)


def updates(t: np.ndarray, found: Detected, still_period_s: float | None) -> np.ndarray:
    """(n,) update of each sample: at the resets, or at all still samples, rate too in a `still_period_s`."""
    update = np.full(len(t), MOVING)
    if still_period_s is None:
        count = np.diff(found.stances.footfalls, prepend=-1)
        one_a_stance = np.repeat(count == 1, count)
        resets = found.stances.resets[: len(one_a_stance)]
        update[resets] = np.where(one_a_stance, ZERO_VELOCITY, ZERO_RATE)
    else:
        for start, stop in runs(found.score < 1.0):
            long = t[stop - 1] - t[start] > still_period_s
            update[start:stop] = ZERO_RATE if long else ZERO_VELOCITY
    return update


def _still_time(t: np.ndarray, score: np.ndarray, footfalls: np.ndarray) -> np.ndarray:
    """(k,) s that the foot is at rest around each of the samples `footfalls`; by their `score` (n,)."""
    found = runs(score < 1.0)
    start, stop = found[np.maximum(np.searchsorted(found[:, 0], footfalls, side="right") - 1, 0)].T
    return t[stop - 1] - t[start]


def _filtered(states: States, start: StartPose, innovation: np.ndarray) -> Filtered:
    heading = np.unwrap([start.heading, *states.heading])[1:]
    return Filtered(
        footfalls=Footfalls.at(states.t, states.position, heading),
        accel_bias=states.accel_bias,
        gyro_bias=states.gyro_bias,
        heading_sd=states.heading_sd,
        innovation=innovation,
    )
