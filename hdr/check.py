"""Named checks of a method, built in or your own: what every study relies on, on feet of known truth.

The idea is that of scikit-learn's `check_estimator`. Each check is a function that raises `Failed` with one
sentence; under pytest: `@pytest.mark.parametrize(("name", "check"), checks(method))`.
"""

from __future__ import annotations

import math
import multiprocessing
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np

from footfall.conventions import wrap
from footfall.errors import InputError
from footfall.hdr.method import Method
from footfall.hdr.others import Foreign
from footfall.hdr.sound import finite_fault, heading_fault, shape_fault, time_fault
from footfall.hdr.tracks import Reckoning
from footfall.pdr.reckoning import PdrParams, StartPose
from footfall.pdr.synthetic import walk
from footfall.pdr.track import Track
from footfall.recording import Recording

START_SLACK_M, START_SLACK = 0.05, math.radians(1.0)  # of a foot that stands still
FASTEST = 3.0  # m/s, of a foot's way from stance to stance
TURN_SLACK_M, TURN_SLACK = 0.02, math.radians(0.2)  # methods amplify rounding
RATE_SLACK, RATE_TURN = 0.2, math.radians(30.0)  # share of the way; of the turn
AT = StartPose((12.0, -7.0, 1.5), 3.0)  # a start whose heading is near where wrapped ones jump


class Failed(AssertionError):
    """A method did not pass a check; the message says why, in one sentence."""


class Case(NamedTuple):
    """A recording to try a method on.

    recording : begins at rest; start : where; bias_s : T_bias, s
    """

    name: str
    recording: Recording
    start: StartPose
    bias_s: float = PdrParams().bias_s


class Result(NamedTuple):
    """What came of a check: `reason` is "" where it passed."""

    name: str
    reason: str

    @property
    def passed(self) -> bool:
        """Whether the method passed."""
        return not self.reason


Check = Callable[[], None]


def synthetic_case(seed: int = 1, rate: float = 200.0) -> Case:
    """A foot that walks straight, round a corner and round a circle to the left, then back to the right.

    It rests for 25 s; its IMU has noise, biases and a temperature.
    """
    rng = np.random.default_rng(seed)
    circle = 90.0 + 36.0 * np.arange(1, 12)
    course = np.concatenate([np.zeros(7), np.full(5, 90.0), circle, np.full(7, 430.0), np.full(5, 340.0)])
    headings = np.radians(course + rng.normal(0, 1, len(course)))
    truth = walk(headings.tolist(), rate=rate)
    bias, cold = rng.normal(0, math.radians(0.02), 3), 20 - 5 * truth.t / truth.t[-1]
    recording = truth.recording(gyro_error=bias, angle_random_walk=math.radians(0.05) / 60, seed=seed)
    meta = {"walk": f"synthetic foot, seed {seed}"}
    return Case(f"synthetic {seed}", replace(recording, temperature=cold, meta=meta), AT)


def checks(method: Method, cases: Sequence[Case] = ()) -> Iterator[tuple[str, Check]]:
    """Twelve checks by name.

    Parameters
    ----------
    method : of `footfall.hdr.methods.find_method`
    cases : further recordings to run it on
    """
    if isinstance(method.run, Foreign):
        method = replace(method, run=replace(method.run, judged=False))
    one, other = synthetic_case(1), synthetic_case(2)
    for name, check in {
        "runs": partial(_runs, method, [one, other, *cases]),
        "same input, same bytes": partial(_same_bytes, method, one, other),
        "leaves the recording alone": partial(_leaves_alone, method, one),
        "survives pickling": partial(_pickles, method, one, other),
        "starts where it is told": partial(_starts, method, one),
        "turns with its start": partial(_turns, method, one),
        "t increases inside the recording": partial(_time, method, one),
        "heading is unwrapped": partial(_unwrapped, method, one),
        "finite without temperature": partial(_finite, method, _cold(one)),
        "finite with 0.1 s lost": partial(_finite, method, _lossy(one)),
        "the same at 100 Hz": partial(_at_half_rate, method, one),
        "refuses what is too short": partial(_short, method, one),
    }.items():
        yield name, partial(_told, check)


def examine(method: Method, cases: Sequence[Case] = ()) -> Iterator[Result]:
    """Every check's result; where a method does not run, the others are not tried."""
    runs = True
    for name, check in checks(method, cases):
        if not runs:
            yield Result(name, "not tried, for it does not run")
            continue
        try:
            check()
            yield Result(name, "")
        except Failed as failed:
            runs = name != "runs"
            yield Result(name, str(failed))


def _told(check: Check) -> None:
    """An exception that a method must not raise is a failure, too."""
    try:
        check()
    except InputError as error:
        raise Failed(str(error)) from error


def _track(method: Method, case: Case, start: StartPose | None = None) -> Track:
    """A track that has the right shapes."""
    reckoning = Reckoning(case.recording, start or case.start, PdrParams(bias_s=case.bias_s))
    made = method.run(reckoning, method.params)
    if fault := shape_fault(made):
        raise Failed(f"{case.name}: returned {fault}")
    return made


def _runs(method: Method, cases: Sequence[Case]) -> None:
    for case in cases:
        try:
            _track(method, case)
        except InputError as error:
            raise Failed(f"{case.name}: {error}") from error


def _bytes(track: Track) -> bytes:
    columns = [track.t, track.position, track.heading, *track.evidence.values()]
    return b"".join(np.ascontiguousarray(column).tobytes() for column in columns)


def _same_bytes(method: Method, one: Case, other: Case) -> None:
    first, second = (_bytes(_track(method, one)) for _ in range(2))
    if first != second:
        raise Failed("two runs on the same recording differ: it draws lots or keeps something")
    _track(method, _halved(other))  # which no other check has shown it
    if _bytes(_track(method, one)) != first:
        raise Failed("its track differs after another recording: it keeps something from one to the next")


def _leaves_alone(method: Method, case: Case) -> None:
    recording = case.recording
    names = ("t", "gyro", "accel", "temperature")
    copies = {name: np.array(getattr(recording, name)) for name in names}
    open_to_all = replace(recording, meta={"walk": "of a check"}, **copies)
    for name in names:
        getattr(open_to_all, name).flags.writeable = True
    _track(method, case._replace(recording=open_to_all))
    for name in names:
        if not np.array_equal(getattr(open_to_all, name), getattr(recording, name)):
            raise Failed(f"it writes into the recording's {name}, which the next method is given")
    if open_to_all.meta != {"walk": "of a check"}:
        raise Failed("it writes into the recording's meta, which the next method is given")


def _pickles(method: Method, one: Case, other: Case) -> None:
    """In a new process, on a recording that comes first there and second here."""
    _track(method, one)
    here = _bytes(_track(method, other))
    try:
        with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
            there = pool.submit(_elsewhere, method, other).result()
    except InputError:
        raise
    except Exception as error:  # whatever pickle, a module that is not there, or a lost process raises
        reason = (str(error).strip().splitlines() or [""])[0]
        raise Failed(f"it does not reach another process: {type(error).__name__}: {reason}") from error
    if there != here:
        raise Failed("its track in another process is another one: it draws lots, or keeps something")


def _elsewhere(method: Method, case: Case) -> bytes:
    return _bytes(_track(method, case))


def _starts(method: Method, case: Case) -> None:
    made = _track(method, case)
    late = max(0.0, float(made.t[0]) - case.bias_s)
    off = float(np.linalg.norm(made.position[0] - np.array(case.start.position)))
    if off > START_SLACK_M + FASTEST * late:
        raise Failed(
            f"its first row, at t = {made.t[0]:.4g} s, is {off:.2f} m from where it is told that it rests"
        )
    turned = float(made.heading[0] - case.start.heading)
    if late < 0.5 and abs(turned) > START_SLACK:
        raise Failed(
            f"its first heading is {math.degrees(made.heading[0]):.1f} deg, "
            f"and it is told {math.degrees(case.start.heading):.1f} deg"
        )


def _turns(method: Method, case: Case) -> None:
    ahead = _track(method, case)
    heading = case.start.heading + math.pi / 2
    left = _track(method, case, replace(case.start, heading=heading))
    if not np.array_equal(ahead.t, left.t):
        raise Failed("a start turned by 90 deg changes when its rows are")
    x, y, z = (ahead.position - ahead.position[0]).T
    off = float(np.abs(left.position - left.position[0] - np.column_stack([-y, x, z])).max())
    turned = float(np.abs(wrap(left.heading - ahead.heading - math.pi / 2)).max())
    if not off <= TURN_SLACK_M:
        raise Failed(f"a start turned by 90 deg does not turn the track by 90 deg: it is off by {off:.2f} m")
    if not turned <= TURN_SLACK:
        raise Failed(
            f"a start turned by 90 deg does not turn the headings by 90 deg: they are off by "
            f"{math.degrees(turned):.1f} deg"
        )


def _time(method: Method, case: Case) -> None:
    _refuse(time_fault(_track(method, case), case.recording.t))


def _unwrapped(method: Method, case: Case) -> None:
    _refuse(heading_fault(_track(method, case)))


def _finite(method: Method, case: Case) -> None:
    _refuse(finite_fault(_track(method, case)))


def _refuse(fault: str) -> None:
    if fault:
        raise Failed(f"returned {fault}")


def _at_half_rate(method: Method, case: Case) -> None:
    slow = _halved(case)
    whole, half = _track(method, case), _track(method, slow)
    _refuse(finite_fault(half))
    way = float(np.linalg.norm(np.diff(whole.position, axis=0), axis=1).sum())
    apart = float(np.linalg.norm(half.position[-1] - whole.position[-1]))
    turned = abs(float(half.heading[-1] - whole.heading[-1]))
    if apart > RATE_SLACK * way or turned > RATE_TURN:
        raise Failed(
            f"at 100 Hz it ends {apart:.1f} m and {math.degrees(turned):.0f} deg from where it ends at 200 Hz"
        )


def _short(method: Method, case: Case) -> None:
    try:
        made = _track(method, case._replace(recording=_rows(case.recording, np.arange(2))))
    except Failed as failed:
        raise Failed(f"of a recording of two samples, expected a ValueError: {failed}") from None
    except InputError as error:
        cause = error.__cause__
        if cause is None or isinstance(cause, ValueError):
            return
        raise Failed(f"of a recording of two samples it raises {error}, expected a ValueError") from error
    raise Failed(f"it makes a track of {len(made)} rows of two samples, expected a ValueError")


def _cold(case: Case) -> Case:
    return case._replace(recording=replace(case.recording, temperature=None))


def _lossy(case: Case) -> Case:
    """Without a tenth of a second in the middle of the walk."""
    t = case.recording.t
    middle = (case.bias_s + t[-1]) / 2
    return case._replace(recording=_rows(case.recording, (t < middle) | (t >= middle + 0.1)))


def _halved(case: Case) -> Case:
    """At half the rate: each sample is the mean over two intervals."""
    recording = case.recording
    pairs = np.arange(2, len(recording.t), 2)
    kept = np.concatenate([[0], pairs])

    def mean(values: np.ndarray) -> np.ndarray:
        return np.concatenate([values[:1], (values[pairs] + values[pairs - 1]) / 2])

    slow = replace(_rows(recording, kept), gyro=mean(recording.gyro), accel=mean(recording.accel))
    return case._replace(recording=slow)


def _rows(recording: Recording, kept: np.ndarray) -> Recording:
    temperature = recording.temperature
    return Recording(
        t=recording.t[kept],
        gyro=recording.gyro[kept],
        accel=recording.accel[kept],
        temperature=None if temperature is None else temperature[kept],
        meta=recording.meta,
    )
