"""What dead reckoning and heading correction make of a shank, beside the instep of the same steps.

Once round a block of 40 m by 40 m at four paces, two people each, one simulation for all mounts. A sensor
without error shows what the place itself costs, the sheet `consumer` what is left beside a sensor's errors.
Footfalls are counted as in `benchmarks.validation.strides`. A recording is warned of where
`footfall.pdr.plausibility` says that it is beyond the usual, which every real track is told.

python -m benchmarks.validation.shank --page docs/studies/mounts.md
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from itertools import product
from pathlib import Path

import numpy as np

from benchmarks._common import options, run_all, write_json
from benchmarks._page import Sheet, by_name, fill
from benchmarks.validation.strides import compare, true_stances
from footfall.pdr.detectors import DETECTORS
from footfall.pdr.plausibility import Plausibility, judge_track, longest_movement, velocity_left
from footfall.scenarios.scenario import Scenario, load_scenario
from footfall.scenarios.trial import Setup, Trial, perform, reckoning, recording_of, setup
from footfall.simulate.cache import cached_walk
from footfall.simulate.walk import Walk

MOUNTS = ("instep", "shank", "shank-left")
METHODS = ("pdr", "hdr", "iez", "ihde-plus", "hypotheses")
FINDERS = ("threshold", "patient")  # the defaults of simulated and of real recordings
SHEETS = ("perfect", "consumer")
PACES, WALKS, SEED, SIDE_M = (0.7, 1.0, 1.3, 1.7), 2, 911, 40.0


@dataclass(frozen=True)
class Judged:
    """A recording, dead-reckoned from the stances of a detector.

    Attributes
    ----------
    footfalls, missed, more : true ones, those not found, and those found too often
    warned : what plausibility says; left_m_s, stride_m : two of its figures
    distance_pct, heading_deg, final_m : method -> distance error (%), average heading error (deg), distance
        between the ends of track and truth (m); None where the method refuses
    """

    mount: str
    pace_m_s: float
    number: int
    imu: str
    detector: str
    footfalls: int
    missed: int
    more: int
    warned: tuple[str, ...]
    left_m_s: float
    stride_m: float
    distance_pct: dict[str, float | None]
    heading_deg: dict[str, float | None]
    final_m: dict[str, float | None]


def block(pace: float) -> Scenario:
    """Once round."""
    corner = {"kind": "corner", "turn_deg": 90.0, "radius_m": 2.5}
    side = {"kind": "straight", "length_m": SIDE_M}
    around = load_scenario("straight").changed("path", elements=[side, corner] * 4)
    return around.changed("gait", pace_m_s=pace)


def go(job: tuple[float, int]) -> list[Judged]:
    """One walk, seen from every place."""
    pace, number = job
    around = block(pace)
    worn = {mount: around.changed("sensor", mount=mount) for mount in MOUNTS}
    plans = {mount: one.plan(number, SEED + number) for mount, one in worn.items()}
    found = []
    for mount, scenario in worn.items():
        walk = cached_walk(plans[mount], also=plans.values())
        for imu in SHEETS:
            made = setup(scenario, imu=imu, methods=METHODS)
            for detector in FINDERS:
                params = replace(made.pdr, detector=DETECTORS[detector])
                found.append(judged(replace(made, pdr=params), detector, number, walk))
    return found


def judged(made: Setup, detector: str, number: int, walk: Walk) -> Judged:
    """One recording under one detector."""
    trial = Trial(made, number, SEED + number, SEED + number, SEED + number)
    recording = recording_of(trial, walk)
    given = reckoning(made, walk, recording)
    stances = given.detected.stances
    true, middle = true_stances(walk.t, walk.stance), walk.footfalls.t[:, None]
    asked = ((middle >= true[:, 0]) & (middle <= true[:, 1])).any(axis=0)
    missed, more = compare(true, recording.t[stances.resets[stances.footfalls]] + walk.t[0])
    likely: Plausibility = judge_track(
        given.footfalls.t,
        given.footfalls.position,
        velocity_left(recording, given.detected, given.pdr),
        longest_movement(recording.t, given.detected.score),
        0.0,
    )
    impossible = likely.impossible()
    rows = perform(trial, walk, source=lambda: recording).rows
    scores = {row.method: row.score for row in rows}
    return Judged(
        made.scenario.sensor.mount,
        made.scenario.gait.pace_m_s,
        number,
        made.imu,
        detector,
        int(asked.sum()),
        int((missed & asked).sum()),
        more,
        (*([impossible] if impossible else []), *likely.warnings()),
        float("nan") if likely.velocity_left_m_s is None else likely.velocity_left_m_s,
        likely.longest_stride_m,
        {name: one and one.distance_error_pct for name, one in scores.items()},
        {name: one and one.heading_error_mean_deg for name, one in scores.items()},
        {name: one and one.position_error_final_m for name, one in scores.items()},
    )


def stances_sheet(found: Sequence[Judged]) -> Sheet:
    """What the detectors find, what plausibility says, and what the place itself costs dead reckoning."""
    made = Sheet(
        "shank stances",
        "Footfalls and recordings that are warned of (sheet consumer), distance error of pdr (perfect)",
        [
            *("IMU on the", "detector", "pace m/s", "footfalls", "missed", "too many", "velocity left m/s"),
            *("warned", "distance %"),
        ],
        left=2,
    )
    for mount, detector, pace in product(MOUNTS, FINDERS, PACES):
        place = [one for one in found if (one.mount, one.detector, one.pace_m_s) == (mount, detector, pace)]
        clean, here = ([one for one in place if one.imu == imu] for imu in SHEETS)
        made.rows.append(
            [
                *(f"`{mount}`", f"`{detector}`", f"{pace:g}"),
                *(f"{sum(getattr(one, name) for one in here)}" for name in ("footfalls", "missed", "more")),
                _median([one.left_m_s for one in here], ".2f"),
                f"{sum(bool(one.warned) for one in here)} of {len(here)}",
                _median([one.distance_pct["pdr"] for one in clean], "+.2f"),
            ]
        )
    return made


def _median(values: Sequence[float | None], style: str) -> str:
    done = [value for value in values if value is not None]
    return f"{np.median(done):{style}}" if done else "refused"


def methods_sheet(found: Sequence[Judged]) -> Sheet:
    """Errors of the methods, from the stances of `patient`, over all paces and people."""
    made = Sheet(
        "shank methods",
        "Distance error, average heading error, distance of the ends: medians, detector patient",
        ["method", "sheet", *(f"{mount}: {what}" for mount in MOUNTS for what in ("%", "deg", "m"))],
        left=2,
    )
    for method in METHODS:
        for imu in SHEETS:
            row = [f"`{method}`", f"`{imu}`"]
            for mount in MOUNTS:
                here = [one for one in found if (one.mount, one.imu, one.detector) == (mount, imu, "patient")]
                for told, style in (("distance_pct", "+.2f"), ("heading_deg", ".2f"), ("final_m", ".2f")):
                    row.append(_median([getattr(one, told)[method] for one in here], style))
            made.rows.append(row)
    return made


def main(arguments: Sequence[str] | None = None) -> None:
    """Walk, navigate, count and print."""
    parser = options(__doc__)
    parser.add_argument("--page", type=Path, metavar="MD", help="put the tables into this page's marks")
    chosen = parser.parse_args(arguments)
    jobs = [(pace, number) for pace in PACES for number in range(WALKS)]
    found = [one for judged in run_all(go, jobs, chosen.processes, "walks") for one in judged]
    sheets = [stances_sheet(found), methods_sheet(found)]
    for sheet in sheets:
        sheet.show()
    if chosen.page is not None:
        fill(chosen.page, by_name(sheets))
    write_json(chosen.json, {"found": [asdict(one) for one in found]})


if __name__ == "__main__":
    main()
