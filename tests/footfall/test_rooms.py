"""Data flows one way: no room imports from one that stands below it, and there is no circle."""

import ast
from pathlib import Path

import pytest

import footfall

# Each room, and the rooms that it may know beside what stands in `footfall` itself.
KNOWS = {
    "models": set(),
    "simulate": {"models"},
    "pdr": set(),
    "hdr": {"pdr"},
    "scenarios": {"models", "simulate", "pdr", "hdr"},
    "cli": {"models", "simulate", "pdr", "hdr", "scenarios"},
}
ROOT = Path(footfall.__file__).parent
# The front door: public names, imported when they are used, and `python -m footfall`.
DOOR = {"__init__.py", "__main__.py", "_gymnasium.py", "studies.py"}


def modules(file: Path) -> set[str]:
    """What a file imports of Footfall, at once or late."""
    found = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom):
            found |= {node.module or "", *(f"{node.module}.{name.name}" for name in node.names)}
        elif isinstance(node, ast.Import):
            found |= {name.name for name in node.names}
        elif isinstance(node, ast.Call) and ast.unparse(node.func) == "late":
            found |= {ast.literal_eval(argument) for argument in node.args}
    return {name for name in found if name.startswith("footfall.")}


def rooms_of(file: Path) -> set[str]:
    return {name.split(".")[1] for name in modules(file)} & set(KNOWS)


@pytest.mark.parametrize("room", KNOWS)
def test_a_room_knows_only_those_above_it(room):
    files = list((ROOT / room).rglob("*.py"))
    assert files
    for file in files:
        assert rooms_of(file) <= KNOWS[room] | {room}, file


def test_what_all_rooms_share_knows_none_of_them():
    files = [file for file in ROOT.glob("*.py") if file.name not in DOOR]
    assert len(files) > 10
    for file in files:
        assert not rooms_of(file), file


def test_readers_of_files_know_dead_reckoning_which_knows_no_files():
    """What is read is judged by physics."""
    for file in (ROOT / "formats").rglob("*.py"):
        assert rooms_of(file) <= {"pdr"}, file
    for room in ("models", "simulate", "pdr"):
        for file in (ROOT / room).rglob("*.py"):
            assert not any(name.startswith("footfall.formats") for name in modules(file)), file
