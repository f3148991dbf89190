"""Which shape of walk suits which method?"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks._page import Sheet
from benchmarks.studies._results import AVERAGE, FINAL, Results, figure, quantiles
from footfall.scenarios.report.style import entitle, head, new_figure, save

# What each is a correction of: the same navigation without it.
BASES = dict.fromkeys(("pdr", "hdr", "hdr-basic", "hde-2010"), "pdr") | dict.fromkeys(
    ("iez", "hdr-filter", "hde", "ihde", "ihde-learned", "ihde-jimenez", "ihde-plus"), "iez"
)
_BASE, _BY_RATE, _BY_DIRECTION = "#c1440e", "#1f6fb4", "#6a9f3a"


def sheets(results: Results) -> list[Sheet]:
    """Median and 90th percentile by method and shape; how often a method is worse than none."""
    shapes = results.shapes
    found = []
    for name, score, title in (("average", AVERAGE, "Average"), ("final", FINAL, "Final")):
        sheet = Sheet(name, f"{title} heading error, median / p90 (deg)", ["method", *shapes])
        for method in BASES:
            mine = [results.where(scenario=shape, method=method) for shape in shapes]
            cells = [" / ".join(figure(x) for x in quantiles(rows.score(score))) for rows in mine]
            sheet.rows.append([f"`{method}`", *cells])
        found.append(sheet)
    worse = Sheet(
        "worse", "Worse than the same navigation without the correction (% of cases)", ["method", *shapes]
    )
    for method, base in BASES.items():
        if method != base:
            rows = [
                (results.where(scenario=s, method=method), results.where(scenario=s, method=base))
                for s in shapes
            ]
            both = [mine.beside(theirs) for mine, theirs in rows]
            worse.rows.append([f"`{method}`", *(f"{100 * np.mean(b[:, 0] > b[:, 1]):.0f}" for b in both)])
    return [*found, worse]


def draw(results: Results, path: Path) -> None:
    """Median and 90th percentile of every method on every shape."""
    shapes = results.shapes
    image, grid = new_figure(1, len(shapes), 2.05 * len(shapes), 3.6, sharex=True, sharey=True)
    places = np.arange(len(BASES))[::-1]
    for axis, shape in zip(grid[0], shapes, strict=True):
        for place, method in zip(places, BASES, strict=True):
            middle, high = quantiles(results.where(scenario=shape, method=method).score())
            by_direction = "hde" in method
            colour = _BASE if BASES[method] == method else _BY_DIRECTION if by_direction else _BY_RATE
            word = "uncorrected" if colour == _BASE else "by direction" if by_direction else "by rate of turn"
            axis.plot([middle, high], [place, place], color=colour, lw=1.6, alpha=0.5)
            axis.plot(middle, place, "o", ms=5, color=colour, label=f"{word}; line: to the 90th percentile")
        axis.set(xscale="log", xlabel="average error (deg)")
        axis.set_yticks(places, list(BASES))
        entitle(axis, shape)
    head(image, "Average heading error, median of all cases", list(grid[0]))
    save(image, path)
