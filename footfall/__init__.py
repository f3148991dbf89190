"""Footfall: a physics-simulated gait testbed for pedestrian dead reckoning.

Data flows one way: scenario -> walk (truth) -> recording -> footfalls -> track -> score.

The names of `__all__` are imported when they are first used: `import footfall` alone loads none of its rooms.
"""

from importlib import import_module
from os.path import dirname, isdir, join
from typing import TYPE_CHECKING, Any

from footfall._gymnasium import register_when_imported

if TYPE_CHECKING:
    from footfall.errors import InputError
    from footfall.formats import read
    from footfall.hdr.method import Method
    from footfall.hdr.methods import METHODS
    from footfall.hdr.tracking import track
    from footfall.pdr.track import Track
    from footfall.recording import Recording
    from footfall.scenarios.evaluate import evaluate
    from footfall.scenarios.judge.score import compare, score
    from footfall.scenarios.scenario import load_scenario
    from footfall.simulate.walk import Walk

__version__ = "0.1.0"

__all__ = [
    "METHODS",
    "InputError",
    "Method",
    "Recording",
    "Track",
    "Walk",
    "__version__",
    "compare",
    "evaluate",
    "load_scenario",
    "read",
    "score",
    "track",
]

_HOMES = {
    "METHODS": "hdr.methods",
    "InputError": "errors",
    "Method": "hdr.method",
    "Recording": "recording",
    "Track": "pdr.track",
    "Walk": "simulate.walk",
    "compare": "scenarios.judge.score",
    "evaluate": "scenarios.evaluate",
    "load_scenario": "scenarios.scenario",
    "read": "formats",
    "score": "scenarios.judge.score",
    "track": "hdr.tracking",
}


for _room in (join(dirname(__file__), name) for name in ("models", "simulate", "pdr", "hdr", "scenarios")):
    if not isdir(_room):
        raise ImportError(
            f"{_room} should be a symbolic link to a folder, and git has not made it one: "
            "check out again with `git clone -c core.symlinks=true`"
        )


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = globals()[name] = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


register_when_imported()
