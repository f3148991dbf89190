"""How well the samples of a perfect IMU on the shoe give back the walk that they were taken on.

Walks a scenario (closed-loop: 1,800 m, more than 20 minutes), records it with the sheet `perfect` and
integrates the recording open loop: no zero velocity, no correction of any kind. Shown is the distance between
integrated and true position; the targets are 1 mm at 1 kHz and 2 mm at 200 Hz.

python -m benchmarks.validation.imu_truth
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial

import numpy as np
from rich.table import Table
from scipy.spatial.transform import Rotation

from benchmarks._common import options, out, run_all, shortened, write_json
from footfall.pdr.strapdown import integrate
from footfall.scenarios.scenario import load_scenario
from footfall.scenarios.trial import Trial, recording_of, setup
from footfall.simulate.plan import Plan
from footfall.simulate.walking import walk

TARGET_MM = {1000.0: 1.0, 200.0: 2.0}
AT = 1200.0  # s


@dataclass(frozen=True)
class Error:
    """Of one recording, integrated: position in the first 20 minutes and in all, attitude at the end."""

    rate_hz: float
    duration_s: float
    largest_20_min_mm: float
    largest_mm: float
    attitude_deg: float


def measure(plan: Plan, trial: Trial) -> Error:
    """Walk, record and integrate."""
    truth = walk(plan)
    recording = recording_of(trial, truth)
    found = integrate(
        recording.t,
        recording.gyro,
        recording.accel,
        quaternion=truth.quaternion[0],
        velocity=truth.velocity[0],
        position=truth.position[0],
    )
    off = 1e3 * np.linalg.norm(found.position - truth.position, axis=1)
    ends = Rotation.from_quat(np.stack([found.quaternion[-1], truth.quaternion[-1]]), scalar_first=True)
    return Error(
        rate_hz=plan.rate_hz,
        duration_s=float(recording.t[-1]),
        largest_20_min_mm=float(off[recording.t <= AT].max()),
        largest_mm=float(off.max()),
        attitude_deg=float(np.degrees((ends[0].inv() * ends[1]).magnitude())),
    )


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table."""
    parser = options(__doc__)
    parser.add_argument("--scenario", default="closed-loop", help="stock name or TOML file")
    parser.add_argument("--metres", type=float, help="walk only the first of it")
    chosen = parser.parse_args(arguments)

    worn = setup(load_scenario(chosen.scenario), imu="perfect", methods=())
    trial = Trial(worn, 0, worn.scenario.seeds.base, unit_seed=0, noise_seed=0)
    plan = replace(trial.plan, route=shortened(trial.plan.route, chosen.metres))
    plans = [replace(plan, rate_hz=rate) for rate in TARGET_MM]
    errors = run_all(partial(measure, trial=trial), plans, chosen.processes, "walking")

    table = Table(
        title=f"A perfect IMU integrated open loop, {plan.name}, seed {plan.seed}", title_justify="left"
    )
    for heading in (
        "rate Hz",
        "min",
        "largest, 20 min mm",
        "largest, all mm",
        "target mm",
        "attitude, end deg",
    ):
        table.add_column(heading, justify="right")
    for error in errors:
        table.add_row(
            f"{error.rate_hz:g}",
            f"{error.duration_s / 60:.1f}",
            f"{error.largest_20_min_mm:.4f}",
            f"{error.largest_mm:.4f}",
            f"< {TARGET_MM[error.rate_hz]:g}",
            f"{error.attitude_deg:.1e}",
        )
    out.print(table)
    write_json(chosen.json, {"scenario": plan.name, "errors": [asdict(error) for error in errors]})


if __name__ == "__main__":
    main()
