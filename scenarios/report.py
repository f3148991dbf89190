"""What a run says: tables for people, one JSON document for programs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from rich.table import Table

from footfall.scenarios.paper import HDR_TABLE_2, HDR_TABLE_2_MEAN, PaperRow
from footfall.scenarios.run import Result
from footfall.scenarios.score import Score, improvement, mean_score
from footfall.simulate.journey import versions

_ERRORS = ("heading_error_final_deg", "heading_error_mean_deg")


def spread(values: Sequence[float]) -> dict[str, float]:
    """Mean, median and 90th percentile."""
    array = np.asarray(values, dtype=float)
    return {
        "mean": float(array.mean()),
        "median": float(np.median(array)),
        "p90": float(np.percentile(array, 90)),
    }


def scores_by_method(rows: Sequence[Mapping[str, Score]]) -> dict[str, list[Score]]:
    """Method -> its score in each row."""
    return {name: [row[name] for row in rows] for name in rows[0]} if rows else {}


def as_json(scenario: str, results: Sequence[Result]) -> dict[str, Any]:
    """The document of `run --json` (see the README); `other_units` sums up the units drawn beside."""
    document: dict[str, Any] = {
        "scenario": scenario,
        "distance_m": float(np.mean([_distance(result) for result in results])),
        "duration_s": float(np.mean([_duration(result) for result in results])),
        "versions": versions(),
        "walks": [
            {
                "seed": result.task.walk_seed,
                "imu": result.task.imu,
                "unit": result.task.unit_seed,
                "subject": result.walk.meta["subject"],
                "footfalls": len(next(iter(result.tracks.values()))),
                "methods": {name: score.as_dict() for name, score in result.scores.items()},
            }
            for result in results
        ],
        "mean": {
            name: mean_score(scores).as_dict()
            for name, scores in scores_by_method([result.scores for result in results]).items()
        },
    }
    others = scores_by_method([row for result in results for row in result.others])
    if others:
        document["other_units"] = {
            "count": len(next(iter(others.values()))),
            "methods": {
                name: {key: spread([getattr(score, key) for score in scores]) for key in _ERRORS}
                for name, scores in others.items()
            },
        }
    return document


def _distance(result: Result) -> float:
    """Horizontal distance between the true footfalls, summed (m)."""
    return float(np.hypot(*np.diff(result.walk.footfalls.position[:, :2], axis=0).T).sum())


def _duration(result: Result) -> float:
    """Seconds walked, without the motionless start."""
    return float(result.walk.footfalls.t[-1] - result.walk.footfalls.t[0])


def heading_table(results: Sequence[Result]) -> Table:
    """The HDR paper's Table 2 for these walks: final and average heading error, and improvement."""
    methods = list(results[0].scores)
    table = Table(title="Heading error, final / average (deg)", title_justify="left")
    table.add_column("")
    for result in results:
        table.add_column(f"Walk {result.task.number + 1}\nunit {result.task.unit_seed}", justify="right")
    table.add_column("Mean", justify="right", style="bold")
    columns = [result.scores for result in results]
    means = {name: mean_score(scores) for name, scores in scores_by_method(columns).items()}
    for name in methods:
        label = "uncorrected (pdr)" if name == "pdr" else name
        table.add_row(label, *(_pair(row[name]) for row in columns), _pair(means[name]))
    if "pdr" in methods:
        for name in methods:
            if name != "pdr":
                cells = [_factor(row["pdr"], row[name]) for row in [*columns, means]]
                table.add_row(f"improvement, {name}", *cells, style="dim")
    return table


def paper_table() -> Table:
    """Table 2 of Borenstein et al. (2008), for comparison."""
    table = Table(title="The paper's own walks: Borenstein et al. (2008), Table 2", title_justify="left")
    table.add_column("")
    rows: list[PaperRow] = [*HDR_TABLE_2, HDR_TABLE_2_MEAN]
    for row in rows:
        table.add_column("Mean" if row is HDR_TABLE_2_MEAN else row.name, justify="right")
    table.add_row(
        "uncorrected", *(f"{row.uncorrected.final:g} / {row.uncorrected.average:g}" for row in rows)
    )
    table.add_row("HDR", *(f"{row.hdr.final:g} / {row.hdr.average:g}" for row in rows))
    improved = (f"{row.improvement.final:g}x / {row.improvement.average:g}x" for row in rows)
    table.add_row("improvement", *improved, style="dim")
    return table


def others_table(results: Sequence[Result]) -> Table | None:
    """Spread over the other drawn units on the same walks; None when there are none."""
    others = scores_by_method([row for result in results for row in result.others])
    if not others:
        return None
    count = len(next(iter(others.values())))
    table = Table(
        title=f"{count} other units of the same sheet, drawn and not chosen, on the same walks (deg)",
        title_justify="left",
    )
    table.add_column("")
    for error in ("final", "average"):
        for column in ("mean", "median", "p90"):
            table.add_column(f"{error}\n{column}", justify="right")
    for name, scores in others.items():
        cells = []
        for key in _ERRORS:
            cells += [f"{value:.1f}" for value in spread([getattr(score, key) for score in scores]).values()]
        table.add_row(name, *cells)
    return table


def position_table(results: Sequence[Result]) -> Table:
    """Distance and position errors, mean over the walks."""
    table = Table(title="Position, mean over the walks", title_justify="left")
    headings = ("", "distance error %", "return error %", "position RMSE m", "final position error m")
    for heading in headings:
        table.add_column(heading, justify="right" if heading else "left")
    for name, scores in scores_by_method([result.scores for result in results]).items():
        mean = mean_score(scores)
        table.add_row(
            name,
            f"{mean.distance_error_pct:+.2f}",
            f"{mean.return_error_pct:.2f}",
            f"{mean.position_rmse_m:.1f}",
            f"{mean.position_error_final_m:.1f}",
        )
    return table


def score_table(scores: Mapping[str, Score]) -> Table:
    """One column a track, one row a figure."""
    table = Table("")
    for name in scores:
        table.add_column(name, justify="right")
    for key in next(iter(scores.values())).as_dict():
        table.add_row(key, *(f"{getattr(score, key):.3f}" for score in scores.values()))
    return table


def _pair(score: Score) -> str:
    return f"{score.heading_error_final_deg:.1f} / {score.heading_error_mean_deg:.1f}"


def _factor(row_before: Score, row_after: Score) -> str:
    factor = improvement(row_before, row_after)
    return f"{factor.final:.1f}x / {factor.mean:.1f}x"
