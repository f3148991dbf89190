"""`footfall map`: a method's error over two of its parameters."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from footfall.cli.options import JsonOption, SetOption
from footfall.cli.terminal import OUT, print_json, require_output


def map_(
    x: Annotated[
        str, typer.Argument(metavar="METHOD.A", help="A method's parameter (see `footfall parameters`).")
    ],
    y: Annotated[str, typer.Argument(metavar="METHOD.B", help="Another parameter of the same method.")],
    scenario: Annotated[str, typer.Option(help="Scenario: a name or your file.")] = "closed-loop",
    imu: Annotated[
        str | None, typer.Option(help="IMU on the shoe. Default: the scenario's.", show_default=False)
    ] = None,
    x_range: Annotated[
        str | None,
        typer.Option(
            "--x",
            metavar="FROM..TO",
            help="Range of METHOD.A. Default: a quarter to four times its value.",
            show_default=False,
        ),
    ] = None,
    y_range: Annotated[
        str | None,
        typer.Option(
            "--y", metavar="FROM..TO", help="Range of METHOD.B. Default: as for --x.", show_default=False
        ),
    ] = None,
    steps: Annotated[int, typer.Option(min=2, max=200, help="Number of values of each parameter.")] = 32,
    walks: Annotated[
        int | None, typer.Option(min=1, help="Number of walks. Default: the scenario's.")
    ] = None,
    units: Annotated[int, typer.Option(min=1, help="Number of units, spread over the walks.")] = 20,
    metric: Annotated[str, typer.Option(help="Score to map (docs/scores.md).")] = ("heading_error_mean_deg"),
    over: Annotated[str, typer.Option(help="Figure over the cases: median, mean or p90.")] = "median",
    settings: SetOption = None,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Number of processes. Default: one a core.", show_default=False)
    ] = None,
    figure: Annotated[
        Path | None, typer.Option(help="PNG file to draw the map into.", show_default=False)
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Map a method's error over two of its parameters, over many units and walks.

    HDR's maps are compiled: a thousand pairs cost no more than recording the units. Others run in full.
    """
    from footfall.cli.choices import number_range
    from footfall.errors import InputError
    from footfall.scenarios.parameters import documents, parsed, with_values
    from footfall.scenarios.report.map import draw_map, map_document, map_report
    from footfall.scenarios.report.progress import watching
    from footfall.scenarios.studies.factors import Factor
    from footfall.scenarios.studies.map import error_map, factor_about, ranged
    from footfall.scenarios.studies.points import Worn, require_metric, require_over

    if figure is not None:
        require_output(figure, ".png")
    name = x.partition(".")[0]
    base = with_values(documents(scenario, imu=imu, methods=[name]), parsed(settings or ()))

    def factor(address: str, text: str | None) -> Factor:
        if text is None:
            return factor_about(base.methods[0], address)
        return ranged(Factor(address, 0.0, 1.0), *number_range(text))

    if y.partition(".")[0] != name:
        raise InputError(f"{x} and {y}: expected two parameters of one method")
    with watching("units recorded") as (trials, (heard,)):
        found = error_map(
            base,
            factor(x, x_range),
            factor(y, y_range),
            cases=Worn(walks=walks, units=units),
            metric=require_metric(metric),
            over=require_over(over),
            steps=steps,
            workers=workers,
            on_cases=heard,
            on_trials=trials,
        )
    if figure is not None:
        draw_map(found, metric, over, base.scenario.name, figure)
    if as_json:
        print_json(map_document(found, metric, over, base))
    else:
        for part in map_report(found, metric, over, base.scenario.name):
            OUT.print(part)
