"""Choose the closed loop's five units: drawn from the sheet, kept when they fit the paper's Table 2.

Unit seeds are tried in order from 0, seed k on walk k mod 5 of the scenario. A unit fits when its uncorrected
final and average heading errors lie in the range of the paper's five walks (102-307 and 34-145 deg), in whole
degrees as the paper gives them. It is kept when it fits, its walk has no unit yet, and neither has its fifth
of the range of final errors: so the five span the range as the paper's do. Nothing but uncorrected errors is
looked at: HDR is never run here.

python -m benchmarks.validation.stock_units
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from rich.table import Table

from benchmarks._common import (
    dealt,
    heading_errors_deg,
    options,
    out,
    outcomes,
    within_paper,
    write_json,
)
from footfall.scenarios.judge.papers import HDR_TABLE_2_MEAN, UNCORRECTED_FINAL_RANGE
from footfall.scenarios.scenario import Scenario, load_scenario
from footfall.scenarios.trial import setup


@dataclass(frozen=True)
class Drawn:
    """A unit on its walk: uncorrected errors (deg), and the fifth of the final errors' range it falls in."""

    unit: int
    walk: int
    final: float
    average: float
    fits: bool
    part: int


def judge(unit: int, walk: int, errors: np.ndarray, walks: int) -> Drawn:
    """Does a unit fit, and where in the range? `walk` from 0; errors (2,): final and average (deg)."""
    low, high = UNCORRECTED_FINAL_RANGE
    part = int(np.clip((errors[0] - low) / (high - low) * walks, 0, walks - 1))
    return Drawn(unit, walk, float(errors[0]), float(errors[1]), bool(within_paper(errors)), part)


def keep(drawn: Sequence[Drawn]) -> list[Drawn]:
    """The units kept, in the order of their walks."""
    kept: list[Drawn] = []
    for one in sorted(drawn, key=lambda one: one.unit):
        if one.fits and all(one.walk != other.walk and one.part != other.part for other in kept):
            kept.append(one)
    return sorted(kept, key=lambda one: one.walk)


def draw(scenario: Scenario, least: int, most: int, processes: int) -> list[Drawn]:
    """Draw at least `least` units, and more until every walk has one, `most` at most."""
    walks, worn = scenario.seeds.walks, setup(scenario, methods=["pdr"])
    drawn: list[Drawn] = []
    for first in range(0, most, least):
        seeds = range(first, min(first + least, most))
        trials = dealt(worn, walks, scenario.seeds.base, seeds)
        rows = (one.rows[0] for one in outcomes(trials, processes, f"units {seeds[0]} to {seeds[-1]}"))
        drawn += [judge(row.unit_seed, row.number, np.array(heading_errors_deg(row)), walks) for row in rows]
        if len(keep(drawn)) == walks:
            break
    return drawn


def report(drawn: Sequence[Drawn], kept: Sequence[Drawn]) -> None:
    """Print all that were drawn, and those kept."""
    table = Table(title="Uncorrected heading error of every unit drawn (deg)", title_justify="left")
    for heading in ("unit", "walk", "final", "average", "fits", "kept"):
        table.add_column(heading, justify="right")
    for one in drawn:
        cells = [f"{one.unit}", f"{one.walk + 1}", f"{one.final:.0f}", f"{one.average:.0f}"]
        table.add_row(
            *cells,
            "yes" if one.fits else "",
            "KEPT" if one in kept else "",
            style="bold" if one in kept else None,
        )
    out.print(table)
    fit = sum(one.fits for one in drawn)
    out.print(f"{fit} of {len(drawn)} units fit ({fit / len(drawn):.0%}).")
    if kept:
        final, average = (np.mean([getattr(one, name) for one in kept]) for name in ("final", "average"))
        paper = HDR_TABLE_2_MEAN.uncorrected
        out.print(
            f"Mean of those kept: {final:.0f} final, {average:.0f} average "
            f"(paper: {paper.final:g}, {paper.average:g})."
        )


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table and the line for the scenario's file; 1 if not every walk found a unit."""
    parser = options(__doc__)
    parser.add_argument("--scenario", default="closed-loop", help="stock name or TOML file")
    parser.add_argument("--units", type=int, default=60, help="to draw at least (default 60)")
    parser.add_argument("--most", type=int, default=600, help="to draw at most (default 600)")
    chosen = parser.parse_args(arguments)

    scenario = load_scenario(chosen.scenario)
    drawn = draw(scenario, chosen.units, chosen.most, chosen.processes)
    kept = keep(drawn)
    report(drawn, kept)
    complete = len(kept) == scenario.seeds.walks
    if complete:
        out.print(f"units = {[one.unit for one in kept]}", highlight=False)
    else:
        out.print(f"Only {len(kept)} of {scenario.seeds.walks} walks found a unit: draw more (--most).")
    figures = {"kept": [one.unit for one in kept], "drawn": [vars(one) for one in drawn]}
    write_json(chosen.json, {"scenario": scenario.name, **figures})
    return 0 if complete else 1


if __name__ == "__main__":
    sys.exit(main())
