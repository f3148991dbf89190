"""What a run says to programs: one JSON document."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from footfall.scenarios.judge.score import Score, mean_score
from footfall.scenarios.judge.statistics import extent, spread
from footfall.simulate.plan import versions

if TYPE_CHECKING:
    from footfall.scenarios.run import Result

ERRORS = ("heading_error_mean_deg", "heading_error_final_deg")


def scores_by_method(rows: Sequence[Mapping[str, Score]]) -> dict[str, list[Score]]:
    """Method -> its score in each row."""
    return {name: [row[name] for row in rows] for name in rows[0]} if rows else {}


def run_document(
    scenario: str,
    results: Sequence[Result],
    settings: Mapping[str, Any] | None = None,
    without: Sequence[str] = (),
    command: str | None = None,
) -> dict[str, Any]:
    """The document of `run --json` (docs/scores.md).

    Parameters
    ----------
    settings : address -> value, in place of what the documents say
    without : sensor effects that were switched off
    command : that makes the run again
    """
    document: dict[str, Any] = {
        "scenario": scenario,
        "description": results[0].trial.setup.scenario.file.description,
        **({"command": command} if command else {}),
        "distance_m": float(np.mean([distance_m(result) for result in results])),
        "duration_s": float(np.mean([_duration_s(result) for result in results])),
        **({"settings": dict(settings)} if settings else {}),
        **({"without": list(without)} if without else {}),
        "versions": versions(),
        "walks": [
            {
                "seed": result.trial.walk_seed,
                "imu": result.trial.setup.imu,
                "unit": result.trial.unit_seed,
                "noise": result.trial.noise_seed,
                "subject": result.walk.meta["subject"],
                "footfalls": len(next(iter(result.tracks.values()))),
                "methods": {name: score.as_dict() for name, score in result.scores.items()},
                **_noises_document(result.noises),
            }
            for result in results
        ],
        "mean": {
            name: mean_score(scores).as_dict()
            for name, scores in scores_by_method([result.scores for result in results]).items()
        },
    }
    document |= _noises_document(mean_by_noise(results))
    others = scores_by_method([row for result in results for row in result.others])
    if others:
        document["other_units"] = {
            "count": len(next(iter(others.values()))),
            "methods": {
                name: {key: spread([getattr(score, key) for score in scores]) for key in ERRORS}
                for name, scores in others.items()
            },
        }
    return document


def mean_by_noise(results: Sequence[Result]) -> list[dict[str, Score]]:
    """For each further noise of the walks' own units: method -> mean over the walks."""
    rounds = zip(*(result.noises for result in results), strict=True)
    return [
        {name: mean_score(scores) for name, scores in scores_by_method(round_).items()} for round_ in rounds
    ]


def extents(rows: Sequence[Mapping[str, Score]]) -> dict[str, dict[str, dict[str, float]]]:
    """Method -> heading error -> its extent over `rows`."""
    return {
        name: {key: extent([getattr(score, key) for score in scores]) for key in ERRORS}
        for name, scores in scores_by_method(rows).items()
    }


def _noises_document(rows: Sequence[Mapping[str, Score]]) -> dict[str, Any]:
    return {"other_noises": {"count": len(rows), "methods": extents(rows)}} if rows else {}


def distance_m(result: Result) -> float:
    """Horizontal distance between the true footfalls, summed (m)."""
    return float(np.hypot(*np.diff(result.walk.footfalls.position[:, :2], axis=0).T).sum())


def _duration_s(result: Result) -> float:
    """Seconds walked, without the motionless start."""
    return float(result.walk.footfalls.t[-1] - result.walk.footfalls.t[0])
