"""A map of a method's error: a coarse table, a document, and the figure."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from rich.console import RenderableType
from rich.text import Text

from footfall.late import late
from footfall.scenarios.judge.score import unit_of
from footfall.scenarios.parameters import Documents
from footfall.scenarios.report.sensitivity import WORDS, finite_or_none
from footfall.scenarios.report.sensitivity_figures import short
from footfall.scenarios.report.style import label_of, new_figure, save
from footfall.scenarios.report.tables import new_table, titled
from footfall.scenarios.studies.map import ErrorMap
from footfall.simulate.plan import versions

ndimage = late("scipy.ndimage")

FORMAT = "footfall map 1"
_SHOWN = 8  # values of each parameter in the table


def map_report(found: ErrorMap, metric: str, over: str, scenario: str) -> list[RenderableType]:
    """What `footfall map` prints for people."""
    table = new_table(f"{found.y.address} \\ {found.x.address}", *(f"{v:.3g}" for v in _thin(found.xs)))
    for y, row in zip(_thin(found.ys), _thin(found.scores), strict=True):
        table.add_row(f"{y:.3g}", *(f"{value:.3g}" for value in _thin(row)))
    title = f"{_title(found, metric, over, scenario)} ({unit_of(metric)})"
    told = [_place(name, found, place) for name, place in (("best", found.best), ("default", found.default))]
    told += [f"{len(found.lost)} cases came to no end: {found.lost[0]}"] if found.lost else []
    return [titled(title, table), Text("\n".join(told))]


def _place(name: str, found: ErrorMap, place: tuple[float, float, float]) -> str:
    x, y, score = place
    return f"{name}: {score:.3g} at {found.x.address} = {x:.4g}, {found.y.address} = {y:.4g}"


def _title(found: ErrorMap, metric: str, over: str, scenario: str) -> str:
    said = f"{WORDS[metric]} of {label_of(found.method)} on {scenario}, {over} over {found.cases} units"
    return said[0].upper() + said[1:]


def _thin(values: np.ndarray) -> np.ndarray:
    rows = np.unique(np.linspace(0, len(values) - 1, min(_SHOWN, len(values))).round().astype(int))
    return np.asarray(values[rows])


def map_document(found: ErrorMap, metric: str, over: str, base: Documents) -> dict[str, Any]:
    """The document of `map --json` (docs/sensitivity.md)."""
    return {
        "format": FORMAT,
        "versions": versions(),
        "scenario": base.scenario.name,
        "imu": base.sheet.name,
        "method": found.method,
        "metric": metric,
        "over": over,
        "cases": found.cases,
        "x": {"address": found.x.address, "values": found.xs.tolist()},
        "y": {"address": found.y.address, "values": found.ys.tolist()},
        "scores": [[finite_or_none(value) for value in row] for row in found.scores.tolist()],
        "best": list(found.best),
        "default": [finite_or_none(value) for value in found.default],
        "lost": list(found.lost),
    }


def draw_map(found: ErrorMap, metric: str, over: str, scenario: str, path: Path) -> None:
    """Colours by the score on a logarithmic scale, lines of equal score, default and best."""
    from matplotlib.colors import LogNorm

    figure, axes = new_figure(1, 1, 6.2, 4.8)
    axis = axes[0, 0]
    scores = np.maximum(found.scores, 1e-3)
    finite = scores[np.isfinite(scores)]
    low, high = float(finite.min()), float(np.percentile(finite, 98))
    high = max(high, low * 1.05)
    mesh = axis.pcolormesh(
        found.xs,
        found.ys,
        scores,
        norm=LogNorm(low, high),
        cmap="viridis_r",
        shading="nearest",
        rasterized=True,
    )
    levels = _levels(low, high)
    if levels:
        # Chance makes islands of single pairs: the lines are of the map smoothed by one step.
        smooth = np.exp(ndimage.gaussian_filter(np.log(np.minimum(scores, high)), 1.0))
        lines = axis.contour(found.xs, found.ys, smooth, levels, colors="white", linewidths=0.8)
        axis.clabel(lines, fmt="%g", fontsize=7)
    for place, marker, label in ((found.default, "o", "default"), (found.best, "*", "smallest")):
        axis.plot(
            *place[:2], marker, ms=11 if marker == "*" else 8, mfc="white", mec="#222222", ls="",
            label=f"{label}: {place[2]:.3g} {unit_of(metric)}",
        )  # fmt: skip
    for factor, scale, name, ticks in (
        (found.x, axis.set_xscale, axis.set_xlabel, axis.set_xticks),
        (found.y, axis.set_yscale, axis.set_ylabel, axis.set_yticks),
    ):
        scale("log" if factor.log else "linear")
        name(factor.address)
        if factor.log:
            at = factor.at(np.linspace(0, 1, 5))
            ticks(at, [short(value) for value in at])
    axis.minorticks_off()
    axis.grid(visible=False)
    bar = figure.colorbar(mesh, ax=axis, extend="max")
    bar.set_ticks(levels, labels=[f"{value:g}" for value in levels])
    bar.ax.minorticks_off()
    bar.set_label(f"{WORDS[metric]} ({unit_of(metric)})")
    axis.legend(loc="upper right", fontsize=8, framealpha=0.85, edgecolor="none")
    figure.suptitle(_title(found, metric, over, scenario), x=0.01, ha="left", fontsize=10)
    save(figure, path)


def _levels(low: float, high: float) -> list[float]:
    """Round values between, about five of them."""
    fine = [m * 10.0**e for e in range(-3, 5) for m in (1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9)]
    inside = [level for level in fine if low < level < high]
    step = -(-len(inside) // 6) or 1
    return inside[::step]
