"""Figures of a sensitivity study: indices with intervals, how they converge, what each factor does."""

from __future__ import annotations

import re
import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from footfall.scenarios.judge.gate import unit_of
from footfall.scenarios.report.sensitivity import asked, order_of
from footfall.scenarios.report.style import MORE, entitle, label_edges, new_figure, new_panels, save
from footfall.scenarios.studies.factors import Factor
from footfall.scenarios.studies.sensitivity import Found, Points

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FIRST, TOTAL, FAINT = "#1f6fb4", "#a9cbe6", "#9a9a9a"
_COLOURS = ("#c1440e", "#1f6fb4", "#6a9f3a", *MORE)
_BINS = 12
_WIDE = 26  # characters of a factor's name before it is broken


def draw_indices(found: Found, path: Path) -> None:
    """Bars of the indices, the greatest at the top, and their way there; of Morris alone mu* and sigma."""
    if found.sobol is None:
        _draw_morris(found, path)
        return
    count = len(found.study.factors)
    figure, axes = new_figure(1, 2, 9.0, 1.6 + 0.42 * count, width_ratios=[1.25, 1.0])
    bars, way = axes[0]
    order = order_of(found.sobol.total)
    places = np.arange(count)[::-1]
    first, total = ([group[i] for i in order] for group in (found.sobol.first, found.sobol.total))
    whisker: Any = {"color": "#222222", "elinewidth": 1.0, "capsize": 2.5, "fmt": "none"}
    for indices, colour, shift, label in (
        (total, TOTAL, 0.18, "total: alone and with others"),
        (first, FIRST, -0.18, "first order: alone"),
    ):
        shown = [index.shown for index in indices]
        bars.barh(places + shift, shown, 0.36, color=colour, label=label)
        bars.errorbar(shown, places + shift, xerr=[index.half for index in indices], **whisker)
    bars.set_yticks(places, [_wrapped(found.study.factors[i]) for i in order])
    bars.grid(axis="y", visible=False)
    bars.set_xlim(left=min(0.0, *(index.shown - index.half for index in first)))
    bars.set_xlabel("share of the variance, with 95 % intervals")
    bars.legend(loc="lower right", frameon=False, fontsize=8)
    _converge(way, found, order)
    figure.suptitle(_title(found), x=0.01, ha="left", fontsize=10)
    save(figure, path)


def _converge(axis: Axes, found: Found, order: list[int]) -> None:
    samples = np.array([step.samples for step in found.convergence])
    for place, i in enumerate(order[:6]):
        colour = _COLOURS[place]
        value = np.array([step.total[i].value for step in found.convergence])
        half = np.array([step.total[i].half for step in found.convergence])
        axis.fill_between(samples, value - half, value + half, color=colour, alpha=0.15, lw=0)
        label = found.study.factors[i].name
        axis.plot(samples, value, "o-", ms=3, lw=1.3, color=colour, label=textwrap.shorten(label, 34))
    axis.set_xscale("log", base=2)
    axis.set_xticks(samples, [str(n) for n in samples])
    axis.set_xlabel("samples N")
    axis.set_ylabel("total index")
    axis.legend(framealpha=0.8, edgecolor="none", fontsize=7, loc="upper right")


def _draw_morris(found: Found, path: Path) -> None:
    assert found.morris is not None
    count = len(found.study.factors)
    figure, axes = new_figure(1, 1, 6.4, 1.4 + 0.36 * count)
    axis = axes[0, 0]
    order = sorted(range(count), key=lambda i: -found.morris[i].mu_star)  # type: ignore[index]
    places = np.arange(count)[::-1]
    size = [found.morris[i].mu_star for i in order]
    axis.barh(places, size, 0.6, color=TOTAL, label="mu*: mean size of an effect")
    halves = [found.morris[i].half for i in order]
    axis.errorbar(size, places, xerr=halves, color="#222222", elinewidth=1, capsize=2.5, fmt="none")
    spread = [found.morris[i].sigma for i in order]
    axis.plot(spread, places, "D", ms=4, color=_COLOURS[0], label="sigma: how it varies from place to place")
    axis.set_yticks(places, [_wrapped(found.study.factors[i]) for i in order])
    axis.grid(axis="y", visible=False)
    what = "logarithm of the error" if found.study.file.of == "ratio" else unit_of(found.study.file.metric)
    axis.set_xlabel(f"change of the {what} over the whole range")
    axis.legend(frameon=False, fontsize=8, loc="lower right")
    figure.suptitle(_title(found), x=0.01, ha="left", fontsize=10)
    save(figure, path)


def draw_effects(found: Found, path: Path) -> None:
    """The score over each factor: median and 10th to 90th percentile over all the others."""
    points = found.points[-1]
    factors = found.study.factors
    figure, axes = new_panels(len(factors), 2.6, 2.1, sharey=True)
    order = range(len(factors)) if found.sobol is None else order_of(found.sobol.total)
    for axis, i in zip(axes, order, strict=True):
        _effect(axis, factors[i], points, i)
        entitle(axis, _wrapped(factors[i], 34, unit=True))
        axis.axhline(found.nominal, color="#222222", lw=0.8, ls=":")
    plain_log(axes[0])
    label_edges(axes, "", f"error ({unit_of(found.study.file.metric)})")
    title = f"{_title(found)}\nMedian and 10th to 90th percentile over all other parameters; dotted: as it is"
    figure.suptitle(title, x=0.01, ha="left", fontsize=9)
    save(figure, path)


def _effect(axis: Axes, factor: Factor, points: Points, i: int) -> None:
    share, scores = points.shares[:, i], points.scores
    if factor.values is not None:
        bins = np.minimum((share * len(factor.values)).astype(int), len(factor.values) - 1)
        x: Any = np.arange(len(factor.values))
        axis.set_xticks(x, [str(value) for value in factor.values])
    else:
        bins = np.minimum((share * _BINS).astype(int), _BINS - 1)
        x = factor.at((np.arange(_BINS) + 0.5) / _BINS)
        if factor.log:
            axis.set_xscale("log")
            ends = factor.at(np.array([0.0, 0.5, 1.0]))
            axis.set_xticks(ends, [f"{value:.2g}" for value in ends])
            axis.minorticks_off()
    there = np.unique(bins)
    low, middle, high = np.array([np.percentile(scores[bins == b], [10, 50, 90]) for b in there]).T
    axis.fill_between(x[there], low, high, color=TOTAL, alpha=0.6, lw=0)
    axis.plot(x[there], middle, "o-", ms=2.5, lw=1.4, color=FIRST)


def plain_log(axis: Axes) -> None:
    """A logarithmic y axis whose ticks are plain numbers."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axis.set_yscale("log")
    axis.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.yaxis.set_minor_formatter(NullFormatter())


def _wrapped(factor: Factor, width: int = _WIDE, *, unit: bool = False) -> str:
    ending = "_" + re.sub(r"\W", "_", factor.unit)
    text = factor.label or factor.address.removesuffix(ending).replace("_", " ").replace(".", ": ", 1)
    told = f" ({factor.unit})" if unit and factor.unit else ""
    return textwrap.fill(text + told, width)


def _title(found: Found) -> str:
    study = found.study
    said = asked(study)
    return f"{study.file.description or study.name}\n{said[0].upper()}{said[1:]}"
