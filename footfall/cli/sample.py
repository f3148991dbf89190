"""`footfall sample`: a small recording to try things on."""

from __future__ import annotations

import shutil
from importlib.resources import as_file, files
from pathlib import Path
from typing import Annotated

import typer

from footfall.cli.terminal import require_output, say

NAMES = ("walk.csv", "footprints.csv")


def sample(
    folder: Annotated[Path, typer.Argument(help="Where to write them.")] = Path("."),
) -> None:
    """Write a small recording, walk.csv, and its true footfalls, footprints.csv.

    Half a minute around a square with a simulated consumer IMU on the instep, as a phone's logger writes it.
    """
    for name in NAMES:
        require_output(folder / name, ".csv")
        with as_file(files("footfall") / "samples" / name) as source:
            shutil.copyfile(source, folder / name)
    say(f"{folder / NAMES[0]}, {folder / NAMES[1]}")
