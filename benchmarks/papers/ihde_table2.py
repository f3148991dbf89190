"""Table 2 of Deng et al. (2018): heading methods on three paths, tuned on some walks, judged on others.

The scenarios give every gyro the bias about the vertical that the paper's uncorrected tracks ask for. Every
method is judged on this package's filter, and the paper's three on the paper's filter with its detector too,
on walks of people's variability and of somebody who walks along a marked line. The methods are tuned on both
gaits, on this package's filter, for the smallest mean heading error, so that no oval can hide an error by
symmetry, and for the geometric mean over tests and gaits, so that each counts alike: HDE on Tests 1 and 2,
for it has no answer to Test 3, the others on all three. No walk seed and no unit serves on both sides.

Then one thing after another is changed, to see what decides; and the methods walk the closed loop of the HDR
paper, whose gyro warms up for 20 minutes and whose streets bend.

python -m benchmarks.papers.ihde_table2 --page docs/ihde.md --figures docs/images
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from math import degrees, radians
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks._common import options, write_json
from benchmarks._page import by_name, fill
from benchmarks.papers._ihde_page import loop_table, setting_table, table_2, variant_table
from benchmarks.papers._ihde_ways import Job, Way, judge, take_walks, walks_of
from footfall.hdr.hde import Hde2010Params, HdeParams
from footfall.hdr.ihde import IhdeParams
from footfall.hdr.ihde_plus import IhdePlusParams
from footfall.hdr.jimenez import FilterHdrParams, JimenezParams
from footfall.hdr.step_heading import HeadingSource
from footfall.scenarios.judge.papers import IHDE_TABLE_2
from footfall.scenarios.scenario import Scenario, load_scenario
from footfall.scenarios.studies.tune import grid, smallest

TESTS = tuple(IHDE_TABLE_2)
GAITS: Mapping[str, float] = {"people": 1.0, "line": 0.3}  # variability
SOURCES: tuple[HeadingSource, ...] = ("yaw", "course", "both")

HDE_GRID = grid(HdeParams(), {"heading": SOURCES, "sigma_deg": (8, 12, 20, 40)})
IHDE_GRID = [
    IhdeParams(heading=heading, a=IhdeParams.k1 * radians(scatter), sigma=radians(sigma))
    for heading, scatter, sigma in product(SOURCES, (1.5, 1.75, 2, 2.5), (4, 8))
]
JIMENEZ_GRID = grid(JimenezParams(), {"heading": SOURCES, "gate_deg": (2, 3, 4), "sigma_deg": (2, 4)})
PLUS_GRID = grid(IhdePlusParams(), {"heading": SOURCES, "scatter_deg": (1.5, 2, 2.5)})


@dataclass(frozen=True)
class Tuned:
    """What the tuning walks chose."""

    hde: HdeParams
    ihde: IhdeParams
    jimenez: JimenezParams
    plus: IhdePlusParams

    def ways(self) -> dict[str, Way]:
        """Rows of Table 2."""
        alone = replace(self.ihde, fallback=False)
        learned = replace(alone, directions=replace(alone.directions, reference=None))
        return {
            "pdr": Way("pdr"),
            "hde-2010": Way("hde-2010", Hde2010Params()),
            "iez": Way("iez"),
            "hde": Way("hde", self.hde),
            "ihde": Way("ihde", self.ihde),
            "ihde, no mean heading": Way("ihde", alone),
            "ihde-learned": Way("ihde-learned", learned),
            "ihde-jimenez": Way("ihde-jimenez", self.jimenez),
            "hdr-filter": Way("hdr-filter", FilterHdrParams()),
            "ihde-plus": Way("ihde-plus", self.plus),
            "iez-paper": Way("iez-paper"),
            "hde-paper": Way("hde-paper", self.hde),
            "ihde-paper": Way("ihde-paper", self.ihde),
        }

    def variants(self) -> dict[str, Way]:
        """What is changed, one thing at a time."""
        k1 = self.ihde.k1

        def ihde(start_off_deg: float = 0.0, bias: float = 1.0, **changed: Any) -> Way:
            return Way("ihde", replace(self.ihde, **changed), start_off_deg, bias)

        def plus(start_off_deg: float = 0.0, bias: float = 1.0, **changed: Any) -> Way:
            return Way("ihde-plus", replace(self.plus, **changed), start_off_deg, bias)

        return {
            "iez, no bias": Way("iez", bias=0.0),
            "hde as it comes": Way("hde", HdeParams()),
            "ihde as it comes": Way("ihde", IhdeParams()),
            "**ihde as tuned**": ihde(),
            "the start: wrong by 5 deg": ihde(start_off_deg=5.0),
            "the start: wrong by 10 deg": ihde(start_off_deg=10.0),
            **{f"the foot's angle: {source}": ihde(heading=source) for source in SOURCES},
            "the window: W = 3": ihde(window=3),
            "the window: W = 8": ihde(window=8),
            "straight: a / k1 = 1 deg": ihde(a=k1 * radians(1)),
            "straight: a / k1 = 3 deg": ihde(a=k1 * radians(3)),
            "straight: a / k1 = 3 deg, no mean heading": ihde(a=k1 * radians(3), fallback=False),
            "a direction within 10 deg": ihde(match=radians(10)),
            "a direction within 15 deg": ihde(match=radians(15)),
            "no mean heading": ihde(fallback=False),
            "no bias": ihde(bias=0.0),
            "twice the bias": ihde(bias=2.0),
            "ihde-plus as it comes": Way("ihde-plus", IhdePlusParams()),
            "**ihde-plus as tuned**": plus(),
            "ihde-plus, start wrong by 5 deg": plus(start_off_deg=5.0),
            "ihde-plus, start wrong by 10 deg": plus(start_off_deg=10.0),
            **{f"ihde-plus on {source}": plus(heading=source) for source in SOURCES},
            "ihde-plus, no bias": plus(bias=0.0),
            "ihde-plus, twice the bias": plus(bias=2.0),
        }

    def loop(self) -> dict[str, Way]:
        """What walks the closed loop."""
        return {
            "iez": Way("iez"),
            "hde": Way("hde", self.hde),
            "ihde": Way("ihde", self.ihde),
            "ihde, no mean heading": Way("ihde", replace(self.ihde, fallback=False)),
            "ihde-jimenez": Way("ihde-jimenez", self.jimenez),
            "ihde-plus": Way("ihde-plus", self.plus),
        }


def jobs(scenarios: Mapping[str, Scenario], seeds: Sequence[int], ways: Sequence[Way]) -> list[Job]:
    """Every test with every gait; each walk wears the unit of its seed."""
    units = {seed: (seed,) for seed in seeds}
    return [
        Job(scenarios[test].changed("gait", variability=gait), units, ways)
        for gait in GAITS.values()
        for test in TESTS
    ]


def tune(scenarios: Mapping[str, Scenario], seeds: Sequence[int], processes: int) -> Tuned:
    """Choose the parameters on these walks, by the mean heading error."""
    grids: dict[str, Sequence[Any]] = {
        "hde": HDE_GRID,
        "ihde": IHDE_GRID,
        "ihde-jimenez": JIMENEZ_GRID,
        "ihde-plus": PLUS_GRID,
    }
    ways = [Way(use, params) for use, sets in grids.items() for params in sets]
    found = judge(jobs(scenarios, seeds, ways), processes, "tuning")
    chosen: list[Any] = []
    first = 0
    for use, sets in grids.items():
        part = slice(first, first + len(sets))
        tests = TESTS[:2] if use == "hde" else TESTS
        chosen.append(
            sets[smallest([rows[:, part, 1] for (test, _), rows in found.items() if test in tests])]
        )
        first = part.stop
    return Tuned(*chosen)


def in_words(params: Any) -> str:
    """What was tuned, of any of the methods."""
    words = [f"heading = {params.heading}"]
    if isinstance(params, IhdeParams):
        words.append(f"a / k1 = {degrees(params.a / params.k1):.3g} deg")
    for name in ("gate", "scatter", "sigma"):
        if hasattr(params, name):
            words.append(f"{name} = {degrees(getattr(params, name)):.3g} deg")
    return ", ".join(words)


def settings_in_words(tuned: Tuned) -> dict[str, tuple[str, str]]:
    """What was chosen, and the defaults."""
    named = {"hde": tuned.hde, "ihde": tuned.ihde, "ihde-jimenez": tuned.jimenez, "ihde-plus": tuned.plus}
    return {name: (in_words(params), in_words(type(params)())) for name, params in named.items()}


def main(arguments: Sequence[str] | None = None) -> None:
    """Tune, judge, print, write."""
    parser = options(__doc__)
    take_walks(parser)
    for name, default, text in (
        ("loop-walks", 3, "walks of the closed loop (0: none)"),
        ("loop-units", 8, "units on each of them"),
    ):
        parser.add_argument(f"--{name}", type=int, default=default, help=f"{text} (default {default})")
    parser.add_argument("--page", type=Path, metavar="MD", help="put the tables into this page")
    parser.add_argument("--figures", type=Path, metavar="FOLDER", help="draw figures there")
    chosen = parser.parse_args(arguments)
    tuning, seeds = walks_of(chosen)
    scenarios = {test: load_scenario(test) for test in TESTS}
    tuned = tune(scenarios, tuning, chosen.processes)
    ways, variants, loop_ways = tuned.ways(), tuned.variants(), tuned.loop()
    judged = [*ways.values(), *variants.values()]
    found = judge(jobs(scenarios, seeds, judged), chosen.processes, "judging")

    def part(names: Sequence[str], gait: str, first: int = 0) -> dict[str, dict[str, np.ndarray]]:
        return {
            test: {name: found[test, GAITS[gait]][:, first + i] for i, name in enumerate(names)}
            for test in TESTS
        }

    rows = {gait: part(list(ways), gait) for gait in GAITS}
    changed = {gait: part(list(variants), gait, len(ways)) for gait in GAITS}
    sheets = [table_2(gait, rows[gait]) for gait in GAITS]
    sheets += [setting_table(settings_in_words(tuned)), variant_table(changed["people"], changed["line"])]
    looped: np.ndarray | None = None
    if chosen.loop_walks:
        loop = load_scenario("closed-loop")
        units = tuple(range(loop.seeds.base + 500, loop.seeds.base + 500 + chosen.loop_units))
        worn = {loop.seeds.base + i: units for i in range(chosen.loop_walks)}
        todo = [Job(loop, worn, tuple(loop_ways.values()))]
        (looped,) = judge(todo, chosen.processes, "the closed loop").values()
        sheets.append(loop_table(list(loop_ways), looped))

    for sheet in sheets:
        sheet.show()
    if chosen.page is not None:
        fill(chosen.page, by_name(sheets))
    if chosen.figures is not None:
        from benchmarks.papers._ihde_figure import draw

        draw(chosen.figures, scenarios, tuned, seeds[0], rows["people"])
    document = {
        "settings": settings_in_words(tuned),
        "columns": ["return_error_pct", "heading_error_mean_deg", "heading_error_final_deg"],
        "table_2": {gait: _lists(by) for gait, by in rows.items()},
        "decides": {gait: _lists(by) for gait, by in changed.items()},
        "loop": None if looped is None else {name: looped[:, i].tolist() for i, name in enumerate(loop_ways)},
    }
    write_json(chosen.json, document)


def _lists(errors: Mapping[str, Mapping[str, np.ndarray]]) -> dict[str, dict[str, Any]]:
    return {test: {name: rows.tolist() for name, rows in by.items()} for test, by in errors.items()}


if __name__ == "__main__":
    main()
