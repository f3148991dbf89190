"""What was tried against the heading that a zero velocity makes of a perfect IMU, beside the default.

Each way is run stance by stance on stock scenarios in a perfect IMU, unaligned (largest heading error and
largest distance from the truth, worst of the walks), and on the real recordings beside the checkout (sum of
their errors). Then the velocity that the simulated foot has at the instant of zero velocity, by slope.

python -m benchmarks.papers.iez_ways --page docs/iez.md
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from benchmarks._common import options, run_all, write_json
from benchmarks._page import Sheet, by_name, fill
from benchmarks.validation._real import BESIDE, Real, find
from benchmarks.validation.perfect_imu import Own, own, without_bias
from benchmarks.validation.real_recordings import DETECTOR, judge, reckoning
from footfall.hdr.tracks import Reckoning, pdr_track
from footfall.pdr.filter import _kernels as kernels
from footfall.pdr.filter import run
from footfall.pdr.filter.ins import MOVING, ZERO_VELOCITY, FilterSettings, InertialFilter
from footfall.pdr.filter.layout import STATE
from footfall.pdr.filter.states import States
from footfall.pdr.track import Track
from footfall.scenarios.judge.score import compare
from footfall.scenarios.trial import Trial, recording_of, setup, walk_of
from footfall.scenarios.trial import reckoning as simulated

SCENARIOS = ("straight", "curving", "errands", "closed-loop")
STEEP = 0.035  # rise over run from which on a stride belongs to the slope of 5 %
WHOLE_STRIDE = 0.6  # m
FEW = 30  # strides; of fewer no mean is given


@dataclass(frozen=True)
class Way:
    """How the filter takes the end of a stance.

    Attributes
    ----------
    vertical : what counts as the vertical, about which zero velocity leaves the gyro's errors alone: the
        "moment"'s, that of the "rest", or the mean over so many strides
    height : m, the foot's velocity is not zero but rate x height, as of a foot that turns about a point below
    lever : m, sigma_v^2 grows by (lever rate)^2
    sigma : m/s, sigma_v
    """

    vertical: str | int = run.STRIDES
    height: float = 0.0
    lever: float = 0.0
    sigma: float = FilterSettings.sigma_velocity


WAYS = {
    "**default**: vertical of the first ten strides": Way(),
    "vertical of the moment": Way("moment"),
    "the same, sigma_v 0.2 m/s": Way("moment", sigma=0.2),
    "the same, sigma_v grows with the rate, lever 0.5 m": Way("moment", lever=0.5),
    "the same, turning about a point 0.05 m below": Way("moment", height=0.05),
    "vertical of the rest": Way("rest"),
    "vertical of the first stride": Way(1),
    "vertical of all strides": Way(1_000_000),
    "default, sigma_v 0.02 m/s": Way(sigma=0.02),
    "default, sigma_v 0.1 m/s": Way(sigma=0.1),
    "default, turning about a point 0.05 m below": Way(height=0.05),
}


def track(given: Reckoning, way: Way) -> Track:
    """The recording through the filter, stance by stance."""
    recording, found = given.recording, given.detected
    start = run.align(
        recording, found, given.start, strides=way.vertical if isinstance(way.vertical, int) else 1
    )
    start = replace(start, vertical=None) if way.vertical == "rest" else start
    now = InertialFilter(FilterSettings(sigma_velocity=way.sigma), start)
    stances, update = found.stances, run.updates(recording.t, found, None)
    kept, last = [], found.rest.last
    for place, row in enumerate(stances.resets):
        rows = slice(last + 1, row + 1)
        moving = np.full(row - last, MOVING)
        now.advance(recording.t[rows], recording.gyro[rows], recording.accel[rows], moving)
        last = row
        if row > found.rest.last:
            _stand(now, recording.gyro[row] - now.gyro_bias, int(update[row]), way)
        if place in set(stances.footfalls.tolist()):
            kept.append(now.state())
    states = States.joined(kept)
    heading = np.unwrap([given.start.heading, *states.heading])[1:]
    return replace(pdr_track(given.footfalls), position=states.position, heading=heading)


def _stand(now: InertialFilter, rate: np.ndarray, update: int, way: Way) -> None:
    """The update at the end of a stance; in a longer rest the foot has no velocity."""
    attitude = np.array(kernels.matrix(tuple(now.quaternion))).reshape(3, 3)
    if way.vertical == "moment":
        now._up = tuple(attitude[2].tolist())
    walking = update == ZERO_VELOCITY
    spread = way.sigma**2 + walking * (way.lever * np.linalg.norm(rate)) ** 2
    now._variances = (float(spread), now._variances[1])
    velocity = np.cross(attitude @ rate, [0.0, 0.0, walking * way.height])
    now._x[STATE["velocity"]] -= velocity
    now.rest(update)
    now._x[STATE["velocity"]] += velocity


@dataclass(frozen=True)
class Slid:
    """The foot's velocity (m/s) at the instant of zero velocity: mean along the stride, by slope."""

    level: float
    up: float
    down: float


def slid(found: Track, place: np.ndarray) -> Slid:
    """From what dead reckoning's strides lack: with a perfect IMU that is this velocity, stride by stride.

    place : (n, 2) m, true, at the footfalls
    """
    step = np.diff(place, axis=0)
    length = np.hypot(*step.T)
    lacking = -np.diff(found.position[:, :2] - place, axis=0) / np.diff(found.t)[:, None]
    along = np.einsum("ij,ij->i", lacking, step) / np.maximum(length, 1e-9)
    slope = np.diff(found.position[:, 2]) / np.maximum(length, 1e-9)
    whole = length > WHOLE_STRIDE

    def mean(rows: np.ndarray) -> float:
        chosen = along[whole & rows]
        return float(chosen.mean()) if len(chosen) >= FEW else math.nan

    return Slid(mean(np.abs(slope) < STEEP / 2), mean(slope > STEEP), mean(slope < -STEEP))


def on_walk(trial: Trial) -> tuple[dict[str, Own], Slid]:
    """Every way on one walk."""
    walk = walk_of(trial)
    given = simulated(trial.setup, walk, recording_of(trial, walk))
    name, number = trial.setup.scenario.name, trial.number + 1
    found = {way: own(name, number, way, track(given, how), walk) for way, how in WAYS.items()}
    reckoned = pdr_track(given.footfalls)
    return found, slid(reckoned, compare(reckoned, walk).truth)


def on_feet(real: Real) -> dict[str, float]:
    """Every way on one recording: return error or RMSE to the footprints (m)."""
    given = reckoning(real, DETECTOR)
    return {name: judge(real, DETECTOR, name, track(given, way)).error_m for name, way in WAYS.items()}


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure and print."""
    parser = options(__doc__)
    parser.add_argument(
        "scenarios", nargs="*", default=list(SCENARIOS), help=f"default: {', '.join(SCENARIOS)}"
    )
    parser.add_argument("--walks", type=int, default=2, help="of each scenario (default 2)")
    parser.add_argument("--first", type=int, default=0, help="number of the first of them (default 0)")
    parser.add_argument("--no-real", action="store_true", help="leave real recordings out")
    parser.add_argument("--page", type=Path, metavar="MD", help="fill its tables")
    chosen = parser.parse_args(arguments)
    setups = [setup(without_bias(name), imu="perfect", methods=()) for name in chosen.scenarios]
    numbers = range(chosen.first, chosen.first + chosen.walks)
    jobs = [Trial(one, k, one.scenario.seeds.base + k, 1, 1) for one in setups for k in numbers]
    walked = run_all(on_walk, jobs, chosen.processes, "perfect IMU")
    reals = [] if chosen.no_real or not BESIDE.is_dir() else find(BESIDE)
    feet = run_all(on_feet, reals, chosen.processes, "real feet")

    ways = Sheet("ways", "Heading deg / position %, worst of the walks; sum of real errors, m", ["way"])
    ways.headings += [*(f"`{name}`" for name in chosen.scenarios), *(["real"] if feet else [])]
    for name in WAYS:
        row = [name]
        for scenario in chosen.scenarios:
            worst = [found[name] for found, _ in walked if found[name].scenario == scenario]
            heading = max(one.largest_heading_deg for one in worst)
            row.append(f"{heading:.2f} / {max(one.largest_position_pct for one in worst):.3f}")
        ways.rows.append(row + ([f"{sum(one[name] for one in feet):.2f}"] if feet else []))
    ways.show()
    slides = Sheet("slides", "Velocity along the stride when it is called zero", ["mm/s"])
    slides.headings += ["level", "5 % up", "5 % down"]
    for found, slide in walked:
        one = next(iter(found.values()))
        cells = (f"{1e3 * value:+.1f}" if value == value else "-" for value in vars(slide).values())
        slides.rows.append([f"`{one.scenario}`, walk {one.walk}", *cells])
    slides.show()
    if chosen.page is not None:
        fill(chosen.page, by_name([ways, slides]))
    document = {sheet.name: {"head": sheet.headings, "rows": sheet.rows} for sheet in (ways, slides)}
    write_json(chosen.json, document)


if __name__ == "__main__":
    main()
