"""The figure of hdr_table2.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from footfall.hdr.hdr import HdrParams
from footfall.scenarios.report.style import new_figure, save

_LABELS = ("tuning units", "judged units (hindsight)")
_COLOURS = ("#1f6fb4", "#c98a00")


def draw(
    path: Path,
    i_c: Sequence[float],
    theta_w: Sequence[float],
    maps: Sequence[np.ndarray],
    methods: Mapping[str, np.ndarray],
    in_range: np.ndarray,
) -> None:
    """Two maps of the average error over i_c and theta_w, and every judged unit before and after.

    Parameters
    ----------
    i_c, theta_w : deg/s
    maps : (i_c, theta_w) deg, of tuning and judging
    methods : name -> (c, 2) final and average error (deg); "uncorrected" is one of them
    in_range : (c,) bool, units in the range of the paper's Table 2
    """
    figure, axes = new_figure(1, 3, 13.5, 4.0)
    top = max(2 * min(one.min() for one in maps), 30.0)
    for axis, values, label in zip(axes.flat, maps, _LABELS, strict=False):
        axis.imshow(values, cmap="viridis_r", vmin=0, vmax=top, aspect="auto", origin="lower")
        for (row, column), value in np.ndenumerate(values):
            best = value == values.min()
            colour = "white" if value > 0.55 * top else "black"
            axis.text(
                column, row, f"{value:.0f}", ha="center", va="center", fontsize=8, color=colour,
                fontweight="bold" if best else "normal",
                bbox={"facecolor": "none", "edgecolor": colour, "pad": 2} if best else None,
            )  # fmt: skip
        default = HdrParams()
        at = [
            int(np.argmin(np.abs(np.asarray(values) - value)))
            for values, value in ((theta_w, np.degrees(default.theta_w)), (i_c, np.degrees(default.i_c)))
        ]
        axis.plot(*at, "s", ms=21, mfc="none", mec="#c1440e", mew=1.8)
        axis.set_xticks(range(len(theta_w)), [f"{value:g}" for value in theta_w])
        axis.set_yticks(range(len(i_c)), [f"{value:g}" for value in i_c])
        axis.grid(False)
        axis.set_xlabel("theta_w (deg/s)")
        axis.set_ylabel("i_c (deg/s per footfall)")
        axis.set_title(
            f"Average heading error (deg), {label}\n(red: nearest to the default; frame: smallest)",
            loc="left",
            fontsize=9,
        )
    axis = axes.flat[2]
    before = methods["uncorrected"][:, 1]
    corrected = [name for name in methods if name != "uncorrected"]
    for name, colour in zip(corrected, _COLOURS, strict=False):
        after = methods[name][:, 1]
        axis.plot(
            before[in_range], after[in_range], "o", color=colour, ms=4, label=f"{name}, in Table 2's range"
        )
        axis.plot(
            before[~in_range],
            after[~in_range],
            "o",
            mfc="none",
            color=colour,
            ms=4,
            alpha=0.7,
            label=f"{name}, others",
        )
    limit = axis.get_xlim()[1]
    axis.plot([0, limit], [0, limit], color="#888888", lw=0.9, label="no change")
    axis.set_xlabel("uncorrected average heading error (deg)")
    axis.set_ylabel("with HDR (deg)")
    axis.set_title("Every judged unit", loc="left", fontsize=9)
    axis.legend(fontsize=7, frameon=False)
    save(figure, path)
