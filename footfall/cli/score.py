"""`footfall score`: a track beside the true walk."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from footfall.cli.options import JsonOption
from footfall.cli.terminal import OUT, blaming, print_json


def score(
    track: Annotated[
        Path,
        typer.Argument(
            help="A track, ours or anyone's: Parquet or CSV with t, x, y, z, heading (s, m, rad)."
        ),
    ],
    walk: Annotated[Path, typer.Argument(help="The walk that was recorded.")],
    align: Annotated[
        str,
        typer.Option(
            help="What is fitted first, by a shift on the plane and a turn: none, nothing; start, the first "
            "row; yaw, the first row's position and the best turn; rigid, the best shift and turn. For "
            "tracks of an unknown start."
        ),
    ] = "none",
    as_json: JsonOption = False,
) -> None:
    """Score a track against the true walk: heading and position errors.

    Nothing is fitted, unless --align asks for it.
    """
    from footfall.pdr.track import read_track
    from footfall.scenarios.judge.score import require_align
    from footfall.scenarios.judge.score import score as judge
    from footfall.scenarios.report.tables import score_table
    from footfall.simulate.walk import read_walk

    fitted = require_align(align)
    estimate, truth = read_track(track), read_walk(walk)
    with blaming(track, "track"):
        result = judge(estimate, truth, fitted)
    if as_json:
        print_json({"align": fitted, **result.as_dict()})
    else:
        OUT.print(score_table(result, fitted))
