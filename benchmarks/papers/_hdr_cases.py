"""Units on walks, dead-reckoned once, so that HDR can correct them with many parameters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from benchmarks._common import err, run_all
from footfall.errors import InputError
from footfall.hdr.tracks import pdr_track
from footfall.pdr.footfalls import Footfalls
from footfall.scenarios.judge.score import compare
from footfall.scenarios.trial import Trial, reckoning, recording_of, walk_of


@dataclass(frozen=True)
class Case:
    """A trial's footfalls, whose heading is off by `error`: (n,) rad, estimate - truth."""

    trial: Trial
    footfalls: Footfalls
    error: np.ndarray

    def uncorrected_deg(self) -> np.ndarray:
        """(2,) final and average absolute heading error of dead reckoning."""
        return _final_and_average_deg(self.error)

    def corrected_deg(self, headings: np.ndarray) -> np.ndarray:
        """(s, 2) the same of a method's (s, n) headings (rad), which start where dead reckoning does."""
        return _final_and_average_deg(self.error + headings - self.footfalls.heading)


def _final_and_average_deg(error: np.ndarray) -> np.ndarray:
    size = np.degrees(np.abs(error))
    return np.stack([size[..., -1], size.mean(axis=-1)], axis=-1)


def _dead_reckon(trials: Sequence[Trial]) -> list[Case] | str:
    """Trials on one walk; or why it came to no end."""
    try:
        walk = walk_of(trials[0])
    except InputError as error:
        return str(error)
    cases = []
    for trial in trials:
        footfalls = reckoning(trial.setup, walk, recording_of(trial, walk)).footfalls
        cases.append(Case(trial, footfalls, compare(pdr_track(footfalls), walk).heading_error))
    return cases


def dead_reckoned(trials: Sequence[Trial], processes: int, label: str) -> list[Case]:
    """Every trial, by unit and noise. Walks that came to no end are named and left out."""

    def walked(trial: Trial) -> tuple[int, int]:
        return trial.number, trial.walk_seed

    jobs = [list(group) for _, group in groupby(sorted(trials, key=walked), key=walked)]
    cases: list[Case] = []
    for job, result in zip(jobs, run_all(_dead_reckon, jobs, processes, label), strict=True):
        if isinstance(result, str):
            err.print(f"[red]left out, {len(job)} recordings:[/red] {result}")
        else:
            cases += result
    return sorted(cases, key=lambda case: (case.trial.unit_seed, case.trial.noise_seed))
