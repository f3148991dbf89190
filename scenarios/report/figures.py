"""Figures of a run."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from footfall.scenarios.judge.score import compare
from footfall.scenarios.judge.statistics import running_mean
from footfall.scenarios.report.style import (
    COLOURS,
    MORE,
    TRUTH,
    colours_of,
    entitle,
    head,
    label_edges,
    label_of,
    new_panels,
    save,
    widths_of,
)
from footfall.scenarios.run import Result

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MOST_PANELS = 8  # walks beyond these are in the tables, not in the figures
_CAUSES = {
    "temperature": "#c1440e",
    "g_sensitivity": "#1f6fb4",
    "flicker": "#6a9f3a",
    "white": "#444f9b",
    "scale": "#7b4fa3",
    "misalignment": "#e3a700",
    "non_linearity": "#d16ba5",
    "rate_random_walk": "#2a9d8f",
    "g2": "#8d5524",
}
_WALKS = ("#1f6fb4", "#c1440e", "#6a9f3a", "#7b4fa3", "#e3a700", "#8d5524", "#2a9d8f", "#d16ba5")
_DASHES = ("-", "--", "-.", ":")  # lines are told apart by these too, in print without colours
_SHOWN_SHARE = 0.03  # of the largest cause; smaller ones are pooled


def _walk(result: Result) -> str:
    return f"Walk {result.trial.number + 1}, unit {result.trial.unit_seed}"


def _named(results: Sequence[Result], what: str) -> str:
    return f"{results[0].trial.setup.scenario.name}: {what}"


def maps(results: Sequence[Result], title: str | None = None) -> Figure:
    """Truth and every method's track, one panel a walk (the HDR paper's Figure 8)."""
    figure, axes = new_panels(len(results), 3.7, 3.3)
    for axis, result in zip(axes, results, strict=True):
        colours, widths = colours_of(list(result.tracks)), widths_of(list(result.tracks))
        for name, track in result.tracks.items():
            row = compare(track, result.walk)
            axis.plot(*row.estimate.T, color=colours[name], lw=widths[name], label=label_of(name))
            axis.plot(*row.estimate[-1], "o", color=colours[name], ms=4)
        truth = result.walk.footfalls.position[:, :2]
        axis.plot(*truth.T, color=TRUTH, lw=2.2, alpha=0.45, label="truth", zorder=1)
        axis.plot(*truth[0], "^", color=TRUTH, ms=6, ls="", label="start")
        axis.set_aspect("equal", adjustable="datalim")
        entitle(axis, _walk(result))
    if len({result.trial.setup.scenario.name for result in results}) == 1:
        _one_scale(axes)
    label_edges(axes, "x (m)", "y (m)")
    head(figure, title or _named(results, "tracks"), axes)
    return figure


def _one_scale(axes: Sequence[Axes]) -> None:
    """The same metres in every panel, so that errors are compared by eye."""
    low, high = (np.array([axis.dataLim.get_points()[end] for axis in axes]) for end in (0, 1))
    low, high = low.min(axis=0), high.max(axis=0)
    margin = 0.04 * float((high - low).max())
    for axis in axes:
        axis.set_xlim(low[0] - margin, high[0] + margin)
        axis.set_ylim(low[1] - margin, high[1] + margin)
        axis.set_aspect("equal", adjustable="box")


def heading_errors(results: Sequence[Result]) -> Figure:
    """Heading error against time, one panel a method, one line a walk."""
    methods = list(results[0].tracks)
    figure, axes = new_panels(len(methods), 4.4, 3.0)
    for axis, name in zip(axes, methods, strict=True):
        ends = []
        for i, result in enumerate(results):
            row = compare(result.tracks[name], result.walk)
            minutes, error = (row.t - row.t[0]) / 60, np.degrees(row.heading_error)
            axis.plot(minutes, error, _DASHES[i % len(_DASHES)], color=_WALKS[i % len(_WALKS)], lw=1.2)
            ends.append((float(minutes[-1]), float(error[-1])))
        axis.axhline(0, color=TRUTH, lw=0.8)
        if len(results) > 1:
            _number(axis, ends, [result.trial.number + 1 for result in results])
        entitle(axis, label_of(name))
    label_edges(axes, "time walked (min)", "heading error (deg)")
    numbers = " (numbers: walks)" if len(results) > 1 else ""
    head(figure, _named(results, f"heading error, estimate - truth{numbers}"), axes)
    return figure


def _number(axis: Axes, ends: Sequence[tuple[float, float]], numbers: Sequence[int]) -> None:
    """Number lines at their ends, in a column to the right in which no number hides another."""
    low, high = axis.get_ylim()
    right = max(x for x, _ in ends)
    order = np.argsort([y for _, y in ends])
    places = spread_out(np.array([ends[i][1] for i in order]), 0.055 * (high - low))
    for i, place in zip(order, places, strict=True):
        axis.annotate(
            f"{numbers[i]}",
            ends[i],
            xytext=(1.035 * right, place),
            va="center",
            fontsize=7.5,
            arrowprops={"arrowstyle": "-", "lw": 0.4, "color": "#888888", "shrinkA": 1, "shrinkB": 1},
        )


def spread_out(values: np.ndarray, gap: float) -> np.ndarray:
    """Rising (n,) values moved apart to at least `gap`, each as little as its neighbours allow."""
    level = values - gap * np.arange(len(values))
    groups: list[list[float]] = []
    for value in level:
        groups.append([float(value)])
        # Neighbours that came too close move together, to the mean of where they want to be.
        while len(groups) > 1 and np.mean(groups[-2]) > np.mean(groups[-1]):
            groups[-2:] = [groups[-2] + groups[-1]]
    return np.concatenate([np.full(len(group), np.mean(group)) for group in groups]) + gap * np.arange(
        len(values)
    )


def drift_budget(results: Sequence[Result]) -> Figure:
    """Heading error by cause as it accumulates, one panel a walk; small causes are pooled."""
    figure, axes = new_panels(len(results), 3.6, 2.8, sharex=True)
    headings = [
        {cause: np.degrees(np.cumsum(rate * r.budget.interval)) for cause, rate in r.budget.causes.items()}
        for r in results
    ]
    peak = {cause: max(np.abs(heading[cause]).max() for heading in headings) for cause in headings[0]}
    ranked = sorted(peak, key=lambda cause: -peak[cause])
    shown = [cause for cause in ranked if peak[cause] > _SHOWN_SHARE * peak[ranked[0]]]
    colours = {cause: _CAUSES.get(cause, MORE[i % len(MORE)]) for i, cause in enumerate(shown)}
    for axis, result, heading in zip(axes, results, headings, strict=True):
        budget = result.budget
        minutes = (budget.t - (budget.t[0] - budget.interval[0])) / 60
        for i, cause in enumerate(shown):
            dashes, label = _DASHES[i % len(_DASHES)], cause.replace("_", " ")
            axis.plot(minutes, heading[cause], dashes, color=colours[cause], lw=1.4, label=label)
        pooled = sum(value for cause, value in heading.items() if cause not in shown)
        if np.any(pooled):
            axis.plot(minutes, pooled, color="#bbbbbb", lw=1.0, label="all others")
        total = np.degrees(np.cumsum(budget.total * budget.interval))
        axis.plot(minutes, total, color=TRUTH, lw=1.8, label="sum")
        axis.axhline(0, color=TRUTH, lw=0.6)
        entitle(axis, _walk(result))
    label_edges(axes, "time walked (min)", "heading error (deg)")
    head(figure, _named(results, "uncorrected heading error by cause"), axes)
    return figure


def filtered_rates(results: Sequence[Result], method: str = "hdr", count: int = 35) -> Figure:
    """Raw, once and twice filtered rate of the first walk's straightest footfalls (the paper's Figure 3)."""
    evidence = results[0].tracks[method].evidence
    turning = np.abs(evidence["rate_twice"])
    count = min(count, len(turning))
    settled = min(40, len(turning) - count)  # the filters take a while to forget that they began at rest
    worst = np.lib.stride_tricks.sliding_window_view(turning[settled:], count).max(axis=1)
    start = settled + int(np.argmin(worst))
    number = np.arange(start, start + count)
    figure, axes = new_panels(2, 6.4, 2.3, columns=1, sharex=True)
    lines = (
        ("raw_rate", "raw", "#999999", 0.9),
        ("rate_once", "once filtered", "#c98a00", 1.4),
        ("rate_twice", "twice filtered", "#1f6fb4", 2.0),
    )
    # What HDR judges is small beside the swaying that the filters take away: it has a scale of its own.
    for axis, chosen, name in zip(
        axes, (lines, lines[-1:]), ("all three", "the twice filtered alone, which HDR judges"), strict=True
    ):
        for key, label, colour, width in chosen:
            axis.plot(number, np.degrees(evidence[key][number]), color=colour, lw=width, label=label)
        axis.axhline(0, color=TRUTH, lw=0.8)
        entitle(axis, name)
    label_edges(axes, "footfall", "rate (deg/s)")
    title = f"rate of turn over the straightest {count} footfalls of walk {results[0].trial.number + 1}"
    head(figure, _named(results, title), axes)
    return figure


def controller(results: Sequence[Result], method: str = "hdr") -> Figure:
    """The controller's -I beside the true drift, which the paper could not know."""
    figure, axes = new_panels(
        len(results),
        7.0 if len(results) < 5 else 5.2,
        1.7,
        columns=1 if len(results) < 5 else 2,
        sharex=True,
    )
    for axis, result in zip(axes, results, strict=True):
        track, budget = result.tracks[method], result.budget
        began = track.t[0]
        drift = running_mean(np.degrees(budget.total))
        axis.plot((budget.t - began) / 60, drift, color=TRUTH, lw=1.6, alpha=0.55, label="true drift")
        minutes = (track.t - began) / 60
        integrator = -np.degrees(track.evidence["integrator"])
        axis.plot(minutes, integrator, color=COLOURS["hdr"], lw=1.2, label="what HDR takes off (-I)")
        idle = track.evidence["attenuator"] <= 0
        limits = axis.get_ylim()
        axis.fill_between(
            minutes, *limits, where=idle, color="#bbbbbb", alpha=0.35, lw=0, label="HDR rests (A = 0)"
        )
        axis.set_ylim(limits)
        entitle(axis, _walk(result))
    label_edges(axes, "time walked (min)", "drift (deg/s)")
    head(figure, _named(results, "what HDR takes for drift, and the true drift (mean of 25 strides)"), axes)
    return figure


_ALWAYS: dict[str, Callable[[Sequence[Result]], Figure]] = {
    "maps": maps,
    "heading_error": heading_errors,
    "drift_budget": drift_budget,
}
_WITH_HDR: dict[str, Callable[[Sequence[Result]], Figure]] = {
    "filtered_rates": filtered_rates,
    "controller": controller,
}
FIGURES = (*_ALWAYS, *_WITH_HDR)


def run_figures(results: Sequence[Result], folder: Path) -> None:
    """Every figure of a run that its methods allow, as NAME.png into `folder`; of its first eight walks."""
    shown = results[:_MOST_PANELS]
    for name, draw in (_ALWAYS | (_WITH_HDR if "hdr" in results[0].tracks else {})).items():
        save(draw(shown), folder / f"{name}.png")
