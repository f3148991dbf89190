"""A trial's documents, and the same with other values by address (what there is: listing.py).

`AREA.PATH`: the area tells which stage a new value repeats. Values pass the models that files pass.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any

from pydantic import BaseModel

from footfall.addresses import edited, keys, parse, pattern
from footfall.errors import InputError
from footfall.hdr.method import Method
from footfall.hdr.methods import METHODS
from footfall.models.imu import ImuSpec, SheetDocument, build_spec, read_sheet
from footfall.models.imu.override import CONSTANTS, overridden
from footfall.models.imu.spec import ImuSheet
from footfall.models.imu.unit import draw_unit
from footfall.models.subject import SHOES, SUBJECTS
from footfall.pdr.detectors import require_detector
from footfall.pdr.filter.ins import FilterSettings
from footfall.pdr.reckoning import PdrParams
from footfall.scenarios.scenario import (
    Scenario,
    ScenarioDocument,
    ScenarioFile,
    SubjectTable,
    build_scenario,
    listed,
    read_document,
)
from footfall.scenarios.trial import DEFAULT_METHODS, Setup, find, setup
from footfall.settings import changed, did_you_mean, leaves
from footfall.toml import parse_toml


@dataclass(frozen=True)
class Documents:
    """What a setup is built from.

    Attributes
    ----------
    scenario, sheet : as they stand in TOML
    methods : with their parameters
    detector : name, or None for dead reckoning's default
    pdr, guided, unit : edge name -> value, in place of the defaults
    """

    scenario: ScenarioDocument
    sheet: SheetDocument
    methods: tuple[Method, ...]
    detector: str | None = None
    pdr: Mapping[str, Any] = field(default_factory=dict)
    guided: Mapping[str, Any] = field(default_factory=dict)
    unit: Mapping[str, Any] = field(default_factory=dict)
    without: tuple[str, ...] = ()

    def setup(self, scenario: Scenario | None = None) -> Setup:
        """Checked and built.

        Parameters
        ----------
        scenario : what is built of its document, where it is there already

        Raises
        ------
        InputError
            What a file, a data sheet or a method refuses.
        """
        scenario = scenario or build_scenario(self.scenario)
        made = setup(scenario, imu=self.sheet, methods=self.methods, without=self.without)
        pdr = reckoning_params(made.pdr, self.detector, self.pdr)
        guided = _about("filter", made.guided, self.guided)
        if self.unit:  # refused here, not in every trial
            overridden(draw_unit(made.spec, 0), self.unit)
        return replace(made, pdr=pdr, guided=guided, unit=dict(self.unit))


def documents(
    scenario: str,
    *,
    imu: str | None = None,
    methods: Iterable[Any] = DEFAULT_METHODS,
    without: Iterable[str] = (),
) -> Documents:
    """The documents of a scenario by its name or file; its own sheet unless told otherwise.

    Parameters
    ----------
    imu : data sheet by name or file; None for the scenario's
    methods : as `footfall.hdr.methods.find_method` takes each
    without : sensor effects that are switched off

    Returns
    -------
    Documents
        What addresses change (`with_values`), and what a trial is made of (`setup()`).

    Raises
    ------
    InputError
        What cannot be read or found.
    """
    read = read_document(scenario)
    sheet = read_sheet(imu) if imu is not None else read_sheet(build_scenario(read).imu)
    return Documents(read, sheet, find(methods), without=tuple(without))


def parsed(settings: Iterable[str]) -> dict[str, Any]:
    """`ADDRESS=VALUE` texts as address -> value; a value is written as in TOML, text may go without quotes.

    `@FILE` stands for all of the table `[set]` of a TOML file, as `footfall tune` writes it.

    Raises
    ------
    InputError
        No "=", an address twice, or a file that has no such table.
    """
    found: dict[str, Any] = {}
    for setting in settings:
        if setting.startswith("@"):
            for address, value in _file_of_values(setting[1:]).items():
                if address in found:
                    raise InputError(f"--set {setting}: {address} is given twice")
                found[address] = value
            continue
        # An "=" in brackets chooses an element.
        match = re.fullmatch(r"((?:[^=\[]|\[[^\]]*\])+)=(.*)", setting, flags=re.DOTALL)
        if match is None:
            raise InputError(f"--set {setting}: expected ADDRESS=VALUE (see `footfall parameters`)")
        address, text = match[1].strip(), match[2].strip()
        if address in found:
            raise InputError(f"--set {address}: given twice")
        try:
            found[address] = tomllib.loads(f"value = {text}")["value"]
        except tomllib.TOMLDecodeError:
            found[address] = text
    return found


def _file_of_values(name: str) -> dict[str, Any]:
    values = parse_toml(name).get("set")
    if not isinstance(values, dict) or any(isinstance(value, dict) for value in values.values()):
        raise InputError('expected a table [set] of "ADDRESS" = VALUE', name)
    return values


def with_values(base: Documents, values: Mapping[str, Any]) -> Documents:
    """The documents with other values, by address, in their order.

    Raises
    ------
    InputError
        No such address, with the nearest one. What a value itself breaks is refused by `Documents.setup`,
        or here where the settings of a method are concerned.
    """
    for address, value in values.items():
        area, _, path = address.partition(".")
        own = {method.name for method in base.methods}
        if area in AREAS:  # first: the method pdr has no parameters of its own
            base = AREAS[area](base, address, path, value)
        elif area in own:
            base = replace(base, methods=tuple(_told(method, area, path, value) for method in base.methods))
        elif area in METHODS:
            raise InputError(f"method {area!r} is not among {', '.join(sorted(own))}", address)
        else:
            raise InputError(f"unknown area{did_you_mean(area, [*AREAS, *sorted(own)])}", address)
    return base


def _told(method: Method, area: str, path: str, value: Any) -> Method:
    if method.name != area:
        return method
    try:
        return method.with_params({path: value})
    except InputError as error:
        raise InputError(f"{area}.{error}") from None


def _scenario(base: Documents, address: str, path: str, value: Any) -> Documents:
    _require_known(address, _addresses("scenario", ScenarioFile))
    if address == "scenario.sensor.imu":
        raise InputError("set imu, or use the option --imu", address)
    table = opened_subjects(base.scenario.table, path)
    return replace(base, scenario=replace(base.scenario, table=edited(table, path, value)))


def opened_subjects(table: Mapping[str, Any], path: str) -> Mapping[str, Any]:
    """A stock subject's name becomes a table before something in it is set."""
    first, *rest = parse(path)
    subjects = table.get("subjects")
    if first.name != "subjects" or not rest:
        return table
    return {**table, "subjects": [_as_table(entry) for entry in listed(subjects)]}


def _as_table(entry: Any) -> Any:
    if not isinstance(entry, str) or entry not in SUBJECTS:
        return entry
    subject = SUBJECTS[entry]
    shoe = next(name for name, sole in SHOES.items() if sole == subject.sole_time_s)
    known = [name for name in SubjectTable.model_fields if name != "shoe"]
    return {name: getattr(subject, name) for name in known} | {"shoe": shoe}


def _imu(base: Documents, address: str, path: str, value: Any) -> Documents:
    return replace(base, sheet=_sheet_with(base.sheet, address, path, value))


def _sheet_with(sheet: SheetDocument, address: str, path: str, value: Any) -> SheetDocument:
    if not path:
        return read_sheet(str(value))
    known = _addresses("imu", ImuSheet)
    if address not in known:
        one = f"unit.{path}" if path in CONSTANTS else None
        spread = next((name for name in known if name.replace("_sigma", "") == address), None)
        if one and spread:
            raise InputError(f"unknown; did you mean {spread} (of the sheet) or {one} (of a unit)?", address)
        _require_known(address, known)
    return replace(sheet, table=edited(sheet.table, path, value))


def sensor(imu: str, values: Mapping[str, Any]) -> tuple[ImuSpec, dict[str, Any]]:
    """A data sheet with other values, and the constants of a unit that are given by hand (`overridden`).

    Raises
    ------
    InputError
        An address of another area, or a value that the sheet or the unit refuses.
    """
    require_areas(values, ("imu", "unit"), "record")
    sheet, unit = read_sheet(imu), {}
    for address, value in values.items():
        area, _, path = address.partition(".")
        if area == "imu":
            sheet = _sheet_with(sheet, address, path, value)
        else:
            _require_known(address, [f"unit.{name}" for name in CONSTANTS])
            unit[path] = value
    return build_spec(sheet), unit


def require_areas(values: Mapping[str, Any], areas: Collection[str], command: str) -> None:
    """Refuse addresses of stages that a command does not do."""
    for address in values:
        if address.partition(".")[0] not in areas:
            raise InputError(
                f"--set {address}: footfall {command} takes addresses of {', '.join(areas)} alone"
            )


def _unit(base: Documents, address: str, path: str, value: Any) -> Documents:
    _require_known(address, [f"unit.{name}" for name in CONSTANTS])
    return replace(base, unit={**base.unit, path: value})


def _pdr(base: Documents, address: str, path: str, value: Any) -> Documents:
    if path == "detector":
        return replace(base, detector=str(value))
    detector = require_detector(base.detector) if base.detector else PdrParams().detector
    own = [f"pdr.{leaf.name}" for leaf in leaves(PdrParams(detector=detector))]
    _require_known(address, ["pdr.detector", *own])
    return replace(base, pdr={**base.pdr, path: value})


def _filter(base: Documents, address: str, path: str, value: Any) -> Documents:
    _require_known(address, [f"filter.{leaf.name}" for leaf in leaves(FilterSettings())])
    return replace(base, guided={**base.guided, path: value})


AREAS = {"scenario": _scenario, "imu": _imu, "unit": _unit, "pdr": _pdr, "filter": _filter}


def reckoning_params(base: PdrParams, detector: str | None, values: Mapping[str, Any]) -> PdrParams:
    """Dead reckoning's settings with another detector and other values, by their edge names.

    Raises
    ------
    InputError
        No such detector or setting, or a value that it refuses.
    """
    chosen = base if detector is None else replace(base, detector=require_detector(detector))
    return _about("pdr", chosen, values)


def _about(area: str, base: Any, values: Mapping[str, Any]) -> Any:
    try:
        return changed(base, values)
    except InputError as error:
        raise InputError(f"{area}.{error}") from None


@lru_cache
def _addresses(area: str, model: type[BaseModel]) -> tuple[str, ...]:
    """Those of a document; studies ask for them at every point."""
    return tuple(f"{area}.{key.address}" for key in keys(model))


def _require_known(address: str, known: Iterable[str]) -> None:
    parse(address)
    patterns = {pattern(one) for one in known}
    if pattern(address) not in patterns:
        raise InputError(f"unknown{did_you_mean(pattern(address), sorted(patterns))}", address)
