"""The front door to studies: `from footfall.studies import Study, sweep, parameters`.

The names are imported when they are first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from footfall.scenarios.parameters import documents, parameters
    from footfall.scenarios.studies.plan import plan_of
    from footfall.scenarios.studies.study import Study, stock_studies
    from footfall.scenarios.studies.sweep import Progress, StoppedError, sweep

__all__ = [
    "Progress",
    "StoppedError",
    "Study",
    "documents",
    "parameters",
    "plan_of",
    "stock_studies",
    "sweep",
]

_HOMES = {
    "Progress": "studies.sweep",
    "StoppedError": "studies.sweep",
    "Study": "studies.study",
    "documents": "parameters",
    "parameters": "parameters",
    "plan_of": "studies.plan",
    "stock_studies": "studies.study",
    "sweep": "studies.sweep",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = globals()[name] = getattr(import_module(f"footfall.scenarios.{_HOMES[name]}"), name)
    return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
