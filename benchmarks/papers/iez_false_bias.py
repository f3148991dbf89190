"""Where the heading error of the paper's filter (IEZ) comes from, on simulated and on real feet.

A zero velocity at every still sample, of a foot that is not still, makes a gyro bias: how much with a perfect
IMU, by settings and by detector; which part of the foot's motion it is made of and by which cross-covariance;
the same on real recordings, where there are some beside the checkout; and how much of the paper's Table 2 it
explains. Every setting is run beside the package's default.

python -m benchmarks.papers.iez_false_bias --page docs/iez.md --figures docs/images
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np

from benchmarks._common import options, outcomes, write_json
from benchmarks._page import Sheet, by_name, fill
from benchmarks.papers._false_bias import PAPER, PARTS, Feet, all_but, drive, without
from benchmarks.papers._false_bias_figures import cause, cure
from benchmarks.validation._real import BESIDE, find
from footfall.hdr.methods import METHODS
from footfall.hdr.tracks import Reckoning, pdr_track
from footfall.models.policy import stock_policy
from footfall.pdr.detectors import DETECTORS
from footfall.pdr.filter.ins import FilterSettings, frozen
from footfall.pdr.reckoning import PdrParams
from footfall.pdr.rest import still_time
from footfall.scenarios.judge.papers import IHDE_TABLE_2, range_text
from footfall.scenarios.judge.score import compare
from footfall.scenarios.scenario import Scenario, load_scenario
from footfall.scenarios.trial import Trial, reckoning, recording_of, setup, walk_of

SIGMA_V = (0.01, 0.03, 0.1)  # m/s
OURS = FilterSettings()
AFTER_S = 240.0  # of the walk, for what is run sample by sample in Python
PLAIN_S = 60.0  # the same, for what is run in numpy
GLRT = DETECTORS["shoe"]  # the paper's detector, Eq. 14-19
Rows = list[list[str]]


def settings_of(sigma_v: float, update: str, states: int) -> FilterSettings:
    """The paper's filter with one thing or another changed."""
    chosen = replace(PAPER, sigma_velocity=sigma_v, update=update)
    return frozen(chosen) if states == 9 else chosen


def perfect(scenario: Scenario) -> Feet:
    """The scenario's first walk, in a perfect IMU."""
    worn = setup(scenario, imu="perfect", methods=())
    worn = replace(worn, pdr=replace(worn.pdr, detector=GLRT))
    trial = Trial(worn, 0, scenario.seeds.base, unit_seed=0, noise_seed=0)
    walk = walk_of(trial)
    reckoned = reckoning(worn, walk, recording_of(trial, walk))
    truth = compare(pdr_track(reckoned.footfalls), walk)
    return Feet("simulated, perfect IMU", reckoned, reckoned.footfalls.heading - truth.heading_error)


def real_feet() -> list[Feet]:
    """Recordings beside the checkout."""
    return [
        Feet(
            one.name,
            Reckoning(one.recording, pdr=PdrParams(bias_s=still_time(one.recording), detector=GLRT)),
        )
        for one in (find(BESIDE) if BESIDE.is_dir() else [])
    ]


def grid(feet: Feet) -> Rows:
    """Heading errors by sigma_v, updates and states."""
    rows = []
    for update, states in product(("sample", "stance"), (15, 9)):
        row = [f"every {update}", f"{states}"]
        for sigma_v in SIGMA_V:
            mean, final = feet.heading_error_deg(settings_of(sigma_v, update, states))
            row.append(f"{mean:.2f} / {abs(final):.2f}")
        rows.append(row)
    mean, final = feet.heading_error_deg(OURS)
    return [*rows, ["**default**", "15", f"{mean:.2f} / {abs(final):.2f}", "", ""]]


def parts(feet: Feet) -> dict[str, float]:
    """False bias (deg/s) from each part of the foot's motion."""
    return {name: drive(feet, PAPER, all_but(part), AFTER_S) for name, part in PARTS.items()}


def by_feet(all_feet: Sequence[Feet]) -> tuple[Rows, dict[str, tuple[float, float]]]:
    """The same on every recording, and paper's against default's false bias (deg/s) for the figure."""
    rows, pairs = [], {}
    for feet in all_feet:
        rates = [feet.false_bias_deg_s(settings_of(sigma_v, "sample", 15)) for sigma_v in SIGMA_V]
        ours = feet.false_bias_deg_s(OURS)
        pairs[feet.name] = (rates[0], ours)
        told = drive(feet, PAPER, lambda motion: motion.velocity, AFTER_S)
        ways = [without(feet, way, PLAIN_S) for way in ("", "bias", "heading")]
        rows.append([feet.name, *(f"{value:+.3f}" for value in (*rates, told, *ways, ours))])
    return rows, pairs


def by_detector(all_feet: Sequence[Feet]) -> Rows:
    """False bias (deg/s) of the paper's filter and of the default with each detector."""
    rows = []
    for name, detector in DETECTORS.items():
        row = [f"`{name}`"]
        for feet in all_feet:
            r = feet.reckoning
            other = replace(
                feet, reckoning=Reckoning(r.recording, r.start, replace(r.pdr, detector=detector))
            )
            # Another detector finds other instants: its own dead reckoning is the reference.
            other = replace(other, turn=None)
            row.append(f"{other.false_bias_deg_s(PAPER):+.2f} / {other.false_bias_deg_s(OURS):+.3f}")
        rows.append(row)
    return rows


def paper_trials(test: str, walks: int) -> list[Trial]:
    """Each walk of one of the paper's tests with its unit of the test's IMU, and with a perfect one.

    Without the bias that the scenario gives every gyro: what is left is the filter's own.
    """
    scenario = load_scenario(test).changed("sensor", bias_shift_deg_s=0.0)
    ways = [replace(METHODS["iez-paper"], name=name, params=params) for name, params in filters().items()]
    worn, still = setup(scenario, methods=ways), setup(scenario, imu="perfect", methods=ways)
    base, trials = scenario.seeds.base, []
    for number in range(walks):
        unit = scenario.unit_seed(number)
        trials.append(Trial(worn, number, base + number, unit, unit))
        trials.append(Trial(still, number, base + number, unit_seed=0, noise_seed=0))
    return trials


def filters() -> dict[str, FilterSettings]:
    """What is judged on the paper's tests."""
    return {
        **{f"as in the paper, sigma_v {sv:g} m/s": settings_of(sv, "sample", 15) for sv in SIGMA_V},
        "the same, biases frozen, sigma_v 0.01 m/s": settings_of(0.01, "sample", 9),
        "default": OURS,
    }


def paper_tests(walks: int, processes: int) -> Rows:
    """Median return errors beside the paper's IEZ row."""
    trials = [trial for test in IHDE_TABLE_2 for trial in paper_trials(test, walks)]
    errors: dict[tuple[str, str, str], list[float]] = {}
    for row in (row for one in outcomes(trials, processes, "the paper's tests") for row in one.rows):
        key = (row.method, row.imu, row.scenario)
        errors.setdefault(key, []).append(row.require().return_error_pct)
    rows = []
    for name, unit in product(filters(), ("", ", perfect IMU")):
        line = [name + unit]
        for test in IHDE_TABLE_2:
            imu = "perfect" if unit else load_scenario(test).imu
            low, middle, high = np.percentile(errors[name, imu, test], [10, 50, 90])
            line.append(f"{middle:.2f} ({low:.2f} to {high:.2f})")
        rows.append(line)
    return [*rows, ["**the paper's IEZ**", *(range_text(row["iez"]) for row in IHDE_TABLE_2.values())]]


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure, print, fill the page, draw."""
    parser = options(__doc__)
    parser.add_argument("--scenario", default="closed-loop", help="the long walk (default: closed-loop)")
    parser.add_argument("--walks", type=int, default=20, help="of each of the paper's tests; 0 for none")
    parser.add_argument("--no-real", action="store_true", help="leave real recordings out")
    parser.add_argument("--page", type=Path, metavar="MD", help="fill its tables")
    parser.add_argument(
        "--figures", type=Path, metavar="DIR", help="draw iez_cause.png and iez_cure.png there"
    )
    chosen = parser.parse_args(arguments)

    simulated = perfect(load_scenario(chosen.scenario))
    real = [] if chosen.no_real else real_feet()
    everyone = [simulated, *real]
    names = [feet.name for feet in everyone]
    made_of = [parts(feet) for feet in everyone]
    turned = [f"{feet.motion.turned:.0%}" for feet in everyone]
    feet_rows, pairs = by_feet(everyone)
    ahead = [f"sigma_v {value:g} m/s" for value in SIGMA_V]
    sheets = [
        Sheet("grid", "Settings", ["heading error (deg), mean / final", "states", *ahead], grid(simulated)),
        Sheet(
            "parts",
            "Parts of the motion",
            ["false bias (deg/s) by what is called zero", *names],
            [
                *([part, *(f"{one[part]:+.2f}" for one in made_of)] for part in PARTS),
                ["share of the motion that turns about one point", *turned],
            ],
        ),
        Sheet(
            "feet",
            "Feet",
            ["deg/s", *ahead, "told its motion", "first minute", "no P(v, b)", "no P(v, psi)", "**default**"],
            feet_rows,
        ),
        Sheet("detectors", "Detectors", ["paper / default, deg/s", *names], by_detector(everyone)),
    ]
    if chosen.walks:
        head = ["P_err (%), median (10th to 90th percentile)", *IHDE_TABLE_2]
        tests = paper_tests(chosen.walks, chosen.processes)
        sheets.append(Sheet("tests", "The paper's tests", head, tests))
    for sheet in sheets:
        sheet.show()
    if chosen.page:
        walker = f"The simulated feet are those of the walker `{stock_policy().digest}`."
        fill(chosen.page, {**by_name(sheets), "walker": walker})
    if chosen.figures:
        cause(chosen.figures / "iez_cause.png", simulated, made_of[0])
        cure(chosen.figures / "iez_cure.png", simulated, pairs)
    document = {sheet.name: {"head": sheet.headings, "rows": sheet.rows} for sheet in sheets}
    write_json(chosen.json, document)


if __name__ == "__main__":
    main()
