"""The figure of gait_realism.py: simulated strides over real ones."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from footfall.pdr.gait.strides import N_PHASE
from footfall.scenarios.report.style import new_figure, save

# Column of the normalised signals -> what it is; degrees for rates.
_PANELS = {
    0: ("roll rate (x, forward)", "angular rate (deg/s)"),
    1: ("pitch rate (y, left)", ""),
    2: ("yaw rate (z, up)", ""),
    4: ("forward (x)", "specific force (m/s²)"),
    5: ("left (y)", ""),
    6: ("up (z)", ""),
}
_RATES = (0, 1, 2)
_EACH, _BAND, _REAL, _SIMULATED = "#8a8a8a", "#cfcfcf", "#333333", "#c1440e"


def draw(path: Path, real: Sequence[np.ndarray], simulated: np.ndarray, title: str) -> None:
    """Mean stride and its band, simulated over real, six signals.

    Parameters
    ----------
    real : (strides, phases, 8) of each recording, `normalised` (rad/s, m/s2)
    simulated : (strides, phases, 8)
    """
    percent = 100 * np.arange(N_PHASE) / N_PHASE
    figure, axes = new_figure(2, 3, 12.0, 6.6, sharex=True)
    for axis, (signal, (name, unit)) in zip(axes.flat, _PANELS.items(), strict=True):
        size = np.degrees(1.0) if signal in _RATES else 1.0
        means = size * np.array([strides[..., signal].mean(axis=0) for strides in real])
        strides = size * simulated[..., signal]
        for values, colour, alpha, label in (
            (means, _BAND, 0.7, f"real: ± 2 SD between {len(real)} recordings"),
            (strides, _SIMULATED, 0.25, "simulated: ± 2 SD between strides"),
        ):
            centre, spread = values.mean(axis=0), 2 * values.std(axis=0, ddof=1)
            low, high = centre - spread, centre + spread
            axis.fill_between(percent, low, high, color=colour, alpha=alpha, lw=0, label=label)
        for number, mean in enumerate(means):
            axis.plot(
                percent, mean, color=_EACH, lw=0.6, label=None if number else "real: each recording's mean"
            )
        axis.plot(percent, means.mean(axis=0), color=_REAL, lw=1.5, label="real: mean")
        axis.plot(percent, strides.mean(axis=0), color=_SIMULATED, lw=1.7, label="simulated: mean")
        axis.set_title(name, loc="left", fontsize=9)
        axis.set_ylabel(unit)
        axis.set_xlim(0, 100)
    for axis in axes[1]:
        axis.set_xlabel("stride (%), heel strike near 0")
    figure.suptitle(title, x=0.012, ha="left", fontsize=10)
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=5, fontsize=8, frameon=False)
    save(figure, path)
