"""Compiled kernels are kept, and never outlive what they were compiled from."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.helpers.places import ROOT

KERNEL = """
from footfall.compiled import kernel
from footfall.law import FACTOR

@kernel()
def scaled(x):
    return FACTOR * x
"""
# A package of its own in Footfall's place; what it gives, and whether that came from the cache.
RUN = """
import importlib.util, sys
from pathlib import Path
from footfall import compiled, sources
sources._ROOT = Path.cwd()
for name in ("constant", "law", "kernels"):
    spec = importlib.util.spec_from_file_location(f"footfall.{name}", f"{name}.py")
    sys.modules[spec.name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(sys.modules[spec.name])
scaled = sys.modules["footfall.kernels"].scaled
print(scaled(1.0), sum(scaled.stats.cache_hits.values()))
"""


@pytest.fixture
def package(tmp_path: Path) -> Path:
    files = {
        "kernels": KERNEL,
        "law": "from footfall.constant import FACTOR\n",
        "constant": "FACTOR = 2.0\n",
        "compiled": "",
        "unused": "",
    }
    for name, text in files.items():
        (tmp_path / f"{name}.py").write_text(text)
    return tmp_path


def run(folder: Path) -> tuple[float, int]:
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1", "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-c", RUN], cwd=folder, env=environment, capture_output=True, text=True, check=True
    )
    value, hits = done.stdout.split()
    return float(value), int(hits)


def test_a_kernel_follows_a_constant_that_it_has_by_way_of_another_file(package: Path) -> None:
    """Of the same size and age, which is all that numba asks, and of the kernel's own file alone."""
    assert run(package) == (2.0, 0)
    assert run(package) == (2.0, 1)
    file = package / "constant.py"
    age = file.stat().st_mtime_ns
    file.write_text("FACTOR = 3.0\n")
    os.utime(file, ns=(age, age))
    assert run(package) == (3.0, 0)
    assert run(package) == (3.0, 1)


def test_what_a_kernel_is_not_made_of_leaves_it_alone(package: Path) -> None:
    """A file that nobody imports, and new times on all of them, as after a checkout."""
    assert run(package) == (2.0, 0)
    (package / "unused.py").write_text("x = 1\n")
    for file in package.glob("*.py"):
        os.utime(file, (1e9, 1e9))
    assert run(package) == (2.0, 1)


@pytest.mark.parametrize("room", ["models", "simulate", "pdr", "hdr", "scenarios", "footfall"])
def test_every_kernel_of_the_house_is_kept_this_way(room: str) -> None:
    others = [
        file
        for file in (ROOT / room).rglob("*.py")
        if "njit(" in file.read_text(encoding="utf-8") and file.name != "compiled.py"
    ]
    assert not others
