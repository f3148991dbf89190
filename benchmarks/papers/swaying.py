"""What HDR makes of the three types of motion of its paper (section 3.1): swaying, curving and turning.

First with an IMU without error, which has no drift for HDR to mend: what the double low-pass filter, the
attenuator and de-lagging make of each (Figures 2 to 4), and how far HDR turns the heading for nothing.
Then HDR against no correction on the stock scenario `swaying`, with drawn units and several seeds of noise.
Fills the tables of docs/swaying.md and draws its figure.

python -m benchmarks.papers.swaying --page docs/swaying.md --figure docs/images/swaying.png
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks._common import heading_errors_deg, options, outcomes, run_all, write_json
from benchmarks._page import Sheet, by_name, fill
from benchmarks.papers._swaying_figure import draw
from footfall.hdr.hdr import HdrParams, HdrTrace, trace
from footfall.hdr.tracks import pdr_track
from footfall.pdr.footfalls import Footfalls
from footfall.scenarios.judge.score import compare
from footfall.scenarios.scenario import Scenario, load_scenario
from footfall.scenarios.trial import Trial, reckoning, recording_of, setup, walk_of

SWAYS = ("sway at the footfall rate", "people's wander", "wide, slow sway")
LEAD = {"kind": "straight", "length_m": 80.0}
OTHERS = {
    "curving, radius 60 m": [LEAD, {"kind": "arc", "radius_m": 60.0, "turn_deg": 90.0}, LEAD],
    "curving, radius 400 m": [
        LEAD,
        {"kind": "arc", "radius_m": 400.0, "length_m": 200.0, "side": "left"},
        LEAD,
    ],
    "turning": [LEAD, {"kind": "corner", "turn_deg": 90.0, "radius_m": 1.5}, LEAD],
}
PERIODS = (2.2, 5.0, 10.0, 20.0, 40.0, 80.0)  # s, of a sway
INTERVAL = 1.1  # s, of a stride
METHODS = {"uncorrected": "pdr", "basic HDR": "hdr-basic", "HDR": "hdr"}
FINAL, AVERAGE = 0, 1


@dataclass(frozen=True)
class Motion:
    """One walk with an IMU without error: what HDR computed on it, true heading (rad) and places (n, 3) m."""

    name: str
    footfalls: Footfalls
    found: HdrTrace
    truth: np.ndarray
    position: np.ndarray


def gain(period: float, tau: float, interval: float = INTERVAL) -> float:
    """What the double low-pass filter leaves of a sway of this period (s): |H|^2 of Eq. 6a at e^(i w T)."""
    back = np.exp(-2j * np.pi * interval / period)
    return float(abs(interval / (interval + tau - tau * back)) ** 2)


def delagged(rate: np.ndarray, interval: np.ndarray, tau: float) -> np.ndarray:
    """Eq. 10a and 10b of (n,) rates whose row 0 is the start."""
    for _ in range(2):
        rate = rate + np.concatenate([[0.0], tau / interval[1:] * np.diff(rate)])
    return rate


def perfect_trials(scenario: Scenario) -> dict[str, Trial]:
    """The walks of `swaying`, and its first on other paths, in an IMU without error."""

    def trial(walked: Scenario, number: int) -> Trial:
        worn = setup(walked, imu="perfect", methods=())
        return Trial(worn, number, scenario.seeds.base + number, unit_seed=0, noise_seed=0)

    found = {name: trial(scenario, number) for number, name in enumerate(SWAYS)}
    return found | {
        name: trial(scenario.changed("path", elements=elements), 0) for name, elements in OTHERS.items()
    }


def motion(item: tuple[str, Trial]) -> Motion:
    """Walk, dead-reckon with an IMU without error, and correct what needs no correction."""
    name, trial = item
    walk = walk_of(trial)
    footfalls = reckoning(trial.setup, walk, recording_of(trial, walk)).footfalls
    error = compare(pdr_track(footfalls), walk).heading_error
    t = walk.t - walk.t[0]
    places = np.column_stack([np.interp(footfalls.t, t, column) for column in walk.position.T])
    return Motion(name, footfalls, trace(footfalls), footfalls.heading - error, places)


def scored(
    scenario: Scenario, walks: int, units: Sequence[int], noises: Sequence[int], processes: int
) -> np.ndarray:
    """(sway, walk, unit, noise, method, 2) final and average heading error (deg)."""
    worn = setup(scenario, methods=METHODS.values())
    trials = [
        Trial(worn, number, scenario.seeds.base + number + len(SWAYS) * k, unit, noise)
        for number in range(len(SWAYS))
        for k in range(walks)
        for unit in units
        for noise in noises
    ]
    found = outcomes(trials, processes, "units")
    if len(found) < len(trials):
        raise SystemExit("a walk came to no end")
    errors = np.array([[heading_errors_deg(row) for row in one.rows] for one in found])
    return errors.reshape(len(SWAYS), walks, len(units), len(noises), len(METHODS), 2)


def stage_sheet(motions: Sequence[Motion]) -> Sheet:
    """What each stage of HDR makes of each motion; after the filters have filled."""
    heads = ["motion", "footfalls", "SD raw", "once", "twice", "A = 0 (%)", "mean A", "largest I"]
    sheet = Sheet("stages", "HDR's stages, IMU without error (rates in deg/s)", heads)
    sheet.headings += ["HDR's error: average (deg)", "final (deg)"]
    for one in motions:
        found, late = one.found, slice(30, None)
        error = np.degrees(found.heading - one.truth)
        rates = [np.degrees(getattr(found, stage)[late]).std() for stage in ("raw", "once", "twice")]
        sheet.rows.append(
            [
                one.name,
                f"{len(one.footfalls)}",
                *(f"{rate:.2f}" for rate in rates),
                f"{100 * np.mean(found.attenuator[late] == 0):.0f}",
                f"{found.attenuator[late].mean():.2f}",
                f"{np.degrees(np.abs(found.integrator)).max():.3f}",
                f"{np.abs(error).mean():.1f}",
                f"{abs(error[-1]):.1f}",
            ]
        )
    return sheet


def gain_sheet() -> Sheet:
    """The double filter's gain by the sway's period."""
    sheet = Sheet(
        "gain", "What the double filter leaves of a sway", ["period (s)", *(f"{p:g}" for p in PERIODS)]
    )
    sheet.rows.append(["left (%)", *(f"{100 * gain(period, HdrParams().tau_s):.2g}" for period in PERIODS)])
    return sheet


def error_sheet(errors: np.ndarray) -> Sheet:
    """errors (sway, walk, unit, noise, method, 2) deg: median and 90th percentile of each sway and method."""
    heads = ["sway", "method", "average: median (deg)", "p90", "final: median (deg)", "p90"]
    count = f"{errors.shape[1]} walks x {errors.shape[2]} units x {errors.shape[3]} noises"
    sheet = Sheet("errors", f"Heading error with the nIMU, {count}", heads)
    sheet.headings += ["worse than uncorrected (%)", "final over the noises: range, median (deg)"]
    for name, level in zip(SWAYS, errors, strict=True):
        for m, method in enumerate(METHODS):
            average, final = level[..., m, AVERAGE], level[..., m, FINAL]
            numbers = [np.percentile(values, q) for values in (average, final) for q in (50, 90)]
            worse = 100 * np.mean(average > level[..., 0, AVERAGE])
            scatter = np.median(np.ptp(final, axis=-1))
            cells = [f"{value:.1f}" for value in numbers]
            sheet.rows.append(
                [name if m == 0 else "", method, *cells, f"{worse:.0f}" if m else "", f"{scatter:.1f}"]
            )
    return sheet


def main(arguments: Sequence[str] | None = None) -> None:
    """Walk, correct, print, fill, draw."""
    parser = options(__doc__)
    for name, default, text in (
        ("walks", 2, "walks of each sway that are judged"),
        ("units", 10, "units on each walk"),
        ("noises", 3, "seeds of noise of each unit"),
        ("unit-seed", 1000, "of the first unit"),
    ):
        parser.add_argument(f"--{name}", type=int, default=default, help=text)
    parser.add_argument("--page", type=Path, metavar="MD", help="fill its tables")
    parser.add_argument("--figure", type=Path, metavar="PNG", help="draw there")
    chosen = parser.parse_args(arguments)

    scenario = load_scenario("swaying")
    motions = run_all(motion, list(perfect_trials(scenario).items()), chosen.processes, "motions")
    tau = HdrParams().tau_s
    undone = max(
        np.abs(delagged(one.found.twice, one.footfalls.interval, tau) - one.footfalls.rate).max()
        for one in motions
    )
    units = range(chosen.unit_seed, chosen.unit_seed + chosen.units)
    errors = scored(scenario, chosen.walks, units, range(chosen.noises), chosen.processes)

    sheets = [stage_sheet(motions), gain_sheet(), error_sheet(errors)]
    for sheet in sheets:
        sheet.show()
    print(f"De-lagging the twice filtered rate gives the raw one back to {np.degrees(undone):.1e} deg/s.")
    if chosen.page is not None:
        fill(chosen.page, by_name(sheets))
    if chosen.figure is not None:
        draw(chosen.figure, [one for one in motions if one.name != SWAYS[1]])  # between its neighbours
    write_json(
        chosen.json,
        {"undone_deg_s": float(np.degrees(undone)), **{s.name: [s.headings, *s.rows] for s in sheets}},
    )


if __name__ == "__main__":
    main()
