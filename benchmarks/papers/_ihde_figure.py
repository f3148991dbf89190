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
from footfall.scenarios.report.style import colours_of, entitle, head, label_of, new_panels, save
from footfall.scenarios.run import Part, Result, perform_run
from footfall.scenarios.scenario import Scenario
from footfall.scenarios.trial import Trial, setup

if TYPE_CHECKING:
    from matplotlib.axes import Axes

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
        entitle(axis, test)
        axis.yaxis.set_major_formatter("{x:g}")
    axes[0].set_ylabel("return error (% of the distance)")
    head(
        figure,
        "Return errors of the judged walks (dots), their median (line) and the paper's range (grey)",
        axes,
    )
    return figure


def look_closer(axis: Axes, result: Result) -> None:
    """An inset of some metres round the middle of the walk, where good tracks lie on each other."""
    truth = result.walk.footfalls.position[:, :2]
    x, y = truth[len(truth) // 2]
    half = 0.02 * max(float(np.ptp(axis.get_xlim())), float(np.ptp(axis.get_ylim())))
    # In the corner of the panel that is emptiest.
    points = np.vstack([line.get_xydata() for line in axis.lines])
    left, right, low, high = *axis.get_xlim(), *axis.get_ylim()
    share = (points - (left, low)) / (right - left, high - low)
    corners = {
        (cx, cy): int((np.abs(share - (cx + 0.17, cy + 0.17)) < 0.19).all(axis=1).sum())
        for cx in (0.02, 0.64)
        for cy in (0.02, 0.64)
    }
    place = min(corners, key=lambda corner: corners[corner])
    inset = axis.inset_axes((*place, 0.34, 0.34), xlim=(x - half, x + half), ylim=(y - half, y + half))
    for line in axis.lines:
        inset.plot(*line.get_data(), color=line.get_color(), lw=line.get_linewidth(), alpha=line.get_alpha())
    inset.set(xticks=[], yticks=[])
    inset.set_title(f"{2 * half:.1f} m", fontsize=7, pad=2)
    axis.indicate_inset_zoom(inset, edgecolor="#222222")


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
        look_closer(axis, results[test])
    save(figure, folder / "ihde_tracks.png")
    title = "ihde-test2: heading, and what IHDE makes of it"
    save(evaluation(results["ihde-test2"], title), folder / "ihde_evaluation.png")
