"""A scenario: who walks where, how fast and how regularly, in what cold, with which sensor, how often."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from pathlib import Path as File
from typing import Annotated

from pydantic import BeforeValidator, Discriminator, Field, Tag

from footfall.errors import InputError
from footfall.models.body import MOUNTS
from footfall.models.imu import TemperatureProfile, load_spec, stock_specs
from footfall.models.subject import SHOES, SUBJECTS, Subject
from footfall.scenarios.path import Path, PathSpec, build_path
from footfall.scenarios.terrain import Terrain, build_terrain, require_one_height
from footfall.simulate.record import BIAS_TIME
from footfall.simulate.truth import divisor
from footfall.simulate.walker.steering import Pace, Stop
from footfall.simulate.walking import PHYSICS_STEP, Plan
from footfall.toml import Strict, read_toml

STOCK = File(__file__).parent / "stock"

Seed = Annotated[int, Field(ge=0)]


class SubjectTable(Strict):
    """A subject of the scenario's own; `Subject` says which bodies can walk. `shoe` is one of `SHOES`."""

    name: Annotated[str, Field(min_length=1)]
    height_m: float = Subject.height_m
    mass_kg: float = Subject.mass_kg
    cadence: float = Subject.cadence
    step_width_m: float = Subject.step_width_m
    toe_out_deg: float = Subject.toe_out_deg
    asymmetry: float = Subject.asymmetry
    friction: float = Subject.friction
    shoe: str = "walking"


# Told apart by hand, so that an error speaks of the one that was meant.
SubjectEntry = Annotated[
    Annotated[str, Tag("name")] | Annotated[SubjectTable, Tag("table")],
    Discriminator(lambda entry: "name" if isinstance(entry, str) else "table"),
]


def _listed(value: object) -> object:
    return value if isinstance(value, list) else [value]


# A number for every walk, or a list that is used in turn from walk to walk.
_WanderM = Annotated[
    tuple[Annotated[float, Field(ge=0, le=0.5)], ...],
    Field(strict=False, min_length=1),
    BeforeValidator(_listed),
]
_WanderTimeS = Annotated[
    tuple[Annotated[float, Field(ge=0.5, le=60)], ...],
    Field(strict=False, min_length=1),
    BeforeValidator(_listed),
]


class GaitTable(Strict):
    """How the path is walked. `variability` 1 is that of people, 0 a metronome's; the others: its parts."""

    pace_m_s: float = Field(ge=0.7, le=1.7)
    variability: float = Field(1.0, ge=0, le=1.5)
    placement_variability: float = Field(1.0, ge=0, le=2)
    cadence_variability: float = Field(1.0, ge=0, le=2)
    toe_out_variability: float = Field(1.0, ge=0, le=2)
    action_noise: float = Field(0.0, ge=0, le=0.3)
    wander_m: _WanderM = (0.0,)
    wander_time_s: _WanderTimeS = (4.0,)


class StopTable(Strict):
    """A pause on the way."""

    at_m: float = Field(gt=0)
    for_s: float = Field(gt=0, le=3600)


class PaceTable(Strict):
    """A change of pace on the way."""

    at_m: float = Field(gt=0)
    m_s: float = Field(ge=0.7, le=1.7)


class DisturbanceTable(Strict):
    """Pushes at the trunk: how well does the walker stand them?"""

    push_Ns: float = Field(gt=0, le=30)
    every_s: float = Field(10.0, ge=1)


class TemperatureTable(Strict):
    """The sensor warms up indoors and is carried out just before its calibration."""

    indoors_degC: float = Field(ge=-40, le=85)
    outdoors_degC: float = Field(ge=-40, le=85)


# Walks of different days may have a profile each.
TemperatureEntry = Annotated[
    Annotated[TemperatureTable, Tag("table")]
    | Annotated[tuple[TemperatureTable, ...], Field(strict=False, min_length=1), Tag("list")],
    Discriminator(lambda entry: "list" if isinstance(entry, list) else "table"),
]


class SensorTable(Strict):
    """What is on the shoe: `imu` is a stock name or a data sheet's path relative to the scenario's file.

    `bias_time_s` is T_bias. `bias_shift_deg_s` is a gyro bias about the vertical that appears with the first
    step; left for units of odd seeds and right for others.
    """

    imu: Annotated[str, Field(min_length=1)]
    mount: str = "instep"
    rate_hz: float = Field(200.0, ge=50)
    calibration_s: float = Field(30.0, ge=0, le=600)
    bias_time_s: float = Field(BIAS_TIME, gt=0, le=600)
    bias_shift_deg_s: float = Field(0.0, ge=0, le=10)


class SeedTable(Strict):
    """Walk i of `walks` has the seed base + i; `units` are seeds of sensors, used in turn."""

    base: Seed
    walks: Annotated[int, Field(ge=1)] = 1
    units: Annotated[tuple[Seed, ...] | None, Field(strict=False, min_length=1)] = None


class TerrainTable(Strict):
    """The ground follows the path's slopes on a grid of cells this wide; a level path has level ground."""

    cell_m: Annotated[float, Field(ge=0.2, le=2.0)] = 0.5


class ScenarioFile(Strict):
    """A scenario as it stands in TOML."""

    description: Annotated[str, Field(min_length=1)]
    subjects: Annotated[tuple[SubjectEntry, ...], Field(strict=False, min_length=1)]
    path: PathSpec
    gait: GaitTable
    stops: Annotated[tuple[StopTable, ...], Field(strict=False)] = ()
    paces: Annotated[tuple[PaceTable, ...], Field(strict=False)] = ()
    disturbance: DisturbanceTable | None = None
    temperature: TemperatureEntry
    sensor: SensorTable
    seeds: SeedTable
    terrain: TerrainTable = TerrainTable()


@dataclass(frozen=True)
class Scenario:
    """Everything that a run needs to know beforehand.

    Attributes
    ----------
    name : a stock scenario's, or its file's without the ending
    description : one line for people
    path : where to walk
    cell : m, of the terrain's grid
    subjects : used in turn from walk to walk
    stops : pauses, in walking order
    pace : m/s, asked of the walker on straights; paces : changes of it, in walking order
    variability : of the gait, 1 = that of people; placement_variability, cadence_variability and
        toe_out_variability : of where and when the feet land and how far they turn out, each times the former
    action_noise : SD of the noise on the walker's actions
    wander, wander_time : m and s, slow lateral wander of the steering's aim; each used in turn
    push, push_every : N s and s, pushes at the trunk; 0: none
    temperatures : of the air around the sensor from the recording's start, used in turn from walk to walk
    imu : stock name or path of a data sheet
    mount : name of a mounting on the shoe
    rate_hz : of truth and recording
    calibration : s of standing before the first footfall
    bias_time : s, T_bias: of it, over which the static bias is averaged
    bias_shift : rad/s, gyro bias about the vertical that appears with the first step
    seed : of walk 0; walks : how many by default
    units : seeds of sensors, used in turn; None: each walk's own seed
    """

    name: str
    description: str
    path: Path
    cell: float
    subjects: tuple[Subject, ...]
    stops: tuple[Stop, ...]
    pace: float
    paces: tuple[Pace, ...]
    variability: float
    placement_variability: float
    cadence_variability: float
    toe_out_variability: float
    action_noise: float
    wander: tuple[float, ...]
    wander_time: tuple[float, ...]
    push: float
    push_every: float
    temperatures: tuple[TemperatureProfile, ...]
    imu: str
    mount: str
    rate_hz: float
    calibration: float
    bias_time: float
    bias_shift: float
    seed: int
    walks: int
    units: tuple[int, ...] | None

    @cached_property
    def terrain(self) -> Terrain | None:
        """The ground, or None where the path is level; built at the first call."""
        return build_terrain(self.path, self.cell)

    def unit_seed(self, walk: int) -> int:
        """Seed of the sensor that is worn on a walk."""
        return self.units[walk % len(self.units)] if self.units else self.seed + walk

    def temperature_of(self, walk: int) -> TemperatureProfile:
        """What the sensor goes through on walk number `walk` (from 0)."""
        return self.temperatures[walk % len(self.temperatures)]

    def unit_bias_shift(self, unit_seed: int) -> float:
        """The bias shift (rad/s, left positive) of a unit: its seed decides the side."""
        return self.bias_shift if unit_seed % 2 else -self.bias_shift

    def plan(self, walk: int) -> Plan:
        """What the simulator needs for walk number `walk` (from 0)."""
        return Plan(
            name=self.name,
            route=self.path.route,
            subject=self.subjects[walk % len(self.subjects)],
            mount=MOUNTS[self.mount],
            ground=self.terrain,
            pace=self.pace,
            paces=self.paces,
            stops=self.stops,
            variability=self.variability,
            placement_variability=self.placement_variability,
            cadence_variability=self.cadence_variability,
            toe_out_variability=self.toe_out_variability,
            action_noise=self.action_noise,
            wander=self.wander[walk % len(self.wander)],
            wander_time=self.wander_time[walk % len(self.wander_time)],
            push=self.push,
            push_every=self.push_every,
            calibration=self.calibration,
            rate_hz=self.rate_hz,
            seed=self.seed + walk,
        )


def stock_scenarios() -> tuple[str, ...]:
    """Names of the scenarios that come with Footfall."""
    return tuple(sorted(file.stem for file in STOCK.glob("*.toml")))


def load_scenario(name_or_path: str | os.PathLike[str]) -> Scenario:
    """A stock scenario by name, or anyone's by the path of its TOML file.

    Raises
    ------
    InputError
        Neither a stock name nor a file; or what cannot be walked, with file, key, value and reason.
    """
    if (name := os.fspath(name_or_path)) in stock_scenarios():
        file = STOCK / f"{name}.toml"
    elif not (file := File(name)).is_file():
        stock = ", ".join(stock_scenarios())
        raise InputError(f"scenario {name!r}: neither a stock scenario ({stock}) nor a TOML file that exists")
    content = read_toml(file, ScenarioFile)
    try:
        return _scenario(file, content)
    except InputError as error:
        raise error.about(file) from None


def _scenario(file: File, content: ScenarioFile) -> Scenario:
    path = build_path(content.path)
    require_one_height(path)
    gait, sensor, seeds = content.gait, content.sensor, content.seeds
    if sensor.mount not in MOUNTS:
        raise InputError(f"sensor.mount = {sensor.mount!r}: expected one of {', '.join(MOUNTS)}")
    try:
        divisor(PHYSICS_STEP, sensor.rate_hz)
    except InputError as error:
        raise error.about("sensor.rate_hz") from None
    imu = sensor.imu if sensor.imu in stock_specs() else str(file.parent / sensor.imu)
    load_spec(imu)
    return Scenario(
        name=file.stem,
        description=content.description,
        path=path,
        cell=content.terrain.cell_m,
        subjects=tuple(_subject(i, entry) for i, entry in enumerate(content.subjects)),
        stops=_stops(content.stops, path.route.length),
        pace=gait.pace_m_s,
        paces=_paces(content.paces, path.route.length),
        variability=gait.variability,
        placement_variability=gait.placement_variability,
        cadence_variability=gait.cadence_variability,
        toe_out_variability=gait.toe_out_variability,
        action_noise=gait.action_noise,
        wander=gait.wander_m,
        wander_time=gait.wander_time_s,
        push=content.disturbance.push_Ns if content.disturbance else 0.0,
        push_every=content.disturbance.every_s if content.disturbance else Plan.push_every,
        temperatures=_temperatures(content.temperature),
        imu=imu,
        mount=sensor.mount,
        rate_hz=sensor.rate_hz,
        calibration=sensor.calibration_s,
        bias_time=sensor.bias_time_s,
        bias_shift=math.radians(sensor.bias_shift_deg_s),
        seed=seeds.base,
        walks=seeds.walks,
        units=seeds.units,
    )


def _stops(tables: tuple[StopTable, ...], length: float) -> tuple[Stop, ...]:
    """In walking order; 3 m apart and from the ends, or there is no walking between them."""
    at = [0.0, *(table.at_m for table in tables), length]
    for i, (before, after) in enumerate(pairwise(at)):
        if after - before < 3.0:
            key, value = (f"stops.{i}.at_m", after) if i < len(tables) else (f"stops.{i - 1}.at_m", before)
            raise InputError(
                f"{key} = {value:g}: expected at least 3 m beyond the stop (or the start) before it and "
                f"before the path's end at {length:g} m"
            )
    return tuple(Stop(table.at_m, table.for_s) for table in tables)


def _paces(tables: tuple[PaceTable, ...], length: float) -> tuple[Pace, ...]:
    """In walking order, and on the path."""
    at = [0.0, *(table.at_m for table in tables)]
    for i, (before, after) in enumerate(pairwise(at)):
        if not before < after < length:
            raise InputError(
                f"paces.{i}.at_m = {after:g}: expected beyond the change (or the start) before it at "
                f"{before:g} m and before the path's end at {length:g} m"
            )
    return tuple(Pace(table.at_m, table.m_s) for table in tables)


def _temperatures(entry: TemperatureTable | tuple[TemperatureTable, ...]) -> tuple[TemperatureProfile, ...]:
    tables = entry if isinstance(entry, tuple) else (entry,)
    return tuple(TemperatureProfile.step(table.indoors_degC, table.outdoors_degC) for table in tables)


def _subject(i: int, entry: str | SubjectTable) -> Subject:
    if isinstance(entry, SubjectTable):
        if entry.shoe not in SHOES:
            raise InputError(f"subjects.{i}.shoe = {entry.shoe!r}: expected one of {', '.join(SHOES)}")
        return Subject(**entry.model_dump(exclude={"shoe"}), sole_time_s=SHOES[entry.shoe])
    if entry not in SUBJECTS:
        raise InputError(f"subjects.{i} = {entry!r}: expected one of {', '.join(SUBJECTS)}, or a table")
    return SUBJECTS[entry]
