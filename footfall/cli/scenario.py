"""`footfall scenario`: scenarios from what others have of a path."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from footfall.cli.terminal import require_output, say

scenario = typer.Typer(help="Make a scenario from points on the way.", no_args_is_help=True)


@scenario.callback()
def _scenario() -> None:
    """Keep `from` a command of its own, although there is no other."""


@scenario.command("from")
def from_(
    file: Annotated[
        Path,
        typer.Argument(
            help="Points in walking order: GPX, GeoJSON, or CSV with columns x, y (m) or lat, lon (deg)."
        ),
    ],
    output: Annotated[Path, typer.Option("--output", "-o", help="Scenario to write, a TOML file.")],
    figure: Annotated[
        Path | None, typer.Option(help="PNG file to draw a map of it into.", show_default=False)
    ] = None,
    tolerance: Annotated[
        float,
        typer.Option(
            min=0.05,
            max=100,
            help="How far points may lie off straights and arcs, m; 3 or so for GPS.",
        ),
    ] = 0.5,
    corner_radius: Annotated[
        float,
        typer.Option(
            min=0.05,
            max=50,
            help="Radius to which corners are rounded, m.",
        ),
    ] = 1.5,
) -> None:
    """Fit straights, arcs and corners to points, and write the scenario of a walk along them.

    The path is level, whatever heights the points have. Pace, temperatures, sensor and seeds are common ones:
    change them in the file.
    """
    from footfall.scenarios.report.path_map import draw_path
    from footfall.scenarios.waypoints.scenario import told, trace, write_scenario

    require_output(output, ".toml", file)
    if figure is not None:
        require_output(figure, ".png")
    found = trace(file, tolerance, corner_radius)
    write_scenario(found, file, output)
    if figure is not None:
        draw_path(found, output.stem, figure)
    say(f"{output}: {told(found)}")
