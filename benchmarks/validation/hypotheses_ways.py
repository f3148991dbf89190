"""What was tried where `hypotheses` falls short, and what it makes of more knowledge, on judged units.

Ways change parameters, or what is made of the filter's beliefs. The units are those that hypotheses.py and
real_chains.py judge; none of the constants was chosen on them. Each cell: mean average / final heading error
(deg); 90th percentile of the average; share of units left worse than uncorrected by more than 1 deg (%); mean
of (final error / told SD)^2.

python -m benchmarks.validation.hypotheses_ways --page docs/hypotheses.md
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from pathlib import Path

import numpy as np

from benchmarks._common import options, run_all, write_json
from benchmarks._page import Sheet, by_name, fill
from benchmarks.validation import real_chains
from benchmarks.validation._chains import PATIENT, chain, piece_of
from benchmarks.validation._hard_feet import cooling_on_a_curve, steady_bias
from benchmarks.validation._real import BESIDE, find
from benchmarks.validation.hypotheses import WORSE_DEG, Job, footfalls_of, jobs, setup_of
from benchmarks.validation.hypotheses_wander import PATHS, SENSORS, WANDERS, Case, walked
from footfall.errors import InputError
from footfall.hdr.hypotheses.filter import Beliefs, beliefs
from footfall.hdr.hypotheses.params import DEG, HABITS, HypothesesParams
from footfall.hdr.hypotheses.smoother import smoothed
from footfall.hdr.tracks import Reckoning, pdr_track
from footfall.pdr.footfalls import Footfalls
from footfall.pdr.reckoning import dead_reckon
from footfall.scenarios.judge.score import compare
from footfall.scenarios.trial import Trial, walk_of

Made = Callable[[Footfalls, Beliefs], np.ndarray]  # the heading (n,) that is made of the beliefs
USUAL = HypothesesParams()


def as_told(feet: Footfalls, found: Beliefs) -> np.ndarray:
    """The filter's own heading."""
    return found.heading


def in_part(feet: Footfalls, found: Beliefs, share: float) -> np.ndarray:
    """A share of the correction."""
    return feet.heading + share * (found.heading - feet.heading)


def by_sd(feet: Footfalls, found: Beliefs) -> np.ndarray:
    """Less of a correction that is less than sure: B^2 / (B^2 + SD^2) of it."""
    square = (found.heading - feet.heading) ** 2
    return feet.heading + square / np.maximum(square + found.heading_sd**2, 1e-12) * (
        found.heading - feet.heading
    )


def beyond_sd(feet: Footfalls, found: Beliefs, sds: float) -> np.ndarray:
    """The correction only where it is larger than so many SD."""
    correction = found.heading - feet.heading
    return feet.heading + np.where(np.abs(correction) > sds * found.heading_sd, correction, 0.0)


@dataclass(frozen=True)
class Way:
    """Parameters and what is made of the beliefs."""

    params: HypothesesParams = USUAL
    made: Made = as_told
    smooth: bool = False


def _park(chance: float) -> HypothesesParams:
    first, _, *others = USUAL.straight_curve
    return replace(USUAL, straight_curve=(first, chance, *others))


LOOP_NAMES = ("closed-loop", "closed-loop-gentle")
STREETS = replace(USUAL, reference=0.0, along_first=0.9)
CROWD = {"`hypotheses` 128": Way(replace(USUAL, hypotheses=128))}
BANKS = {
    "`scales` 1, 0.07": Way(replace(USUAL, scales=(1.0, 0.07))),
    "`scales` 1, 0.03": Way(replace(USUAL, scales=(1.0, 0.03))),
    "`scales` 1, 0.1, 0.01": Way(replace(USUAL, scales=(1.0, 0.1, 0.01))),
}
LOOPS = {
    "as it comes": Way(),
    "told a direction": Way(replace(USUAL, reference=0.0)),
    "told that there are directions, and one": Way(STREETS),
    "the same, smoothed": Way(STREETS, smooth=True),
    **CROWD,
    "`straight_curve` .01 in parks": Way(_park(0.01)),
    "both": Way(replace(_park(0.01), hypotheses=128)),
    **BANKS,
}
CURVES = {
    "as it comes": Way(),
    **CROWD,
    "`bending` a tenth": Way(replace(USUAL, bending=USUAL.bending / 10)),
    "`bending` ten times": Way(replace(USUAL, bending=USUAL.bending * 10)),
    "`straight_curve` .01 in parks": Way(_park(0.01)),
    "the correction times 0.8": Way(made=partial(in_part, share=0.8)),
    "the correction shrunk by its SD": Way(made=by_sd),
    **BANKS,
    "smoothed": Way(smooth=True),
    "smoothed, `hypotheses` 128": Way(replace(USUAL, hypotheses=128), smooth=True),
    "smoothed, `straight_curve` .01 in parks": Way(_park(0.01), smooth=True),
}
PERFECT = {"as it comes": Way(), **CROWD, "`straight_curve` .01 in parks": Way(_park(0.01)), **BANKS}


def _more_habits(wander: float, time: float) -> HypothesesParams:
    """A sixth habit of walking streets."""
    first = {name: getattr(USUAL, name)[0] for name in HABITS} | {"wander_m": wander, "wander_s": time}
    return replace(USUAL, **{name: (*getattr(USUAL, name), first[name]) for name in HABITS})


SLOWER = (*USUAL.wander_s[:2], 6.0, *USUAL.wander_s[3:])
WANDER = {
    "as it comes": Way(),
    "a sixth habit, 0.35 m at 10 s": Way(_more_habits(0.35, 10.0)),
    "the third habit slower, 0.4 m at 6 s": Way(replace(USUAL, wander_s=SLOWER)),
    "`straight_curve` .01 in parks": Way(_park(0.01)),
    **CROWD,
    "`scales` 1, 0.03": BANKS["`scales` 1, 0.03"],
    "`straight_curve` .01 and `scales` 1, 0.03": Way(replace(_park(0.01), scales=(1.0, 0.03))),
}
ROOMS = {
    "as it comes": Way(),
    **CROWD,
    "without directions": Way(replace(USUAL, along_first=0.0)),
    "`beside_deg` 4": Way(replace(USUAL, beside=4 * DEG)),
    "`course_deg` 2": Way(replace(USUAL, course=2 * DEG)),
    "the correction shrunk by its SD": Way(made=by_sd),
    "the correction beyond 2 SD only": Way(made=partial(beyond_sd, sds=2.0)),
}
FEET = {
    "as it comes": Way(),
    "without directions": Way(replace(USUAL, along_first=0.0)),
    "`scales` 1, 0.1, 0.01": BANKS["`scales` 1, 0.1, 0.01"],
    **CROWD,
    "the correction shrunk by its SD": Way(made=by_sd),
    "the correction beyond 2 SD only": Way(made=partial(beyond_sd, sds=2.0)),
}


def errors(feet: Footfalls, true: np.ndarray, ways: Sequence[Way]) -> np.ndarray:
    """(1 + ways, 3): average and final error (deg), and final error / SD, uncorrected first."""
    found = [_error(feet.heading, true, np.nan)]
    for way in ways:
        believed = (smoothed if way.smooth else beliefs)(feet, way.params)
        found.append(_error(way.made(feet, believed), true, float(believed.heading_sd[-1])))
    return np.array(found)


def _error(heading: np.ndarray, true: np.ndarray, sd: float) -> tuple[float, float, float]:
    error = np.degrees(heading - true)
    return float(np.abs(error).mean()), float(abs(error[-1])), float(np.radians(error[-1])) / sd


def on_walk(job: Job, store: Path, ways: Sequence[Way]) -> list[np.ndarray]:
    """Errors of every unit of a job; none where the walk came to no end."""
    setup, found = setup_of(job), []
    for unit in job.units:
        trial = Trial(setup, job.number, setup.scenario.seeds.base + job.number, unit, unit)
        try:
            walk = walk_of(trial)
        except InputError:
            return []
        feet = footfalls_of(trial, walk, store)
        track = pdr_track(feet)
        found.append(errors(feet, track.heading - compare(track, walk).heading_error, ways))
    return found


def on_chain(job: real_chains.Job, ways: Sequence[Way]) -> list[np.ndarray]:
    """The same of one chain of real recordings."""
    walks = real_chains.in_order(job.pieces, job.unit)
    truth = pdr_track(dead_reckon(chain(walks, job.unit, true=True), PATIENT))
    feet = Reckoning(chain(walks, job.unit), pdr=PATIENT).footfalls
    track = pdr_track(feet)
    true = track.heading - np.radians(real_chains.heading_error_deg(track, truth))
    return [errors(feet, true, ways)]


def told(found: np.ndarray, place: int) -> str:
    """A cell of a table, of errors (units, 1 + ways, 3)."""
    average, final, ratio = found[:, place].T
    worse = 100 * (found[:, place, :2] > found[:, 0, :2] + WORSE_DEG).mean(axis=0)
    text = f"{average.mean():.1f} / {final.mean():.1f}; {np.percentile(average, 90):.1f}"
    return text if place == 0 else f"{text}; {worse[0]:.0f} / {worse[1]:.0f} %; {np.mean(ratio**2):.1f}"


def sheet(name: str, ways: Sequence[str], groups: dict[str, np.ndarray]) -> Sheet:
    """A row for each way, a column for each group of units."""
    made = Sheet(name, name, ["", *groups])
    for place, way in enumerate(["uncorrected", *ways]):
        made.rows.append([way, *(told(found, place) for found in groups.values())])
    return made


@dataclass(frozen=True)
class Table:
    """Ways on units of scenarios, with their own IMU or another."""

    ways: dict[str, Way]
    scenarios: tuple[str, ...]
    units: int = 60
    imu: str | None = None


TABLES = {
    "ways on loops": Table(LOOPS, (*LOOP_NAMES, "straight")),
    "ways on curves": Table(CURVES, ("curving",)),
    "ways in rooms": Table(ROOMS, ("rooms",), 12),
    "ways with a perfect IMU": Table(PERFECT, (*LOOP_NAMES, "errands", "curving"), 2, "perfect"),
}
WANDERING, HARD = "ways with wander", "ways on hard walks"
FEET_BARE = "ways on real feet as they are"


def main() -> None:
    """Judge, and tell."""
    parser = options(__doc__)
    names = [*TABLES, WANDERING, HARD, FEET_BARE]
    parser.add_argument("--tables", nargs="+", default=names, choices=names, metavar="NAME")
    parser.add_argument("--chains", type=int, default=5, help="of real walks, a group (default 5)")
    parser.add_argument("--store", type=Path, help="folder of footfalls (default a temporary one)")
    parser.add_argument("--page", type=Path, help="fill the tables of this page")
    args = parser.parse_args()
    sheets = []
    with tempfile.TemporaryDirectory() as folder:
        for name in args.tables:
            if name in TABLES:
                groups = walks(TABLES[name], args.store or Path(folder), args.processes)
                ways = TABLES[name].ways
            elif name == WANDERING:
                groups, ways = wandering(args.processes), WANDER
            elif name == HARD:
                groups, ways = hard(), WANDER
            else:
                groups, ways = bare_feet(args.chains, args.processes), FEET
            sheets.append(sheet(name, list(ways), groups))
            sheets[-1].show()
    write_json(args.json, {"figures": {each.name: each.rows for each in sheets}})
    if args.page:
        fill(args.page, by_name(sheets))


def walks(table: Table, store: Path, processes: int) -> dict[str, np.ndarray]:
    """Errors by scenario."""
    work = partial(on_walk, store=store, ways=tuple(table.ways.values()))
    groups = {}
    for scenario in table.scenarios:
        parts = run_all(work, jobs((scenario,), table.imu, table.units), processes, scenario)
        groups[scenario] = np.array([one for part in parts for one in part])
    return groups


def wandering(processes: int) -> dict[str, np.ndarray]:
    """Errors on the made-up footfalls of hypotheses_wander.py, one of each case, by gyro and at the hole."""
    cases = [
        Case(path, m, s, sensor, 1000 * k + 1)
        for path, sensor in product(PATHS, SENSORS)
        for k, (m, s) in enumerate(WANDERS)
    ]
    found = np.array(run_all(made_up, cases, processes, "made-up walks"))
    groups = {f"priors x {sensor:g}": np.array([c.sensor == sensor for c in cases]) for sensor in SENSORS}
    hole = np.array([(c.wander_m, c.wander_s) == (0.35, 20.0) for c in cases])
    groups |= {"0.35 m at 20 s": hole, "all but these": ~hole}
    return {name: found[rows] for name, rows in groups.items()}


def hard() -> dict[str, np.ndarray]:
    """Errors on eight walks each of a gyro without noise that drifts."""
    ways, groups = tuple(WANDER.values()), {}
    for name, make in (("steady bias", steady_bias), ("cooling on a curve", cooling_on_a_curve)):
        walks = [make(seed) for seed in range(1, 9)]
        groups[name] = np.array([errors(feet, feet.heading - drifted, ways) for feet, drifted in walks])
    return groups


def made_up(case: Case) -> np.ndarray:
    """Errors of made-up footfalls."""
    feet, drifted = walked(case)
    return errors(feet, feet.heading - drifted, tuple(WANDER.values()))


def bare_feet(chains: int, processes: int) -> dict[str, np.ndarray]:
    """Errors by group of recordings, nothing added."""
    pieces = {real.name: piece_of(real) for real in find(BESIDE)}
    if not pieces:
        raise SystemExit(f"{BESIDE}: no recordings here")
    groups = {}
    for group, names in real_chains.GROUPS.items():
        own = tuple(pieces[each] for each in names if each in pieces)
        units = range(real_chains.FIRST_UNIT, real_chains.FIRST_UNIT + chains)
        work = [real_chains.Job(group, own, unit, None) for unit in units]
        parts = run_all(partial(on_chain, ways=tuple(FEET.values())), work, processes, group)
        groups[group] = np.array([one for part in parts for one in part])
    return groups


if __name__ == "__main__":
    main()
