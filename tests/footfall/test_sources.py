"""Which files a stage depends on: all that it loads, and nothing else."""

import json
import shutil
import subprocess
import sys

import pytest

from footfall import sources
from footfall.sources import NO_PART, STAGES, modules_of, stage_digest

LOADED = """
import importlib, json, sys
for module in sys.argv[1:]:
    importlib.import_module(module)
print(json.dumps({name: hasattr(module, "__path__") for name, module in sys.modules.items()
                  if name.startswith("footfall.")}))
"""
WALKER = ("state", "walkers", "steering", "disturbance", "_balance_kernels", "_stop_kernels")


@pytest.mark.parametrize("stage", STAGES)
def test_all_that_a_stage_loads_is_hashed(stage):
    """Python itself says what is loaded. A package's own file holds no more than what is imported from it."""
    done = subprocess.run(
        [sys.executable, "-c", LOADED, *STAGES[stage]], capture_output=True, text=True, check=True
    )
    loaded = {name for name, package in json.loads(done.stdout).items() if not package}
    hashed = set(modules_of(*STAGES[stage]))
    assert loaded - hashed <= NO_PART | {"footfall._gymnasium"}


def test_an_edit_of_what_does_not_walk_throws_no_walk_away():
    hashed = set(modules_of(*STAGES["walk"]))
    for part in ("draw", "render", "record", "budget", "from_recording", "cache", "learn"):
        assert not any(name.startswith(f"footfall.simulate.{part}") for name in hashed), part
    for room in ("pdr", "hdr", "scenarios", "cli", "formats", "models.imu", "models.appearance"):
        assert not any(name.startswith(f"footfall.{room}") for name in hashed), room
    assert {f"footfall.simulate.walker.{part}" for part in WALKER} <= hashed


@pytest.mark.parametrize(
    ("stage", "kernels"),
    [
        ("walk", "simulate._truth_kernels"),
        ("record", "simulate._budget_kernels"),
        ("reckon", "pdr._kernels"),
        ("reckon", "pdr._detection"),
        ("track", "pdr.filter._kernels"),
        ("track", "hdr._kernels"),
    ],
)
def test_kernels_that_are_imported_late_are_hashed_too(stage, kernels):
    assert f"footfall.{kernels}" in modules_of(*STAGES[stage])


def test_navigation_does_not_depend_on_how_walks_are_made():
    for stage in ("reckon", "track"):
        assert not any(name.startswith("footfall.simulate") for name in modules_of(*STAGES[stage]))
    assert not any("walking" in name for name in modules_of(*STAGES["score"]))


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A package of its own in Footfall's place."""
    files = {
        "__init__": "",
        "a": "import os\nfrom footfall import b\nfrom footfall.sub import name\nimport footfall.far.away\n"
        "fast, _ = late('footfall.fast'), late('scipy')\n",
        "b": "def later():\n    from footfall.c import thing\n",
        "c": "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from footfall import types_alone\n",
        "types_alone": "",
        "unused": "",
        "fast": "",
        "sub/__init__": "from footfall.sub.inner import name\n",
        "sub/inner": "name = 1\n",
        "sub/other": "",
        "far/__init__": "",
        "far/away": "from footfall import a\n",
    }
    for name, text in files.items():
        file = tmp_path / f"{name}.py"
        file.parent.mkdir(exist_ok=True)
        file.write_text(text)
    monkeypatch.setattr(sources, "_ROOT", tmp_path)
    monkeypatch.setitem(STAGES, "walk", ("footfall.a",))
    forget()
    yield tmp_path
    monkeypatch.undo()
    forget()


def forget() -> None:
    for function in (sources.stage_digest, sources.modules_of, sources.imports_of, sources._content):
        function.cache_clear()


def test_imports_are_followed_to_the_end(package):
    """Late ones, those through a package's own file, and round in circles; types alone count for nothing."""
    assert modules_of("footfall.a") == (
        "footfall.a", "footfall.b", "footfall.c", "footfall.far.away", "footfall.fast", "footfall.sub",
        "footfall.sub.inner",
    )  # fmt: skip


def test_the_digest_is_of_the_content_of_those_files_alone(package):
    before = stage_digest("walk")
    for name in ("unused", "types_alone", "sub/other"):
        (package / f"{name}.py").write_text("x = 2\n")
    forget()
    assert stage_digest("walk") == before
    kept = shutil.copytree(package, package.parent / "kept")
    for name in ("a", "b", "c", "sub/__init__", "sub/inner", "far/away", "fast"):
        file = package / f"{name}.py"
        file.write_text((kept / f"{name}.py").read_text() + "x = 2\n")
        forget()
        assert stage_digest("walk") != before, name
        shutil.copy(kept / f"{name}.py", file)
    forget()
    assert stage_digest("walk") == before
