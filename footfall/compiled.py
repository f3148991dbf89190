"""Compiled kernels are never older than what they were compiled from."""

from __future__ import annotations

from pathlib import Path


def forget_stale(*rooms: Path) -> None:
    """Drop numba's cache of these folders' kernels where any of their sources is newer.

    numba looks only at the file that a kernel stands in. What the kernel calls or reads elsewhere may have
    changed since, as after an update of a checkout, and would silently stay as it was.
    """
    sources = [path.stat().st_mtime for room in rooms for path in room.rglob("*.py")]
    for room in rooms:
        for index in room.rglob("__pycache__/*.nbi"):
            try:
                if index.stat().st_mtime < max(sources):
                    index.unlink()
            except OSError:  # another process was faster, or the installation is not ours to change
                pass
