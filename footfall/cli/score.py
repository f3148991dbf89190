"""`footfall score`: a track beside the true walk, beside footprints, or beside its own start."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from footfall.cli.options import JsonOption
from footfall.cli.reading import require_kind
from footfall.cli.terminal import OUT, blaming, print_json
from footfall.errors import InputError


def score(
    track: Annotated[
        Path,
        typer.Argument(help="A track from any program: Parquet or CSV with t, x, y, z, heading (s, m, rad)."),
    ],
    walk: Annotated[
        Path | None, typer.Argument(help="The walk that was recorded.", show_default=False)
    ] = None,
    footprints: Annotated[
        Path | None,
        typer.Option(
            help="Instead of a walk, measured footprints: CSV or Parquet with t (s, on the recording's "
            "clock), x, y (m, in any frame); shift and turn are fitted.",
            show_default=False,
        ),
    ] = None,
    closed: Annotated[
        bool, typer.Option("--closed", help="Instead of a walk: the walk ended where it began.")
    ] = False,
    align: Annotated[
        str,
        typer.Option(
            help="For tracks of an unknown start, fit a shift on the plane and a turn first. none: nothing; "
            "start: to the first row; yaw: shift to the first row's position, best turn; rigid: best shift "
            "and turn."
        ),
    ] = "none",
    as_json: JsonOption = False,
) -> None:
    """Score a track against the true walk: heading and position errors.

    Nothing is fitted, unless --align asks for it. The true walk of a real recording is not known: score it
    against measured --footprints, or as a --closed walk.
    """
    from footfall.pdr.track import read_track
    from footfall.scenarios.judge.reference import read_footprints, score_closure, score_footprints
    from footfall.scenarios.report.tables import reference_table

    if (walk is not None) + (footprints is not None) + closed != 1:
        raise InputError("score: expected one of a walk, --footprints and --closed")
    if walk is not None:
        return _beside_walk(track, walk, align, as_json)
    if align != "none":
        raise InputError(
            "--align: is for a walk; footprints are always fitted, and a closed walk needs no fit"
        )
    prints = None if footprints is None else read_footprints(footprints)
    require_kind(track, "track")
    estimate = read_track(track)
    with blaming(track, "track"):
        result = score_closure(estimate) if prints is None else score_footprints(estimate, prints)
    if as_json:
        print_json(result.as_dict())
    else:
        OUT.print(reference_table(result))


def _beside_walk(track: Path, walk: Path, align: str, as_json: bool) -> None:
    from footfall.pdr.track import read_track
    from footfall.scenarios.judge.score import require_align
    from footfall.scenarios.judge.score import score as judge
    from footfall.scenarios.report.tables import score_table
    from footfall.simulate.walk import read_walk

    fitted = require_align(align)
    require_kind(track, "track")
    require_kind(walk, "walk")
    estimate, truth = read_track(track), read_walk(walk)
    with blaming(track, "track"):
        result = judge(estimate, truth, fitted)
    if as_json:
        print_json({"align": fitted, **result.as_dict()})
    else:
        OUT.print(score_table(result, fitted))
