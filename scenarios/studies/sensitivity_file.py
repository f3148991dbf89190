"""The file of a sensitivity study: what is varied, for the errors of which methods, over which cases."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, field_validator, model_validator

from footfall.addresses import pattern
from footfall.errors import InputError
from footfall.scenarios.listing import parameters
from footfall.scenarios.parameters import Documents, documents, with_values
from footfall.scenarios.studies.factors import Factor, FactorTable, factors_of, points_at
from footfall.scenarios.studies.points import Over, Worn, require_allowed, require_metric
from footfall.toml import Strict, checked, no_such_file, parse_toml

FOLDER = Path(__file__).resolve().parent / "stock" / "sensitivity"  # of the studies that come with Footfall
UNIT = "unit"  # the factor that is the unit itself

Fidelity = Literal["full", "budget"]


class MorrisTable(Strict):
    trajectories: Annotated[int, Field(ge=2)] = 50


class SobolTable(Strict):
    samples: Annotated[int, Field(ge=16)] = 1024
    at_most: Annotated[int, Field(ge=16)] = 8192
    widest: Annotated[float, Field(gt=0)] = 0.1

    @field_validator("samples", "at_most")
    @classmethod
    def _power_of_two(cls, value: int) -> int:
        if value & (value - 1):
            raise ValueError("expected a power of 2, or the sequence loses its balance")
        return value


class SensitivityFile(Strict):
    """A study's file (docs/sensitivity.md)."""

    description: Annotated[str, Field(min_length=1)]
    scenario: str
    imu: str | None = None
    methods: Annotated[tuple[str, ...], Field(strict=False, min_length=1)] = ("hdr",)
    metric: str = "heading_error_mean_deg"
    over: Over = "median"
    of: Literal["ratio", "difference"] = "ratio"
    fidelity: Fidelity = "full"
    units_as_factor: bool = False
    seed: Annotated[int, Field(ge=0)] = 1
    cases: Worn = Worn()
    set: dict[str, Any] = Field(default_factory=dict)
    parameters: dict[str, FactorTable]
    morris: MorrisTable | None = None
    sobol: SobolTable | None = None

    @model_validator(mode="after")
    def _something_to_do(self) -> SensitivityFile:
        if self.morris is None and self.sobol is None:
            raise ValueError("neither [morris] nor [sobol]: expected one of them, or both")
        if len(self.parameters) + self.units_as_factor < 2:
            raise ValueError("one parameter alone has nothing to be compared with: expected at least 2")
        return self


@dataclass(frozen=True)
class Study:
    """A study as it is understood.

    Attributes
    ----------
    name : of its file
    file : what stands there
    base : the documents, with its methods and all that it sets
    factors : what is varied, the unit last where it is a factor
    """

    name: str
    file: SensitivityFile
    base: Documents
    factors: tuple[Factor, ...]

    def points(self, shares: np.ndarray) -> tuple[list[dict[str, Any]], np.ndarray | None]:
        """Address -> value at shares (p, factors); and which case each is, where the unit is a factor."""
        if not self.file.units_as_factor:
            return points_at(self.factors, shares), None
        units = len(self.factors[-1].ends)
        which = np.minimum((shares[:, -1] * units).astype(int), units - 1)
        return points_at(self.factors[:-1], shares), which

    def without_unit(self) -> Study:
        """The same over all units at each point, where the unit is a factor."""
        file = self.file.model_copy(update={"units_as_factor": False})
        return replace(self, file=file, factors=self.varied)

    @property
    def varied(self) -> tuple[Factor, ...]:
        """The factors that have an address: all but the unit."""
        return self.factors[:-1] if self.file.units_as_factor else self.factors


def stock_studies() -> dict[str, Path]:
    """Name -> file of the studies that come with Footfall."""
    return {path.stem: path for path in sorted(FOLDER.glob("*.toml"))}


def read_study(name_or_path: str, changes: Mapping[str, Any] | None = None) -> Study:
    """A study that comes with Footfall by name, or your own by the path of its TOML file.

    Parameters
    ----------
    **changes : keys of the file with other values

    Raises
    ------
    InputError
        Neither a name nor a file; what the file, its scenario, method or a parameter's range refuses.
    """
    stock = stock_studies()
    path = stock.get(name_or_path, Path(name_or_path))
    if not path.is_file():
        raise no_such_file("study", name_or_path, stock)
    return build_study(path.stem, {**parse_toml(path), **(changes or {})}, str(path))


def build_study(name: str, table: Mapping[str, Any], source: str) -> Study:
    """The study that a document describes.

    Raises
    ------
    InputError
        As of `read_study`.
    """
    file = checked(table, SensitivityFile, source)
    try:
        require_metric(file.metric)
        base = documents(file.scenario, imu=file.imu, methods=file.methods)
        base = with_values(base, file.set)
        factors = with_units(base, factors_of(file.parameters))
        require_allowed(base, factors)
    except InputError as error:
        raise error.about(source) from None
    if file.units_as_factor:
        dealt = file.cases.deal(base.setup())
        units = tuple(trial.unit_seed for trial in dealt)
        factors = (*factors, Factor(UNIT, 0.0, len(units) - 1.0, values=units))
    return Study(name, file, base, factors)


def with_units(base: Documents, factors: Sequence[Factor]) -> tuple[Factor, ...]:
    """The factors with the units of their addresses."""
    units = {pattern(one.address): one.unit for one in parameters(base)}
    return tuple(replace(factor, unit=units.get(pattern(factor.address), "")) for factor in factors)
