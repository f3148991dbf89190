"""Ways to navigate the walks of the IHDE paper's tests, and what each of them errs by."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from math import radians
from typing import Literal

import numpy as np

from benchmarks._common import err, run_all
from footfall.errors import InputError
from footfall.hdr.hde import Hde, Hde2010Params, HdeParams
from footfall.hdr.ihde import Ihde, IhdeParams
from footfall.hdr.ihde_plus import IhdePlus, IhdePlusParams
from footfall.hdr.jimenez import FilterHdr, FilterHdrParams, Jimenez, JimenezParams
from footfall.hdr.methods import on_papers_filter
from footfall.hdr.tracks import (
    HeadingMethod,
    Reckoning,
    corrected_track,
    hde_2010_track,
    iez_track,
    pdr_track,
)
from footfall.models.imu import draw_unit, load_spec
from footfall.pdr.filter.ins import FilterSettings
from footfall.pdr.track import Track
from footfall.scenarios.judge.score import score
from footfall.scenarios.scenario import Scenario
from footfall.scenarios.trial import reckoning, setup
from footfall.simulate.cache import cached_walk
from footfall.simulate.record import record

Params = HdeParams | Hde2010Params | IhdeParams | IhdePlusParams | JimenezParams | FilterHdrParams
CORRECTORS: Mapping[type, type] = {
    HdeParams: Hde,
    IhdeParams: Ihde,
    IhdePlusParams: IhdePlus,
    JimenezParams: Jimenez,
    FilterHdrParams: FilterHdr,
}


@dataclass(frozen=True)
class Way:
    """How to navigate.

    Attributes
    ----------
    params : of the heading method; None for none. Directions count from the path's first, 0
    filter : "ours", or the "paper" 's with its detector; "none" for dead reckoning and a method after it
    start_off_deg : by which the heading that is given for the start is wrong
    bias : share of the scenario's bias shift that the gyro has
    """

    params: Params | None = None
    filter: Literal["ours", "paper", "none"] = "ours"
    start_off_deg: float = 0.0
    bias: float = 1.0

    def track(self, given: Reckoning) -> Track:
        """The track of a recording."""
        if self.start_off_deg:
            off = radians(self.start_off_deg)
            given = replace(given, start=replace(given.start, heading=given.start.heading + off))
        if self.filter == "none":
            if self.params is None:
                return pdr_track(given.footfalls)
            assert isinstance(self.params, Hde2010Params)
            return hde_2010_track(given.footfalls, self.params)
        paper = self.filter == "paper"
        given = on_papers_filter(given) if paper else given
        if self.params is None:
            return iez_track(given, FilterSettings.paper() if paper else FilterSettings(), name="iez")
        corrector: HeadingMethod = CORRECTORS[type(self.params)](self.params)
        settings = FilterSettings.paper() if paper else given.guided
        return corrected_track(given, corrector, settings, name=type(self.params).__name__)


@dataclass(frozen=True)
class Job:
    """One walk of a scenario, the seeds of the units to wear on it, and the ways to navigate each."""

    scenario: Scenario
    seed: int
    units: tuple[int, ...]
    ways: tuple[Way, ...]


def navigate(job: Job) -> np.ndarray | str:
    """(units, ways, 3) return error (%), mean and final heading error (deg); or why the walk did not end."""
    scenario, number = job.scenario, job.seed - job.scenario.seeds.base
    try:
        walk = cached_walk(scenario.plan(number))
    except InputError as error:
        return str(error)

    @cache
    def given(unit: int, bias: float) -> Reckoning:
        recording = record(
            walk,
            draw_unit(load_spec(scenario.imu), unit),
            seed=unit,
            temperature=scenario.temperature_of(number),
            bias_shift=bias * scenario.unit_bias_shift(unit),
        )
        return reckoning(setup(scenario), walk, recording)

    errors = np.empty((len(job.units), len(job.ways), 3))
    for i, unit in enumerate(job.units):
        for j, way in enumerate(job.ways):
            found = score(way.track(given(unit, way.bias)), walk)
            errors[i, j] = found.return_error_pct, found.heading_error_mean_deg, found.heading_error_final_deg
    return errors


def judge(jobs: Sequence[Job], processes: int, label: str) -> dict[tuple[str, float], np.ndarray]:
    """(scenario, variability) -> (walks x units, ways, 3) of `navigate`.

    Walks that came to no end are named and left out.
    """
    found: dict[tuple[str, float], list[np.ndarray]] = {}
    for job, result in zip(jobs, run_all(navigate, jobs, processes, label), strict=True):
        rows = found.setdefault((job.scenario.name, job.scenario.gait.variability), [])
        if isinstance(result, str):
            err.print(f"[red]left out:[/red] {result}")
        else:
            rows.append(result)
    if not all(found.values()):
        raise SystemExit(f"{label}: no walk of a test came to its end")
    return {key: np.concatenate(rows) for key, rows in found.items()}
