"""How still does a loaded foot lie when a walker sets out and at its last step before a stop?

Drawn people stand, walk 6 m, stand for 5 s, walk on for 6 m and stand again, on level ground and on slopes,
with the physics of the walks. What twist and pitch are `footfall.simulate.learn.still_feet` says; samples are
1 ms apart.

python -m benchmarks.validation.starts --people 10
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np
from rich.table import Table

from benchmarks._common import options, out, run_all, write_json
from footfall.conventions import GRAVITY
from footfall.models import body
from footfall.models.policy import stock_policy
from footfall.models.route import Ground
from footfall.models.subject import draw_subject
from footfall.scenarios.path import PathSpec, build_path
from footfall.simulate.episode import FallError, stroll
from footfall.simulate.learn.still_feet import Moved, feet, last_step, set_out
from footfall.simulate.plan import Gait, Plan, Stop
from footfall.simulate.walker._balance_kernels import GO_SPEED
from footfall.simulate.walker.steering import StrayError
from footfall.streams import stream

METRES, AT, PAUSE_S = 12.0, 6.0, 5.0
# Gradient of the ground along and to the left of the way.
PLACES = {
    "level": (0.0, 0.0),
    "5 % uphill": (0.05, 0.0),
    "5 % downhill": (-0.05, 0.0),
    "5 %, left side up": (0.0, 0.05),
    "5 %, right side up": (0.0, -0.05),
}
_STEP_S = 0.001
_SET_OUT_S, _STOPPING_S = 2.0, 4.0  # windows: from the wish to walk on, and before the foot is at rest


@dataclass(frozen=True)
class Outcome:
    """One walk: which foot led each start, and how the feet moved."""

    place: str
    fell: bool
    led: tuple[str, ...]
    moved: tuple[Moved, ...]


def plan(place: str, seed: int) -> Plan:
    """The walk of a drawn person."""
    rng = stream(seed, "who sets out")
    spec = PathSpec.model_validate({"elements": [{"kind": "straight", "length_m": METRES}]})
    along, across = PLACES[place]
    x, y = np.arange(-12.0, METRES + 12), np.arange(-12.0, 12.0)
    heights = (along * x + across * y[:, None]).astype(np.float32)
    return Plan(
        name=place,
        route=build_path(spec).route,
        ground=Ground(x[0], y[0], 1.0, heights) if along or across else None,
        subject=draw_subject(rng),
        gait=Gait(pace_m_s=float(rng.uniform(0.8, 1.6))),
        stops=(Stop(AT, PAUSE_S),),
        seed=seed,
    )


def go(job: tuple[str, int]) -> Outcome:
    """Walk once."""
    place, seed = job
    poses, touches, steady, wishes = [], [], [], []
    try:
        for moment in stroll(plan(place, seed), stock_policy(), stand=2.0):
            walkers = moment.walkers
            poses.append(moment.trace.qpos[0])
            touches.append(moment.trace.sensor[0][:, body.SENSOR_TOUCH].reshape(-1, 2, 3).sum(axis=2))
            steady.append(bool(walkers.gate.value[0] <= 0))
            stood = (
                len(steady) < 2 or steady[-2]
            )  # at once, a gait without a shift of weight no longer stands
            wishes.append(stood and bool(walkers.speed_goal[0] > GO_SPEED))
        fell = False
    except (FallError, StrayError):
        fell = True
    model, k = walkers.models[0], len(poses[0])
    qpos, load = np.concatenate(poses), np.concatenate(touches).T / (model.body_mass.sum() * GRAVITY)
    moved: list[Moved] = []
    begins = np.flatnonzero(np.diff(np.array(wishes, dtype=int)) == 1) + 1
    ends = [*begins, len(poses)]
    for kind, begin in zip(("start", "restart"), begins, strict=False):
        rows = slice(k * begin - 1, k * begin + round(_SET_OUT_S / _STEP_S))
        if rows.stop <= len(qpos):
            angles = feet(model, qpos[rows])
            angles = angles - angles[:, :, :1]
            moved += set_out(kind, angles[:, 0, 1:], angles[:, 1, 1:], load[:, rows][:, 1:], _STEP_S)
    for end in ends[1:]:
        rows = slice(k * end - round((PAUSE_S + _STOPPING_S) / _STEP_S), k * end)
        if steady[end - 2] and rows.start > 0:
            angles = feet(model, qpos[rows])
            angles = angles - angles[:, :, -1:]
            moved += last_step(angles[:, 0], angles[:, 1], load[:, rows])
    led = tuple(one.side for one in moved if one.kind != "stop" and one.first)
    return Outcome(place, fell, led, tuple(moved))


def report(found: Sequence[Outcome]) -> None:
    """One row a place and foot."""
    for kind, title, roles in (
        ("start", "Setting out", {True: "steps first", False: "stands first"}),
        ("restart", "Setting out after a pause", {True: "steps first", False: "stands first"}),
        ("stop", "The last step", {True: "lands last", False: "has landed"}),
    ):
        table = Table(title=f"{title}: deg, median / 90 % / largest", title_justify="left")
        for heading in ("", "foot", "times", "right", "twist", "toes up", "toes down"):
            table.add_column(heading, justify="left" if heading in ("", "foot") else "right")
        for place in (*dict.fromkeys(one.place for one in found), "all"):
            here = [one for one in found if place in (one.place, "all")]
            for first, role in roles.items():
                rows = [m for one in here for m in one.moved if m.kind == kind and m.first == first]
                if rows:
                    columns = np.array([(m.twist, m.up, m.down) for m in rows]).T
                    cells = [
                        "{:.1f} / {:.1f} / {:.1f}".format(*np.percentile(c, [50, 90, 100])) for c in columns
                    ]
                    right = sum(m.side == "r" for m in rows)
                    table.add_row(place, role, str(len(rows)), str(right), *cells)
        out.print(table)
    out.print(f"{len(found)} walks, {sum(one.fell for one in found)} falls")


def main(arguments: Sequence[str] | None = None) -> None:
    """Walk and print the tables."""
    parser = options(__doc__)
    parser.add_argument("--people", type=int, default=10, help="at each place (default 10)")
    parser.add_argument("--first-seed", type=int, default=801)
    chosen = parser.parse_args(arguments)
    jobs = [
        (place, chosen.first_seed + chosen.people * number + person)
        for number, place in enumerate(PLACES)
        for person in range(chosen.people)
    ]
    found = run_all(go, jobs, chosen.processes, "starts")
    report(found)
    write_json(chosen.json, {"starts": [asdict(one) for one in found]})


if __name__ == "__main__":
    main()
