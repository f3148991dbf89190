"""Does the detector of real recordings find every stride? By pace, by where the IMU sits, from mid-walk on.

The walks of the stock studies `paces` and `mounts`, each with the first unit that the study puts on it, and
120 m in each place at each of four paces, are detected as a stranger's recording is: rest where there is
some, then the detector. Then minutes are cut out of each, that begin and end anywhere in mid-walk. A footfall
is asked for where its middle is in the record. It is found if a stance of the detector lies in it, or misses
it by 0.1 s at most; a second one, and one that lies in none, are too many.

python -m benchmarks.validation.strides --page docs/real_recordings.md
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from itertools import product
from pathlib import Path

import numpy as np

from benchmarks._common import options, run_all, write_json
from benchmarks._page import Sheet, by_name, fill
from footfall.models.mount import MOUNTS
from footfall.pdr.detectors import DETECTORS
from footfall.pdr.reckoning import PdrParams, detect
from footfall.pdr.rests import find_rest
from footfall.recording import Recording
from footfall.runs import runs
from footfall.scenarios.scenario import load_scenario
from footfall.scenarios.studies.plan import plan_of
from footfall.scenarios.studies.study import Study
from footfall.scenarios.trial import Trial, recording_of, setup, walk_of
from footfall.streams import stream

STUDIES = ("paces", "mounts")
FEET = tuple(name for name, mount in MOUNTS.items() if mount.segment == "foot")  # shanks: `shank`
CUT_S = 60.0
NEAR_S = 0.1
SHORT_M, SHORT_SEED, PACES = 120.0, 901, (0.7, 1.0, 1.3, 1.7)
BEGUN = ("at rest", "in mid-walk")


@dataclass(frozen=True)
class Counted:
    """Footfalls asked for in a record, those that are missed, and those that are too many.

    cut : whether it begins in mid-walk
    """

    study: str
    mount: str
    pace_m_s: float
    cut: bool
    true: int
    missed: int
    more: int


def trials() -> Iterator[tuple[str, Trial]]:
    """One a walk, with the first unit that the study puts on it; then the short walks."""
    for name in STUDIES:
        seen = set()
        for task in plan_of(Study.read(name)).tasks:
            if task.walk not in seen:
                seen.add(task.walk)
                yield name, next(iter(task.trials()))[0][0]
    short = load_scenario("straight").changed("path", elements=[{"kind": "straight", "length_m": SHORT_M}])
    for mount, pace in product(FEET, PACES):
        worn = short.changed("sensor", mount=mount, imu="consumer").changed("gait", pace_m_s=pace)
        yield "short", Trial(setup(worn, methods=["pdr"]), 0, SHORT_SEED, SHORT_SEED, SHORT_SEED)


def compare(stances: np.ndarray, found: np.ndarray) -> tuple[np.ndarray, int]:
    """Which of the true stances (n, 2) none answers, and how many of those found (m,) are too many; all in s.

    One answers to the true stance that it lies in, or misses by `NEAR_S` at most.
    """
    off = np.maximum(stances[:, :1] - found, found - stances[:, 1:])
    near = off.argmin(axis=0)
    belongs = off.min(axis=0) <= NEAR_S
    count = np.bincount(near[belongs], minlength=len(stances))
    return count == 0, int((~belongs).sum() + np.maximum(count - 1, 0).sum())


def true_stances(t: np.ndarray, stance: np.ndarray) -> np.ndarray:
    """First and last instants (n, 2) of the stances of a record, cut where the record is.

    A landing after which the foot is not at rest for a moment is one with the stance that follows.
    """
    bounds = runs(stance)
    first, last = t[bounds[:, 0]], t[bounds[:, 1] - 1]
    apart = first[1:] - last[:-1] > NEAR_S
    return np.column_stack([first[np.concatenate([[True], apart])], last[np.concatenate([apart, [True]])]])


def stances_of(recording: Recording, detector: str) -> np.ndarray:
    """Times (n,) of the footfalls that a recording of any kind has."""
    params = PdrParams(detector=DETECTORS[detector])
    rest = find_rest(recording, params)
    found = detect(recording, params, rest)
    return recording.t[found.stances.resets[found.stances.footfalls]]


def go(job: tuple[str, Trial, str, int, Sequence[Trial]]) -> list[Counted]:
    """A walk whole and in cuts; the last of a job are the trials on the same steps."""
    study, trial, detector, cuts, alike = job
    walk = walk_of(trial, also=alike)
    whole = recording_of(trial, walk)
    rng = stream(trial.walk_seed, "where a recording begins")
    begins = rng.uniform(walk.calibration_s + 5.0, walk.t[-1] - CUT_S - 5.0, size=cuts)
    parts = [slice(0, len(walk.t))]
    parts += [slice(*np.searchsorted(walk.t, [begin, begin + CUT_S])) for begin in begins]
    found = []
    for rows in parts:
        true = true_stances(walk.t[rows], walk.stance[rows])
        middle = walk.footfalls.t[:, None]
        asked = ((middle >= true[:, 0]) & (middle <= true[:, 1])).any(axis=0)
        cut = Recording(whole.t[rows], whole.gyro[rows], whole.accel[rows])
        missed, more = compare(true, stances_of(cut, detector))
        found.append(
            Counted(
                study,
                trial.setup.scenario.sensor.mount,
                trial.plan.gait.pace_m_s,
                bool(rows.start > 0),
                int(asked.sum()),
                int((missed & asked).sum()),
                more,
            )
        )
    return found


def sheet(found: Sequence[Counted]) -> Sheet:
    """One row a place and pace: those that begin at rest, and those that begin in mid-walk."""
    headings = ["IMU on the", "pace m/s"]
    headings += [f"{begun}: {what}" for begun in BEGUN for what in ("footfalls", "missed", "too many")]
    made = Sheet("found", "Footfalls that the detector finds", headings)
    places = sorted(
        {(one.mount, one.pace_m_s) for one in found}, key=lambda it: (list(MOUNTS).index(it[0]), it)
    )
    for mount, pace in [*places, ("all", math.nan)]:
        row = [mount, "" if mount == "all" else f"{pace:g}"]
        for cut in (False, True):
            here = [one for one in found if one.cut == cut and mount in (one.mount, "all")]
            here = [one for one in here if mount == "all" or one.pace_m_s == pace]
            row += [f"{sum(getattr(one, name) for one in here):,}" for name in ("true", "missed", "more")]
        made.rows.append(row)
    return made


def main(arguments: Sequence[str] | None = None) -> None:
    """Walk, cut, count and print."""
    parser = options(__doc__)
    parser.add_argument("--detector", choices=DETECTORS, default="patient", help="default patient")
    parser.add_argument("--cuts", type=int, default=20, help="minutes cut out of each walk (default 20)")
    parser.add_argument("--page", type=Path, metavar="MD", help="put the table into this page's mark")
    chosen = parser.parse_args(arguments)
    every = [(name, trial, trial.plan.steps) for name, trial in trials()]
    alike: dict[str, list[Trial]] = {}
    for _, trial, steps in every:
        alike.setdefault(steps, []).append(trial)
    jobs = [(name, trial, chosen.detector, chosen.cuts, alike[steps]) for name, trial, steps in every]
    found = [one for counted in run_all(go, jobs, chosen.processes, "walks") for one in counted]
    made = sheet(found)
    made.show()
    if chosen.page is not None:
        fill(chosen.page, by_name([made]))
    write_json(chosen.json, {"detector": chosen.detector, "found": [asdict(one) for one in found]})


if __name__ == "__main__":
    main()
