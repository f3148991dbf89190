"""HDR's accuracy on the closed loop: parameters tuned on some walks and units, judged on others.

Tuning: for every pair of i_c and theta_w, HDR corrects units drawn from the sheet. The pair with the smallest
average heading error, mean over those units whose uncorrected errors lie in the range of the paper's Table 2,
is chosen. Judging: beside the default pair, on other walks with other units: all that were drawn, those in
the range, and the scenario's own five. No walk seed and no unit serves on both sides.
More scenarios may be named: they are judged with the parameters that the first one chose.

python benchmarks/hdr_table2.py --figure hdr.png
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from math import inf
from pathlib import Path
from typing import Any

import numpy as np
from _common import Case, Wearing, dead_reckoned, options, out, shared_out, within_paper, write_json
from _hdr_figure import draw
from rich.table import Table

from footfall.hdr.hdr import HdrParams, headings
from footfall.scenarios.paper import HDR_TABLE_2_MEAN
from footfall.scenarios.report import spread
from footfall.scenarios.scenario import Scenario, load_scenario

I_C = (0.002, 0.003, 0.004, 0.005, 0.006, 0.007, 0.010, 0.015, 0.020)  # deg/s
THETA_W = (0.15, 0.20, 0.25, 0.30, 0.35, 0.40, 0.50, 0.70, 1.00, inf)  # deg/s
FINAL, AVERAGE = 0, 1


@dataclass(frozen=True)
class Study:
    """Units on walks; errors (final, average) in deg, uncorrected (c, 2) and by parameter set (s, c, 2)."""

    cases: Sequence[Case]
    uncorrected: np.ndarray
    corrected: np.ndarray

    @property
    def in_range(self) -> np.ndarray:
        """(c,) bool."""
        return within_paper(self.uncorrected)

    def average_map(self, chosen: np.ndarray) -> np.ndarray:
        """(i_c, theta_w) mean over the `chosen` cases (c,) of the average error (deg)."""
        grid = self.corrected[: len(I_C) * len(THETA_W), chosen, AVERAGE]
        return grid.mean(axis=1).reshape(len(I_C), len(THETA_W))


def study(todo: Sequence[Wearing], sets: Sequence[HdrParams], processes: int, label: str) -> Study:
    """Dead-reckon every unit once and correct it with every parameter set."""
    cases = dead_reckoned(todo, processes, label)
    if not cases:
        raise SystemExit(f"{label}: no walk came to its end")
    found = headings([case.footfalls for case in cases], sets)
    corrected = [case.corrected_deg(psi) for case, psi in zip(cases, found, strict=True)]
    return Study(cases, np.array([case.uncorrected_deg() for case in cases]), np.stack(corrected, axis=1))


def name_of(params: HdrParams) -> str:
    """The pair in deg/s."""
    return f"i_c {np.degrees(params.i_c):.3f}, theta_w {np.degrees(params.theta_w):.2f}"


def print_map(values: np.ndarray, title: str) -> None:
    """i_c down, theta_w across (deg/s), the smallest in bold."""
    table = Table(title=title, title_justify="left")
    table.add_column("i_c \\ theta_w")
    for theta_w in THETA_W:
        table.add_column(f"{theta_w:g}", justify="right")
    for i_c, row in zip(I_C, values, strict=True):
        table.add_row(f"{i_c:g}", *(f"[bold]{v:.1f}[/]" if v == values.min() else f"{v:.1f}" for v in row))
    out.print(table)


def judge(found: Study, own: np.ndarray, methods: Mapping[str, np.ndarray], title: str) -> dict[str, Any]:
    """Print and return mean, median and 90th percentile of each method's errors (c, 2), by group of units."""
    groups = {"all units drawn": ~own, "in Table 2's range": ~own & found.in_range, "the scenario's own": own}
    table = Table(title=title, title_justify="left")
    for heading in ("", "", "average: mean", "median", "p90", "final: mean", "median", "p90"):
        table.add_column(heading, justify="right" if heading else "left")
    figures: dict[str, Any] = {}
    for group, chosen in groups.items():
        if not chosen.any():
            continue
        figures[group] = {"count": int(chosen.sum())}
        for name, errors in methods.items():
            average, final = (spread(errors[chosen, which].tolist()) for which in (AVERAGE, FINAL))
            figures[group][name] = {"average_deg": average, "final_deg": final}
            label = f"{chosen.sum()} {group}" if name == "uncorrected" else ""
            table.add_row(label, name, *(f"{value:.1f}" for value in [*average.values(), *final.values()]))
        table.add_section()
    paper = HDR_TABLE_2_MEAN
    for name, row in (("uncorrected", paper.uncorrected), ("HDR", paper.hdr)):
        cells = [f"{row.average:g}", "", "", f"{row.final:g}", "", ""]
        table.add_row("the paper's five" if row is paper.uncorrected else "", name, *cells, style="dim")
    out.print(table)
    return figures


def sides(scenario: Scenario, chosen: argparse.Namespace) -> tuple[list[Wearing], list[Wearing]]:
    """Who wears what on which walk: for tuning, and for judging, where the scenario's own units come in too.

    Raises
    ------
    SystemExit
        The two sides share a walk seed or a unit.
    """
    first = scenario.seed if chosen.walk_seed is None else chosen.walk_seed
    drawn = range(chosen.unit_seed, chosen.unit_seed + chosen.units)
    judged = shared_out(scenario, chosen.walks, first, drawn)
    if scenario.units:
        judged = [
            Wearing(scenario, one.number, one.seed, (*one.units, scenario.unit_seed(one.number)))
            for one in judged
        ]
    seeds = range(chosen.tuning_unit_seed, chosen.tuning_unit_seed + chosen.tuning_units)
    tuning = shared_out(scenario, chosen.tuning_walks, chosen.tuning_walk_seed, seeds)
    reported = {*drawn, *(scenario.units or ())}
    if reported & set(seeds) or {one.seed for one in judged} & {one.seed for one in tuning}:
        raise SystemExit("tuning and judging share a walk seed or a unit: choose other seeds")
    return tuning, judged


def main(arguments: Sequence[str] | None = None) -> None:
    """Tune, judge, print, draw."""
    parser = options(__doc__)
    parser.add_argument("scenarios", nargs="*", default=["closed-loop"], help="default: closed-loop")
    for name, default, text in (
        ("walks", 5, "walks to judge on"),
        ("units", 60, "units to judge with, shared out over the walks"),
        ("walk-seed", None, "of the first of these walks (default: the scenario's)"),
        ("unit-seed", 1000, "of the first of these units (default 1000, as in `footfall run`)"),
        ("tuning-walks", 5, "walks to tune on"),
        ("tuning-units", 60, "units to tune with"),
        ("tuning-walk-seed", 101, "of the first of these walks"),
        ("tuning-unit-seed", 2000, "of the first of these units"),
    ):
        parser.add_argument(f"--{name}", type=int, default=default, help=text)
    parser.add_argument("--tau", type=float, default=8.0, help="s, time constant of the filters (default 8)")
    parser.add_argument("--figure", type=Path, metavar="PNG", help="draw map and scatter there")
    chosen = parser.parse_args(arguments)

    grid = [
        HdrParams.from_degrees(tau_s=chosen.tau, i_c_deg_s=i_c, theta_w_deg_s=theta_w)
        for i_c, theta_w in product(I_C, THETA_W)
    ]
    scenarios = [load_scenario(name) for name in chosen.scenarios]
    first = scenarios[0]
    todo = [sides(scenario, chosen) for scenario in scenarios]
    tuning = study(todo[0][0], grid, chosen.processes, f"tuning on {first.name}")
    fit = tuning.in_range if tuning.in_range.any() else np.ones(len(tuning.cases), bool)
    tuned_map = tuning.average_map(fit)
    best = grid[int(np.argmin(tuned_map))]
    count = f"{fit.sum()} of {len(tuning.cases)} tuning units" + (
        "" if tuning.in_range.any() else " (none in range)"
    )
    print_map(tuned_map, f"Average heading error (deg), {first.name}, mean over {count}")
    out.print(f"Chosen: {name_of(best)} deg/s", highlight=False)

    document: dict[str, Any] = {
        "tau_s": chosen.tau,
        "i_c_deg_s": I_C,
        "theta_w_deg_s": [None if theta_w == inf else theta_w for theta_w in THETA_W],
        "tuning_average_deg": tuned_map.tolist(),
        "chosen": name_of(best),
        "judged": {},
    }
    for scenario, (_, judged) in zip(scenarios, todo, strict=True):
        found = study(judged, [*grid, best, HdrParams()], chosen.processes, f"judging on {scenario.name}")
        methods = {"uncorrected": found.uncorrected, "HDR, tuned": found.corrected[-2]}
        if best == HdrParams():
            methods["HDR, tuned = default"] = methods.pop("HDR, tuned")
        else:
            methods["HDR, default"] = found.corrected[-1]
        own = np.isin([case.unit for case in found.cases], scenario.units or ())
        title = (
            f"Heading error (deg), {scenario.name}; tuned: {name_of(best)}; default: {name_of(HdrParams())}"
        )
        document["judged"][scenario.name] = judge(found, own, methods, title)
        if scenario is first:
            fit = ~own & found.in_range
            judged_map = found.average_map(fit if fit.any() else ~own)
            print_map(judged_map, "The same map over the judged units: hindsight, not used")
            document["judged_average_deg"] = judged_map.tolist()
            if chosen.figure is not None:
                draw(chosen.figure, I_C, THETA_W, (tuned_map, judged_map), methods, found.in_range)
    write_json(chosen.json, document)


if __name__ == "__main__":
    main()
