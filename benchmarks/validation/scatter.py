"""How much do course and stance yaw scatter on long straights, with and without wander?

Course: the direction of each stride of the instrumented foot; stance yaw: its heading at the footfalls; both
about the straight, steady strides alone. Real feet there: course 0.6 to 1.4 deg, stance yaw 1.3 to
2.6 (SD).

python -m benchmarks.validation.scatter
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np
from rich.table import Table

from benchmarks._common import options, out, run_all, write_json
from footfall.models.subject import SUBJECTS
from footfall.scenarios.path import PathSpec, build_path
from footfall.simulate.cache import cached_walk
from footfall.simulate.plan import Gait, Plan
from footfall.simulate.walk import TrueFootfalls

METRES, LEFT_OUT = 100.0, 3  # m; strides at either end that set out or stop
PACES, WANDERS = (1.3, 1.5), (0.0, 0.1)


@dataclass(frozen=True)
class Scatter:
    """One walk: SD of course and stance yaw (deg) and of the stride time (ms)."""

    subject: str
    pace: float
    wander: float
    seed: int
    course_sd_deg: float
    stance_yaw_sd_deg: float
    stride_sd_ms: float


def scatter(falls: TrueFootfalls) -> tuple[float, float, float]:
    """SD of course and stance yaw (deg) and of the stride time (ms) of a walk along x."""
    kept = slice(LEFT_OUT, -LEFT_OUT)
    x, y = np.diff(falls.position[kept, :2], axis=0).T
    course = np.degrees(np.arctan2(y, x))
    yaw, times = np.degrees(falls.heading[kept]), 1e3 * np.diff(falls.t[kept])
    return float(course.std(ddof=1)), float(yaw.std(ddof=1)), float(times.std(ddof=1))


def measure(job: tuple[str, float, float, int]) -> Scatter:
    """Walk once."""
    subject, pace, wander, seed = job
    spec = PathSpec.model_validate({"elements": [{"kind": "straight", "length_m": METRES}]})
    gait = Gait(pace_m_s=pace, wander_m=wander)
    plan = Plan("scatter", build_path(spec).route, SUBJECTS[subject], gait=gait, seed=seed)
    return Scatter(*job, *scatter(cached_walk(plan).footfalls))


def report(found: Sequence[Scatter]) -> None:
    """A row a kind of walk: mean over its walks, smallest and largest."""
    table = Table(title="SD on long straights: mean (smallest to largest walk)", title_justify="left")
    for heading in ("subject", "m/s", "wander m", "walks", "course deg", "stance yaw deg", "stride time ms"):
        table.add_column(heading, justify="left" if heading == "subject" else "right")
    kinds = dict.fromkeys((one.subject, one.pace, one.wander) for one in found)
    for kind in kinds:
        rows = [one for one in found if (one.subject, one.pace, one.wander) == kind]
        cells = []
        for name in ("course_sd_deg", "stance_yaw_sd_deg", "stride_sd_ms"):
            values = np.array([getattr(one, name) for one in rows])
            cells.append(f"{values.mean():.1f} ({values.min():.1f} to {values.max():.1f})")
        table.add_row(kind[0], f"{kind[1]:g}", f"{kind[2]:g}", str(len(rows)), *cells)
    out.print(table)


def main(arguments: Sequence[str] | None = None) -> None:
    """Walk and print."""
    parser = options(__doc__)
    parser.add_argument("--seeds", type=int, default=6, help="walks of each kind (default 6)")
    parser.add_argument("--first-seed", type=int, default=901)
    chosen = parser.parse_args(arguments)
    seeds = range(chosen.first_seed, chosen.first_seed + chosen.seeds)
    jobs = [
        (who, pace, wander, seed)
        for wander in WANDERS
        for who in SUBJECTS
        for pace in PACES
        for seed in seeds
    ]
    found = run_all(measure, jobs, chosen.processes, "straights")
    report(found)
    write_json(chosen.json, {"scatter": [asdict(one) for one in found]})


if __name__ == "__main__":
    main()
