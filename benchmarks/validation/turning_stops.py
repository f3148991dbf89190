"""Who falls when told to stop in the middle of a turn? Drawn people on level ground stop four times each.

Everybody walks straight on for 2 s at 0.7 to 1.1 m/s, turns for 2 s by up to 0.9 rad/s, and is then told at
once to stand and not to turn, for 5 s. Walks never ask for it so harshly. A loss of heading counts as a fall.

python -m benchmarks.validation.turning_stops --people 48 --seeds 4
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np
from rich.table import Table

from benchmarks._common import options, out, run_all, write_json
from footfall.models.body import build_body
from footfall.models.policy import stock_policy
from footfall.models.subject import draw_subject
from footfall.simulate.walker.walkers import Walkers, grip

PACES, SHARPEST = (0.7, 1.1), 0.9  # m/s, rad/s
STAND_S, WALK_S, TURN_S, STOP_S, STOPS = 1.5, 2.0, 2.0, 5.0, 4
_STEP, _SUBSTEPS = 0.0025, 12  # s of physics; physics steps a control step


@dataclass(frozen=True)
class Stopped:
    """What came of one set of people: falls when stopping and else, and stops without a stand."""

    seed: int
    people: int
    falls: int
    falls_else: int
    steps_on: int


def stop(job: tuple[int, int]) -> Stopped:
    """Let so many people walk, turn and stop, four times."""
    seed, n = job
    rng = np.random.default_rng(seed)
    subjects = [draw_subject(rng) for _ in range(n)]
    models = [build_body(one.build, timestep=_STEP / one.time_scale) for one in subjects]
    policy = stock_policy()
    walkers = Walkers(models, policy.feedback_gains, rng=np.random.default_rng([seed, 1]), substeps=_SUBSTEPS)
    walkers.place(
        np.ones(n, dtype=bool),
        phase=0.5 * rng.integers(2, size=n),
        speed=np.zeros(n),
        heading=np.zeros(n),
        position=np.zeros((n, 3)),
        standing=np.ones(n, dtype=bool),
        variability=np.ones(n),
        habits=[one.habits for one in subjects],
    )
    down, falls, steps_on = np.zeros(n, dtype=bool), {True: 0, False: 0}, 0
    parts: list[tuple[float, np.ndarray, np.ndarray]] = [(STAND_S, np.zeros(n), np.zeros(n))]
    for _ in range(STOPS):
        speed, turn = rng.uniform(*PACES, n), rng.uniform(-SHARPEST, SHARPEST, n)
        parts += [(WALK_S, speed, 0 * turn), (TURN_S, speed, turn), (STOP_S, 0 * speed, 0 * turn)]
    for seconds, speed, turn in parts:
        walkers.speed_goal[:], walkers.turn_goal[:] = speed, turn
        stopping = not speed.any()
        for _ in range(round(seconds / (_STEP * _SUBSTEPS))):
            grip(walkers)
            walkers.step(policy(walkers.observe()))
            fallen = walkers.fallen() & ~down
            falls[stopping] += int(fallen.sum())
            down |= fallen
        if seconds == STOP_S:
            steps_on += int(((walkers.gate.value > 0) & ~down).sum())
    walkers.close()
    return Stopped(seed, n, falls[True], falls[False], steps_on)


def report(found: Sequence[Stopped]) -> None:
    """One row a set of people, and their sum."""
    table = Table(title="Stops out of a turn", title_justify="left")
    for heading in ("seed", "people", "stops", "falls when stopping", "falls else", "still stepping"):
        table.add_column(heading, justify="right")
    for one in found:
        cells = (one.people, one.people * STOPS, one.falls, one.falls_else, one.steps_on)
        table.add_row(str(one.seed), *map(str, cells))
    people = sum(one.people for one in found)
    sums = (sum(getattr(one, key) for one in found) for key in ("falls", "falls_else", "steps_on"))
    table.add_row("all", str(people), str(people * STOPS), *map(str, sums))
    out.print(table)


def main(arguments: Sequence[str] | None = None) -> None:
    """Walk and print the table."""
    parser = options(__doc__)
    parser.add_argument("--people", type=int, default=48, help="of each seed (default 48)")
    parser.add_argument("--seeds", type=int, default=4, help="sets of people (default 4)")
    parser.add_argument("--first-seed", type=int, default=1)
    chosen = parser.parse_args(arguments)
    jobs = [(chosen.first_seed + number, chosen.people) for number in range(chosen.seeds)]
    found = run_all(stop, jobs, chosen.processes, "stops out of turns")
    report(found)
    write_json(chosen.json, {"turning_stops": [asdict(one) for one in found]})


if __name__ == "__main__":
    main()
