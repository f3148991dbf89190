"""What a walk costs, and how much of it is physics.

Walks the first metres of a scenario twice, on level ground and on its heightfield, and gives CPU seconds for
20 simulated minutes (scaled; building the body, which happens once, is added unscaled) by where they go. Then
MuJoCo alone repeats the same physics in the same run: every control step from its recorded state under its
recorded servo targets, in a few large rollouts, which must end in the same states to the last bit. "whole /
bare" is therefore what everything around the physics costs. Trust that ratio more than the seconds.

python benchmarks/walker_speed.py
"""

from __future__ import annotations

import time
from collections import defaultdict
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from typing import Any
from unittest import mock

import mujoco
import numpy as np
from _common import err, options, out, shortened, write_json
from mujoco import rollout
from rich.table import Table

from footfall.models.policy import Policy
from footfall.scenarios.scenario import load_scenario
from footfall.simulate import journey, walkers
from footfall.simulate.journey import PHYSICS_STEP, Plan, walk
from footfall.simulate.steer import Pursuit
from footfall.simulate.walkers import Walkers

MINUTES = 20
PHYSICS = "MuJoCo"
# None of these calls another one, so their times add up.
WATCHED: tuple[tuple[str, Any, str], ...] = (
    (PHYSICS, rollout.Rollout, "rollout"),
    ("policy", Policy, "__call__"),
    ("observation", Walkers, "observe"),
    ("feedback", walkers, "feedback"),
    ("steering", Pursuit, "command"),
    ("truth", journey, "imu_truth"),
    ("truth", journey, "at_rest"),
    ("set-up", journey, "build_body"),
)
REST = "rest: gait, state, record"


@dataclass
class Watch:
    """CPU seconds by label, and what went into and came out of the physics."""

    seconds: defaultdict[str, float] = field(default_factory=lambda: defaultdict(float))
    physics: list[tuple[tuple[Any, ...], np.ndarray]] = field(default_factory=list)

    def over(self, label: str, work: Callable[..., Any]) -> Callable[..., Any]:
        """`work`, timed."""

        def timed(*arguments: Any, **keywords: Any) -> Any:
            start = time.process_time()
            result = work(*arguments, **keywords)
            self.seconds[label] += time.process_time() - start
            if label == PHYSICS:
                self.physics.append((arguments[1:], result[0][:, -1]))
            return result

        return timed


def watched_walk(plan: Plan) -> Watch:
    """Walk a plan under the watch."""
    watch = Watch()
    with ExitStack() as stack:
        for label, owner, name in WATCHED:
            stack.enter_context(mock.patch.object(owner, name, watch.over(label, getattr(owner, name))))
        start = time.process_time()
        walk(plan)
        watch.seconds[REST] = time.process_time() - start - sum(watch.seconds.values())
    return watch


def bare(watch: Watch, batch: int = 500) -> float:
    """CPU seconds of MuJoCo alone for the same steps.

    Raises
    ------
    SystemExit
        It did not come to the same states: the comparison would be void.
    """
    model = watch.physics[0][0][0]
    model = model[0] if isinstance(model, list) else model
    starts, targets, ends = (
        np.concatenate(parts)
        for parts in zip(*((given[2], given[3], end) for given, end in watch.physics), strict=True)
    )
    seconds = 0.0
    with rollout.Rollout(nthread=0) as alone:
        data = mujoco.MjData(model)
        for first in range(0, len(starts), batch):
            rows = slice(first, first + batch)
            start = time.process_time()
            states, _ = alone.rollout(model, data, starts[rows], targets[rows])
            seconds += time.process_time() - start
            if not np.array_equal(states[:, -1], ends[rows]):
                raise SystemExit("MuJoCo alone did not repeat the walk's states")
    return seconds


def measure(plan: Plan) -> dict[str, float]:
    """Label -> CPU seconds for 20 simulated minutes, and the totals."""
    watch = watched_walk(plan)
    simulated = sum(given[3].shape[1] for given, _ in watch.physics) * PHYSICS_STEP
    scale = MINUTES * 60 / simulated
    result = {label: value * (1.0 if label == "set-up" else scale) for label, value in watch.seconds.items()}
    whole = sum(result.values())
    alone = bare(watch) * scale
    return result | {
        "whole": whole,
        "share in MuJoCo": result[PHYSICS] / whole,
        "bare MuJoCo": alone,
        "whole / bare": whole / alone,
        "simulated minutes": simulated / 60,
    }


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table."""
    parser = options(__doc__, processes=False)
    parser.add_argument("--scenario", default="closed-loop", help="stock name or TOML file")
    parser.add_argument(
        "--metres", type=float, default=240.0, help="to walk of it, twice (default 240: 3 min)"
    )
    chosen = parser.parse_args(arguments)

    plan = load_scenario(chosen.scenario).plan(0)
    plan = replace(plan, route=shortened(plan.route, chosen.metres))
    level = replace(plan, ground=None, route=replace(plan.route, z=np.zeros_like(plan.route.z)))
    plans = {"level": level} | ({"heightfield": plan} if plan.ground is not None else {})
    with err.status("walking"):
        walk(replace(level, route=shortened(level.route, 10.0)))  # imports and caches
        found = {name: measure(one) for name, one in plans.items()}

    minutes = found["level"].pop("simulated minutes")
    for result in found.values():
        result.pop("simulated minutes", None)
    title = (
        f"CPU seconds for {MINUTES} simulated minutes at {PHYSICS_STEP * 1e3:g} ms, scaled from {minutes:.1f}"
    )
    table = Table(title=title, title_justify="left")
    table.add_column("")
    for name in found:
        table.add_column(name, justify="right")
    order = [label for label, _, _ in WATCHED] + [REST]
    for label in dict.fromkeys([*order, *found["level"]]):
        share = label in order
        cells = [
            f"{row[label]:.2f}" + (f"  {row[label] / row['whole']:4.0%}" if share else "")
            for row in found.values()
        ]
        table.add_row(label, *cells, style=None if share else "bold")
    out.print(table)
    out.print(f"Target: 60 s, physics and truth together. Path: the start of {plan.name}, seed {plan.seed}.")
    write_json(chosen.json, {"scenario": plan.name, "simulated_minutes": minutes, "cpu_s": found})


if __name__ == "__main__":
    main()
