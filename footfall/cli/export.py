"""`footfall export`: files for other tools."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from footfall.cli.terminal import require_output, say
from footfall.errors import InputError


def export(
    file: Annotated[Path, typer.Argument(help="A track or a walk.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="File to write.")],
    format: Annotated[
        str, typer.Option(help="tum: a line `t x y z qx qy qz qw` a pose (s, m), as evo and others read it.")
    ] = "tum",
) -> None:
    """Write a track, or a walk's truth, in the format of other tools.

    A track has headings alone: its poses are level. Compare positions, not rotations, with those of a walk.
    """
    from footfall.scenarios.export import export_tum

    if format != "tum":
        raise InputError(f"--format {format!r} is unknown, expected tum")
    require_output(output, (".tum", ".txt"), file)
    say(f"{export_tum(file, output)} poses: {output}")
