"""A scenario: people, path, pace and regularity, temperatures, sensor, and number of walks."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path as File
from typing import Annotated, Any

from pydantic import BeforeValidator, Discriminator, Field, Tag

from footfall.conventions import BIAS_TIME
from footfall.errors import InputError
from footfall.models.imu import TemperatureProfile, load_spec, stock_specs
from footfall.models.mount import MOUNTS
from footfall.models.subject import SHOES, SUBJECTS, Subject
from footfall.scenarios.layouts import PathEntry, laid_out, shortest
from footfall.scenarios.on_the_way import PaceTable, StopTable, paces_of, stops_of
from footfall.scenarios.path import Path
from footfall.scenarios.terrain import Terrain, build_terrain, require_one_height
from footfall.settings import did_you_mean
from footfall.simulate.plan import PHYSICS_STEP, Disturbance, Gait, Pace, Plan, Stop
from footfall.simulate.truth import divisor
from footfall.toml import Strict, checked, no_such_file, parse_toml

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


def listed(value: Any) -> list[Any]:
    """What may stand alone or in a list, as a list."""
    return value if isinstance(value, list) else [value]


# A number for every walk, or a list that is used in turn from walk to walk.
_WanderM = Annotated[
    tuple[Annotated[float, Field(ge=0, le=0.5)], ...],
    Field(strict=False, min_length=1),
    BeforeValidator(listed),
]
_WanderTimeS = Annotated[
    tuple[Annotated[float, Field(ge=0.5, le=60)], ...],
    Field(strict=False, min_length=1),
    BeforeValidator(listed),
]


class GaitTable(Strict):
    """How the path is walked: `Gait`, whose wander may be another from walk to walk."""

    pace_m_s: float = Field(ge=0.7, le=1.7)
    variability: float = Field(Gait.variability, ge=0, le=1.5)
    placement_variability: float = Field(Gait.placement_variability, ge=0, le=2)
    cadence_variability: float = Field(Gait.cadence_variability, ge=0, le=2)
    toe_out_variability: float = Field(Gait.toe_out_variability, ge=0, le=2)
    action_noise: float = Field(Gait.action_noise, ge=0, le=0.3)
    wander_m: _WanderM = (Gait.wander_m,)
    wander_time_s: _WanderTimeS = (Gait.wander_time_s,)


_IN_TURN = ("wander_m", "wander_time_s")  # what of the gait is used in turn from walk to walk


class DisturbanceTable(Strict):
    """Pushes at the trunk: how well does the walker stand them?"""

    push_Ns: float = Field(gt=0, le=30)
    every_s: float = Field(Disturbance.every_s, ge=1)


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
    rate_hz: float = Field(Plan.rate_hz, ge=50)
    calibration_s: float = Field(Plan.calibration_s, ge=0, le=600)
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
    subjects: Annotated[tuple[SubjectEntry, ...], Field(strict=False, min_length=1), BeforeValidator(listed)]
    path: PathEntry
    gait: GaitTable
    stops: Annotated[tuple[StopTable, ...], Field(strict=False)] = ()
    paces: Annotated[tuple[PaceTable, ...], Field(strict=False)] = ()
    disturbance: DisturbanceTable | None = None
    temperature: TemperatureEntry
    sensor: SensorTable
    seeds: SeedTable
    terrain: TerrainTable = TerrainTable()


@dataclass(frozen=True)
class ScenarioDocument:
    """A scenario as it was read, not checked yet.

    Attributes
    ----------
    name : a stock scenario's, or its file's without the ending
    folder : where the files lie that it names
    table : TOML's tables
    source : the file that errors speak of; the name where there is none
    """

    name: str
    folder: File
    table: Mapping[str, Any]
    source: str = ""

    def changed(self, table: str, **keys: Any) -> ScenarioDocument:
        """Another document, which has these keys in one of its tables."""
        return replace(self, table={**self.table, table: {**self.table.get(table, {}), **keys}})


@dataclass(frozen=True)
class Scenario:
    """What stands in a scenario's file, and what was built from it.

    A setting has the name that it has in the file: `scenario.gait.pace_m_s`, `scenario.file.terrain.cell_m`.

    Attributes
    ----------
    document : what it was built from
    file : its content, checked
    path : where to walk; of paths that seeds draw, that of the first walk
    subjects : used in turn from walk to walk
    stops, paces : pauses and changes of pace, in walking order
    temperatures : of the air around the sensor from the recording's start, used in turn from walk to walk
    imu : stock name or path of a data sheet
    """

    document: ScenarioDocument
    file: ScenarioFile
    path: Path
    subjects: tuple[Subject, ...]
    stops: tuple[Stop, ...]
    paces: tuple[Pace, ...]
    temperatures: tuple[TemperatureProfile, ...]
    imu: str

    @property
    def name(self) -> str:
        """A stock scenario's, or its file's without the ending."""
        return self.document.name

    @property
    def gait(self) -> GaitTable:
        """How it is walked."""
        return self.file.gait

    @property
    def sensor(self) -> SensorTable:
        """What is on the shoe, and how it is used."""
        return self.file.sensor

    @property
    def seeds(self) -> SeedTable:
        """Of walks and units."""
        return self.file.seeds

    def changed(self, table: str, **keys: Any) -> Scenario:
        """Another scenario, which has these keys in one of its tables: `changed("gait", wander_m=0.2)`.

        Raises
        ------
        InputError
            As `build_scenario`.
        """
        return build_scenario(self.document.changed(table, **keys))

    @cached_property
    def terrain(self) -> Terrain | None:
        """The ground, or None where the path is level; built at the first call."""
        return build_terrain(self.path, self.file.terrain.cell_m)

    def unit_seed(self, walk: int) -> int:
        """Seed of the sensor that is worn on a walk."""
        units = self.seeds.units
        return units[walk % len(units)] if units else self.seeds.base + walk

    def temperature_of(self, walk: int) -> TemperatureProfile:
        """What the sensor goes through on walk number `walk` (from 0)."""
        return self.temperatures[walk % len(self.temperatures)]

    def unit_bias_shift(self, unit_seed: int) -> float:
        """The bias shift (rad/s, left positive) of a unit: its seed decides the side."""
        shift = math.radians(self.sensor.bias_shift_deg_s)
        return shift if unit_seed % 2 else -shift

    def gait_of(self, walk: int) -> Gait:
        """How walk number `walk` (from 0) is walked."""
        own = {key: getattr(self.gait, key)[walk % len(getattr(self.gait, key))] for key in _IN_TURN}
        return Gait(**(self.gait.model_dump() | own))

    def plan(self, walk: int, seed: int | None = None) -> Plan:
        """What the simulator needs for walk number `walk` (from 0); `seed` in place of the scenario's own."""
        pushes = self.file.disturbance
        seed = self.seeds.base + walk if seed is None else seed
        return Plan(
            name=self.name,
            route=laid_out(self.file.path, seed).route,
            subject=self.subjects[walk % len(self.subjects)],
            mount=MOUNTS[self.sensor.mount],
            ground=self.terrain,
            gait=self.gait_of(walk),
            paces=self.paces,
            stops=self.stops,
            disturbance=None if pushes is None else Disturbance(**pushes.model_dump()),
            calibration_s=self.sensor.calibration_s,
            rate_hz=self.sensor.rate_hz,
            seed=seed,
        )


def stock_scenarios() -> tuple[str, ...]:
    """Names of the scenarios that come with Footfall."""
    # Gates lie beside them, in closed-loop.gates.toml.
    return tuple(sorted(file.stem for file in STOCK.glob("*.toml") if "." not in file.stem))


def load_scenario(name_or_path: str | os.PathLike[str]) -> Scenario:
    """A stock scenario by name, or your own by the path of its TOML file.

    Returns
    -------
    Scenario
        Path, people, gait, temperatures, sensor and seeds; `plan(number)` is what a walk needs.

    Raises
    ------
    InputError
        Neither a stock name nor a file; or what cannot be walked, with file, key, value and reason.
    """
    return build_scenario(read_document(name_or_path))


def read_document(name_or_path: str | os.PathLike[str]) -> ScenarioDocument:
    """What stands in the file of a stock scenario, by name, or of your own, by path.

    Raises
    ------
    InputError
        Neither a stock name nor a file; or a file that is not TOML.
    """
    if (name := os.fspath(name_or_path)) in stock_scenarios():
        file = STOCK / f"{name}.toml"
    elif not (file := File(name)).is_file():
        raise no_such_file("scenario", name, stock_scenarios())
    return ScenarioDocument(file.stem, file.parent, parse_toml(file), str(file))


def build_scenario(document: ScenarioDocument) -> Scenario:
    """Check a document and build what stands in it.

    Raises
    ------
    InputError
        What cannot be walked, with file, key, value and reason.
    """
    source = document.source or document.name
    content = checked(document.table, ScenarioFile, source)
    try:
        return _built(document, content)
    except InputError as error:
        raise error.about(source) from None


def _built(document: ScenarioDocument, content: ScenarioFile) -> Scenario:
    path, sensor = laid_out(content.path, content.seeds.base), content.sensor
    require_one_height(path)
    if sensor.mount not in MOUNTS:
        raise InputError(f"sensor.mount = {sensor.mount!r} is unknown{did_you_mean(sensor.mount, MOUNTS)}")
    try:
        divisor(PHYSICS_STEP, sensor.rate_hz)
    except InputError as error:
        raise error.about("sensor.rate_hz") from None
    imu = sensor.imu if sensor.imu in stock_specs() else str(document.folder / sensor.imu)
    load_spec(imu)
    return Scenario(
        document=document,
        file=content,
        path=path,
        subjects=tuple(_subject(i, entry) for i, entry in enumerate(content.subjects)),
        stops=stops_of(content.stops, shortest(content.path)),
        paces=paces_of(content.paces, shortest(content.path)),
        temperatures=_temperatures(content.temperature),
        imu=imu,
    )


def _temperatures(entry: TemperatureTable | tuple[TemperatureTable, ...]) -> tuple[TemperatureProfile, ...]:
    tables = entry if isinstance(entry, tuple) else (entry,)
    return tuple(TemperatureProfile.step(table.indoors_degC, table.outdoors_degC) for table in tables)


def _subject(i: int, entry: str | SubjectTable) -> Subject:
    if isinstance(entry, SubjectTable):
        if entry.shoe not in SHOES:
            told = f"subjects no. {i + 1}, shoe = {entry.shoe!r} is unknown"
            raise InputError(f"{told}{did_you_mean(entry.shoe, SHOES)}")
        return Subject(**entry.model_dump(exclude={"shoe"}), sole_time_s=SHOES[entry.shoe])
    if entry not in SUBJECTS:
        told = f"subjects no. {i + 1} = {entry!r} is unknown"
        raise InputError(f"{told}{did_you_mean(entry, [*SUBJECTS, 'a table'])}")
    return SUBJECTS[entry]
