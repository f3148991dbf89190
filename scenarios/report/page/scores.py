"""The six scores as columns of a page's tables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields

from footfall.scenarios.judge.score import Score
from footfall.scenarios.report.page.html import Number, number

LABELS = {
    "heading_error_mean_deg": "heading error, mean (deg)",
    "heading_error_final_deg": "heading error, final (deg)",
    "return_error_pct": "return error (%)",
    "distance_error_pct": "distance error (%)",
    "position_rmse_m": "position error, RMS (m)",
    "position_error_final_m": "position error, final (m)",
}
NAMES = tuple(item.name for item in fields(Score))


def score_columns() -> tuple[str, ...]:
    """Their heads."""
    return tuple(LABELS[name] for name in NAMES)


def scores_row(score: Mapping[str, float]) -> list[Number]:
    """Their cells."""
    return [
        number(score[name], 2 if name.endswith("_pct") else 1, sign=name == "distance_error_pct")
        for name in NAMES
    ]
