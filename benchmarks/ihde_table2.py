"""Table 2 of Deng et al. (2018): heading methods on three paths, tuned on some walks, judged on others.

The paper's uncorrected tracks drift far more than its IMU does, and its filter, which takes every still
sample for zero velocity, makes such drift by itself; how much depends on the noise of that velocity, which
the paper does not state. So every method is judged on two filters: this package's, and the paper's with
sigma_v matched, path by path, to the middle of the paper's IEZ row on the tuning walks. On the latter the
methods are tuned for the smallest mean heading error, so that no oval can hide an error by symmetry, and for
the geometric mean over the tests, so that each counts alike: HDE on Tests 1 and 2, for it has no answer to
Test 3, IHDE and iHDE on all three. No walk seed and no unit serves on both sides.

python benchmarks/ihde_table2.py --page docs/ihde.md --figures docs/images
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from math import degrees, radians
from pathlib import Path
from typing import Any

import numpy as np
from _common import err, options, out, run_all, write_json
from _ihde_page import fill, scatter_table, setting_table, table_2, threshold_table
from robustness import gait, places, steady

from footfall.errors import InputError
from footfall.hdr.hde import Hde, Hde2010Params, HdeParams
from footfall.hdr.ihde import Ihde, IhdeParams
from footfall.hdr.jimenez import FilterHdr, FilterHdrParams, Jimenez, JimenezParams
from footfall.hdr.tracks import (
    HeadingMethod,
    Reckoning,
    corrected_track,
    hde_2010_track,
    iez_track,
    pdr_track,
)
from footfall.models.imu import draw_unit, load_spec
from footfall.pdr.ins import FilterSettings
from footfall.pdr.track import Track
from footfall.scenarios.paper import IHDE_TABLE_2
from footfall.scenarios.run import start_pose
from footfall.scenarios.scenario import Scenario, load_scenario
from footfall.scenarios.score import score
from footfall.simulate.cache import cached_walk
from footfall.simulate.record import record
from footfall.simulate.walk import Walk

TESTS = tuple(IHDE_TABLE_2)
OURS = FilterSettings()
SIGMA_V = tuple(float(v) for v in np.geomspace(0.01, 0.64, 13))  # m/s
HDE_GRID = tuple(HdeParams(sigma=radians(sigma)) for sigma in (2, 4, 8, 12, 20, 40))
IHDE_GRID = tuple(
    IhdeParams(a=IhdeParams.k1 * radians(scatter), sigma=radians(sigma), fallback=fallback)
    for fallback, scatter, sigma in product((True, False), (1, 1.5, 2, 2.5, 3, 4, 6), (2, 4, 8))
)
JIMENEZ_GRID = tuple(
    JimenezParams(gate=radians(gate), sigma=radians(sigma)) for gate, sigma in product((3, 4, 6), (1, 2, 4))
)

Params = HdeParams | Hde2010Params | IhdeParams | JimenezParams | FilterHdrParams
CORRECTORS: Mapping[type, type] = {
    HdeParams: Hde,
    IhdeParams: Ihde,
    JimenezParams: Jimenez,
    FilterHdrParams: FilterHdr,
}


@dataclass(frozen=True)
class Way:
    """How to navigate: a filter with a heading method in it, or dead reckoning and one after it.

    `foot_known`: directions are counted from where the walking foot points, not the standing one.
    """

    params: Params | None
    settings: FilterSettings | None
    foot_known: bool = False

    def track(self, reckoning: Reckoning, foot: float = 0.0) -> Track:
        """The track; dominant directions are counted from the heading at the start.

        `foot` : rad, by which the walking foot points further to the left than the standing one
        """
        params = counted(self.params, reckoning.start.heading + (foot if self.foot_known else 0.0))
        if self.settings is None:
            if params is None:
                return pdr_track(reckoning.footfalls)
            assert isinstance(params, Hde2010Params)
            return hde_2010_track(reckoning.footfalls, params)
        if params is None:
            return iez_track(reckoning, self.settings, name="iez")
        corrector: HeadingMethod = CORRECTORS[type(params)](params)
        return corrected_track(reckoning, corrector, self.settings, name=type(params).__name__)


def counted(params: Params | None, heading: float) -> Params | None:
    """The same with its directions, where they are given, counted from `heading` (rad)."""
    if params is None or isinstance(params, FilterHdrParams) or params.directions.reference is None:
        return params
    turned = replace(params.directions, reference=params.directions.reference + heading)
    return replace(params, directions=turned)


@dataclass(frozen=True)
class Job:
    """One walk of a test, worn by the unit of its seed, and the ways to navigate it."""

    scenario: Scenario
    seed: int
    ways: tuple[Way, ...]

    def walk(self) -> Walk:
        return cached_walk(replace(self.scenario.plan(0), seed=self.seed))

    def reckoning(self, walk: Walk) -> Reckoning:
        unit = draw_unit(load_spec(self.scenario.imu), self.seed)
        return Reckoning(
            record(walk, unit, seed=self.seed, temperature=self.scenario.temperature_of(0)), start_pose(walk)
        )


def foot_beside_path(job: Job, walk: Walk) -> tuple[float, float]:
    """The foot's heading less the path's (rad): standing at the start, and the mean of steady stretches."""
    route = job.scenario.path.route
    rows = places(route, walk.footfalls.position)
    off = walk.footfalls.heading - route.heading[rows]
    return float(off[0]), float(off[steady(route)[rows]].mean())


def navigate(job: Job) -> np.ndarray | str:
    """(ways, 3) return error (%), mean and final heading error (deg); or why the walk came to no end."""
    try:
        walk = job.walk()
    except InputError as error:
        return str(error)
    reckoning, (standing, walking) = job.reckoning(walk), foot_beside_path(job, walk)
    found = [score(way.track(reckoning, walking - standing), walk) for way in job.ways]
    return np.array(
        [(one.return_error_pct, one.heading_error_mean_deg, one.heading_error_final_deg) for one in found]
    )


def judge(
    scenarios: Mapping[str, Scenario],
    seeds: Sequence[int],
    ways: Mapping[str, Sequence[Way]],
    processes: int,
    label: str,
) -> dict[str, np.ndarray]:
    """Test -> (seeds, ways, 3) of `navigate`; walks that came to no end are named and left out."""
    jobs = [Job(scenarios[test], seed, tuple(ways[test])) for test in TESTS for seed in seeds]
    found: dict[str, list[np.ndarray]] = {test: [] for test in TESTS}
    for job, result in zip(jobs, run_all(navigate, jobs, processes, label), strict=True):
        if isinstance(result, str):
            err.print(f"[red]left out:[/red] {result}")
        else:
            found[job.scenario.name].append(result)
    if not all(found.values()):
        raise SystemExit(f"{label}: no walk came to its end on one of the tests")
    return {test: np.stack(rows) for test, rows in found.items()}


def match_sigma(errors: np.ndarray, wanted: float) -> float:
    """sigma_v (m/s) at which IEZ's mean return error is `wanted` %, between errors (seeds, SIGMA_V, 3)."""
    mean = np.minimum.accumulate(errors[:, :, 0].mean(axis=0))  # falls as zero velocity is trusted less
    return float(np.exp(np.interp(-np.log(wanted), -np.log(mean), np.log(SIGMA_V))))


def best(grid: Sequence[Any], errors: Mapping[str, np.ndarray], tests: Sequence[str]) -> int:
    """Place in the grid of the smallest heading error, geometric mean over tests; errors (seeds, grid, 3)."""
    mean = np.mean([np.log(errors[test][:, :, 1].mean(axis=0)) for test in tests], axis=0)
    return int(np.argmin(mean[: len(grid)]))


@dataclass(frozen=True)
class Tuned:
    """What the tuning walks chose: sigma_v (m/s), parameters; test -> errors (seeds, IHDE_GRID, 3) there."""

    sigma_v: Mapping[str, float]
    hde: HdeParams
    ihde: IhdeParams
    ihde_alone: IhdeParams
    jimenez: JimenezParams
    ihde_errors: Mapping[str, np.ndarray]

    def matched(self, test: str) -> FilterSettings:
        """The paper's filter with the zero velocity's noise that gives its IEZ row."""
        return replace(FilterSettings.paper(), sigma_velocity=self.sigma_v[test])

    def methods(self) -> dict[str, Params | None]:
        """Rows of the table that stand on a filter."""
        learned = replace(self.ihde_alone, directions=replace(self.ihde_alone.directions, reference=None))
        return {
            "iez": None,
            "hde": self.hde,
            "ihde": self.ihde,
            "ihde, no mean heading": self.ihde_alone,
            "ihde-learned": learned,
            "ihde-jimenez": self.jimenez,
            "hdr-filter": FilterHdrParams(),
        }


def tune(scenarios: Mapping[str, Scenario], seeds: Sequence[int], processes: int) -> Tuned:
    """Match sigma_v, then choose the parameters, on these walks."""
    scan = [Way(None, replace(FilterSettings.paper(), sigma_velocity=sigma)) for sigma in SIGMA_V]
    found = judge(scenarios, seeds, dict.fromkeys(TESTS, scan), processes, "matching sigma_v")
    sigma_v = {test: match_sigma(found[test], float(np.mean(IHDE_TABLE_2[test]["iez"]))) for test in TESTS}
    grid = (*HDE_GRID, *IHDE_GRID, *JIMENEZ_GRID)
    ways = {
        test: [Way(params, replace(FilterSettings.paper(), sigma_velocity=sigma_v[test])) for params in grid]
        for test in TESTS
    }
    found = judge(scenarios, seeds, ways, processes, "tuning the methods")

    def part(first: int, size: int) -> dict[str, np.ndarray]:
        return {test: found[test][:, first : first + size] for test in TESTS}

    half, start = len(IHDE_GRID) // 2, len(HDE_GRID)
    with_mean, alone = part(start, half), part(start + half, half)
    return Tuned(
        sigma_v,
        HDE_GRID[best(HDE_GRID, part(0, start), TESTS[:2])],
        IHDE_GRID[best(IHDE_GRID[:half], with_mean, TESTS)],
        IHDE_GRID[half + best(IHDE_GRID[half:], alone, TESTS)],
        JIMENEZ_GRID[best(JIMENEZ_GRID, part(start + 2 * half, len(JIMENEZ_GRID)), TESTS)],
        part(start, 2 * half),
    )


def settings_in_words(tuned: Tuned) -> dict[str, tuple[str, str]]:
    """What was chosen beside the defaults, by method."""

    def ihde(p: IhdeParams) -> str:
        return f"a / k1 = {degrees(p.a / p.k1):.1f} deg, sigma = {degrees(p.sigma):.0f} deg"

    def jimenez(p: JimenezParams) -> str:
        return f"gate = {degrees(p.gate):.0f} deg, sigma = {degrees(p.sigma):.0f} deg"

    words = {
        "hde": (
            f"sigma = {degrees(tuned.hde.sigma):.0f} deg",
            f"sigma = {degrees(HdeParams().sigma):.0f} deg",
        ),
        "ihde": (ihde(tuned.ihde), ihde(IhdeParams())),
        "ihde, no mean heading": (ihde(tuned.ihde_alone), ""),
        "ihde-jimenez": (jimenez(tuned.jimenez), jimenez(JimenezParams())),
    }
    for test, sigma in tuned.sigma_v.items():
        words[f"sigma_v, {test}"] = (f"{sigma:.3f} m/s", "")
    return words


THRESHOLDS = (0.7, 1.0, 1.4, 2.0, 3.0)  # deg, a / k1 for gaits of other regularity
VARIANTS: Mapping[str, Mapping[str, float]] = {
    "a metronome's": {"variability": 0.0},
    "half as irregular as people's": {"variability": 0.5},
    "people's": {},
    "people's, weaving by 0.1 m": {"wander": 0.1},
}


@dataclass(frozen=True)
class Scattered:
    """One walk of a gait.

    Attributes
    ----------
    yaw_sd_deg : SD of the stance yaw about the path
    standing_deg, walking_deg : the foot's heading less the path's, at the start and in the mean
    errors : (1 + 3 thresholds, 3) of `navigate`, as lists: IEZ, then the `forms` of IHDE, each by threshold
    """

    gait: str
    test: str
    yaw_sd_deg: float
    standing_deg: float
    walking_deg: float
    errors: Sequence[Sequence[float]]


def forms(tuned: Tuned, settings: FilterSettings) -> tuple[Way, ...]:
    """IEZ; by threshold IHDE, IHDE that knows the walking foot, and that without the mean heading."""
    kinds = ((tuned.ihde, False), (tuned.ihde, True), (tuned.ihde_alone, True))
    return (
        Way(None, settings),
        *(
            Way(replace(params, a=params.k1 * radians(scatter)), settings, known)
            for params, known in kinds
            for scatter in THRESHOLDS
        ),
    )


def scattered(job: tuple[str, Job]) -> Scattered | None:
    """Judge one walk of a gait."""
    name, one = job
    errors = navigate(one)
    if isinstance(errors, str):
        err.print(f"[red]left out:[/red] {errors}")
        return None
    walk = one.walk()
    yaw = gait(one.scenario.plan(0), walk.footfalls).stance_yaw_sd_deg
    standing, walking = np.degrees(foot_beside_path(one, walk))
    return Scattered(name, one.scenario.name, yaw, float(standing), float(walking), errors.tolist())


def main(arguments: Sequence[str] | None = None) -> None:
    """Tune, judge, print, write."""
    parser = options(__doc__)
    for name, default, text in (
        ("walks", 20, "walks of each test to judge on"),
        ("walk-seed", 1, "of the first of them and its unit"),
        ("tuning-walks", 6, "walks of each test to tune on"),
        ("tuning-seed", 101, "of the first of them and its unit"),
        ("gait-walks", 2, "walks of each test with more and less regular gaits (0: none)"),
    ):
        parser.add_argument(f"--{name}", type=int, default=default, help=f"{text} (default {default})")
    parser.add_argument("--page", type=Path, metavar="MD", help="put the tables into this page")
    parser.add_argument("--figures", type=Path, metavar="FOLDER", help="draw figures there")
    chosen = parser.parse_args(arguments)
    seeds = range(chosen.walk_seed, chosen.walk_seed + chosen.walks)
    tuning = range(chosen.tuning_seed, chosen.tuning_seed + chosen.tuning_walks)
    if set(seeds) & set(tuning):
        raise SystemExit("tuning and judging share a walk seed: choose other seeds")

    scenarios = {test: load_scenario(test) for test in TESTS}
    tuned = tune(scenarios, tuning, chosen.processes)
    methods = tuned.methods()
    known = {"ihde, foot known": tuned.ihde, "ihde, foot known, no mean heading": tuned.ihde_alone}
    alone = {"pdr": Way(None, None), "hde-2010": Way(Hde2010Params(), None)}
    ways = {
        test: [
            *alone.values(),
            *(
                Way(params, settings, params_known)
                for settings in (OURS, tuned.matched(test))
                for params_known, rows in ((False, methods), (True, known))
                for params in rows.values()
            ),
        ]
        for test in TESTS
    }
    found = judge(scenarios, seeds, ways, chosen.processes, "judging")
    on_filters = [*methods, *known]
    names = [*alone, *on_filters]
    ours = {test: dict(zip(names, np.swapaxes(rows, 0, 1), strict=False)) for test, rows in found.items()}
    matched = {
        test: dict(zip(on_filters, np.swapaxes(rows, 0, 1)[len(names) :], strict=True))
        for test, rows in found.items()
    }
    tables = {
        "matched": table_2(matched),
        "ours": table_2(ours),
        "settings": setting_table(settings_in_words(tuned)),
        "thresholds": threshold_table(IHDE_GRID, tuned.ihde_errors),
    }

    gaits: list[Scattered] = []
    if chosen.gait_walks:
        todo = [
            (
                name,
                Job(replace(scenarios[test], **change), seed, forms(tuned, tuned.matched(test))),
            )
            for name, change in VARIANTS.items()
            for test in TESTS
            for seed in seeds[: chosen.gait_walks]
        ]
        rows = run_all(scattered, todo, chosen.processes, "other gaits")
        gaits = [row for row in rows if row is not None]
        tables["gaits"] = scatter_table(gaits, list(VARIANTS), TESTS, THRESHOLDS)

    for name, table in tables.items():
        out.print(f"\n[bold]{name}[/bold]\n{table}", highlight=False)
    if chosen.page is not None:
        fill(chosen.page, tables)
    if chosen.figures is not None:
        from _ihde_figure import draw

        draw(chosen.figures, scenarios, tuned, seeds[0])
    document = {
        "sigma_v_m_s": dict(tuned.sigma_v),
        "settings": settings_in_words(tuned),
        "columns": ["return_error_pct", "heading_error_mean_deg", "heading_error_final_deg"],
        "ours": {test: {name: rows.tolist() for name, rows in by.items()} for test, by in ours.items()},
        "matched": {test: {name: rows.tolist() for name, rows in by.items()} for test, by in matched.items()},
        "gaits": [vars(one) for one in gaits],
    }
    write_json(chosen.json, document)


if __name__ == "__main__":
    main()
