"""The map of a path that was fitted to points."""

from __future__ import annotations

import math
from pathlib import Path as File

import numpy as np

from footfall.scenarios.path import plan
from footfall.scenarios.report.style import COLOURS, TRUTH, head, label_edges, new_panels, save
from footfall.scenarios.waypoints.scenario import Traced, told

_KINDS = (("straight", TRUTH), ("turn to the left", COLOURS["hdr"]), ("turn to the right", COLOURS["pdr"]))


def draw_path(traced: Traced, title: str, file: File) -> None:
    """Points and path, its turns in colours, start, end and north; equal scales."""
    figure, (axis,) = new_panels(1, 6.4, 5.0)
    axis.plot(*traced.points.T, "o", color="#bbbbbb", ms=3.5, label="points", zorder=1)
    pieces = traced.path.pieces
    kinds = np.where(pieces.curvature == 0, 0, np.where(pieces.curvature > 0, 1, 2))
    for kind, (label, colour) in enumerate(_KINDS):
        for i in np.flatnonzero(kinds == kind):
            s = pieces.start[i] + np.linspace(0, pieces.length[i], 2 if kind == 0 else 33)
            x, y, *_ = plan(pieces, np.minimum(s, pieces.total))
            axis.plot(x, y, color=colour, lw=1.8, label=label, solid_capstyle="round", zorder=2)
    x, y, *_ = plan(pieces, np.array([0.0, pieces.total]))
    axis.plot(x[0], y[0], "^", color=TRUTH, ms=8, ls="", label="start")
    axis.plot(x[1], y[1], "s", color=TRUTH, ms=6, ls="", mfc="white", label="end", zorder=3)
    north = traced.east + math.pi / 2
    axis.annotate(
        "N",
        xy=(0.95 - 0.045 * math.cos(north), 0.93 - 0.06 * math.sin(north)),
        xytext=(0.95 + 0.045 * math.cos(north), 0.93 + 0.06 * math.sin(north)),
        xycoords="axes fraction",
        textcoords="axes fraction",
        arrowprops={"arrowstyle": "<-", "color": TRUTH},
        ha="center",
        va="center",
    )
    axis.set_aspect("equal", adjustable="datalim")
    label_edges([axis], "x (m)", "y (m)")
    head(figure, f"{title}: {told(traced)}", [axis])
    save(figure, file)
