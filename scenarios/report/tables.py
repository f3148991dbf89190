"""Tables for people: what a run says, and a score."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from rich.box import SIMPLE_HEAD
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from footfall.scenarios.judge.papers import HDR_TABLE_2, HDR_TABLE_2_MEAN, IHDE_TABLE_2, range_text
from footfall.scenarios.judge.reference import ClosureScore, FootprintScore
from footfall.scenarios.judge.score import Align, Score, improvement, mean_score
from footfall.scenarios.judge.statistics import spread
from footfall.scenarios.report.document import ERRORS, distance_m, extents, mean_by_noise, scores_by_method

if TYPE_CHECKING:
    from footfall.scenarios.path import Path
    from footfall.scenarios.run import Result


def run_report(name: str, results: Sequence[Result]) -> list[RenderableType]:
    """What a run of the scenario `name` prints for people."""
    own, distance = results[0].trial, np.mean([distance_m(result) for result in results])
    first = own.setup
    count = "1 walk" if len(results) == 1 else f"{len(results)} walks"
    parts: list[RenderableType] = [
        Text.assemble((name, "bold"), f": {count} of {distance:.0f} m, IMU {first.imu}"),
        Text(path_line(first.scenario.path) + "\n", style="dim"),
        heading_table(results),
    ]
    if name == "closed-loop":
        parts.append(paper_table())
        if own.unit_seed in (first.scenario.seeds.units or ()):
            parts.append(Text(_CHOSEN_UNITS, style="dim"))
    if name in IHDE_TABLE_2:
        parts.append(ihde_table(name, results))
    further = [table for table in (noises_table(results), others_table(results)) if table]
    return [*parts, *further, position_table(results)]


def path_line(path: Path) -> str:
    """Length of a path and whether it returns, or how far and how high from its start it ends."""
    gap, climb = path.closure.gap_m, path.closure.climb_m
    length = f"The path is {path.route.length:.4g} m long and"
    if path.closed:
        return f"{length} ends where it starts"
    height = f", {abs(climb):.2f} m {'higher' if climb > 0 else 'lower'}" if abs(climb) >= 0.005 else ""
    return f"{length} ends {gap:.1f} m from its start{height}"


_CHOSEN_UNITS = (
    "The walks' own units were drawn from the sheet and kept because their uncorrected errors lie in the "
    "range of the paper's Table 2; the other units below were not chosen."
)


def new_table(*columns: str, left: int = 1) -> Table:
    """A table that stays readable on a terminal of 80 columns: its first `left` columns are text."""
    table = Table(box=SIMPLE_HEAD, show_edge=False, show_header=any(columns))
    for i, column in enumerate(columns):
        table.add_column(column, justify="left" if i < left else "right", overflow="fold")
    return table


def titled(title: str, table: Table) -> Group:
    """The table under its title, which may be the wider of the two, and a blank line."""
    return Group(Text(title, style="bold"), table, Text())


def heading_table(results: Sequence[Result]) -> Group:
    """The HDR paper's Table 2 for these walks: average and final heading error, and improvement."""
    rows = [result.scores for result in results]
    means = {name: mean_score(scores) for name, scores in scores_by_method(rows).items()}
    labels = ["pdr\n(uncorrected)" if name == "pdr" else name for name in means]
    table = new_table("walk", "unit", *labels)
    walks = [(str(result.trial.number + 1), str(result.trial.unit_seed)) for result in results]
    for (walk, unit), row in zip([*walks, ("mean", "")], [*rows, means], strict=True):
        cells = (_pair(score) + _gain(row, name) for name, score in row.items())
        table.add_row(walk, unit, *cells, style="bold" if walk == "mean" else None)
    compared = "pdr" in means and len(means) > 1
    gain = "; 3.0x: so many times smaller than uncorrected" if compared else ""
    return titled(f"Heading error, average / final (deg){gain}", table)


def paper_table() -> Group:
    """Table 2 of Borenstein et al. (2008), for comparison."""
    table = new_table("walk", "pdr\n(uncorrected)", "hdr")
    for row in (*HDR_TABLE_2, HDR_TABLE_2_MEAN):
        mean = row is HDR_TABLE_2_MEAN
        table.add_row(
            "mean" if mean else row.name.removeprefix("Walk "),
            f"{row.uncorrected.average:g} / {row.uncorrected.final:g}",
            f"{row.hdr.average:g} / {row.hdr.final:g}\n"
            f"{row.improvement.average:g}x / {row.improvement.final:g}x",
            style="bold" if mean else None,
        )
    return titled("The paper's own walks: Borenstein et al. (2008), Table 2", table)


def ihde_table(name: str, results: Sequence[Result]) -> Group:
    """The row of Deng et al. (2018), Table 2, for one of their tests: ours with its spread, and theirs.

    A method on the paper's own filter (`hde-paper`) stands beside the paper's row of its name (HDE).
    """
    table = new_table("", "mean", "median", "10 to 90 %\nof the walks", "smallest to\nlargest", "the paper's")
    for method, scores in scores_by_method([result.scores for result in results]).items():
        errors = np.array([score.return_error_pct for score in scores])
        low, high = np.percentile(errors, [10, 90])
        paper = IHDE_TABLE_2[name].get(method.removesuffix("-paper"))
        table.add_row(
            method,
            f"{errors.mean():.2f}",
            f"{np.median(errors):.2f}",
            f"{low:.2f} to {high:.2f}",
            f"{errors.min():.2f} to {errors.max():.2f}",
            range_text(paper) if paper else "",
        )
    title = f"Return error P_err (% of the distance), {len(results)} walks; Deng et al. (2018), Table 2"
    return titled(title, table)


def noises_table(results: Sequence[Result]) -> Group | None:
    """What other noises make of the same walks and units, and of their mean; None when there are none."""
    means = mean_by_noise(results)
    if not means:
        return None
    table = new_table(
        "walk", "", "average\nmedian", "smallest\nto largest", "final\nmedian", "smallest\nto largest", left=2
    )
    walks = [(str(result.trial.number + 1), result.noises) for result in results]
    for walk, rows in [*walks, ("mean", means)]:
        for name, errors in extents(rows).items():
            cells = []
            for found in errors.values():
                cells += [f"{found['median']:.1f}", f"{found['smallest']:.1f} to {found['largest']:.1f}"]
            table.add_row(walk, name, *cells, style="bold" if walk == "mean" else None)
    return titled(f"The same walks and units with {len(means)} other noise seeds each (deg)", table)


def others_table(results: Sequence[Result]) -> Group | None:
    """Spread over the other drawn units on the same walks; None when there are none."""
    others = scores_by_method([row for result in results for row in result.others])
    if not others:
        return None
    count = len(next(iter(others.values())))
    columns = [f"{error}\n{column}" for error in ("average", "final") for column in ("mean", "median", "p90")]
    table = new_table("", *columns)
    for name, scores in others.items():
        cells = []
        for key in ERRORS:
            cells += [f"{value:.1f}" for value in spread([getattr(score, key) for score in scores]).values()]
        table.add_row(name, *cells)
    return titled(
        f"{count} other units of the same sheet, drawn and not chosen, on the same walks (deg)", table
    )


def position_table(results: Sequence[Result]) -> Group:
    """Distance and position errors, mean over the walks."""
    table = new_table(
        "",
        "distance\nerror %",
        # P_err, the distance between the ends of track and truth: only a closed path returns.
        f"{'return' if results[0].trial.setup.scenario.path.closed else 'end'}\nerror %",
        "position\nRMSE m",
        "final position\nerror m",
    )
    for name, scores in scores_by_method([result.scores for result in results]).items():
        mean = mean_score(scores)
        table.add_row(
            name,
            f"{mean.distance_error_pct:+.2f}",
            f"{mean.return_error_pct:.2f}",
            f"{mean.position_rmse_m:.1f}",
            f"{mean.position_error_final_m:.1f}",
        )
    return titled("Position, mean over the walks", table)


_SCORE_LABELS = {
    "heading_error_mean_deg": "heading error, mean (deg)",
    "heading_error_final_deg": "heading error, final (deg)",
    "return_error_pct": "end from the true end (% of the distance)",
    "distance_error_pct": "distance error (%)",
    "position_rmse_m": "position error, RMS (m)",
    "position_error_final_m": "position error, final (m)",
}


_ALIGNED = {
    "none": "as it is, nothing fitted",
    "start": "its first row laid on the truth",
    "yaw": "its first row moved there, the turn fitted",
    "rigid": "shift and turn fitted",
}


def score_table(score: Score, align: Align = "none") -> Group:
    """One row a figure, and above them what was fitted."""
    table = new_table("", "")
    for key, value in score.as_dict().items():
        table.add_row(_SCORE_LABELS[key], f"{value:.3f}")
    return titled(f"Errors, estimate against truth ({_ALIGNED[align]})", table)


_REFERENCE_LABELS = {
    "footprint_rmse_m": "from the footprints, RMS (m)",
    "footprint_largest_m": "from the footprints, largest (m)",
    "footprints": "footprints",
    "matched": "of them with a footfall near in time",
    "return_error_m": "end from start (m)",
    "return_error_pct": "return error (% of the distance)",
    "distance_m": "distance (m)",
    "footfalls": "footfalls",
}


def reference_table(score: FootprintScore | ClosureScore) -> Group:
    """One row a figure of a track without a true walk."""
    table = new_table("", "")
    for key, value in score.as_dict().items():
        table.add_row(_REFERENCE_LABELS[key], f"{value:.3f}" if isinstance(value, float) else f"{value}")
    fitted = isinstance(score, FootprintScore)
    return titled(
        "Track over its footprints (shift and turn fitted)" if fitted else "Track of a walk that is closed",
        table,
    )


def _pair(score: Score) -> str:
    return f"{score.heading_error_mean_deg:.1f} / {score.heading_error_final_deg:.1f}"


def _gain(row: Mapping[str, Score], name: str) -> str:
    """On a line of its own: how many times smaller (or worse) than uncorrected, where that was scored."""
    if name == "pdr" or "pdr" not in row:
        return ""
    factor = improvement(row["pdr"], row[name])
    pair = factor.mean, factor.final
    worse = [ratio < 0.95 for ratio in pair]  # what rounds to 1.0 is no worse
    mean, final = (f"{1 / ratio if ratio and ratio < 0.95 else ratio:.1f}x" for ratio in pair)
    if worse[0] == worse[1]:
        return f"\n{mean} / {final}{' worse' if worse[0] else ''}"
    words = ["worse" if bad else "better" for bad in worse]
    return f"\n{mean} {words[0]} / {final} {words[1]}"
