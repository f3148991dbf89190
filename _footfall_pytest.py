"""Gates as tests: `@pytest.mark.footfall_gate("gates.toml")` makes one test a gate.

A module of its own at the top, which imports nothing of Footfall before a gate is asked for: pytest loads the
plug-ins of every installed package, in every project.
"""

from __future__ import annotations

import warnings
from collections.abc import Generator
from pathlib import Path
from typing import Any

import pytest

MARK = "footfall_gate"
_GATE = "_footfall_gate"  # argument that each test of a gate is given


class UndecidedGate(UserWarning):
    """The cases of a gate cannot decide it."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """What an undecided gate is."""
    parser.addini("footfall_undecided", "what an undecided gate does: fail (default) or warn", default="fail")


def pytest_configure(config: pytest.Config) -> None:
    """Make the marker known."""
    config.addinivalue_line(
        "markers",
        f"{MARK}(file, units=None, quick=False, methods=None): one test for each gate of a TOML file "
        "(Footfall, docs/gates.md)",
    )
    if (told := config.getini("footfall_undecided")) not in ("fail", "warn"):
        raise pytest.UsageError(f"footfall_undecided = {told}: expected fail or warn")


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """One test for each gate of the file."""
    mark = metafunc.definition.get_closest_marker(MARK)
    if mark is None:
        return
    from footfall.errors import InputError

    try:
        names = [gate.name for gate in _read(metafunc.definition.path.parent, mark).gates]
    except InputError as error:
        raise pytest.UsageError(str(error)) from None
    metafunc.fixturenames.append(_GATE)
    metafunc.parametrize(_GATE, names, ids=names)


@pytest.fixture
def footfall_cases(request: pytest.FixtureRequest) -> Any:
    """Rows of scores, one a case and method, of the gates of this test's marker (`footfall.evaluate` has them
    alike)."""
    mark = request.node.get_closest_marker(MARK)
    if mark is None:
        raise pytest.UsageError(f"footfall_cases: the test has no mark {MARK}")
    return _judged(request.node, mark).rows


@pytest.hookimpl(wrapper=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> Generator[None, Any, Any]:
    """The gate first, then what the test itself says."""
    mark = pyfuncitem.get_closest_marker(MARK)
    if mark is not None:
        from footfall.scenarios.report.gates import verdict_line

        name = pyfuncitem.callspec.params[_GATE]
        verdict = next(one for one in _judged(pyfuncitem, mark) if one.name == name)
        warns = pyfuncitem.config.getini("footfall_undecided") == "warn"
        if verdict.verdict == "undecided" and warns:
            warnings.warn(verdict_line(verdict), UndecidedGate, stacklevel=1)
        elif verdict.verdict != "pass":
            pytest.fail(verdict_line(verdict), pytrace=False)
    return (yield)


def _read(folder: Path, mark: pytest.Mark) -> Any:
    """The gates of a mark, whose file lies in the folder."""
    from footfall.scenarios.studies.gate_file import read_gates

    file, told = mark.args[0], dict(mark.kwargs)
    beside = folder / file
    gates = read_gates(beside if beside.is_file() else file, told.get("methods"))
    if told.get("units") is not None:
        gates = gates.with_units(told["units"])
    return gates.quick() if told.get("quick") else gates


_JUDGED = pytest.StashKey[dict[Any, Any]]()


def _judged(item: pytest.Item, mark: pytest.Mark) -> Any:
    """The verdicts of a mark, made once in a session."""
    from footfall.scenarios.studies.gate import gate

    known = item.config.stash.setdefault(_JUDGED, {})
    key = (
        item.path.parent,
        mark.args,
        tuple(sorted((name, id(value)) for name, value in mark.kwargs.items())),
    )
    if key not in known:
        known[key] = gate(_read(item.path.parent, mark))
    return known[key]
