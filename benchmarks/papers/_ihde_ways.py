"""Ways to navigate the walks of the IHDE paper's tests, and what each of them errs by."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import radians
from typing import Any

import numpy as np

from benchmarks._common import outcomes
from footfall.errors import InputError
from footfall.hdr.method import Method
from footfall.hdr.methods import METHODS
from footfall.hdr.tracks import Reckoning
from footfall.pdr.track import Track
from footfall.scenarios.scenario import Scenario
from footfall.scenarios.studies.tune import require_apart
from footfall.scenarios.trial import Row, Setup, Trial, setup

Key = tuple[str, float]


@dataclass(frozen=True)
class Way:
    """How to navigate.

    Attributes
    ----------
    use : name of a method
    params : its own; None for its defaults
    start_off_deg : by which the heading that is given for the start is wrong
    bias : share of the scenario's bias shift that the gyro has
    """

    use: str
    params: Any = None
    start_off_deg: float = 0.0
    bias: float = 1.0

    def method(self, name: str) -> Method:
        """The method, called `name` in rows."""
        found = replace(METHODS[self.use], name=name)
        found = found if self.params is None else replace(found, params=self.params)
        if self.start_off_deg:
            found = replace(found, run=partial(_started_off, found.run, radians(self.start_off_deg)))
        return found


def _started_off(run: Any, off: float, reckoning: Reckoning, params: Any) -> Track:
    """A method that is given a start whose heading is `off` (rad) wrong."""
    start = replace(reckoning.start, heading=reckoning.start.heading + off)
    made: Track = run(replace(reckoning, start=start), params)
    return made


@dataclass(frozen=True)
class Job:
    """A scenario, the units to wear on each of its walks (seeds), and the ways to navigate each."""

    scenario: Scenario
    units: Mapping[int, Sequence[int]]
    ways: Sequence[Way]

    def trials(self) -> list[Trial]:
        """Every unit with every bias; a way is named by its place."""
        base = self.scenario.seeds.base
        biases = dict.fromkeys(way.bias for way in self.ways)
        setups = [_biased(self.scenario, bias, self.ways) for bias in biases]
        return [
            Trial(one, seed - base, seed, unit, unit)
            for seed, units in self.units.items()
            for unit in units
            for one in setups
        ]


def _biased(scenario: Scenario, bias: float, ways: Sequence[Way]) -> Setup:
    """The ways that are for a gyro with this share of the bias; filters expect a whole one."""
    methods = [way.method(f"{place}") for place, way in enumerate(ways) if way.bias == bias]
    shift = bias * scenario.sensor.bias_shift_deg_s
    made = setup(scenario.changed("sensor", bias_shift_deg_s=shift), methods=methods)
    return replace(made, guided=setup(scenario, methods=()).guided)


def judge(jobs: Sequence[Job], processes: int, label: str) -> dict[Key, np.ndarray]:
    """(scenario, variability) -> (walks x units, ways, 3) errors.

    They are return error (%), mean and final heading error (deg). Walks that came to no end are named and
    left out.
    """
    rows: dict[Key, dict[tuple[int, int], dict[int, Row]]] = {_key(job.scenario): {} for job in jobs}
    for one in outcomes([trial for job in jobs for trial in job.trials()], processes, label):
        case = one.trial.walk_seed, one.trial.unit_seed
        by_way = rows[_key(one.trial.setup.scenario)].setdefault(case, {})
        by_way |= {int(row.method): row for row in one.rows}
    if not all(rows.values()):
        raise SystemExit(f"{label}: no walk of a test came to its end")
    return {
        key: np.array([[_errors(by_way[place]) for place in sorted(by_way)] for by_way in cases.values()])
        for key, cases in rows.items()
    }


def _key(scenario: Scenario) -> Key:
    return scenario.name, scenario.gait.variability


def _errors(row: Row) -> tuple[float, float, float]:
    score = row.require()
    return score.return_error_pct, score.heading_error_mean_deg, score.heading_error_final_deg


def take_walks(parser: argparse.ArgumentParser) -> None:
    """Options of the walks to tune and to judge on."""
    for name, default, text in (
        ("walks", 20, "walks of each test to judge on"),
        ("walk-seed", 1, "of the first of them and its unit"),
        ("tuning-walks", 6, "walks of each test to tune on"),
        ("tuning-seed", 101, "of the first of them and its unit"),
    ):
        parser.add_argument(f"--{name}", type=int, default=default, help=f"{text} (default {default})")


def walks_of(chosen: argparse.Namespace) -> tuple[range, range]:
    """Seeds to tune and to judge on, of which none is the same."""
    tuning = range(chosen.tuning_seed, chosen.tuning_seed + chosen.tuning_walks)
    seeds = range(chosen.walk_seed, chosen.walk_seed + chosen.walks)
    try:
        require_apart("walk seed", tuning, seeds)
    except InputError as error:
        raise SystemExit(str(error)) from None
    return tuning, seeds
