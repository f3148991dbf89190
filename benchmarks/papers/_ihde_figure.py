"""The figures of ihde_table2.py."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from footfall.scenarios.judge.papers import IHDE_TABLE_2
from footfall.scenarios.report.figures import maps
from footfall.scenarios.report.heading_figures import evaluation
from footfall.scenarios.report.style import colours_of, head, label_of, new_panels, save
from footfall.scenarios.run import Part, Result, perform_run
from footfall.scenarios.scenario import Scenario
from footfall.scenarios.trial import Trial, setup

if TYPE_CHECKING:
    from benchmarks.papers.ihde_table2 import Tuned

_SHOWN = ("iez", "hde", "ihde", "ihde-plus")


def _result(scenario: Scenario, seed: int, tuned: Tuned) -> Result:
    """One walk with the unit of its seed, navigated as tuned."""
    made = setup(scenario, methods=[tuned.ways()[name].method(name) for name in _SHOWN])
    (result,) = perform_run([Part(Trial(made, seed - scenario.seeds.base, seed, seed, seed))])
    return result


def return_errors(errors: Mapping[str, Mapping[str, np.ndarray]]) -> Figure:
    """P_err of every judged walk by test and method, the paper's ranges behind them."""
    figure, axes = new_panels(len(errors), 2.6, 3.4)
    colours = colours_of(_SHOWN)
    for axis, (test, by) in zip(axes, errors.items(), strict=True):
        for place, name in enumerate(_SHOWN):
            found = by[name][:, 0]
            if name in IHDE_TABLE_2[test]:
                low, high = IHDE_TABLE_2[test][name]
                axis.fill_between([place - 0.4, place + 0.4], low, min(high, 200.0), color="#e3e3e3", lw=0)
            beside = place + np.linspace(-0.25, 0.25, len(found))
            axis.plot(beside, np.sort(found), "o", color=colours[name], ms=3)
            axis.plot([place - 0.32, place + 0.32], [np.median(found)] * 2, color=colours[name], lw=1.6)
        axis.set_yscale("log")
        axis.set_ylim(0.01, 200)
        axis.set_xticks(range(len(_SHOWN)), [label_of(name) for name in _SHOWN])
        axis.set_title(test, loc="left", fontsize=9)
        axis.yaxis.set_major_formatter("{x:g}")
    axes[0].set_ylabel("P_err (%)")
    head(figure, "return errors of the judged walks; the paper's ranges in grey", axes)
    return figure


def draw(
    folder: Path,
    scenarios: Mapping[str, Scenario],
    tuned: Tuned,
    seed: int,
    errors: Mapping[str, Mapping[str, np.ndarray]],
) -> None:
    """Return errors; tracks on the three tests (the paper's Figures 6b, 7b and 8); E along Test 2 (7a)."""
    folder.mkdir(parents=True, exist_ok=True)
    save(return_errors(errors), folder / "ihde_table2.png")
    results = {test: _result(scenario, seed, tuned) for test, scenario in scenarios.items()}
    figure = maps(list(results.values()), "Walked paths, and what methods make of a gyro with a bias")
    for axis, (test, scenario) in zip(figure.axes, scenarios.items(), strict=True):
        axis.set_title(f"{test}, {scenario.path.route.length:.0f} m", loc="left", fontsize=9)
    save(figure, folder / "ihde_tracks.png")
    title = "ihde-test2: heading, and what IHDE makes of it"
    save(evaluation(results["ihde-test2"], title), folder / "ihde_evaluation.png")
