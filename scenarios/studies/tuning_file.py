"""The file of a tuning: which parameters of a method, on which cases, and on which others it is judged."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field

from footfall.addresses import pattern
from footfall.errors import InputError
from footfall.scenarios.listing import parameters
from footfall.scenarios.parameters import Documents, documents, with_values
from footfall.scenarios.studies.factors import Factor, FactorTable, factors_of
from footfall.scenarios.studies.points import Over, Worn, require_allowed, require_metric
from footfall.scenarios.studies.sensitivity_file import with_units
from footfall.scenarios.studies.tune import require_apart
from footfall.scenarios.trial import Trial
from footfall.toml import Strict, checked, no_such_file, parse_toml

FOLDER = Path(__file__).resolve().parent / "stock" / "tuning"  # of the studies that come with Footfall


class TuningFile(Strict):
    """A tuning's file (docs/tuning.md)."""

    description: str = ""
    scenario: str
    imu: str | None = None
    method: str = "hdr"
    metric: str = "heading_error_mean_deg"
    over: Over = "median"
    trials: Annotated[int, Field(ge=2)] | None = None
    seed: Annotated[int, Field(ge=0)] = 1
    train: Worn
    test: Worn
    set: dict[str, Any] = Field(default_factory=dict)
    parameters: Annotated[dict[str, FactorTable], Field(min_length=1)]


@dataclass(frozen=True)
class Tuning:
    """A tuning as it is understood.

    Attributes
    ----------
    name : of its file
    base : the documents, with its method and all that it sets
    factors : what is tuned
    train, test : the cases, which share no walk and no unit
    """

    name: str
    file: TuningFile
    base: Documents
    factors: tuple[Factor, ...]
    train: tuple[Trial, ...]
    test: tuple[Trial, ...]

    def defaults(self) -> dict[str, Any]:
        """Address -> value of what is tuned, as it is."""
        now = {pattern(one.address): one.default for one in parameters(self.base)}
        return {factor.address: now[pattern(factor.address)] for factor in self.factors}


def stock_tunings() -> dict[str, Path]:
    """Name -> file of the tunings that come with Footfall."""
    return {path.stem: path for path in sorted(FOLDER.glob("*.toml"))}


def read_tuning(name_or_path: str, changes: Mapping[str, Any] | None = None) -> Tuning:
    """A tuning that comes with Footfall by name, or your own by the path of its TOML file.

    Parameters
    ----------
    **changes : keys of the file with other values; those of a table are changed one by one

    Raises
    ------
    InputError
        Neither a name nor a file; what the file, its scenario, method or a parameter's range refuses; or
        train and test share a walk or a unit.
    """
    stock = stock_tunings()
    path = stock.get(name_or_path, Path(name_or_path))
    if not path.is_file():
        raise no_such_file("tuning", name_or_path, stock)
    table = parse_toml(path)
    for key, value in (changes or {}).items():
        before = table.get(key)
        table[key] = {**before, **value} if isinstance(before, dict) and isinstance(value, dict) else value
    return build_tuning(path.stem, table, str(path))


def build_tuning(name: str, table: Mapping[str, Any], source: str) -> Tuning:
    """The tuning that a document describes.

    Raises
    ------
    InputError
        As of `read_tuning`.
    """
    file = checked(table, TuningFile, source)
    try:
        require_metric(file.metric)
        base = with_values(documents(file.scenario, imu=file.imu, methods=[file.method]), file.set)
        factors = with_units(base, factors_of(file.parameters))
        require_allowed(base, factors)
        setup = base.setup()
        train, test = tuple(file.train.deal(setup)), tuple(file.test.deal(setup))
        require_apart("walk seed", (one.walk_seed for one in train), (one.walk_seed for one in test))
        require_apart("unit", (one.unit_seed for one in train), (one.unit_seed for one in test))
    except InputError as error:
        raise error.about(source) from None
    return Tuning(name, file, base, factors, train, test)
