"""HDR's accuracy on the closed loop: parameters tuned on some walks and units, judged on others.

Tuning: for every pair of i_c and theta_w, HDR corrects units drawn from the sheet. The pair with the smallest
average heading error, mean over those units whose uncorrected errors lie in the range of the paper's Table 2,
is chosen. Judging: beside the default pair, on other walks with other units: all that were drawn, those in
the range, and the scenario's own five. No walk seed and no unit serves on both sides.
HDR is chaotic, so every judged unit is heard through its own noise and some more: the tables are over all
these recordings, and how far mean and median go from noise to noise is told beside.
More scenarios, or the first one with the IMU on other mounts, may be named: they are judged with the
parameters that the first one chose.

python -m benchmarks.papers.hdr_table2 --figure hdr.png --page docs/results.md
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf
from pathlib import Path

import numpy as np
from rich.table import Table

from benchmarks._common import dealt, heard, options, out, within_paper, write_json
from benchmarks._page import Sheet, by_name, fill
from benchmarks.papers._hdr_cases import Case, dead_reckoned
from benchmarks.papers._hdr_figure import draw
from benchmarks.papers._hdr_page import Group, Judged, mounts_sheet, summary
from footfall.errors import InputError
from footfall.hdr.hdr import HdrParams, headings
from footfall.scenarios.scenario import Scenario, load_scenario
from footfall.scenarios.studies.tune import Tuned, grid, require_apart, tune
from footfall.scenarios.trial import Trial, setup

I_C = (0.002, 0.003, 0.004, 0.005, 0.006, 0.007, 0.010, 0.015, 0.020)  # deg/s
THETA_W = (0.15, 0.20, 0.25, 0.30, 0.35, 0.40, 0.50, 0.70, 1.00, inf)  # deg/s
AVERAGE = 1


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


def study(cases: Sequence[Case], sets: Sequence[HdrParams]) -> Study:
    """Correct every unit with every parameter set."""
    found = headings([case.footfalls for case in cases], sets)
    corrected = [case.corrected_deg(psi) for case, psi in zip(cases, found, strict=True)]
    return Study(cases, np.array([case.uncorrected_deg() for case in cases]), np.stack(corrected, axis=1))


def reckoned(todo: Sequence[Trial], processes: int, label: str) -> list[list[Case]]:
    """Dead-reckon every unit: for each noise the cases, in the order of the units."""
    cases = dead_reckoned(todo, processes, label)
    if not cases:
        raise SystemExit(f"{label}: no walk came to its end")
    rounds: dict[int, list[Case]] = {}
    for case in cases:
        rounds.setdefault(case.trial.noise_seed - case.trial.unit_seed, []).append(case)
    return [rounds[noise] for noise in sorted(rounds)]


def average_deg(case: Case, sets: Sequence[HdrParams]) -> np.ndarray:
    """(s,) average heading error of a case by parameter set."""
    return case.corrected_deg(headings([case.footfalls], sets)[0])[:, AVERAGE]


def name_of(params: HdrParams) -> str:
    """The pair in deg/s."""
    return f"i_c {np.degrees(params.i_c):.3f}, theta_w {np.degrees(params.theta_w):.2f}"


def as_map(errors: np.ndarray) -> np.ndarray:
    """(i_c, theta_w) mean over cases of their errors (c, sets)."""
    return np.asarray(errors.mean(axis=0).reshape(len(I_C), len(THETA_W)))


def print_map(values: np.ndarray, title: str) -> None:
    """i_c down, theta_w across (deg/s), the smallest in bold."""
    table = Table(title=title, title_justify="left")
    table.add_column("i_c \\ theta_w")
    for theta_w in THETA_W:
        table.add_column(f"{theta_w:g}", justify="right")
    for i_c, row in zip(I_C, values, strict=True):
        table.add_row(f"{i_c:g}", *(f"[bold]{v:.1f}[/]" if v == values.min() else f"{v:.1f}" for v in row))
    out.print(table)


def judge(own: np.ndarray, methods: Mapping[str, np.ndarray], title: str) -> Judged:
    """Sum up and print each method's errors, by group of units.

    Parameters
    ----------
    own : (c,) bool, the units that the scenario chose
    methods : name -> (r, c, 2) final and average error (deg) of c units through r noises
    """
    uncorrected = methods["uncorrected"]
    all_, own = np.broadcast_to(~own, uncorrected.shape[:2]), np.broadcast_to(own, uncorrected.shape[:2])
    groups = {
        "all units drawn": all_,
        "in Table 2's range": all_ & within_paper(uncorrected),
        "the scenario's own": own,
    }
    found = Judged(
        title,
        {
            name: Group(
                units=int(chosen.any(axis=0).sum()),
                recordings=int(chosen.sum()),
                methods={method: summary(errors, chosen) for method, errors in methods.items()},
            )
            for name, chosen in groups.items()
            if chosen.any()
        },
    )
    out.print(found.table())
    return found


def sides(scenario: Scenario, chosen: argparse.Namespace) -> tuple[list[Trial], list[Trial]]:
    """Who wears what on which walk: for tuning, and for judging, where the scenario's own units come in too.

    Raises
    ------
    InputError
        The two sides share a walk seed or a unit.
    """
    worn = setup(scenario, methods=())
    first = scenario.seeds.base if chosen.walk_seed is None else chosen.walk_seed
    drawn = range(chosen.unit_seed, chosen.unit_seed + chosen.units)
    judged = dealt(worn, chosen.walks, first, drawn, chosen.noises)
    if scenario.seeds.units:
        for number in range(chosen.walks):
            unit = scenario.unit_seed(number)
            judged += heard(Trial(worn, number, first + number, unit, unit), chosen.noises)
    seeds = range(chosen.tuning_unit_seed, chosen.tuning_unit_seed + chosen.tuning_units)
    tuning = dealt(worn, chosen.tuning_walks, chosen.tuning_walk_seed, seeds)
    require_apart("walk seed", (one.walk_seed for one in tuning), (one.walk_seed for one in judged))
    require_apart("unit", seeds, (*drawn, *(scenario.seeds.units or ())))
    return tuning, judged


def print_tuned(tuned: Tuned[HdrParams]) -> None:
    """Default and tuned, on both sides."""
    title = f"Average heading error (deg); tuned: {name_of(tuned.chosen)} deg/s"
    sheet = Sheet("tuned", title, ["", "", "mean", "median", "p90"], left=2)
    for side, by in tuned.figures.items():
        for name, found in by.items():
            sheet.rows.append([side, name, *(f"{value:.1f}" for value in found.values())])
    sheet.show()


def main(arguments: Sequence[str] | None = None) -> None:
    """Tune, judge, print, draw."""
    parser = options(__doc__)
    parser.add_argument("scenarios", nargs="*", default=["closed-loop"], help="default: closed-loop")
    for name, default, text in (
        ("walks", 5, "walks to judge on"),
        ("units", 60, "units to judge with, shared out over the walks"),
        ("walk-seed", None, "of the first of these walks (default: the scenario's)"),
        ("unit-seed", 1000, "of the first of these units (default 1000, as in `footfall run`)"),
        ("noises", 10, "more for each of these units, beside its own"),
        ("tuning-walks", 6, "walks to tune on"),
        ("tuning-units", 72, "units to tune with"),
        ("tuning-walk-seed", 101, "of the first of these walks"),
        ("tuning-unit-seed", 2000, "of the first of these units"),
    ):
        parser.add_argument(f"--{name}", type=int, default=default, help=text)
    parser.add_argument("--tau", type=float, default=8.0, help="s, time constant of the filters (default 8)")
    parser.add_argument("--mounts", nargs="*", default=[], help="judge the first scenario on these, too")
    parser.add_argument("--figure", type=Path, metavar="PNG", help="draw map and scatter there")
    parser.add_argument("--page", type=Path, metavar="MD", help="fill its tables")
    chosen = parser.parse_args(arguments)

    sets = grid(HdrParams(tau_s=chosen.tau), {"i_c_deg_s": I_C, "theta_w_deg_s": THETA_W})
    scenarios = {one.name: one for one in map(load_scenario, chosen.scenarios)}
    first = next(iter(scenarios))
    scenarios |= {
        f"{first}, {mount}": scenarios[first].changed("sensor", mount=mount) for mount in chosen.mounts
    }
    try:
        todo = {title: sides(scenario, chosen) for title, scenario in scenarios.items()}
    except InputError as error:
        raise SystemExit(str(error)) from None
    (tuning,) = reckoned(todo[first][0], chosen.processes, f"tuning on {first}")
    rounds = {
        title: reckoned(judged, chosen.processes, f"judging on {title}")
        for title, (_, judged) in todo.items()
    }
    fits = [case for case in tuning if within_paper(case.uncorrected_deg())]
    drawn = [
        case for case in rounds[first][0] if case.trial.unit_seed not in (scenarios[first].seeds.units or ())
    ]
    tuned = tune(average_deg, sets, HdrParams(), train=fits or tuning, test=drawn)
    best, tuned_map = tuned.chosen, as_map(tuned.errors)
    count = f"{len(fits or tuning)} of {len(tuning)} tuning units" + ("" if fits else " (none in range)")
    print_map(tuned_map, f"Average heading error (deg), {first}, mean over {count}")
    print_tuned(tuned)

    judged: dict[str, Judged] = {}
    for title, heard_all in rounds.items():
        found = study(heard_all[0], [*sets, best, HdrParams()])
        all_found = [found, *(study(cases, [best, HdrParams()]) for cases in heard_all[1:])]
        methods = {
            "uncorrected": np.stack([one.uncorrected for one in all_found]),
            f"HDR, default ({name_of(HdrParams())})": np.stack([one.corrected[-1] for one in all_found]),
            f"HDR, tuned ({name_of(best)})": np.stack([one.corrected[-2] for one in all_found]),
        }
        if best == HdrParams():
            methods.popitem()
        own = np.isin([case.trial.unit_seed for case in found.cases], scenarios[title].seeds.units or ())
        judged[title] = judge(own, methods, title)
        if title == first:
            fit = ~own & found.in_range
            over = fit if fit.any() else ~own
            judged_map = as_map(found.corrected[: len(sets), over, AVERAGE].T)
            print_map(judged_map, "The same map over the judged units: hindsight, not used")
            if chosen.figure is not None:
                alone = {name: errors[0] for name, errors in methods.items()}
                draw(chosen.figure, I_C, THETA_W, (tuned_map, judged_map), alone, found.in_range)
    if chosen.page:
        sheets = [judged[first].sheet(), judged[first].noise_sheet()]
        fill(chosen.page, by_name([*sheets, mounts_sheet(judged)] if chosen.mounts else sheets))
    document = {
        "tau_s": chosen.tau,
        "i_c_deg_s": I_C,
        "theta_w_deg_s": [None if theta_w == inf else theta_w for theta_w in THETA_W],
        "tuning_average_deg": tuned_map.tolist(),
        "chosen": name_of(best),
        "judged": {title: found.as_dict() for title, found in judged.items()},
        "judged_average_deg": judged_map.tolist(),
    }
    write_json(chosen.json, document)


if __name__ == "__main__":
    main()
