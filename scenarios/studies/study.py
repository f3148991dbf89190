"""A study as it stands in TOML: what is walked, worn and varied, and which methods go over it."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field

from footfall.errors import InputError
from footfall.hdr.method import Method
from footfall.hdr.methods import find_method
from footfall.models.imu import stock_specs
from footfall.scenarios.parameters import AREAS, Documents, documents, with_values
from footfall.scenarios.run import OTHER_UNITS_FROM
from footfall.scenarios.scenario import stock_scenarios
from footfall.scenarios.studies.design import DesignTable
from footfall.scenarios.studies.methods import MethodEntry, beside, method_of
from footfall.scenarios.trial import find
from footfall.toml import Strict, checked, no_such_file, parse_toml

if TYPE_CHECKING:
    from footfall.scenarios.studies.results import Results

STOCK = Path(__file__).parent / "stock"
FIRST = ("imu", "pdr.detector")  # what other addresses are inside of is set before them


class CasesTable(Strict):
    """How many walks of each scenario, and units on them (`footfall.scenarios.evaluate.cases`)."""

    walks: int | None = Field(default=None, ge=1)
    seed: int | None = Field(default=None, ge=0)
    units: int = Field(default=20, ge=1)
    first_unit: int = Field(default=OTHER_UNITS_FROM, ge=0)
    noises: int = Field(default=1, ge=1)
    crossed: bool = False


class StudyFile(Strict):
    """A study's document."""

    description: Annotated[str, Field(min_length=1)]
    scenarios: Annotated[tuple[str, ...], Field(strict=False, min_length=1)]
    methods: Annotated[tuple[MethodEntry, ...], Field(strict=False)] = ()
    cases: CasesTable = CasesTable()
    design: DesignTable = DesignTable()
    fixed: dict[str, Any] = Field(default={}, alias="set")
    without: Annotated[tuple[str, ...], Field(strict=False)] = ()


@dataclass(frozen=True)
class Study:
    """A study as it was read; checked where it is used.

    Attributes
    ----------
    name : a stock study's, or its file's without the ending; of its folder of results, too
    table : TOML's tables
    folder : that names of files in it are relative to
    source : the file that errors speak of; the name where there is none
    objects : methods that no document can hold, beside those that it names
    """

    name: str
    table: Mapping[str, Any]
    folder: Path = Path()
    source: str = ""
    objects: tuple[Method, ...] = field(default=())

    @classmethod
    def read(cls, name_or_path: str | os.PathLike[str]) -> Study:
        """A stock study by name, or your own by the path of its TOML file.

        Raises
        ------
        InputError
            Neither; or a file that is not TOML.
        """
        if (name := os.fspath(name_or_path)) in stock_studies():
            file = STOCK / f"{name}.toml"
        elif not (file := Path(name)).is_file():
            raise no_such_file("study", name, stock_studies())
        return cls(file.stem, parse_toml(file), file.parent, str(file))

    def set(self, values: Mapping[str, Any]) -> Study:
        """The same with values, by address, that hold for all of it."""
        return self._with("set", values)

    def of(self, **cases: Any) -> Study:
        """The same with other `cases`: `study.of(walks=1, units=10)`."""
        return self._with("cases", cases)

    def add(self, name: str, method: Callable[..., Any] | Method) -> Study:
        """The same with a method that is a Python object."""
        return replace(self, objects=(*self.objects, find_method(method, name=name)))

    @cached_property
    def file(self) -> StudyFile:
        """The document, checked.

        Raises
        ------
        InputError
            The first mistake in it.
        """
        return checked(self.table, StudyFile, self.source or self.name)

    @cached_property
    def methods(self) -> tuple[Method, ...]:
        """What goes over every recording.

        Raises
        ------
        InputError
            None at all, one that cannot be found, or two of one name.
        """
        with self.blamed():
            found = find([*(method_of(entry, self.folder) for entry in self.file.methods), *self.objects])
            if not found:
                raise InputError("methods: expected at least one")
            return found

    def documents(self) -> dict[str, Documents]:
        """Scenario's name -> what its trials are built from, with the values that hold for all of the study.

        Raises
        ------
        InputError
            A scenario or value that cannot be; or two scenarios of one name.
        """
        made: dict[str, Documents] = {}
        with self.blamed():
            for entry in self.file.scenarios:
                base = documents(self._scenario(entry), methods=self.methods, without=self.file.without)
                if base.scenario.name in made:
                    raise InputError(f"scenario {base.scenario.name!r} is given twice")
                own = str(base.scenario.table["sensor"]["imu"])  # as it is written there
                base = replace(base, sheet=replace(base.sheet, name=own))
                made[base.scenario.name] = self.valued(base, self.file.fixed)
        return made

    def valued(self, base: Documents, values: Mapping[str, Any]) -> Documents:
        """Documents with values by address; sheets are found beside the study."""
        told = {address: values[address] for address in FIRST if address in values}
        told |= {address: value for address, value in values.items() if address not in told}
        if "imu" in told:  # called in the rows as it is written here
            name = str(told.pop("imu"))
            base = with_values(base, {"imu": name if name in stock_specs() else beside(name, self.folder)})
            base = replace(base, sheet=replace(base.sheet, name=name))
        return with_values(base, told)

    def owner(self, address: str) -> str | None:
        """The method that an address belongs to; None where that is shared by all."""
        area = address.partition(".")[0]
        return area if area not in AREAS and any(one.name == area for one in self.methods) else None

    def blamed(self) -> Any:
        """A context whose mistakes are told of this study."""
        return _Blamed(self.source or self.name)

    def results(self, folder: str | os.PathLike[str] | None = None) -> Results:
        """The finished study's rows: a `table`, `to_pandas()` and `plot()`.

        Raises
        ------
        InputError
            There are none.
        """
        from footfall.scenarios.studies.results import Results
        from footfall.scenarios.studies.rows import read_rows

        return Results(read_rows(Path(folder or Path("out") / self.name) / "results.parquet"))

    def _with(self, table: str, values: Mapping[str, Any]) -> Study:
        return replace(self, table={**self.table, table: {**self.table.get(table, {}), **values}})

    def _scenario(self, entry: str) -> str:
        return entry if entry in stock_scenarios() else beside(entry, self.folder)


class _Blamed:
    def __init__(self, source: str) -> None:
        self._source = source

    def __enter__(self) -> None:
        pass

    def __exit__(self, kind: Any, error: BaseException | None, trace: Any) -> None:
        if isinstance(error, InputError):
            raise error.about(self._source) from None


def stock_studies() -> tuple[str, ...]:
    """Names of the studies that come with Footfall."""
    return tuple(sorted(file.stem for file in STOCK.glob("*.toml")))


def described(names: Iterable[str]) -> dict[str, str]:
    """Study -> its description."""
    return {name: Study.read(name).file.description for name in names}
