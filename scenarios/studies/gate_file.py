"""A file of gates: which cases, which methods, and what is asked of them."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field

from footfall.errors import InputError
from footfall.hdr.method import Method
from footfall.hdr.methods import METHODS, find_method
from footfall.hdr.others import entry_point_names
from footfall.pdr.track import Track
from footfall.scenarios.judge.bounds import ALPHA, fewest
from footfall.scenarios.judge.gate import Gate
from footfall.scenarios.parameters import documents, with_values
from footfall.scenarios.scenario import STOCK, Seed, stock_scenarios
from footfall.scenarios.studies.methods import MethodEntry, beside, method_of
from footfall.scenarios.trial import Setup
from footfall.settings import did_you_mean
from footfall.toml import Strict, checked, parse_toml

ENDING = ".gates.toml"  # of those that come with Footfall
UNCORRECTED = ("pdr", "iez", "iez-paper")  # the gyro's own heading: they scatter little from case to case
QUICK = 20

_UNITS = {False: 60, True: 10}  # by whether nothing corrects the heading
_MARGIN_PERCENT = {False: 10.0, True: 2.0}


class CasesTable(Strict):
    """The cases: units (seeds from 1000) dealt to a scenario's walks, each with the noise of its own seed.

    What is left out is the scenario's; `units` are 60, or 10 where no method corrects the heading.
    """

    scenario: Annotated[str, Field(min_length=1)]
    imu: Annotated[str, Field(min_length=1)] | None = None
    walks: Annotated[int, Field(ge=1)] | None = None
    seed: Seed | None = None
    units: Annotated[int, Field(ge=1)] | None = None


class GatesFile(Strict):
    """Gates as they stand in TOML; `set` holds values by address (`footfall parameters`)."""

    description: str = ""
    cases: CasesTable
    set: dict[str, Any] = Field({})
    methods: Annotated[tuple[MethodEntry, ...], Field(strict=False)] = ()
    gates: Annotated[tuple[Gate, ...], Field(strict=False, min_length=1)]


@dataclass(frozen=True)
class Gates:
    """A file of gates, checked, with everything that its cases need.

    Attributes
    ----------
    source : the file; folder : where what it names lies
    setup : scenario, sensor and every method that is gated or gated against
    units, walks, seed : of the cases
    """

    source: str
    folder: Path
    description: str
    gates: tuple[Gate, ...]
    setup: Setup
    units: int
    walks: int
    seed: int

    @property
    def name(self) -> str:
        """The file's without its ending."""
        return Path(self.source).stem

    def baseline(self, gate: Gate) -> Path | None:
        """The file with the scores that a gate is against; None where it is against a method, or nothing."""
        is_file = gate.against is not None and gate.against.endswith(".parquet")
        return self.folder / str(gate.against) if is_file else None

    def margin_percent(self, gate: Gate) -> float:
        """Of a comparison that says none: 2 where nothing corrects the heading, or else 10."""
        known = {method.name: method for method in self.setup.methods}
        compared = (known[name] for name in (gate.method, gate.against) if name in known)
        return _MARGIN_PERCENT[all(map(is_uncorrected, compared))]

    def with_units(self, units: int) -> Gates:
        """The same over other cases.

        Raises
        ------
        InputError
            So few that a gate could never pass.
        """
        _require_enough(self.gates, units, self.source)
        return replace(self, units=units)

    def quick(self) -> Gates:
        """The same over 20 units, or as many as a gate needs."""
        return replace(self, units=min(self.units, max(QUICK, *map(needed, self.gates))))


def is_uncorrected(method: Method) -> bool:
    """Whether its heading is the gyro's own."""
    return any(method.run is METHODS[name].run for name in UNCORRECTED)


def needed(gate: Gate, alpha: float = ALPHA) -> int:
    """How few cases can let a gate pass."""
    return 1 if gate.statistic == "same" else fewest(gate.share, alpha)


def stock_gates() -> tuple[str, ...]:
    """Names of the files of gates that come with Footfall."""
    return tuple(sorted(file.name.removesuffix(ENDING) for file in STOCK.glob(f"*{ENDING}")))


def described(names: Iterable[str]) -> dict[str, str]:
    """Gates that come with Footfall -> what they are about."""
    files = ((name, STOCK / f"{name}{ENDING}") for name in names)
    return {name: checked(parse_toml(file), GatesFile, str(file)).description for name, file in files}


def read_gates(
    source: str | os.PathLike[str], methods: Mapping[str, Method | Callable[..., Track]] | None = None
) -> Gates:
    """Gates from a TOML file, or those of a name that come with Footfall.

    Parameters
    ----------
    methods : further ones by name, in place of what the file says of that name

    Raises
    ------
    InputError
        What cannot be read, found, or gated.
    """
    path = Path(source)
    if str(source) in stock_gates():
        path = STOCK / f"{source}{ENDING}"
    elif path.suffix != ".toml":
        raise InputError(f"gates are a TOML file{did_you_mean(str(source), stock_gates())}", source)
    file = checked(parse_toml(path), GatesFile, str(path))
    try:
        return _resolved(file, path, methods or {})
    except InputError as error:
        raise error.about(path) from None


def _resolved(file: GatesFile, path: Path, given: Mapping[str, Method | Callable[..., Track]]) -> Gates:
    _require_once("gate", [gate.name for gate in file.gates])
    own = [method_of(entry, path.parent) for entry in file.methods]
    _require_once("method", [method.name for method in own])
    known = {name: find_method(name) for name in (*METHODS, *entry_point_names())}
    known |= {method.name: method for method in own}
    known |= {name: find_method(method, name=name) for name, method in given.items()}
    names = _names(file.gates)
    if unknown := [name for name in names if name not in known]:
        raise InputError(f"method {unknown[0]!r}: unknown{did_you_mean(unknown[0], known)}")
    folder, cases = path.parent, file.cases
    scenario = cases.scenario if cases.scenario in stock_scenarios() else beside(cases.scenario, folder)
    imu = None if cases.imu is None else beside(cases.imu, folder)
    found = [known[name] for name in names]
    base = documents(scenario, imu=imu, methods=found)
    setup = with_values(base, file.set).setup()
    uncorrected = all(is_uncorrected(method) for method in setup.methods)
    seeds = setup.scenario.seeds
    made = Gates(
        source=str(path),
        folder=folder,
        description=file.description,
        gates=file.gates,
        setup=setup,
        units=cases.units or _UNITS[uncorrected],
        walks=cases.walks or seeds.walks,
        seed=seeds.base if cases.seed is None else cases.seed,
    )
    for gate in made.gates:
        if gate.against == gate.method:
            raise InputError(f"gate {gate.name!r}: {gate.method} against itself")
    _require_enough(made.gates, made.units)
    return made


def _names(gates: Sequence[Gate]) -> list[str]:
    """Of the methods, in the order in which the gates speak of them."""
    spoken = [name for gate in gates for name in (gate.method, gate.against)]
    return [name for name in dict.fromkeys(spoken) if name is not None and not name.endswith(".parquet")]


def _require_once(what: str, names: Sequence[str]) -> None:
    name, count = Counter(names).most_common(1)[0] if names else ("", 1)
    if count > 1:
        raise InputError(f"two {what}s are called {name!r}")


def _require_enough(gates: Sequence[Gate], units: int, source: str | None = None) -> None:
    for gate in gates:
        if units < needed(gate):
            raise InputError(
                f"gate {gate.name!r}: {gate.statistic} needs {needed(gate)} cases to pass, and there are "
                f"{units} units",
                source,
            )
