"""`hypotheses` on the three tests of Deng et al. (2018), beside IHDE+: what it is told of the place decides.

The tests are those of ihde_table2.py, with its bias. The paper's methods know the direction in which the path
begins and that the rest tells little of the bias. Three ways of `hypotheses` are judged: as it comes; told
the same two things; and told besides how closely the path is followed, which is chosen on other walks with
other units for the smallest mean heading error with hindsight, as the others' parameters are there.

python -m benchmarks.papers.ihde_hypotheses --page docs/hypotheses.md
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from math import degrees, radians
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks._common import options, write_json
from benchmarks._page import Sheet, by_name, fill
from benchmarks.papers._ihde_ways import Job, Way, judge, take_walks, walks_of
from benchmarks.papers.ihde_table2 import TESTS
from footfall.hdr.hypotheses.params import HypothesesParams
from footfall.scenarios.judge.papers import IHDE_TABLE_2, range_text
from footfall.scenarios.scenario import load_scenario
from footfall.scenarios.studies.tune import smallest
from footfall.scenarios.trial import UNSURE

METHODS = ("hypotheses", "hypotheses-smooth")


def told(scales: tuple[float, ...] = (1.0, 0.1), **changed: float) -> HypothesesParams:
    """The model that knows a direction of the tests' paths, and that the rest tells little of the bias."""
    bias = UNSURE / max(scales)
    return HypothesesParams(reference=0.0, along_first=0.9, bias=bias, scales=scales, **changed)


def followed(wander: float, beside: float, course: float, scale: float) -> HypothesesParams:
    """The same that knows how closely the path is followed, and one scale of the sensor's priors."""
    lines = {
        "wander_m": (wander,),
        "wander_s": (1.7,),
        "straight_curve": (0.0004,),
        "straight_turn": (0.01,),
        "turn_straight": (0.6,),
    }
    return told((scale,), beside=radians(beside), course=radians(course), **lines)


GRID = [followed(*point) for point in product((0.015, 0.03, 0.06), (0.2, 0.5, 1.0), (0.5, 1.0), (0.2, 1.0))]


def tune(seeds: Sequence[int], processes: int) -> HypothesesParams:
    """How closely the path is followed, chosen on these walks."""
    ways = [Way(METHODS[1], params) for params in GRID]
    return GRID[smallest([rows[:, :, 1] for rows in judged(ways, seeds, processes, "tuning").values()])]


def judged(
    ways: Sequence[Way], seeds: Sequence[int], processes: int, label: str, tests: Sequence[str] = TESTS
) -> dict[str, np.ndarray]:
    """Test -> errors as of `_ihde_ways.judge`; each walk wears the unit of its seed."""
    jobs = [Job(load_scenario(test), {seed: (seed,) for seed in seeds}, ways) for test in tests]
    return {test: rows for (test, _), rows in judge(jobs, processes, label).items()}


def table(ways: Sequence[str], found: dict[str, np.ndarray]) -> Sheet:
    """Return error (%) and mean heading error (deg) of each way on each test."""
    heads = [""]
    for test in found:
        heads += [f"{test}: median", "p90", "heading"]
    sheet = Sheet("directions", "P_err (%); mean heading error (deg)", heads)
    row = ["**the paper: IHDE**"]
    for test in found:
        row += [range_text(IHDE_TABLE_2[test]["ihde"]), "", ""]
    sheet.rows.append(row)
    for place, way in enumerate(ways):
        row = [way]
        for errors in found.values():
            returned, heading = errors[:, place, 0], errors[:, place, 1]
            row += [f"{x:.2f}" for x in (np.median(returned), np.percentile(returned, 90))]
            row.append(f"{heading.mean():.1f}")
        sheet.rows.append(row)
    return sheet


def tried(close: HypothesesParams) -> dict[str, Way]:
    """What was tried to bring the third test down, beside what is told of it (`close`)."""
    changes: dict[str, dict[str, Any]] = {
        "close": {},
        "`hypotheses` 128": {"hypotheses": 128},
        "half of `wander_m`": {"wander_m": (close.wander_m[0] / 2,)},
        "`scales` 1": {"scales": (1.0,), "bias": UNSURE},
        "`scales` 0.1": {"scales": (0.1,), "bias": UNSURE / 0.1},
        "`beside_deg` 0.1": {"beside": radians(0.1)},
        "`turn_straight` 0.3": {"turn_straight": (0.3,)},
        "`place_m` 0.02": {"place_m": 0.02},
    }
    return {words: Way(METHODS[0], replace(close, **changed)) for words, changed in changes.items()}


def in_words(params: HypothesesParams) -> str:
    """What was chosen."""
    return (
        f"wander_m = {params.wander_m[0]:g}, beside_deg = {degrees(params.beside):.2g}, "
        f"course_deg = {degrees(params.course):.2g}, scales = {params.scales[0]:g}"
    )


def main() -> None:
    """Tune, judge, tell."""
    parser = options(__doc__)
    take_walks(parser)
    parser.add_argument("--page", type=Path, metavar="MD", help="fill the tables of this page")
    parser.add_argument("--tried", action="store_true", help="only what was tried on the third test")
    args = parser.parse_args()
    tuning, seeds = walks_of(args)
    if args.tried:
        ways = tried(tune(tuning, args.processes))
        sheet = table(list(ways), judged(list(ways.values()), seeds, args.processes, "judging", TESTS[2:]))
        sheet.name = "ways on the third test"
        sheet.show()
        if args.page:
            fill(args.page, by_name([sheet]))
        return
    chosen = tune(tuning, args.processes)
    ways = {"`pdr`": Way("pdr"), "`ihde-plus`": Way("ihde-plus")}
    for words, params in {"": None, ", told": told(), ", told, close": chosen}.items():
        ways |= {f"`{method}`{words}": Way(method, params) for method in METHODS}
    found = judged(list(ways.values()), seeds, args.processes, "judging")
    sheets = [
        table(list(ways), found),
        Sheet("close", "Chosen", ["chosen on the tuning walks"], [[in_words(chosen)]]),
    ]
    for sheet in sheets:
        sheet.show()
    write_json(args.json, {"chosen": in_words(chosen), "figures": sheets[0].rows})
    if args.page:
        fill(args.page, by_name(sheets))


if __name__ == "__main__":
    main()
