"""Figures of heading methods at work, drawn where a run has such a method."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from footfall.scenarios.judge.score import compare
from footfall.scenarios.report.style import (
    colours_of,
    head,
    label_edges,
    label_of,
    new_figure,
    save,
    widths_of,
)
from footfall.scenarios.run import Result

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEADING_FIGURES = ("evaluation",)
_ACTIVE, _IDLE = "#c1440e", "#222222"


def judging(result: Result) -> str | None:
    """The first of a result's methods that evaluates how straight the walk is (IHDE); None without one."""
    return next((name for name, track in result.tracks.items() if "evaluation" in track.evidence), None)


def evaluation(result: Result, title: str | None = None) -> Figure:
    """Heading, its error and E along one walk (Figure 7a of Deng et al. 2018); needs a method that has E.

    Above the true heading and every method's, amid what they are off, below E of Eq. 23, red where the
    heading was corrected.
    """
    method = judging(result)
    assert method is not None
    track, names = result.tracks[method], list(result.tracks)
    colours, widths = colours_of(names), widths_of(names)
    figure, grid = new_figure(3, 1, 7.2, 6.0, sharex=True, height_ratios=[1.4, 1.2, 1.0])
    above, amid, below = grid[:, 0]
    began = track.t[0]
    row = compare(track, result.walk)
    truth = np.degrees(track.heading - row.heading_error)
    above.plot(row.t - began, truth, color="#222222", lw=3.0, alpha=0.35, label="truth")
    for name, other in result.tracks.items():
        off = compare(other, result.walk).heading_error
        true = np.interp(other.t, row.t, truth)
        line = true + np.degrees(off)
        above.plot(other.t - began, line, color=colours[name], lw=widths[name], label=label_of(name))
        amid.plot(other.t - began, np.degrees(off), color=colours[name], lw=1.4)
    amid.axhline(0, color="#222222", lw=0.8)
    amid.set_ylabel("heading error (deg)")
    low, high = above.get_ylim()
    for quarter in range(int(np.floor(low / 90)), int(np.ceil(high / 90)) + 1):
        above.axhline(90 * quarter, color="#888888", lw=0.6, ls=":", zorder=0)
    above.set_ylim(low, high)
    above.set_yticks([90 * k for k in range(int(np.ceil(low / 90)), int(np.floor(high / 90)) + 1)])
    above.set_ylabel("heading (deg)")

    e, active = track.evidence["evaluation"], track.evidence["enabled"] > 0
    below.plot(track.t - began, e, color="#bbbbbb", lw=0.8, zorder=1)
    for chosen, colour, label in (
        (active, _ACTIVE, "E, heading corrected"),
        (~active, _IDLE, "E, left alone"),
    ):
        below.plot(track.t[chosen] - began, e[chosen], "o", color=colour, ms=3, label=label)
    threshold = track.meta["params"]["gamma2"]
    below.axhline(threshold, color="#888888", lw=0.8, ls="--", label="threshold")
    below.set_ylim(-0.05, 1.08)
    below.set_ylabel("E")
    label_edges([below], "time walked (s)", "E")
    scenario, number = result.trial.setup.scenario.name, result.trial.number + 1
    what = f"{scenario}: heading, and what {label_of(method)} makes of it, walk {number}"
    head(figure, title or what, [above, below])
    return figure


def heading_figures(results: Sequence[Result], folder: Path) -> None:
    """Every such figure that the run's methods allow, as NAME.png into `folder`; of the first walk."""
    if judging(results[0]) is not None:
        save(evaluation(results[0]), folder / "evaluation.png")
