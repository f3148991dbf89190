"""Footfall's own method against HDR and no correction, on walks and units that it was not tuned on.

The model's constants were chosen on walks of the seeds from 101 on and on units from 2000 on. Judged is on
each scenario's own walks (seeds from 1 on), with units from 1000 on dealt to them, each with its own noise.
"Worse" is the share of units whose heading is left worse than uncorrected by more than 1 deg. "Normalised" is
the mean of (final error / told SD)^2, 1 for an honest SD. Footfalls are kept in --store and shared by runs.

python -m benchmarks.validation.hypotheses --page docs/hypotheses.md
"""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks._common import options, run_all, write_json
from benchmarks._page import Sheet, by_name, fill
from footfall.errors import InputError
from footfall.hdr.methods import METHODS
from footfall.hdr.streamed import StreamedReckoning
from footfall.hdr.tracks import pdr_track
from footfall.pdr.footfalls import Footfalls
from footfall.pdr.reckoning import StartPose
from footfall.scenarios.judge.score import compare
from footfall.scenarios.parameters import documents
from footfall.scenarios.store import Reckoned, footfalls_file, read_footfalls, write_footfalls
from footfall.scenarios.trial import Setup, Trial, reckoning, recording_of, start_pose, walk_of
from footfall.simulate.walk import Walk

JUDGED = ("pdr", "hdr", "hypotheses", "hypotheses-smooth")
SCENARIOS = ("closed-loop", "closed-loop-gentle", "straight", "turning", "errands", "curving", "swaying")
FIRST_UNIT = 1000
WORSE_DEG = 1.0


@dataclass(frozen=True)
class Job:
    """A walk of a scenario and the units that are worn on it."""

    scenario: str
    imu: str | None
    number: int
    units: tuple[int, ...]


@dataclass(frozen=True)
class Judged:
    """Of one unit and one method: heading errors and the told SD at the end (deg); NaN where none is told."""

    scenario: str
    method: str
    average: float
    final: float
    signed: float
    sd: float


def setup_of(job: Job) -> Setup:
    """The scenario, whose IMU may be another."""
    return documents(job.scenario, imu=job.imu).setup()


def footfalls_of(trial: Trial, walk: Walk, store: Path) -> Footfalls:
    """Dead reckoning of a trial, from the store where it is kept."""
    file = footfalls_file(store, trial, walk.sha)
    found = read_footfalls(file)
    if found is None:
        recording = recording_of(trial, walk)
        found = Reckoned(reckoning(trial.setup, walk, recording).footfalls, recording.sha)
        write_footfalls(file, found)
    return found.footfalls


def judge(job: Job, store: Path, methods: Sequence[str]) -> list[Judged]:
    """Every method on every unit of a job; none where the walk came to no end."""
    setup, found = setup_of(job), []
    walk = None
    for unit in job.units:
        trial = Trial(setup, job.number, setup.scenario.seeds.base + job.number, unit, unit)
        try:
            walk = walk or walk_of(trial)
        except InputError:
            return []
        feet = footfalls_of(trial, walk, store)
        start = start_pose(walk, setup.pdr.bias_s)
        for name in methods:
            found.append(_judged(job.scenario, name, feet, start, walk))
    return found


def _judged(scenario: str, name: str, feet: Footfalls, start: StartPose, walk: Walk) -> Judged:
    track = METHODS[name].track(StreamedReckoning(lambda: feet, start)) if name != "pdr" else pdr_track(feet)
    error = np.degrees(compare(track, walk).heading_error)
    sd = float(np.degrees(track.evidence["heading_sd"][-1])) if "heading_sd" in track.evidence else np.nan
    return Judged(scenario, name, float(np.abs(error).mean()), float(abs(error[-1])), float(error[-1]), sd)


def jobs(scenarios: Sequence[str], imu: str | None, units: int) -> list[Job]:
    """Units dealt to the walks of each scenario, walk by walk."""
    found = []
    for scenario in scenarios:
        walks = documents(scenario).setup().scenario.seeds.walks
        worn = range(FIRST_UNIT, FIRST_UNIT + units)
        found += [
            Job(scenario, imu, k, tuple(unit for unit in worn if unit % walks == k)) for k in range(walks)
        ]
    return [job for job in found if job.units]


def errors_sheet(name: str, title: str, found: Sequence[Judged], methods: Sequence[str]) -> Sheet:
    """Average and final error, worse than uncorrected, and how honest the SD is, by scenario and method."""
    heads = ["scenario", "method", "units", "average: mean", "median", "p90", "final: mean", "median", "p90"]
    sheet = Sheet(name, title, [*heads, "worse: average (%)", "final (%)", "normalised"], left=2)
    for scenario in dict.fromkeys(one.scenario for one in found):
        here = [one for one in found if one.scenario == scenario]
        none = np.array([[one.average, one.final] for one in here if one.method == "pdr"])
        for method in methods:
            mine = [one for one in here if one.method == method]
            values = np.array([[one.average, one.final] for one in mine])
            cells = [f"{value:.1f}" for column in values.T for value in statistics(column)]
            worse = 100 * (values > none + WORSE_DEG).mean(axis=0)
            ratio = np.mean([(one.signed / one.sd) ** 2 for one in mine])
            told = "" if np.isnan(ratio) else f"{ratio:.2f}"
            sheet.rows.append([scenario, method, str(len(mine)), *cells, *(f"{w:.0f}" for w in worse), told])
    return sheet


def statistics(values: np.ndarray) -> tuple[float, float, float]:
    """Mean, median and 90th percentile."""
    return float(values.mean()), float(np.median(values)), float(np.percentile(values, 90))


def main() -> None:
    """Judge, and tell."""
    parser = options(__doc__)
    parser.add_argument("--units", type=int, default=60, help="a scenario (default 60)")
    parser.add_argument("--scenarios", nargs="+", default=SCENARIOS, metavar="NAME")
    parser.add_argument("--store", type=Path, help="folder of footfalls (default a temporary one)")
    parser.add_argument("--page", type=Path, help="fill the tables of this page")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        work = partial(judge, store=args.store or Path(folder), methods=JUDGED)
        real = run_all(work, jobs(args.scenarios, None, args.units), args.processes, "the scenarios' own IMU")
        perfect = run_all(work, jobs(args.scenarios, "perfect", 2), args.processes, "an IMU without error")
    sheets = [
        errors_sheet("errors", "Heading errors (deg)", [one for part in real for one in part], JUDGED),
        errors_sheet(
            "perfect", "The same, IMU without error", [one for part in perfect for one in part], JUDGED
        ),
    ]
    for sheet in sheets:
        sheet.show()
    write_json(args.json, {"figures": {sheet.name: sheet.rows for sheet in sheets}})
    if args.page:
        fill(args.page, by_name(sheets))


if __name__ == "__main__":
    main()
