"""Compiled kernels never outlive what they were compiled from."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from footfall.compiled import forget_stale

KERNEL = """
from numba import njit
from other import FACTOR

@njit(cache=True)
def scaled(x):
    return FACTOR * x
"""


def run(folder: Path) -> float:
    source = (
        "from pathlib import Path\nfrom footfall.compiled import forget_stale\n"
        "forget_stale(Path('.').resolve())\nfrom kernel import scaled\nprint(scaled(1.0))"
    )
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1", "PYTHONPATH": str(folder)}
    done = subprocess.run(
        [sys.executable, "-c", source],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    return float(done.stdout)


def test_a_kernel_follows_a_constant_of_another_file(tmp_path: Path) -> None:
    (tmp_path / "kernel.py").write_text(KERNEL)
    (tmp_path / "other.py").write_text("FACTOR = 2.0\n")
    assert run(tmp_path) == 2.0
    assert list((tmp_path / "__pycache__").glob("*.nbi"))
    (tmp_path / "other.py").write_text("FACTOR = 3.0\n")
    later = max(index.stat().st_mtime for index in (tmp_path / "__pycache__").glob("*.nbi")) + 1
    os.utime(tmp_path / "other.py", (later, later))
    assert run(tmp_path) == 3.0


def test_a_cache_as_new_as_its_sources_stays(tmp_path: Path) -> None:
    (tmp_path / "kernel.py").write_text(KERNEL)
    cache = tmp_path / "__pycache__"
    cache.mkdir()
    index = cache / "kernel.scaled-1.nbi"
    index.write_bytes(b"")
    forget_stale(tmp_path)
    assert index.exists()
    os.utime(index, (0, 0))
    forget_stale(tmp_path)
    assert not index.exists()
