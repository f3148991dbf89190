"""Figures of a run. Matplotlib is imported only when a figure is asked for."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from footfall.scenarios.run import Result
from footfall.scenarios.score import compare
from footfall.tables import replacing

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_TRUTH = "#222222"
_COLOURS = {"pdr": "#c1440e", "hdr": "#1f6fb4", "hdr-basic": "#6a9f3a"}
_MORE = ("#7b4fa3", "#c98a00", "#2a9d8f", "#8d5524")
_LABELS = {"pdr": "PDR", "hdr": "PDR + HDR", "hdr-basic": "PDR + basic HDR"}
_CAUSES = {
    "temperature": "#c1440e",
    "g_sensitivity": "#1f6fb4",
    "flicker": "#6a9f3a",
    "white": "#888888",
    "scale": "#7b4fa3",
    "misalignment": "#c98a00",
}
_STYLE: Any = {
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.alpha": 0.25,
    "legend.frameon": False,
    "figure.dpi": 130,
}


def _colour(name: str, methods: Sequence[str]) -> str:
    known = [method for method in methods if method not in _COLOURS]
    return _COLOURS[name] if name in _COLOURS else _MORE[known.index(name) % len(_MORE)]


def new_figure(
    rows: int, columns: int, width: float, height: float, **kwargs: Any
) -> tuple[Figure, np.ndarray]:
    """A figure in the house's style with (rows, columns) axes, drawn without a screen."""
    import matplotlib as mpl
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    with mpl.rc_context(_STYLE):
        figure = Figure(figsize=(width, height), layout="constrained")
        FigureCanvasAgg(figure)
        axes = figure.subplots(rows, columns, squeeze=False, **kwargs)
    return figure, axes


def save(figure: Figure, path: Path) -> Path:
    """Write as PNG."""
    with replacing(path) as temporary:
        figure.savefig(temporary, format="png", dpi=130)
    return path


def maps(results: Sequence[Result], path: Path) -> Path:
    """Truth and every method's track, one panel a walk (the HDR paper's Figure 8)."""
    columns = min(len(results), 3)
    rows = -(-len(results) // columns)
    figure, axes = new_figure(rows, columns, 3.9 * columns, 3.5 * rows)
    for axis, result in zip(axes.flat, results, strict=False):
        methods = list(result.tracks)
        row = None
        for name, track in result.tracks.items():
            row = compare(track, result.walk)
            axis.plot(*row.estimate.T, color=_colour(name, methods), lw=1.1, label=_LABELS.get(name, name))
            axis.plot(*row.estimate[-1], "o", color=_colour(name, methods), ms=4)
        assert row is not None
        axis.plot(*row.truth.T, color=_TRUTH, lw=2.2, alpha=0.45, label="truth", zorder=1)
        axis.plot(*row.truth[0], "^", color=_TRUTH, ms=6)
        axis.set_aspect("equal", adjustable="datalim")
        axis.set_title(f"Walk {result.task.number + 1}, unit {result.task.unit_seed}", loc="left", fontsize=9)
        axis.set_xlabel("x (m)")
        axis.set_ylabel("y (m)")
    axes.flat[0].legend(fontsize=8, loc="best")
    for axis in list(axes.flat)[len(results) :]:
        axis.set_visible(False)
    return save(figure, path)


def heading_errors(results: Sequence[Result], path: Path) -> Path:
    """Heading error against time, one panel a method, one line a walk."""
    methods = list(results[0].tracks)
    figure, axes = new_figure(1, len(methods), 4.6 * len(methods), 3.2)
    for axis, name in zip(axes.flat, methods, strict=True):
        for shade, result in enumerate(results):
            row = compare(result.tracks[name], result.walk)
            alpha = 1 - 0.6 * shade / max(len(results), 2)
            axis.plot(
                (row.t - row.t[0]) / 60,
                np.degrees(row.heading_error),
                color=_colour(name, methods),
                alpha=alpha,
                lw=1.2,
            )
            axis.annotate(
                f"{result.task.number + 1}",
                ((row.t[-1] - row.t[0]) / 60, np.degrees(row.heading_error[-1])),
                xytext=(3, -3),
                textcoords="offset points",
                fontsize=8,
            )
        axis.axhline(0, color=_TRUTH, lw=0.8)
        axis.set_title(f"{_LABELS.get(name, name)} (numbers: walks)", loc="left", fontsize=9)
        axis.set_xlabel("time walked (min)")
        axis.set_ylabel("heading error, estimate - truth (deg)")
    return save(figure, path)


def filtered_rates(result: Result, path: Path, method: str = "hdr", count: int = 35) -> Path:
    """Raw, once and twice filtered rate of 35 footfalls on the straightest stretch (the paper's Figure 3)."""
    evidence = result.tracks[method].evidence
    turning = np.abs(np.degrees(evidence["rate_twice"]))
    worst = np.lib.stride_tricks.sliding_window_view(turning[40:], count).max(axis=1)
    start = 40 + int(np.argmin(worst))
    rows = slice(start, start + count)
    number = np.arange(1, count + 1)
    figure, axes = new_figure(1, 1, 6.4, 3.2)
    axis = axes[0, 0]
    for key, label, colour, width in (
        ("raw_rate", "raw", "#999999", 0.9),
        ("rate_once", "once filtered", "#c98a00", 1.4),
        ("rate_twice", "twice filtered", "#1f6fb4", 2.0),
    ):
        axis.plot(number, np.degrees(evidence[key][rows]), color=colour, lw=width, label=label)
    axis.axhline(0, color=_TRUTH, lw=0.8)
    axis.set_xlabel(f"footfall (from number {start} of walk {result.task.number + 1})")
    axis.set_ylabel("rate of turn (deg/s)")
    axis.legend(ncols=3, loc="upper right", fontsize=8)
    return save(figure, path)


def _smooth(values: np.ndarray, strides: int = 25) -> np.ndarray:
    """Running mean that keeps its length: shorter at the ends."""
    kernel = np.ones(min(strides, len(values)))
    return np.convolve(values, kernel, "same") / np.convolve(np.ones(len(values)), kernel, "same")


def controller(results: Sequence[Result], path: Path, method: str = "hdr") -> Path:
    """The controller's -I beside the true drift, which the paper could not know."""
    figure, axes = new_figure(len(results), 1, 7.0, 1.75 * len(results) + 0.4, sharex=True)
    for axis, result in zip(axes.flat, results, strict=True):
        track, budget = result.tracks[method], result.budget
        began = track.t[0]
        drift = np.degrees(budget.total)
        axis.plot(
            (budget.t - began) / 60, _smooth(drift), color=_TRUTH, lw=1.6, alpha=0.55, label="true drift"
        )
        axis.plot(
            (track.t - began) / 60,
            -np.degrees(track.evidence["integrator"]),
            color=_COLOURS["hdr"],
            lw=1.2,
            label="-I of HDR",
        )
        idle = track.evidence["attenuator"] <= 0
        low, high = axis.get_ylim()
        axis.fill_between(
            (track.t - began) / 60, low, high, where=idle, color="#bbbbbb", alpha=0.35, lw=0, label="A = 0"
        )
        axis.set_ylim(low, high)
        axis.set_title(f"Walk {result.task.number + 1}, unit {result.task.unit_seed}", loc="left", fontsize=9)
        axis.set_ylabel("deg/s")
    axes.flat[0].legend(ncols=3, fontsize=8, loc="best")
    axes.flat[-1].set_xlabel("time walked (min)")
    return save(figure, path)


def drift_budget(results: Sequence[Result], path: Path) -> Path:
    """Heading error by cause as it accumulates, one panel a walk; causes below 2 deg at the end are pooled."""
    columns = min(len(results), 3)
    rows = -(-len(results) // columns)
    figure, axes = new_figure(rows, columns, 3.7 * columns, 3.0 * rows, sharex=True)
    for axis, result in zip(axes.flat, results, strict=False):
        budget = result.budget
        minutes = (budget.t - (budget.t[0] - budget.interval[0])) / 60
        heading = {
            cause: np.degrees(np.cumsum(rate * budget.interval)) for cause, rate in budget.causes.items()
        }
        shown = {cause for cause, value in heading.items() if np.abs(value).max() >= 2.0}
        rest = np.sum([value for cause, value in heading.items() if cause not in shown], axis=0)
        for i, cause in enumerate(sorted(shown, key=lambda cause: -abs(heading[cause][-1]))):
            colour = _CAUSES.get(cause, _MORE[i % len(_MORE)])
            axis.plot(minutes, heading[cause], color=colour, lw=1.2, label=cause.replace("_", " "))
        if np.ndim(rest):
            axis.plot(minutes, rest, color="#bbbbbb", lw=1.0, label="all others")
        total = np.degrees(np.cumsum(budget.total * budget.interval))
        axis.plot(minutes, total, color=_TRUTH, lw=1.8, label="sum")
        axis.axhline(0, color=_TRUTH, lw=0.6)
        axis.set_title(f"Walk {result.task.number + 1}, unit {result.task.unit_seed}", loc="left", fontsize=9)
        axis.legend(fontsize=7, loc="best")
        axis.set_xlabel("time walked (min)")
        axis.set_ylabel("heading error by cause (deg)")
    for axis in list(axes.flat)[len(results) :]:
        axis.set_visible(False)
    return save(figure, path)


def run_figures(results: Sequence[Result], folder: Path) -> list[Path]:
    """Every figure of a run, into `folder`."""
    written = [
        maps(results, folder / "maps.png"),
        heading_errors(results, folder / "heading_error.png"),
        drift_budget(results, folder / "drift_budget.png"),
    ]
    if "hdr" in results[0].tracks:
        written.append(filtered_rates(results[0], folder / "filtered_rates.png"))
        written.append(controller(results, folder / "controller.png"))
    return written
