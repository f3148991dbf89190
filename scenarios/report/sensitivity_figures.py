"""Figures of a sensitivity study: indices with intervals, how they converge, what each factor does."""

from __future__ import annotations

import re
import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from footfall.scenarios.judge.score import unit_of
from footfall.scenarios.report.sensitivity import asked, ranked
from footfall.scenarios.report.style import (
    MORE,
    colours_of,
    entitle,
    head,
    label_edges,
    label_of,
    new_figure,
    new_panels,
    plain_log,
    save,
)
from footfall.scenarios.studies.factors import Factor
from footfall.scenarios.studies.sensitivity import Answer, Found

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FIRST, TOTAL = "#1f6fb4", "#a9cbe6"
_WHISKER: Any = {"color": "#222222", "elinewidth": 1.0, "capsize": 2.5, "fmt": "none"}
_COLOURS = ("#c1440e", "#1f6fb4", "#6a9f3a", *MORE)
_BINS = 12
_COLUMNS = 4  # methods side by side, at most
_WIDE = 26  # characters of a factor's name before it is broken


def draw_indices(found: Found, path: Path) -> None:
    """Bars of the indices, the greatest at the top, and how they converge; of Morris alone mu* and sigma.

    One method has both side by side; of several each has a panel, with the factors in one order.
    """
    methods, count = len(found.answers), len(found.study.factors)
    sobol = found.answers[0].sobol is not None
    tall, columns = 1.0 + 0.42 * count, min(methods, _COLUMNS)
    rows = -(-methods // columns)
    if methods == 1 and sobol:
        figure, grid = new_figure(1, 2, 9.0, tall + 0.6, width_ratios=[1.25, 1.0])
        bars, ways = [grid[0, 0]], [grid[0, 1]]
    else:
        heights = [tall] * rows + [2.4] * rows * sobol
        width = 6.4 if methods == 1 else 2.0 + 2.7 * columns
        figure, grid = new_figure(len(heights), columns, width, sum(heights) + 0.6, height_ratios=heights)
        for axis in [*grid[:rows].flat][methods:] + [*grid[rows:].flat][methods:]:
            figure.delaxes(axis)
        bars, ways = [*grid[:rows].flat][:methods], [*grid[rows:].flat][:methods]
    order = ranked(found)
    names = [_wrapped(found.study.factors[i]) for i in order]
    for place, (axis, one) in enumerate(zip(bars, found.answers, strict=True)):
        draw = _sobol_bars if sobol else _morris_bars
        draw(axis, one, order, found)
        axis.set_yticks(np.arange(count)[::-1], names if place % columns == 0 else [""] * count)
        axis.grid(axis="y", visible=False)
        if methods > 1:
            entitle(axis, label_of(one.method))
    ends = [axis.get_xlim() for axis in bars]
    for axis in bars:  # so that methods can be compared
        axis.set_xlim(min(low for low, _ in ends), max(high for _, high in ends))
    for place, (axis, one) in enumerate(zip(ways, found.answers, strict=bool(ways))):
        _converge(axis, one, order, found)
        axis.set_ylabel("total index" if place % columns == 0 else "")
    head(figure, _title(found), [*bars, *ways])
    save(figure, path)


def _sobol_bars(axis: Axes, one: Answer, order: list[int], found: Found) -> None:
    assert one.sobol is not None
    places = np.arange(len(order))[::-1]
    for group, colour, shift, label in (
        (one.sobol.total, TOTAL, 0.18, "total: alone and with others"),
        (one.sobol.first, FIRST, -0.18, "first order: alone"),
    ):
        shown = [group[i].shown for i in order]
        axis.barh(places + shift, shown, 0.36, color=colour, label=label)
        axis.errorbar(shown, places + shift, xerr=[group[i].half for i in order], **_WHISKER)
    axis.set_xlim(left=min(0.0, *(index.shown - index.half for index in one.sobol.first)))
    axis.set_xlabel("share of the variance (95 %)")


def _morris_bars(axis: Axes, one: Answer, order: list[int], found: Found) -> None:
    assert one.morris is not None
    places = np.arange(len(order))[::-1]
    size = [one.morris[i].mu_star for i in order]
    axis.barh(places, size, 0.6, color=TOTAL, label="mu*: mean size of an effect")
    axis.errorbar(size, places, xerr=[one.morris[i].half for i in order], **_WHISKER)
    spread = [one.morris[i].sigma for i in order]
    axis.plot(spread, places, "D", ms=4, color=_COLOURS[0], label="sigma: how it varies from place to place")
    file = found.study.file
    axis.set_xlabel(f"change of the {'log error' if file.of == 'ratio' else unit_of(file.metric)}")


def _converge(axis: Axes, one: Answer, order: list[int], found: Found) -> None:
    samples = np.array([step.samples for step in one.convergence])
    for place, i in enumerate(order[:6]):
        colour = _COLOURS[place]
        value = np.array([step.total[i].value for step in one.convergence])
        half = np.array([step.total[i].half for step in one.convergence])
        axis.fill_between(samples, value - half, value + half, color=colour, alpha=0.15, lw=0)
        label = textwrap.shorten(found.study.factors[i].name, 34)
        axis.plot(samples, value, "o-", ms=3, lw=1.3, color=colour, label=label)
    axis.set_xscale("log", base=2)
    axis.set_xticks(samples, [str(n) for n in samples])
    axis.set_xlabel("samples N")


def draw_effects(found: Found, path: Path) -> None:
    """The score over each factor, of Sobol's points: median over all others; of one method 10 to 90 %."""
    factors = found.study.factors
    figure, axes = new_panels(len(factors), 2.6, 2.1, sharey=True)
    single = len(found.answers) == 1
    colours = colours_of([one.method for one in found.answers])
    for axis, i in zip(axes, ranked(found), strict=True):
        for one in found.answers:
            colour = FIRST if single else colours[one.method]
            share, scores = found.shares["sobol"][:, i], one.scores["sobol"]
            _effect(axis, factors[i], share, scores, colour, band=single, label=label_of(one.method))
            axis.axhline(one.nominal, color=colour, lw=0.8, ls=":")
        entitle(axis, _wrapped(factors[i], 34, unit=True))
    axes[0].set_yscale("log")
    plain_log(axes[0].yaxis)
    label_edges(axes, "", f"error ({unit_of(found.study.file.metric)})")
    what = "Median and 10th to 90th percentile" if single else "Median"
    title = f"{_title(found)}\n{what} over all other parameters; dotted: with none of them changed"
    head(figure, title, [] if single else axes)
    save(figure, path)


def _effect(
    axis: Axes, factor: Factor, share: np.ndarray, scores: np.ndarray, colour: str, *, band: bool, label: str
) -> None:
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
            axis.set_xticks(ends, [short(value) for value in ends])
            axis.minorticks_off()
    there = np.unique(bins)
    low, middle, high = np.array([np.percentile(scores[bins == b], [10, 50, 90]) for b in there]).T
    if band:
        axis.fill_between(x[there], low, high, color=TOTAL, alpha=0.6, lw=0)
    axis.plot(x[there], middle, "o-", ms=2.5, lw=1.4, color=colour, label=label)


def short(value: float) -> str:
    """Two digits, without an exponent where that is not shorter."""
    return f"{float(f'{value:.2g}'):g}"


def _wrapped(factor: Factor, width: int = _WIDE, *, unit: bool = False) -> str:
    ending = "_" + re.sub(r"\W", "_", factor.unit)
    text = factor.label or factor.address.removesuffix(ending).replace("_", " ").replace(".", ": ", 1)
    told = f" ({factor.unit})" if unit and factor.unit else ""
    return textwrap.fill(text + told, width)


def _title(found: Found) -> str:
    study = found.study
    said = asked(study)
    return f"{study.file.description or study.name}\n{said[0].upper()}{said[1:]}"
