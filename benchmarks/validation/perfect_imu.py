"""What navigation makes of a perfect IMU on every stock scenario, unaligned: what is left is its own.

Heading error at footfall 0 and the largest anywhere (deg); distance error and the largest distance between
track and truth (% of the distance walked).

python -m benchmarks.validation.perfect_imu
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np
from rich.table import Table

from benchmarks._common import options, out, run_all, write_json
from footfall.pdr.track import Track
from footfall.scenarios.judge.score import compare, score
from footfall.scenarios.scenario import Scenario, load_scenario, stock_scenarios
from footfall.scenarios.trial import Trial, perform, setup, walk_of
from footfall.simulate.walk import Walk

METHODS = ("pdr", "iez")


@dataclass(frozen=True)
class Own:
    """A method's own error on one walk: heading in deg, the others in % of the distance."""

    scenario: str
    walk: int
    method: str
    first_heading_deg: float
    largest_heading_deg: float
    distance_error_pct: float
    largest_position_pct: float


def own(scenario: str, walk: int, method: str, track: Track, truth: Walk) -> Own:
    """Compare as it is."""
    row = compare(track, truth)
    heading = np.degrees(np.abs(row.heading_error))
    walked = np.hypot(*np.diff(row.truth, axis=0).T).sum()
    off = np.hypot(*(row.estimate - row.truth).T).max()
    distance = score(track, truth).distance_error_pct
    return Own(scenario, walk, method, float(heading[0]), float(heading.max()), distance, 100 * off / walked)


def without_bias(name: str) -> Scenario:
    """A stock scenario without the gyro bias that the IHDE tests give to whatever sensor is worn."""
    return load_scenario(name).changed("sensor", bias_shift_deg_s=0.0)


def measure(trial: Trial) -> list[Own]:
    """Walk once, record without an error, navigate."""
    walk = walk_of(trial)
    kept = perform(trial, walk, keep=True).kept
    assert kept is not None
    name = trial.setup.scenario.name
    return [own(name, trial.number + 1, method, track, walk) for method, track in kept.tracks.items()]


def report(found: Sequence[Own]) -> None:
    """A row a scenario and method: the worst of its walks."""
    table = Table(title="A perfect IMU, unaligned: worst of the walks", title_justify="left")
    for heading in ("scenario", "method", "footfall 0 deg", "heading deg", "distance %", "position %"):
        table.add_column(heading, justify="left" if heading in ("scenario", "method") else "right")
    for scenario, method in dict.fromkeys((one.scenario, one.method) for one in found):
        rows = [one for one in found if (one.scenario, one.method) == (scenario, method)]
        distance = max((one.distance_error_pct for one in rows), key=abs)
        table.add_row(
            scenario,
            method,
            f"{max(one.first_heading_deg for one in rows):.3f}",
            f"{max(one.largest_heading_deg for one in rows):.2f}",
            f"{distance:+.2f}",
            f"{max(one.largest_position_pct for one in rows):.2f}",
        )
    out.print(table)


def main(arguments: Sequence[str] | None = None) -> None:
    """Walk, navigate, print."""
    parser = options(__doc__)
    parser.add_argument("scenarios", nargs="*", default=list(stock_scenarios()), help="default: all")
    parser.add_argument("--walks", type=int, default=2, help="of each scenario (default 2)")
    chosen = parser.parse_args(arguments)
    setups = [setup(without_bias(name), imu="perfect", methods=METHODS) for name in chosen.scenarios]
    jobs = [
        Trial(one, number, one.scenario.seeds.base + number, unit_seed=1, noise_seed=1)
        for one in setups
        for number in range(chosen.walks)
    ]
    found = [one for rows in run_all(measure, jobs, chosen.processes, "perfect IMU") for one in rows]
    report(found)
    write_json(chosen.json, {"perfect": [asdict(one) for one in found]})


if __name__ == "__main__":
    main()
