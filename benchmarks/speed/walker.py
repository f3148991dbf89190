"""What a walk costs, and how much of it is physics.

Walks the first metres of a scenario, on level ground and on its slopes, and gives CPU seconds for 20
simulated minutes (scaled; building the body, which happens once, is added unscaled). The whole and MuJoCo's
share of it come from a walk in which nothing but MuJoCo is timed, where the rest goes from another one. Then
MuJoCo alone repeats the same physics: every control step from its recorded state under its recorded servo
targets (on slopes also over its planes), in a few large rollouts, which must end in the same states to the
last bit. "whole / bare" is therefore what everything around the physics costs. Last, several walks at once:
simulated seconds per second of the clock, each walk's own, added up. Trust ratios more than seconds, and on a
busy machine, whose other work empties the caches, the median control step more than the sum.

python -m benchmarks.speed.walker
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
from mujoco import rollout
from rich.table import Table

from benchmarks._common import err, options, out, run_all, shortened, write_json
from footfall.models.policy import Policy
from footfall.scenarios.scenario import load_scenario
from footfall.simulate import episode, walking
from footfall.simulate.episode import SUBSTEPS
from footfall.simulate.plan import PHYSICS_STEP, Plan
from footfall.simulate.walker import walkers
from footfall.simulate.walker.steering import Pursuit
from footfall.simulate.walker.variability import Variability
from footfall.simulate.walker.walkers import Walkers
from footfall.simulate.walking import walk

MINUTES, TARGET_S, TARGET_SHARE = 20, 45, 0.85
PHYSICS = "MuJoCo"
# None of these calls another one, so their times add up.
WATCHED: tuple[tuple[str, Any, str], ...] = (
    ("policy", Policy, "__call__"),
    ("observation", Walkers, "observe"),
    ("feedback, standing, gate", walkers, "act_all"),
    ("servo targets", walkers, "stride_all"),
    ("servo targets", walkers, "targets_all"),
    ("variability", Variability, "draw"),
    ("state", walkers, "land_all"),
    ("steering", Pursuit, "command"),
    ("truth", walking, "imu_truth"),
    ("truth", walking, "at_rest"),
    ("set-up", episode, "build_body"),
)
REST = "record and calls"


@dataclass(frozen=True)
class Step:
    """Physics of one control step: its model, state and what drives it, and the state that it came to."""

    model: mujoco.MjModel
    noslip: int
    start: np.ndarray
    control: np.ndarray
    spec: int
    end: np.ndarray


@dataclass
class Watch:
    """CPU seconds by label, and the physics."""

    seconds: defaultdict[str, float] = field(default_factory=lambda: defaultdict(float))
    steps: list[Step] = field(default_factory=list)

    def over(self, label: str, work: Callable[..., Any]) -> Callable[..., Any]:
        """`work`, timed."""

        def timed(*arguments: Any, **keywords: Any) -> Any:
            start = time.process_time()
            result = work(*arguments, **keywords)
            self.seconds[label] += time.process_time() - start
            return result

        return timed

    def physics(self, work: Callable[..., Any]) -> Callable[..., Any]:
        """`work`, which is rollout, kept."""

        def kept(own: Any, models: Any, data: Any, start: Any, control: Any, **keywords: Any) -> Any:
            result = work(own, models, data, start, control, **keywords)
            noslip, end = int(models[0].opt.noslip_iterations), result[0][:, -1].copy()
            self.steps.append(Step(models[0], noslip, start.copy(), control, keywords["control_spec"], end))
            return result

        return kept


def watched_walk(plan: Plan) -> tuple[float, np.ndarray, Watch]:
    """CPU seconds of a walk, those at which MuJoCo began and ended each step (n, 2), where the rest goes."""
    watch, times = Watch(), []
    rollouts = rollout.Rollout.rollout

    def timed(*arguments: Any, **keywords: Any) -> Any:
        begun = time.process_time()
        result = rollouts(*arguments, **keywords)
        times.append((begun, time.process_time()))
        return result

    with mock.patch.object(rollout.Rollout, "rollout", timed):
        start = time.process_time()
        walk(plan)
        whole = time.process_time() - start
    with ExitStack() as stack:
        stack.enter_context(mock.patch.object(rollout.Rollout, "rollout", watch.physics(rollouts)))
        for label, owner, name in WATCHED:
            stack.enter_context(mock.patch.object(owner, name, watch.over(label, getattr(owner, name))))
        walk(plan)
    return whole, np.array(times), watch


def bare(steps: Sequence[Step], batch: int = 500) -> float:
    """CPU seconds of MuJoCo alone for the same steps.

    Raises
    ------
    SystemExit
        It did not come to the same states: the comparison would be void.
    """
    model, seconds = steps[0].model, 0.0
    with rollout.Rollout(nthread=0) as alone:
        data = mujoco.MjData(model)
        for noslip in sorted({step.noslip for step in steps}):
            model.opt.noslip_iterations = noslip
            some = [step for step in steps if step.noslip == noslip]
            for first in range(0, len(some), batch):
                rows = some[first : first + batch]
                starts, controls, ends = (
                    np.concatenate(parts)
                    for parts in zip(*((row.start, row.control, row.end) for row in rows), strict=True)
                )
                start = time.process_time()
                states, _ = alone.rollout(model, data, starts, controls, control_spec=steps[0].spec)
                seconds += time.process_time() - start
                if not np.array_equal(states[:, -1], ends):
                    raise SystemExit("MuJoCo alone did not repeat the walk's states")
    return seconds


def measure(plan: Plan) -> dict[str, float]:
    """Label -> CPU seconds for 20 simulated minutes, and the totals."""
    _warm_up(plan)
    whole, times, watch = watched_walk(plan)
    inside, step = times[:, 1] - times[:, 0], np.diff(times[:, 0])
    alone = bare(watch.steps)
    simulated = len(watch.steps) * SUBSTEPS * PHYSICS_STEP
    scale = MINUTES * 60 / simulated
    once = watch.seconds.pop("set-up")
    parts = {label: value * scale for label, value in watch.seconds.items()} | {"set-up": once}
    whole = (whole - once) * scale + once
    result = {PHYSICS: float(inside.sum()) * scale} | parts
    result[REST] = whole - sum(result.values())
    return result | {
        "whole": whole,
        "share in MuJoCo": result[PHYSICS] / whole,
        "share, median step": float(np.median(inside) / np.median(step)),
        "bare MuJoCo": alone * scale,
        "whole / bare": whole / (alone * scale),
        "simulated minutes": simulated / 60,
    }


def _warm_up(plan: Plan) -> None:
    """Imports, and compiled code from its cache."""
    walk(replace(plan, route=shortened(plan.route, 20.0)))


def timed_walk(plan: Plan) -> float:
    """Simulated seconds per second of the clock."""
    _warm_up(plan)
    start = time.perf_counter()
    walked = walk(plan)
    return float(walked.t[-1]) / (time.perf_counter() - start)


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table."""
    parser = options(__doc__)
    parser.add_argument("--scenario", default="closed-loop", help="stock name or TOML file")
    parser.add_argument("--metres", type=float, default=600.0, help="to walk of it (default 600)")
    chosen = parser.parse_args(arguments)

    plan = load_scenario(chosen.scenario).plan(0)
    # Without the long first stand, standing has about the share that it has in 20 minutes.
    plan = replace(plan, route=shortened(plan.route, chosen.metres), calibration_s=0.0)
    level = replace(plan, ground=None, route=replace(plan.route, z=np.zeros_like(plan.route.z)))
    plans = {"level": level} | ({"slopes": plan} if plan.ground is not None else {})
    with err.status("walking"):
        found = {name: measure(one) for name, one in plans.items()}
    together = [replace(level, seed=level.seed + i) for i in range(chosen.processes)]
    one = timed_walk(level)
    rates = run_all(timed_walk, together, chosen.processes, "walking at once")

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
    order = [PHYSICS, *(label for label, _, _ in WATCHED), REST]
    for label in dict.fromkeys([*order, *found["level"]]):
        share = label in order
        cells = [
            f"{row[label]:.2f}" + (f"  {row[label] / row['whole']:5.1%}" if share else "")
            for row in found.values()
        ]
        table.add_row(label, *cells, style=None if share else "bold")
    out.print(table)
    out.print(f"Target: {TARGET_S} s, {TARGET_SHARE:.0%} of it in MuJoCo.")
    out.print(
        f"Times real time, on the level: {one:.0f} alone, {sum(rates):.0f} with {len(rates)} walks at once."
    )
    out.print(f"Path: the start of {plan.name}, seed {plan.seed}.")
    figures = {"cpu_s": found, "real_time_alone": one, "real_time_at_once": rates}
    write_json(chosen.json, {"scenario": plan.name, "simulated_minutes": minutes, **figures})


if __name__ == "__main__":
    main()
