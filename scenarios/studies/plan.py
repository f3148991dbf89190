"""From a study to its tasks: what is to be done, what of it is the same, and what it costs."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

from footfall.addresses import pattern
from footfall.errors import InputError
from footfall.hdr.command import Command
from footfall.hdr.method import Method
from footfall.identity import digest_of
from footfall.models.policy import stock_policy
from footfall.scenarios.evaluate import cases
from footfall.scenarios.listing import Parameter, parameters
from footfall.scenarios.parameters import Documents
from footfall.scenarios.scenario import Scenario, build_scenario
from footfall.scenarios.studies.design import Point, labels, points, require_addresses
from footfall.scenarios.studies.rows import CASE, Kind, kind_of
from footfall.scenarios.studies.study import Study
from footfall.scenarios.studies.task import Cell, Setting, Task
from footfall.scenarios.trial import Setup, Trial
from footfall.simulate.cache import is_cached, plan_key
from footfall.sources import stage_digest

CHUNK = 10  # units of a task: some seconds, so that little is lost where it is cut short
KEY = 24  # hex digits


class Entry(NamedTuple):
    """Rows of the dataset: those of a cell, with the values of the axes that they stand for."""

    key: str
    values: Mapping[str, Any]


class Walked(NamedTuple):
    """A walk of the study: metres and seconds, its samples a second, and its steps (`Plan.steps`)."""

    metres: float
    seconds: float
    rate_hz: float
    steps: str


@dataclass(frozen=True)
class Axis:
    """What an axis is to people: its values, unit and label."""

    values: tuple[Any, ...]
    unit: str
    label: str


@dataclass(frozen=True)
class Plan:
    """All of a study.

    Attributes
    ----------
    scenarios : by name
    tasks : none of their cells twice, those on a walk after each other
    entries : of the dataset
    axes : address -> what it is
    kinds : of the columns, of the axes that have one: the sheet has a column anyway
    walks : by key
    """

    study: Study
    scenarios: tuple[str, ...]
    tasks: tuple[Task, ...]
    entries: tuple[Entry, ...]
    axes: Mapping[str, Axis]
    kinds: Mapping[str, Kind]
    walks: Mapping[str, Walked]

    @property
    def rows(self) -> int:
        """Of the dataset."""
        sizes = {key: len(task.seeds) for task in self.tasks for key in task.cells}
        return sum(sizes[entry.key] for entry in self.entries)

    @property
    def digest(self) -> str:
        """Of the dataset: all that makes it."""
        return digest_of([(entry.key, repr(sorted(entry.values.items()))) for entry in self.entries])


@dataclass
class _Recorded:
    """Points that share walks and recordings: by what dead reckoning is told, the documents and methods."""

    documents: Documents
    setup: Setup
    content: str
    settings: dict[str, tuple[Documents, Setup, dict[str, Method]]] = field(default_factory=dict)
    meant: list[tuple[str, str, Mapping[str, Any]]] = field(default_factory=list)


def plan_of(study: Study) -> Plan:
    """Read all of a study and see that it can be.

    Raises
    ------
    InputError
        Of any of its values, with the file's name.
    """
    made: dict[str, Task] = {}
    entries: list[Entry] = []
    walks = _Walks()
    known: dict[str, Parameter] = {}
    scenarios = study.documents()
    with study.blamed():
        for base in scenarios.values():
            known |= {pattern(one.address): one for one in parameters(base)}
        design = study.file.design
        given = points(design, study.owner, lambda address: _whole(known, address))
        require_addresses(given, study.file.fixed, "design")
        told = _Told(study)
        for name, base in scenarios.items():
            for recorded in _recorded(study, name, base, given, told).values():
                _add(recorded, study, made, entries, walks)
    order = {key: at for at, key in enumerate(walks.found)}
    tasks = sorted(made.values(), key=lambda task: order[task.walk])
    axes = _axes(given, known, labels(design))
    kinds = {address: kind_of(axis.values) for address, axis in axes.items() if address not in CASE}
    return Plan(study, tuple(scenarios), tuple(tasks), tuple(entries), axes, kinds, walks.found)


class _Walks:
    """The walks of a study by key, each hashed once: plans are big."""

    def __init__(self) -> None:
        self.found: dict[str, Walked] = {}
        self._keys: dict[tuple[int, int, int], str] = {}
        self._held: list[Scenario] = []  # so that no other gets its id

    def key(self, trial: Trial) -> str:
        """Of a trial's walk."""
        scenario = trial.setup.scenario
        short = (id(scenario), trial.number, trial.walk_seed)
        if short not in self._keys:
            self._held.append(scenario)
            plan = trial.plan
            key = self._keys[short] = plan_key(plan, stock_policy())
            pauses = sum(stop.for_s for stop in plan.stops) + plan.calibration_s
            seconds = pauses + plan.route.length / plan.gait.pace_m_s
            length = float(plan.route.length)
            self.found.setdefault(key, Walked(length, float(seconds), plan.rate_hz, plan.steps))
        return self._keys[short]


class _Told:
    """A method with the parameters of a point, made once."""

    def __init__(self, study: Study) -> None:
        self._study = study
        self._made: dict[str, Method] = {}

    def __call__(self, base: Documents, name: str, values: Mapping[str, Any]) -> Method:
        key = f"{name} {sorted(values.items())!r}"
        if key not in self._made:
            methods = self._study.valued(base, values).methods
            self._made[key] = next(method for method in methods if method.name == name)
        return self._made[key]


def _recorded(
    study: Study, name: str, base: Documents, given: Sequence[Point], told: _Told
) -> dict[str, _Recorded]:
    """Points by what they record."""
    scenarios: dict[str, Scenario] = {}
    found: dict[str, _Recorded] = {}
    for point in given:
        try:
            documents = study.valued(base, point.shared)
            walked = _hash(documents.scenario.table)
            if walked not in scenarios:
                scenarios[walked] = build_scenario(documents.scenario)
            setup = documents.setup(scenarios[walked])
        except InputError as error:
            raise error.about(f"scenario {name}") if len(study.file.scenarios) > 1 else error from None
        content = _content(setup)
        here = found.setdefault(walked + content, _Recorded(documents, setup, content))
        reckoned = digest_of(setup.pdr, setup.guided, setup.directions)
        _, _, methods = here.settings.setdefault(reckoned, (replace(documents, methods=()), setup, {}))
        for method in study.methods:
            for own in point.own.get(method.name, ({},)):
                made = told(base, method.name, own) if own else _named(base, method.name)
                version = _version(made)
                methods.setdefault(version, made)
                here.meant.append((reckoned, version, {**point.shared, **own}))
    return found


def _named(base: Documents, name: str) -> Method:
    return next(method for method in base.methods if method.name == name)


def _version(method: Method) -> str:
    """All that makes what a method makes of a recording."""
    made: list[Any] = [method.name, method.params, method.needs, method.version or stage_digest("track")]
    if isinstance(run := method.run, Command):
        made += [run.words, run.format, run.timeout_s]
    return digest_of(*made)


def _add(
    recorded: _Recorded, study: Study, made: dict[str, Task], entries: list[Entry], walks: _Walks
) -> None:
    """The tasks of what is recorded alike, beside those that are there, and what they are for."""
    table, setup = study.file.cases, recorded.setup
    every = cases(setup, **table.model_dump())
    content = recorded.content
    for walk in _by_walk(every):
        first = walk[0]
        scenario, walked = setup.scenario, walks.key(first)
        weather = digest_of(scenario.temperature_of(first.number), _subject(first), scenario.name)
        for at in range(0, len(walk), CHUNK):
            seeds = tuple((trial.unit_seed, trial.noise_seed) for trial in walk[at : at + CHUNK])
            key = _hash(content, walked, weather, first.number, first.walk_seed, seeds)
            cells: dict[tuple[str, str], str] = {}
            settings = []
            for reckoned, (documents, _, methods) in recorded.settings.items():
                own = {version: _hash(key, reckoned, version) for version in methods}
                cells |= {(reckoned, version): cell for version, cell in own.items()}
                settings.append(
                    Setting(documents, tuple(Cell(own[version], one) for version, one in methods.items()))
                )
            steps = walks.found[walked].steps
            task = Task(key, walked, steps, first.number, first.walk_seed, seeds, tuple(settings))
            there = made.get(key)  # where points differ in what no recording tells
            further = task if there is None else task.without(there.cells)
            if there is not None and further is not None:
                made[key] = replace(there, settings=there.settings + further.settings)
            elif there is None:
                made[key] = task
            entries += [
                Entry(cells[reckoned, version], values) for reckoned, version, values in recorded.meant
            ]


def _subject(trial: Trial) -> str:
    subjects = trial.setup.scenario.subjects
    return subjects[trial.number % len(subjects)].name


def _by_walk(trials: Sequence[Trial]) -> Iterator[list[Trial]]:
    groups: dict[int, list[Trial]] = {}
    for trial in trials:
        groups.setdefault(trial.number, []).append(trial)
    yield from groups.values()


def _content(setup: Setup) -> str:
    """All that makes recordings of a walk, but for walk and seeds; and what makes scores of tracks."""
    return digest_of(
        "task 1",
        *(stage_digest(stage) for stage in ("record", "reckon", "score")),
        setup.imu,
        setup.spec,
        dict(setup.unit),
        sorted(setup.without),
        setup.scenario.sensor.bias_shift_deg_s,
    )


def _hash(*parts: object) -> str:
    return hashlib.sha256(repr(parts).encode()).hexdigest()[:KEY]


def _whole(known: Mapping[str, Parameter], address: str) -> bool:
    found = known.get(pattern(address))
    return found is not None and found.type.startswith(("whole number", "a whole number"))


def _axes(
    given: Sequence[Point], known: Mapping[str, Parameter], called: Mapping[str, str]
) -> dict[str, Axis]:
    """Every address that a point sets, with the different values that it takes."""
    values: dict[str, dict[str, Any]] = {}
    for point in given:
        for told in (point.shared, *(one for sets in point.own.values() for one in sets)):
            for address, value in told.items():
                values.setdefault(address, {})[repr(value)] = value
    axes = {}
    for address, found in values.items():
        unit = known[pattern(address)].unit if pattern(address) in known else ""
        axes[address] = Axis(_sorted(found.values()), unit, called.get(address) or _label(address, unit))
    return axes


def _sorted(values: Any) -> tuple[Any, ...]:
    """Numbers in their order, anything else as it comes."""
    found = tuple(values)
    return tuple(sorted(found)) if kind_of(found) in ("number", "integer") else found


def _label(address: str, unit: str) -> str:
    """The last step of an address, without its unit, in words."""
    if address == "imu":
        return "IMU"
    name = pattern(address).replace("[*]", "").rsplit(".", 1)[-1]
    ending = "_" + unit.replace("/", "_").replace("-", "_").lower()
    return name.removesuffix(ending).replace("_", " ").strip() if unit else name.replace("_", " ")


class Cost(NamedTuple):
    """What is left to do. `seconds` : about so long on one core."""

    walks: int
    cached: int
    recordings: int
    reckonings: int
    rows: int
    seconds: float


# s of one core: a second of walking; a sample recorded, dead-reckoned, filtered; a footfall in a method.
_WALKING, _RECORDING, _RECKONING, _FILTER, _FOOTFALL = 0.03, 1.8e-6, 0.7e-6, 1.2e-6, 6e-6


def task_seconds(task: Task, walk: Walked) -> float:
    """About so long takes a task on one core."""
    samples = walk.seconds * walk.rate_hz
    a_unit = _RECORDING * samples
    for setting in task.settings:
        a_unit += _RECKONING * samples
        for cell in setting.cells:
            a_unit += _FOOTFALL * walk.seconds if cell.method.needs == "footfalls" else _FILTER * samples
    return a_unit * len(task.seeds)


def walk_seconds(walks: Iterable[Walked]) -> dict[str, float]:
    """Steps -> about so long takes walking them on one core, for all walks of these steps at once."""
    return {walk.steps: _WALKING * walk.seconds for walk in walks}


def cost_of(plan: Plan, tasks: Sequence[Task]) -> Cost:
    """What these tasks cost."""
    keys = {task.walk for task in tasks}
    cached = {key for key in keys if is_cached(key)}
    seconds = sum(task_seconds(task, plan.walks[task.walk]) for task in tasks)
    return Cost(
        walks=len(keys),
        cached=len(cached),
        recordings=sum(len(task.seeds) for task in tasks),
        reckonings=sum(len(task.seeds) * len(task.settings) for task in tasks),
        rows=sum(len(task.seeds) * len(task.cells) for task in tasks),
        seconds=seconds + sum(walk_seconds(plan.walks[key] for key in keys - cached).values()),
    )
