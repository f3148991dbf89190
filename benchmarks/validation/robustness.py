"""Does the walker reach the end, and how does it walk? Every stock scenario with several seeds.

Stride times and stance yaw are judged on steady stretches, with no bend tighter than 20 m radius within 5 m.
Stance yaw is the foot's heading less the path's, its mean (toe-out) removed; lateral is the foot's distance
from the path, its mean (half the step width) removed, corners included. People: stride-time SD 15-25 ms,
stance yaw about 2 deg.

python -m benchmarks.validation.robustness --seeds 4
python -m benchmarks.validation.robustness straight --metres 400 --push 10 --seeds 4
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial

import numpy as np
from rich.table import Table

from benchmarks._common import options, out, run_all, shortened, write_json
from footfall.errors import InputError
from footfall.models.route import Route
from footfall.scenarios.scenario import Scenario, load_scenario, stock_scenarios
from footfall.simulate.cache import cached_walk
from footfall.simulate.plan import Disturbance, Plan
from footfall.simulate.walk import TrueFootfalls
from footfall.simulate.walking import walk

TIGHT, CLEAR = 1 / 20, 5.0  # 1/m and m: a stretch is steady that far from curvature above this
MOST = 4.0  # m of path that a stride may cover


@dataclass(frozen=True)
class Gait:
    """How one walk was walked; `stumble` says why it came to no end."""

    scenario: str
    seed: int
    stumble: str | None = None
    minutes: float = 0.0
    speed_m_s: float = np.nan
    stride_s: float = np.nan
    stride_sd_ms: float = np.nan
    stance_yaw_sd_deg: float = np.nan
    lateral_rms_m: float = np.nan
    lateral_max_m: float = np.nan
    stands: bool = False


def places(route: Route, position: np.ndarray) -> np.ndarray:
    """(m,) nearest rows of the route to (m, 2+) footfalls, followed along it: it may cross itself."""
    spacing, row, rows = route.s[1] - route.s[0], 0, []
    back, on = int(1 / spacing), int(MOST / spacing)
    for x, y in position[:, :2]:
        first = max(0, row - back)
        near = slice(first, row + on)
        row = first + int(np.argmin((route.x[near] - x) ** 2 + (route.y[near] - y) ** 2))
        rows.append(row)
    return np.array(rows)


def steady(route: Route) -> np.ndarray:
    """(n,) bool: rows of the route with no tight bend near."""
    reach = int(CLEAR / (route.s[1] - route.s[0]))
    tight = np.abs(route.curvature) > TIGHT
    return np.convolve(tight, np.ones(2 * reach + 1), "same") < 0.5


def gait(plan: Plan, falls: TrueFootfalls) -> Gait:
    """How the footfalls of a walk lie along its route."""
    route = plan.route
    rows = places(route, falls.position)
    calm = steady(route)[rows]
    # Strides from and to a standing foot are none of those that are judged.
    stride = np.diff(falls.t)[1:-1][calm[1:-2] & calm[2:-1]]
    stride = stride[stride < 1.5 * np.median(stride)]
    length = np.hypot(*np.diff(falls.position[:, :2], axis=0).T)
    direction = route.heading[rows]
    offset = falls.position[:, :2] - np.column_stack([route.x[rows], route.y[rows]])
    lateral = -np.sin(direction) * offset[:, 0] + np.cos(direction) * offset[:, 1]
    lateral -= lateral.mean()
    minutes = (falls.t[-1] - falls.t[0]) / 60
    return Gait(
        plan.name,
        plan.seed,
        minutes=float(minutes),
        speed_m_s=float(length.sum() / (60 * minutes)),
        stride_s=float(stride.mean()),
        stride_sd_ms=float(1e3 * stride.std()),
        stance_yaw_sd_deg=float(np.degrees((falls.heading - direction)[calm].std())),
        lateral_rms_m=float(np.sqrt(np.mean(lateral**2))),
        lateral_max_m=float(np.abs(lateral).max()),
    )


def measure(plan: Plan, use_cache: bool) -> Gait:
    """Walk once."""
    try:
        truth = cached_walk(plan) if use_cache else walk(plan)
    except InputError as error:
        return Gait(plan.name, plan.seed, stumble=str(error))
    return replace(gait(plan, truth.footfalls), stands=truth.meta["ends"] == "standing")


def plans(scenario: Scenario, seeds: int, first: int | None, metres: float | None, push: float) -> list[Plan]:
    """One plan a seed; the scenario's subjects in turn."""
    made = [scenario.plan(number) for number in range(seeds)]
    start = scenario.seeds.base if first is None else first
    changed = []
    for number, plan in enumerate(made):
        route = shortened(plan.route, metres)
        stops = tuple(stop for stop in plan.stops if stop.at_m < route.length - 3)
        pushed = Disturbance(push) if push else None
        changed.append(replace(plan, seed=start + number, route=route, stops=stops, disturbance=pushed))
    return changed


def report(walks: Sequence[Gait]) -> None:
    """One row a scenario, means over its walks that reached the end; then every stumble."""
    table = Table(title="Means over the walks that reached the end", title_justify="left")
    headings = (
        "",
        "reached the end",
        "and stood",
        "min",
        "m/s",
        "stride s",
        "stride SD ms",
        "stance yaw SD deg",
    )
    for heading in (*headings, "lateral RMS m", "largest m"):
        table.add_column(heading, justify="right" if heading else "left")
    for name in dict.fromkeys(one.scenario for one in walks):
        here = [one for one in walks if one.scenario == name]
        good = [asdict(one) for one in here if one.stumble is None]
        row = [name, f"{len(good)} of {len(here)}"]
        if good:
            mean = {
                key: np.mean([one[key] for one in good]) for key in Gait.__annotations__ if key.count("_")
            }
            row += [
                str(sum(one["stands"] for one in good)),
                f"{np.mean([one['minutes'] for one in good]):.1f}",
                f"{mean['speed_m_s']:.3f}",
                f"{mean['stride_s']:.3f}",
                f"{mean['stride_sd_ms']:.1f}",
                f"{mean['stance_yaw_sd_deg']:.2f}",
                f"{mean['lateral_rms_m']:.3f}",
                f"{max(one['lateral_max_m'] for one in good):.2f}",
            ]
        table.add_row(*row)
    out.print(table)
    for one in walks:
        if one.stumble is not None:
            out.print(f"{one.scenario}, seed {one.seed}: {one.stumble}", highlight=False)


def main(arguments: Sequence[str] | None = None) -> None:
    """Walk and print the table."""
    parser = options(__doc__)
    parser.add_argument(
        "scenarios", nargs="*", help="stock names or TOML files (default: all stock scenarios)"
    )
    parser.add_argument("--seeds", type=int, default=4, help="walks of each (default 4)")
    parser.add_argument("--first-seed", type=int, help="of the walks (default: each scenario's own)")
    parser.add_argument("--metres", type=float, help="walk only the first of each")
    parser.add_argument("--push", type=float, default=0.0, metavar="NS", help="at the trunk every 10 s")
    parser.add_argument("--no-cache", action="store_true", help="walk anew and keep no walks")
    chosen = parser.parse_args(arguments)

    todo: list[Plan] = []
    for name in chosen.scenarios or stock_scenarios():
        todo += plans(load_scenario(name), chosen.seeds, chosen.first_seed, chosen.metres, chosen.push)
    work = partial(measure, use_cache=not chosen.no_cache)
    walks = run_all(work, todo, chosen.processes, "walks")
    report(walks)
    figures = [{key: value for key, value in asdict(one).items() if value == value} for one in walks]
    write_json(chosen.json, {"walks": figures})


if __name__ == "__main__":
    main()
