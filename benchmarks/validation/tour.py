"""A stranger's tour, timed: list, run, walk, record, track, render, and a method of three lines evaluated.

Everything is as after an installation: no walk is in the cache and no kernel is compiled. Each step is a
process of its own; what it took by the clock and of the processors is told, beside five minutes in all.

python -m benchmarks.validation.tour
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

from rich.table import Table

from benchmarks._common import options, out, write_json
from benchmarks._usage import children_cpu_s

TARGET_S = 300.0
SCENARIO = "block"

METHOD = f"""
import footfall
import numpy as np
from footfall.hdr.correct import turned_positions


def four_ways(footfalls, start):
    heading = np.round(footfalls.heading / (np.pi / 2)) * np.pi / 2
    return footfall.Track(footfalls.t, turned_positions(footfalls, heading), heading)


four_ways.needs = "footfalls"

if __name__ == "__main__":
    print(footfall.evaluate(["pdr", four_ways], "{SCENARIO}", units=10))
"""

STEPS = (
    "footfall list",
    f"footfall run {SCENARIO}",
    f"footfall walk {SCENARIO} -o walk.parquet",
    "footfall record walk.parquet --unit-seed 7 -o rec.parquet",
    "footfall track rec.parquet --method hdr -o hdr.parquet",
    "footfall score hdr.parquet walk.parquet",
    f"footfall render {SCENARIO} -o walker.webp",
    "python method.py",
)


class Took(NamedTuple):
    """What a step took, by the clock and of all processors (s), and how it ended."""

    step: str
    seconds: float
    processor_s: float
    code: int
    said: str


def take(step: str, folder: Path, environment: dict[str, str]) -> Took:
    """Do a step in a folder, with its words kept."""
    program, *words = step.split()
    command = [sys.executable, *(("-m", "footfall") if program == "footfall" else ()), *words]
    before, begin = children_cpu_s(), time.perf_counter()
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    seconds, used = time.perf_counter() - begin, children_cpu_s() - before
    return Took(step, seconds, used, done.returncode, (done.stderr or done.stdout).strip())


def tour(steps: tuple[str, ...] = STEPS) -> list[Took]:
    """Take the steps in a folder of their own; after one that fails no other is taken."""
    found = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "method.py").write_text(METHOD, encoding="utf-8")
        own = {"XDG_CACHE_HOME": f"{name}/cache", "NUMBA_CACHE_DIR": f"{name}/kernels"}
        for step in steps:
            found.append(take(step, folder, {**os.environ, **own}))
            if found[-1].code:
                break
    return found


def parser() -> argparse.ArgumentParser:
    """Of the command line."""
    return options(__doc__, processes=False)


def main() -> None:
    """Take the tour and print the table; the exit code is that of the step that failed, if one did."""
    chosen = parser().parse_args()
    with out.status("on tour"):
        found = tour()
    seconds, used = sum(one.seconds for one in found), sum(one.processor_s for one in found)
    table = Table("step", "s", "CPU-s", title=f"{seconds:.0f} s in all (target {TARGET_S:.0f})")
    for column in table.columns[1:]:
        column.justify = "right"
    for one in found:
        table.add_row(one.step, f"{one.seconds:.1f}", f"{one.processor_s:.1f}")
    table.add_row("all", f"{seconds:.1f}", f"{used:.1f}")
    out.print(table)
    write_json(
        chosen.json,
        {
            "seconds": seconds,
            "processor_s": used,
            "steps": {one.step: {"seconds": one.seconds, "processor_s": one.processor_s} for one in found},
        },
    )
    if found[-1].code:
        sys.exit(f"{found[-1].step}: ended with {found[-1].code}: {found[-1].said}")


if __name__ == "__main__":
    main()
