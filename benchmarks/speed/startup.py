"""What a short command costs before it does its work: processor seconds, with every cache warm.

Each command runs in a process of its own, several times; the least is told, beside Python alone and beside
`import numpy`: trust the ratios more than the times.

python -m benchmarks.speed.startup
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from benchmarks._usage import children_cpu_s

SCENARIO = """
description = "thirty metres"
subjects = ["reference"]
[path]
elements = [{ kind = "straight", length_m = 30.0 }]
[gait]
pace_m_s = 1.3
[temperature]
indoors_degC = 20.0
outdoors_degC = 20.0
[sensor]
imu = "nimu"
[seeds]
base = 3
walks = 1
"""
MAKE = (
    "walk short.toml --no-cache -o walk.parquet",
    "record walk.parquet -o rec.parquet",
    "track rec.parquet -o hdr.parquet",
)
COMMANDS = (
    "--version",
    "--help",
    "list",
    "score hdr.parquet walk.parquet",
    "track rec.parquet -o again.parquet",
    "track rec.parquet --method ihde -o again.parquet",
    "record walk.parquet -o again.parquet",
)


def processor_time(arguments: list[str], folder: Path) -> float:
    """User and system time (s) of a Python process and its children."""
    before = children_cpu_s()
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    command = [sys.executable, *arguments]
    subprocess.run(command, cwd=folder, check=True, capture_output=True, env=environment)
    return children_cpu_s() - before


def main() -> None:
    """Walk, record and track once, then time."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=5)
    repeats = parser.parse_args().repeats
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "short.toml").write_text(SCENARIO, encoding="utf-8")
        for line in (*MAKE, *COMMANDS):
            processor_time(["-m", "footfall", *line.split()], folder)
        bare = {"python -c pass": ["-c", "pass"], "import numpy": ["-c", "import numpy"]}
        bare["import footfall"] = ["-c", "import footfall"]
        asked = bare | {f"footfall {line}": ["-m", "footfall", *line.split()] for line in COMMANDS}
        took = {
            what: min(processor_time(arguments, folder) for _ in range(repeats))
            for what, arguments in asked.items()
        }
    numpy = took["import numpy"]
    print(f"{'':56s} CPU-s  of numpy's")
    for what, seconds in took.items():
        print(f"{what:56s} {seconds:5.2f} {seconds / numpy:9.1f}")


if __name__ == "__main__":
    main()
