"""The atom of every study: one walk, one IMU on it, its noise, and the scores of the methods."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from footfall.conventions import BIAS_TIME
from footfall.errors import InputError
from footfall.hdr.directions import DirectionParams
from footfall.hdr.method import Method
from footfall.hdr.methods import find_method, tracks
from footfall.hdr.streamed import StreamedReckoning
from footfall.hdr.tracks import Reckoning
from footfall.models.imu import (
    ImuSpec,
    ImuUnit,
    SheetDocument,
    build_spec,
    draw_unit,
    read_sheet,
    require_effects,
)
from footfall.models.imu.override import overridden
from footfall.pdr.filter.ins import FilterSettings
from footfall.pdr.reckoning import PdrParams, StartPose
from footfall.pdr.track import Track
from footfall.recording import Recording
from footfall.scenarios.judge.score import Score, score
from footfall.scenarios.scenario import Scenario
from footfall.scenarios.store import Reckoned, footfalls_file, read_footfalls, write_footfalls
from footfall.simulate.budget import DriftBudget
from footfall.simulate.plan import Plan
from footfall.simulate.record import record, record_with_budget
from footfall.simulate.walk import Walk

DEFAULT_METHODS = ("pdr", "hdr")
UNSURE = FilterSettings.paper().gyro_bias_sd  # rad/s, of a gyro bias that no rest has told


@dataclass(frozen=True)
class Setup:
    """The documents of a trial: everything but its seeds.

    Attributes
    ----------
    scenario : what is walked, in what weather
    imu : name of the data sheet; spec : what it says
    methods : from recording to track
    pdr : dead reckoning's settings, T_bias among them
    guided : the filter's under a heading method
    directions : dominant directions, for methods that go by them
    unit : edge name -> value (`gyro.scale`), constants of every unit in place of those that its seed draws
    without : sensor effects that are switched off
    """

    scenario: Scenario
    imu: str
    spec: ImuSpec
    methods: tuple[Method, ...]
    pdr: PdrParams
    guided: FilterSettings
    directions: DirectionParams
    unit: Mapping[str, Any] = field(default_factory=dict)
    without: tuple[str, ...] = ()


@dataclass(frozen=True)
class Trial:
    """One walk x one unit x its noise.

    `number` is of the walk in the scenario, and decides subject and temperatures. `noise_seed` is of what
    differs from recording to recording of one unit.
    """

    setup: Setup
    number: int
    walk_seed: int
    unit_seed: int
    noise_seed: int

    @property
    def plan(self) -> Plan:
        """What is walked."""
        return self.setup.scenario.plan(self.number, self.walk_seed)

    @property
    def worn(self) -> ImuUnit:
        """The unit on the shoe."""
        return overridden(draw_unit(self.setup.spec, self.unit_seed), self.setup.unit)


@dataclass(frozen=True)
class Row:
    """The result of one method on a trial: a score, or the stage and the reason of a failure.

    Attributes
    ----------
    subject : name of the person; footfalls : rows of the track
    stage : of a failure: "walk", "record", "track" or "score"; "worker" where its process ended
    walk_sha, recording_sha : of their content, or "" where there is none
    """

    scenario: str
    number: int
    walk_seed: int
    subject: str
    imu: str
    unit_seed: int
    noise_seed: int
    method: str
    score: Score | None = None
    footfalls: int = 0
    stage: str = ""
    error: str = ""
    walk_sha: str = ""
    recording_sha: str = ""

    def require(self) -> Score:
        """The score.

        Raises
        ------
        InputError
            There is none, for the reason that the row tells.
        """
        if self.score is None:
            raise InputError(self.error)
        return self.score

    def as_dict(self) -> dict[str, Any]:
        """Plain values by name; scores that are not there are None."""
        mine = asdict(self)
        del mine["score"]
        scores = dict.fromkeys(item.name for item in fields(Score))
        return mine | (scores if self.score is None else self.score.as_dict())


@dataclass(frozen=True)
class Kept:
    """What a trial went through, for files and figures. `tracks` by method's name."""

    walk: Walk
    recording: Recording
    budget: DriftBudget
    tracks: Mapping[str, Track]


@dataclass(frozen=True)
class Outcome:
    """A trial's rows, one a method, and what it went through where that was asked for.

    `seconds` that it took by stage: "record" and "track", which dead reckoning is part of, and "score".
    """

    trial: Trial
    rows: tuple[Row, ...]
    kept: Kept | None = None
    seconds: Mapping[str, float] = field(default_factory=dict, compare=False)

    @property
    def scores(self) -> dict[str, Score]:
        """Method -> score.

        Raises
        ------
        InputError
            Some method has none.
        """
        return {row.method: row.require() for row in self.rows}


def find(methods: Iterable[str | Method | Callable[..., Track]]) -> tuple[Method, ...]:
    """Methods by name, object or callable (`footfall.hdr.methods.find_method`).

    Raises
    ------
    InputError
        One that is unknown, or two of one name.
    """
    found = tuple(find_method(method) for method in methods)
    names = [method.name for method in found]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InputError(f"method {twice!r} is given twice: give each a name of its own")
    return found


def setup(
    scenario: Scenario,
    *,
    imu: str | SheetDocument | None = None,
    methods: Iterable[str | Method | Callable[..., Track]] = DEFAULT_METHODS,
    without: Iterable[str] = (),
) -> Setup:
    """A scenario with its own sheet, T_bias and path's direction, unless told otherwise.

    Where a bias appears with the first step, filters under a heading method are told that the rest says
    little of it.

    Parameters
    ----------
    imu : stock name, path or content of a data sheet; the scenario's when None
    methods : as of `find`

    Raises
    ------
    InputError
        An unknown IMU, method or effect, or two methods of one name.
    """
    require_effects(dropped := tuple(without))
    sheet = imu if isinstance(imu, SheetDocument) else read_sheet(imu or scenario.imu)
    return Setup(
        scenario=scenario,
        imu=sheet.name,
        spec=build_spec(sheet),
        methods=find(methods),
        pdr=PdrParams(bias_s=scenario.sensor.bias_time_s),
        guided=FilterSettings(gyro_bias_sd=UNSURE) if scenario.sensor.bias_shift_deg_s else FilterSettings(),
        directions=DirectionParams(reference=float(scenario.path.route.heading[0])),
        without=dropped,
    )


def start_pose(walk: Walk, bias_s: float = BIAS_TIME) -> StartPose:
    """The known start: the IMU's true pose at rest, at the last sample of the first `bias_s` seconds.

    Raises
    ------
    InputError
        The walk does not stand still for so long.
    """
    if bias_s > walk.calibration_s:
        raise InputError(
            f"start: the walk stands still for {walk.calibration_s:g} s, less than the {bias_s:g} s of T_bias"
        )
    return StartPose(*walk.pose_at_rest(bias_s))


def reckoning(setup: Setup, walk: Walk, recording: Recording) -> Reckoning:
    """A recording and what the methods are told of it."""
    start = start_pose(walk, setup.pdr.bias_s)
    return Reckoning(recording, start, setup.pdr, setup.directions, setup.guided)


def walk_of(
    trial: Trial,
    folder: Path | None = None,
    on_progress: Callable[[float], None] | None = None,
    also: Iterable[Trial] = (),
) -> Walk:
    """The trial's walk, from the cache where it has been walked before.

    Parameters
    ----------
    folder : the cache; the user's when None
    on_progress : called now and then with the metres walked
    also : trials whose walks differ in mount and rate alone, kept as well where there is to be walked

    Raises
    ------
    FallError, StrayError
        The walker did not reach the end.
    """
    # Late: the physics, which documents and settings do without.
    from footfall.simulate.cache import cached_walk

    return cached_walk(trial.plan, also=(one.plan for one in also), folder=folder, on_progress=on_progress)


def recording_of(trial: Trial, walk: Walk) -> Recording:
    """What the trial's unit says of its walk."""
    return record(walk, trial.worn, **_weather(trial))


def perform(
    trial: Trial,
    walk: Walk,
    *,
    keep: bool = False,
    store: Path | None = None,
    source: Callable[[], Recording] | None = None,
    surprised: Callable[[Exception], None] | None = None,
) -> Outcome:
    """Record the trial's walk, navigate by each method and score.

    What a recording, method or score refuses becomes the `error` of its row.

    Parameters
    ----------
    walk : of the trial (`walk_of`)
    keep : whether walk, recording, drift budget and tracks are part of the outcome
    store : folder of footfalls that are taken from there, where no method needs samples, and kept there
    source : gives the trial's recording, where others have it, too; made here when None
    surprised : called with an unexpected exception, which then becomes an `error`, too; None: it is raised
    """
    blank = blank_row(trial, subject=str(walk.meta["subject"]), walk_sha=walk.sha)
    setup, budget, spent = trial.setup, None, dict.fromkeys(("record", "track", "score"), 0.0)
    expected = InputError if surprised is None else Exception
    try:
        with _timed(spent, "record"):
            if keep:
                told = _weather(trial)
                recording, budget = record_with_budget(walk, trial.worn, **told, bias_time=setup.pdr.bias_s)
                given, sha = reckoning(setup, walk, recording), recording.sha
            elif store is not None and all(method.needs == "footfalls" for method in setup.methods):
                given, sha = _stored(trial, walk, store, source)
            else:
                recording = source() if source else recording_of(trial, walk)
                given, sha = reckoning(setup, walk, recording), recording.sha
    except expected as error:
        refused = replace(blank, stage="record", error=_reason(error, surprised))
        rows = tuple(replace(refused, method=method.name) for method in setup.methods)
        return Outcome(trial, rows, seconds=spent)
    blank = replace(blank, recording_sha=sha)
    found, made = [], {}
    for method in setup.methods:
        row, stage = replace(blank, method=method.name), "track"
        try:
            with _timed(spent, stage):
                track = made[method.name] = (
                    method.track(given) if budget is None else tracks(given, [method])[method.name]
                )
            row, stage = replace(row, footfalls=len(track)), "score"
            with _timed(spent, stage):
                row = replace(row, score=score(track, walk))
        except expected as error:
            row = replace(row, stage=stage, error=_reason(error, surprised))
        found.append(row)
    if store is not None and budget is None and {"recording", "footfalls"} <= vars(given).keys():
        write_footfalls(footfalls_file(store, trial, walk.sha), Reckoned(given.footfalls, sha))
    kept = None if budget is None else Kept(walk, recording, budget, made)
    return Outcome(trial, tuple(found), kept, spent)


def _reason(error: Exception, surprised: Callable[[Exception], None] | None) -> str:
    """What a row tells of an exception."""
    if isinstance(error, InputError) or surprised is None:
        return str(error)
    surprised(error)
    return f"{type(error).__name__}: {(str(error).splitlines() or [''])[0]}"


@contextmanager
def _timed(spent: dict[str, float], stage: str) -> Iterator[None]:
    start = time.perf_counter()
    try:
        yield
    finally:
        spent[stage] += time.perf_counter() - start


def _stored(
    trial: Trial, walk: Walk, store: Path, source: Callable[[], Recording] | None
) -> tuple[Reckoning, str]:
    """What the methods are told, of footfalls that are kept; and the hash of their recording."""
    found = read_footfalls(footfalls_file(store, trial, walk.sha))
    if found is None:
        recording = source() if source else recording_of(trial, walk)
        return reckoning(trial.setup, walk, recording), recording.sha
    start = start_pose(walk, trial.setup.pdr.bias_s)
    return StreamedReckoning(lambda: found.footfalls, start, trial.setup.directions), found.recording_sha


def failed(trial: Trial, error: InputError, stage: str = "walk") -> Outcome:
    """The outcome of a trial whose walk, or whatever stage, came to no end."""
    row = replace(blank_row(trial, trial.plan.subject.name), stage=stage, error=str(error))
    return Outcome(trial, tuple(replace(row, method=method.name) for method in trial.setup.methods))


def blank_row(trial: Trial, subject: str, walk_sha: str = "") -> Row:
    """The row of a trial that no method has gone over yet."""
    return Row(
        scenario=trial.setup.scenario.name,
        number=trial.number,
        walk_seed=trial.walk_seed,
        subject=subject,
        imu=trial.setup.imu,
        unit_seed=trial.unit_seed,
        noise_seed=trial.noise_seed,
        method="",
        walk_sha=walk_sha,
    )


def _weather(trial: Trial) -> dict[str, Any]:
    """What happens to the sensor on this walk."""
    scenario = trial.setup.scenario
    return {
        "seed": trial.noise_seed,
        "temperature": scenario.temperature_of(trial.number),
        "without": trial.setup.without,
        "bias_shift": scenario.unit_bias_shift(trial.unit_seed),
    }
