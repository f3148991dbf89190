"""The front door to studies: `from footfall.studies import Study, sweep, gate, parameters`.

The names are imported when they are first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from footfall.scenarios.judge.verdict import Verdict
    from footfall.scenarios.listing import parameters
    from footfall.scenarios.parameters import documents
    from footfall.scenarios.studies.gate import Judged, gate
    from footfall.scenarios.studies.gate_file import read_gates, stock_gates
    from footfall.scenarios.studies.map import ErrorMap, error_map
    from footfall.scenarios.studies.plan import plan_of
    from footfall.scenarios.studies.sensitivity import sensitivity
    from footfall.scenarios.studies.study import Study, stock_studies
    from footfall.scenarios.studies.sweep import Progress, sweep
    from footfall.scenarios.studies.task import StoppedError
    from footfall.scenarios.studies.tuning import tuned

__all__ = [
    "ErrorMap",
    "Judged",
    "Progress",
    "StoppedError",
    "Study",
    "Verdict",
    "documents",
    "error_map",
    "gate",
    "parameters",
    "plan_of",
    "read_gates",
    "sensitivity",
    "stock_gates",
    "stock_studies",
    "sweep",
    "tuned",
]

_HOMES = {
    "ErrorMap": "studies.map",
    "Judged": "studies.gate",
    "Progress": "studies.sweep",
    "StoppedError": "studies.task",
    "Study": "studies.study",
    "Verdict": "judge.verdict",
    "documents": "parameters",
    "error_map": "studies.map",
    "gate": "studies.gate",
    "parameters": "listing",
    "plan_of": "studies.plan",
    "read_gates": "studies.gate_file",
    "sensitivity": "studies.sensitivity",
    "stock_gates": "studies.gate_file",
    "stock_studies": "studies.study",
    "sweep": "studies.sweep",
    "tuned": "studies.tuning",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = globals()[name] = getattr(import_module(f"footfall.scenarios.{_HOMES[name]}"), name)
    return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
