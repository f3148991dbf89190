"""Scores as columns of a page's tables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields

from footfall.scenarios.judge.score import Score
from footfall.scenarios.report.page.cases import Cases, middle
from footfall.scenarios.report.page.html import Cell, Number, integer, number

LABELS = {
    "heading_error_mean_deg": "mean heading error (deg)",
    "heading_error_final_deg": "final heading error (deg)",
    "return_error_pct": "return error (%)",
    "distance_error_pct": "distance error (%)",
    "position_rmse_m": "RMS position error (m)",
    "position_error_final_m": "final position error (m)",
}
NAMES = tuple(item.name for item in fields(Score))
_SUMMED = ("heading_error_mean_deg", "heading_error_final_deg", "position_error_final_m")


def label_of(name: str) -> str:
    """A score's name in words, without its unit."""
    return LABELS[name].rpartition(" (")[0]


def unit_of(name: str) -> str:
    """The unit of a score."""
    return LABELS[name].rpartition("(")[2].rstrip(")")


def score_columns() -> tuple[str, ...]:
    """Their heads."""
    return tuple(LABELS[name] for name in NAMES)


def scores_row(score: Mapping[str, float]) -> list[Number]:
    """Their cells."""
    return [
        number(score[name], 2 if name.endswith("_pct") else 1, sign=name == "distance_error_pct")
        for name in NAMES
    ]


def summary_columns() -> tuple[str, ...]:
    """Heads of what many cases come to."""
    pairs = ((name, which) for name in _SUMMED for which in ("median", "p90"))
    return ("cases", "failed", *(f"{label_of(name)}: {which} ({unit_of(name)})" for name, which in pairs))


def summary_row(cases: Cases) -> list[Cell]:
    """Their cells."""
    found = (value for name in _SUMMED for value in middle(cases.scores(name)).values())
    return [integer(len(cases)), integer(cases.lost), *(number(value, 2) for value in found)]
