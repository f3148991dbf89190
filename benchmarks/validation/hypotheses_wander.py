"""`hypotheses` on made-up footfalls: wander of 0 to 0.5 m, corners of any angle. Does it ever do harm?

Nothing here is walked. A path is told stride by stride; people stray from it by a first-order Gauss-Markov
aim that they follow with a lag of 1.5 s, and their feet scatter. The gyro's errors are drawn from the priors
of the sheet `nimu`, times 1, 0.1 and 0, and no loads and temperature are told. The habits of walking were
chosen on seeds from 501 on. "Worse": share of walks whose average or final error is more than 1 deg larger
than that of the gyro alone.

python -m benchmarks.validation.hypotheses_wander --page docs/hypotheses.md
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from pathlib import Path

import numpy as np

from benchmarks._common import options, run_all, write_json
from benchmarks._page import Sheet, by_name, fill
from footfall.hdr.hypotheses.filter import beliefs
from footfall.hdr.hypotheses.params import HypothesesParams
from footfall.hdr.hypotheses.smoother import smoothed
from footfall.pdr.footfalls import Footfalls

STRIDE_M, STRIDE_S, LAG_S = 1.4, 1.08, 1.5
WANDERS = [(0.0, 6.0), *product((0.05, 0.1, 0.2, 0.35, 0.5), (2.0, 6.0, 20.0))]  # m, s
SENSORS = (1.0, 0.1, 0.0)
WORSE_DEG = 1.0
METHODS = {"hypotheses": beliefs, "hypotheses-smooth": smoothed}


def legs(rng: np.random.Generator, angles: Callable[[np.random.Generator], float]) -> np.ndarray:
    """Turns (n,) rad of streets of 30 to 150 m; each corner takes two strides."""
    turns: list[float] = []
    while len(turns) < 600:
        corner = angles(rng)
        turns += [*np.zeros(rng.integers(20, 105)), corner / 2, corner / 2]
    return np.array(turns[:600])


def right(rng: np.random.Generator) -> float:
    """A right angle to either side."""
    return float(rng.choice([-1, 1])) * math.pi / 2


def odd(rng: np.random.Generator) -> float:
    """Any corner of 25 to 155 deg."""
    return float(rng.choice([-1, 1]) * np.radians(rng.uniform(25, 155)))


def bends(rng: np.random.Generator) -> np.ndarray:
    """Turns of straights of 40 to 120 m between arcs of 20 to 150 m radius, of 45 to 120 deg."""
    turns: list[float] = []
    while len(turns) < 600:
        angle = rng.choice([-1, 1]) * np.radians(rng.uniform(45, 120))
        strides = max(2, round(abs(angle) * rng.uniform(20, 150) / STRIDE_M))
        turns += [*np.zeros(rng.integers(28, 85)), *np.full(strides, angle / strides)]
    return np.array(turns[:600])


PATHS: dict[str, Callable[[np.random.Generator], np.ndarray]] = {
    "straight": lambda rng: np.zeros(600),
    "right angles": partial(legs, angles=right),
    "odd angles": partial(legs, angles=odd),
    "bends": bends,
}


@dataclass(frozen=True)
class Case:
    """A path, a wander, a gyro, and the seed of all that is drawn."""

    path: str
    wander_m: float
    wander_s: float
    sensor: float
    seed: int


def gauss_markov(rng: np.random.Generator, n: int, sd: float, time: float) -> np.ndarray:
    """(n,) one a stride, stationary from the start."""
    kept = math.exp(-STRIDE_S / time)
    noise = rng.normal(0, sd, n)
    for i in range(1, n):
        noise[i] = kept * noise[i - 1] + math.sqrt(1 - kept * kept) * noise[i]
    return noise


def drift(rng: np.random.Generator, n: int) -> np.ndarray:
    """Heading's drift (n,) rad of a gyro drawn from the priors, from the first footfall on."""
    p = HypothesesParams()
    rate = rng.normal(0, p.bias_unloaded) + np.cumsum(rng.normal(0, p.bias_walk * math.sqrt(STRIDE_S), n))
    rate += gauss_markov(rng, n, p.flicker, p.flicker_s)
    steps = STRIDE_S * rate + rng.normal(0, p.random_walk * math.sqrt(STRIDE_S), n)
    steps[0] = 0.0
    return np.cumsum(steps)


def walked(case: Case) -> tuple[Footfalls, np.ndarray]:
    """Footfalls as dead reckoning tells them, and the heading's drift at each (n,) rad."""
    rng = np.random.default_rng([case.seed, list(PATHS).index(case.path)])
    path = np.concatenate([[0.0], np.cumsum(PATHS[case.path](rng))])
    n = len(path)
    drifted = case.sensor * drift(rng, n)
    aim = gauss_markov(rng, n, case.wander_m, case.wander_s)
    share = 1 - math.exp(-STRIDE_S / LAG_S)
    aside = aim.copy()
    for i in range(1, n):
        aside[i] = aside[i - 1] + share * (aim[i] - aside[i - 1])
    aside += rng.normal(0, 0.012, n)
    course = path + np.arctan2(np.diff(aside, prepend=aside[0]), STRIDE_M) + rng.normal(0, np.radians(0.5), n)
    middle = 0.5 * (drifted + np.concatenate([[0.0], drifted[:-1]]))
    steps = STRIDE_M * np.column_stack([np.cos(course + middle), np.sin(course + middle), np.zeros(n)])
    steps[0] = 0.0
    return Footfalls.at(STRIDE_S * np.arange(n), np.cumsum(steps, axis=0), path + drifted), drifted


def judge(case: Case) -> np.ndarray:
    """(1 + methods, 2) average and final error (deg), without a method first; then without directions."""
    feet, drifted = walked(case)
    nowhere = HypothesesParams(along_first=0.0)
    headings = [feet.heading, *(method(feet).heading for method in METHODS.values())]
    headings.append(beliefs(feet, nowhere).heading)
    errors = np.degrees([heading - feet.heading + drifted for heading in headings])
    return np.column_stack([np.abs(errors).mean(axis=1), np.abs(errors[:, -1])])


def harm(found: np.ndarray, place: int) -> float:
    """Per cent of walks (m, ways, 2) whose average or final error has grown by more than 1 deg."""
    return 100 * float((found[:, place] > found[:, 0] + WORSE_DEG).any(axis=1).mean())


def sheet(name: str, title: str, groups: Sequence[tuple[list[str], np.ndarray]], heads: list[str]) -> Sheet:
    """Mean errors and harm of each group of walks."""
    columns = [*heads, "walks", "none"]
    for method in METHODS:
        columns += [method, "p90", "worse (%)"]
    made = Sheet(name, title, [*columns, "told that there are no directions"], left=len(heads))
    for words, found in groups:
        cells = [*words, str(len(found)), _pair(found[:, 0].mean(axis=0))]
        for place in range(1, 1 + len(METHODS)):
            one = found[:, place]
            cells += [_pair(one.mean(axis=0)), _pair(np.percentile(one, 90, axis=0))]
            cells.append(f"{harm(found, place):.1f}")
        made.rows.append([*cells, _pair(found[:, -1].mean(axis=0))])
    return made


def _pair(values: np.ndarray) -> str:
    return " / ".join(f"{value:.1f}" for value in values)


def main() -> None:
    """Judge, tell."""
    parser = options(__doc__)
    parser.add_argument("--seeds", type=int, default=10, help="of each case (default 10)")
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument("--page", type=Path, metavar="MD", help="fill the tables of this page")
    args = parser.parse_args()
    base = Case("", 0.0, 1.0, 1.0, 0)
    cases = [
        replace(base, path=path, wander_m=m, wander_s=s, sensor=sensor, seed=1000 * k + args.first_seed + i)
        for path, sensor in product(PATHS, SENSORS)
        for k, (m, s) in enumerate(WANDERS)
        for i in range(args.seeds)
    ]
    found = np.array(run_all(judge, cases, args.processes, "walks"))

    def group(**chosen: object) -> np.ndarray:
        rows = [all(getattr(case, key) == value for key, value in chosen.items()) for case in cases]
        return found[np.array(rows)]

    wanders = [([f"{m:g}", f"{s:g}" if m else ""], group(wander_m=m, wander_s=s)) for m, s in WANDERS]
    paths = [
        ([path, f"{sensor:g}"], group(path=path, sensor=sensor)) for path, sensor in product(PATHS, SENSORS)
    ]
    title = "Mean average / final heading error (deg)"
    sheets = [
        sheet("wander", title, [*wanders, (["all", ""], found)], ["wander (m)", "time (s)"]),
        sheet("paths", title, paths, ["path", "priors x"]),
    ]
    for one in sheets:
        one.show()
    write_json(args.json, {"figures": {one.name: one.rows for one in sheets}})
    if args.page:
        fill(args.page, by_name(sheets))


if __name__ == "__main__":
    main()
