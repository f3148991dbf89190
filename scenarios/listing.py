"""Every parameter by its address: type, unit, value, bounds, and the stage that a change repeats."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from footfall.addresses import keys, parse, there
from footfall.models.imu.override import CONSTANTS
from footfall.models.imu.spec import ImuSheet
from footfall.pdr.detectors import DETECTORS
from footfall.scenarios.layouts import concerns
from footfall.scenarios.parameters import Documents, opened_subjects
from footfall.scenarios.scenario import ScenarioFile
from footfall.settings import kind_of, leaves

STAGES = ("walk", "record", "reckon", "track")  # in the order of the data; a stage repeats all after it

# What of a scenario does not concern the walk.
_LATER = {
    "scenario.temperature": "record",
    "scenario.sensor.imu": "record",
    "scenario.sensor.bias_shift_deg_s": "record",
    "scenario.seeds.units": "record",
    "scenario.sensor.bias_time_s": "reckon",
}
_NO_PARAMETERS = {"scenario.description", "scenario.sensor.imu", "imu.name"}
_ENDINGS = {
    "_deg_s_g2": "deg/s/g2", "_deg_s_g": "deg/s/g", "_deg_s_k2": "deg/s/K2", "_deg_s_k": "deg/s/K",
    "_deg_rt_h": "deg/rt-h", "_deg_h_rt_h": "deg/h/rt-h", "_deg_h": "deg/h", "_deg_s": "deg/s", "_deg": "deg",
    "_ug_rt_hz": "ug/rt-Hz", "_ug_rt_h": "ug/rt-h", "_ug_g2": "ug/g2", "_ug": "ug",
    "_mg_k2": "mg/K2", "_mg_k": "mg/K", "_mg": "mg", "_g": "g", "_percent_fs": "% of full scale",
    "_percent": "%", "_m_s": "m/s", "_degC": "degC", "_hz": "Hz", "_Ns": "N s", "_kg": "kg",
    "_m": "m", "_s": "s",
}  # fmt: skip


class Parameter(NamedTuple):
    """One value that can be set.

    stage : the first one that a new value repeats (`STAGES`)
    """

    address: str
    type: str
    unit: str
    default: Any
    bounds: str
    stage: str


def parameters(base: Documents) -> Iterator[Parameter]:
    """Every address with what stands there now."""
    for key in keys(ScenarioFile):
        address = f"scenario.{key.address}"
        table = opened_subjects(base.scenario.table, key.address)
        told = there(table, key.address) and concerns(key.address, table.get("path"))
        if address in _NO_PARAMETERS or not told:
            continue
        stage = next((stage for head, stage in _LATER.items() if address.startswith(head)), "walk")
        now = _now(table, key.address, key.default)
        yield Parameter(address, key.type, _unit_of(address), now, key.bounds, stage)
    for key in keys(ImuSheet):
        address = f"imu.{key.address}"
        if address not in _NO_PARAMETERS:
            now = _now(base.sheet.table, key.address, key.default)
            yield Parameter(address, key.type, _unit_of(address), now, key.bounds, "record")
    for name, constant in CONSTANTS.items():
        kind = "list of 3 numbers" if len(constant.shape) == 1 else "list of 3 rows of 3 numbers"
        yield Parameter(f"unit.{name}", kind, _unit_of(name), "drawn", "", "record")
    made = base.setup()
    yield Parameter("pdr.detector", " or ".join(DETECTORS), "", base.detector or "threshold", "", "reckon")
    yield from _settings("pdr", made.pdr, "reckon")
    yield from _settings("filter", made.guided, "track")
    for method in base.methods:
        if method.params is not None:
            yield from _settings(method.name, method.params, "track")


def _settings(area: str, params: Any, stage: str) -> Iterator[Parameter]:
    for leaf in leaves(params):
        bounds = {">=": leaf.ge, ">": leaf.gt, "<=": leaf.le, "<": leaf.lt}
        said = ", ".join(f"{sign} {value:g}" for sign, value in bounds.items() if value is not None)
        yield Parameter(f"{area}.{leaf.name}", kind_of(leaf.type), leaf.unit, leaf.value, said, stage)


def _unit_of(address: str) -> str:
    name = address.rsplit(".", 1)[-1]
    return next((unit for ending, unit in _ENDINGS.items() if name.endswith(ending)), "")


def _now(table: Mapping[str, Any], address: str, default: Any) -> Any:
    """What a document holds at an address; the different values where that is several, else the default."""
    found: list[Any] = [table]
    for part in parse(address):
        below = []
        for one in found:
            if isinstance(one, dict) and part.name in one:
                value = one[part.name]
                if part.which is None:
                    below += value if isinstance(value, list) and _tables(value) else [value]
                else:
                    key, _, text = part.which.partition("=")
                    entries = value if isinstance(value, list) else [value]
                    below += [e for e in entries if not text or (isinstance(e, dict) and e.get(key) == text)]
        found = below
    if not found or found == [table]:
        return default
    different = [one for i, one in enumerate(found) if one not in found[:i]]
    return different[0] if len(different) == 1 else different


def _tables(values: list[Any]) -> bool:
    return bool(values) and all(isinstance(value, dict) for value in values)
