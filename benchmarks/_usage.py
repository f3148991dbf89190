"""What processes take of the processors and of memory; NaN where the system does not tell, as Windows."""

from __future__ import annotations

import math
import sys
from pathlib import Path

try:
    import resource
except ImportError:  # Windows
    resource = None  # type: ignore[assignment]

_PEAK_BYTES = 1 if sys.platform == "darwin" else 1024  # the unit of ru_maxrss


def children_cpu_s() -> float:
    """Processor time (s), the system's included, of all processes that this one started and that ended."""
    if resource is None:
        return math.nan
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def peak_bytes() -> float:
    """The most memory (bytes) that this process has held."""
    return math.nan if resource is None else _peak(resource.RUSAGE_SELF)


def children_peak_bytes() -> float:
    """The most memory (bytes) that any process held that this one started and that ended."""
    return math.nan if resource is None else _peak(resource.RUSAGE_CHILDREN)


def resident_bytes() -> float:
    """Memory (bytes) of this process; Linux tells it."""
    try:
        pages = Path("/proc/self/statm").read_text(encoding="utf-8").split()[1]
    except OSError:
        return math.nan
    return float(int(pages) * resource.getpagesize())


def _peak(whose: int) -> float:
    return float(resource.getrusage(whose).ru_maxrss * _PEAK_BYTES)
