"""The figure of swaying.py: a column for each motion, a row for each stage of HDR."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from footfall.hdr.hdr import HdrParams
from footfall.scenarios.report.style import head, new_figure, save

if TYPE_CHECKING:
    from benchmarks.papers.swaying import Motion

_RAW, _ONCE, _TWICE, _FED, _TRUTH, _HDR = "#aaaaaa", "#c98a00", "#1f6fb4", "#7b4fa3", "#222222", "#c1440e"
_ROWS = (
    ("y (m)", 1.2),
    ("rate of turn (deg/s)", 1.3),
    ("fed back, w (deg/s)", 1.3),
    ("attenuator A", 0.7),
    ("integrator I (deg/s)", 0.9),
    ("heading (deg)", 1.4),
)
_FROM, _MOST = 100, 120  # of a long walk: the first footfall shown, and how many
_SWAY_M, _W_DEG_S, _I_DEG_S = 1.5, 1.0, 0.25  # half heights of panels


def _shown(count: int) -> slice:
    """The whole of a short walk; of a long one some footfalls from which its start is forgotten."""
    return slice(_FROM, _FROM + _MOST) if count > 2 * (_FROM + _MOST) else slice(0, count)


def draw(path: Path, motions: Sequence[Motion]) -> None:
    """Walks with an IMU without error, stage by stage."""
    figure, grid = new_figure(
        len(_ROWS),
        len(motions),
        2.7 * len(motions),
        11.0,
        gridspec_kw={"height_ratios": [height for _, height in _ROWS]},
    )
    theta = np.degrees(HdrParams().theta_w)
    for column, one in zip(grid.T, motions, strict=True):
        found, rows = one.found, _shown(len(one.footfalls))
        number = np.arange(len(one.footfalls))[rows]
        where, raw, fed, attenuator, integrator, heading = column
        place = one.position[rows]
        where.plot(*place[:, :2].T, "-", color=_TRUTH, lw=0.8, marker=".", ms=3)
        where.set_title(one.name, loc="left", fontsize=10)
        where.set_xlabel("x (m)", fontsize=8)
        if np.ptp(place[:, 1]) > 2 * _SWAY_M:
            where.set_aspect("equal", adjustable="datalim")
        else:
            where.set_ylim(-_SWAY_M, _SWAY_M)
        for values, label, colour, width in (
            (found.raw, "raw (Eq. 2)", _RAW, 0.8),
            (found.once, "once filtered (6a)", _ONCE, 1.3),
            (found.twice, "twice filtered (6b)", _TWICE, 1.8),
        ):
            raw.plot(number, np.degrees(values[rows]), color=colour, lw=width, label=label)
        fed.axhspan(-theta, theta, color="#6a9f3a", alpha=0.2, lw=0, label="within theta_w: A > 0")
        fed.plot(number, np.degrees(found.rate[rows]), color=_FED, lw=1.5, label="w = twice filtered + I (9)")
        fed.set_ylim(-_W_DEG_S, _W_DEG_S)
        attenuator.fill_between(number, found.attenuator[rows], color=_TWICE, alpha=0.5, lw=0)
        attenuator.set_ylim(0, 1)
        integrator.plot(number, np.degrees(found.integrator[rows]), color=_FED, lw=1.5)
        integrator.axhline(0, color=_TRUTH, lw=0.8)
        integrator.set_ylim(-_I_DEG_S, _I_DEG_S)
        lagging = found.heading[0] + np.cumsum(found.rate * one.footfalls.interval)
        for values, label, colour, width in (
            (one.truth, "true heading", _TRUTH, 2.6),
            (lagging, "sum of w, not de-lagged", _FED, 1.3),
            (found.heading, "HDR: de-lagged (11)", _HDR, 1.1),
        ):
            heading.plot(number, np.degrees(values[rows]), color=colour, lw=width, label=label)
        heading.set_xlabel("footfall", fontsize=8)
        for axis in (raw, fed, attenuator, integrator):
            axis.sharex(heading)
            axis.tick_params(labelbottom=False)
    for axis, (label, _) in zip(grid[:, 0], _ROWS, strict=True):
        axis.set_ylabel(label, fontsize=8)
    title = "What each stage of HDR makes of straight, curved and turning walks; IMU without error"
    head(figure, title, [*grid[1], *grid[2], *grid[5]])
    save(figure, path)
