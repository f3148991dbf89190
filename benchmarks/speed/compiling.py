"""What compiling costs a first run: once for all, and what each further process takes to load what it finds.

Each measurement is a fresh process with an own cache of numba's; processor time is told. Without `warm` every
worker would compile.

python -m benchmarks.speed.compiling
python -m benchmarks.speed.compiling --methods pdr,hdr,ihde,iez
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence

from footfall.hdr.methods import find_method
from footfall.scenarios.scenario import load_scenario
from footfall.scenarios.trial import Trial, setup
from footfall.scenarios.warm import warm


def measure(scenario: str, methods: Sequence[str]) -> dict[str, float]:
    """In this process: processor seconds of the imports, of `warm`, and how much of it was compiling."""
    from numba.core import event

    found = [find_method(name) for name in methods]
    trial = Trial(setup(load_scenario(scenario), methods=found), 0, 1, 1, 1)
    begin = time.process_time()
    with event.install_recorder("numba:compile") as recorder:
        warm(trial, walks=True)
    count = sum(item.is_end for _, item in recorder.buffer)
    return {"imports": begin, "warm": time.process_time() - begin, "compiled": count}


def fresh(folder: str, arguments: Sequence[str]) -> dict[str, float]:
    """`measure` in a process of its own, whose kernels are kept in `folder`."""
    command = [sys.executable, "-m", "benchmarks.speed.compiling", "--here", *arguments]
    environment = {**os.environ, "NUMBA_CACHE_DIR": folder}
    done = subprocess.run(command, env=environment, stdout=subprocess.PIPE, text=True, check=True)
    found: dict[str, float] = json.loads(done.stdout)
    return found


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--scenario", default="closed-loop")
    parser.add_argument("--methods", default="pdr,hdr")
    parser.add_argument("--here", action="store_true", help=argparse.SUPPRESS)
    chosen = parser.parse_args(arguments)
    if chosen.here:
        print(json.dumps(measure(chosen.scenario, chosen.methods.split(","))))
        return
    told = ["--scenario", chosen.scenario, "--methods", chosen.methods]
    with tempfile.TemporaryDirectory() as folder:
        for name in ("first process", "any other after it"):
            found = fresh(folder, told)
            print(
                f"{name:20} {found['warm']:6.1f} CPU-s for {found['compiled']:.0f} functions compiled, "
                f"after {found['imports']:.1f} of imports"
            )


if __name__ == "__main__":
    main()
