"""`footfall export`: files for other tools."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from footfall.cli.terminal import require_output, say


def export(
    file: Annotated[Path, typer.Argument(help="A track or a walk.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="File to write.")],
    format: Annotated[
        str,
        typer.Option(
            help="tum: a line `t x y z qx qy qz qw` a pose (s, m), as evo and others read it; kitti: each "
            "pose's 3 x 4 matrix, without times; csv: as tum, with commas and names."
        ),
    ] = "tum",
) -> None:
    """Write a track, or a walk's truth, in the format of other tools.

    A track has headings only, so its poses are level. Compare its positions with a walk's, not its rotations.
    """
    from footfall.scenarios.export import export as write
    from footfall.scenarios.export import require_format

    require_format(format)
    endings = (".csv",) if format == "csv" else (f".{format}", ".txt")
    require_output(output, endings, file)
    say(f"{write(file, output, format)} poses: {output}")
