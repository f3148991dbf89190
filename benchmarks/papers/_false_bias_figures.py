"""The figures of iez_false_bias.py."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.papers._false_bias import PAPER, Feet, coupling
from footfall.pdr.filter.ins import FilterSettings, frozen
from footfall.pdr.filter.run import run_filter
from footfall.scenarios.report.style import new_figure, save

_AXES = (("forward", "#888888"), ("to the left", "#c1440e"), ("up", "#1f6fb4"))
_BINS = 12


def signed(value: float) -> str:
    """With two digits and its sign; what rounds to nothing has none."""
    return f"{value:+.2f}" if abs(value) >= 0.005 else "0"


def cause(path: Path, simulated: Feet, made_of: Mapping[str, float]) -> None:
    """How the foot moves while it is called still, what the filter makes of it, and of which part.

    Parameters
    ----------
    made_of : part of the motion -> false bias (deg/s)
    """
    figure, axes = new_figure(1, 3, 13.5, 3.9, width_ratios=[1, 1, 1.25])
    motion = simulated.motion
    middles = (np.arange(_BINS) + 0.5) / _BINS
    bins = np.minimum(motion.place[motion.still] * _BINS, _BINS - 1).astype(int)
    axis = axes[0, 0]
    for k, (name, colour) in enumerate(_AXES):
        mean = np.array([100 * motion.velocity[motion.still, k][bins == one].mean() for one in range(_BINS)])
        axis.plot(100 * middles, mean, "o-", ms=3, color=colour, label=name)
    axis.axhline(0, color="#222222", lw=0.8)
    axis.set_xlabel("share of the time that it is called still (%)")
    axis.set_ylabel("velocity of the IMU (cm/s)")
    axis.set_title("a  A foot that is called still moves", loc="left", fontsize=10)
    axis.legend(frameon=False, fontsize=8, title="mean over strides", title_fontsize=8)

    axis = axes[0, 1]
    found = coupling(simulated, len(simulated.reckoning.footfalls) // 2)
    axis.plot(
        found.t,
        found.sideways,
        color="#c1440e",
        label="P(v, b) / P(b, b): m/s to the left\nper rad/s of bias",
    )
    axis.plot(found.t, found.distance, "--", color="#222222", label="distance come (m)")
    axis.set_xlabel("time since lift-off (s)")
    axis.set_ylabel("m")
    axis.set_title(
        "b  The filter takes sideways speed for gyro bias:\nits covariance grows with the stride",
        loc="left",
        fontsize=10,
    )
    axis.legend(frameon=False, fontsize=8, loc="upper left")

    axis = axes[0, 2]
    names = list(made_of)[::-1]
    values = [made_of[name] for name in names]
    colours = ["#c1440e" if name == "sideways" else "#b9b9b9" for name in names]
    colours[-1] = "#222222"
    axis.barh(names, values, color=colours)
    for k, value in enumerate(values):
        axis.text(max(value, 0) + 0.01, k, signed(value), va="center", fontsize=8)
    axis.axvline(0, color="#222222", lw=0.8)
    axis.set_xlim(min(0, *values) * 1.15, max(values) * 1.2)
    axis.locator_params(axis="x", nbins=5)
    axis.grid(axis="y", visible=False)
    axis.set_xlabel("false gyro bias about the vertical (deg/s)")
    axis.set_title(
        "c  False bias by the part of the motion called zero\n(red: what makes it, black: all of it)",
        loc="left",
        fontsize=10,
    )
    save(figure, path)


def cure(path: Path, simulated: Feet, pairs: Mapping[str, tuple[float, float]]) -> None:
    """Heading error of a perfect IMU over the walk, and the false bias on every recording.

    Parameters
    ----------
    pairs : recording -> false bias of the paper's filter and of the default (deg/s)
    """
    figure, axes = new_figure(1, 2, 11.5, 4.7)
    axis = axes[0, 0]
    r = simulated.reckoning
    stance = replace(PAPER, update="stance")
    for label, settings, colour, style in (
        ("every still sample, $\\sigma_v$ 0.01 m/s (the paper's)", PAPER, "#c1440e", "-"),
        ("every still sample, 0.1 m/s", replace(PAPER, sigma_velocity=0.1), "#e08b5a", "-"),
        ("every still sample, biases frozen", frozen(PAPER), "#7b4fa3", "-"),
        ("once a stance", stance, "#c98a00", "-"),
        ("default: once a stance, heading left to the gyro", FilterSettings(), "#1f6fb4", "-"),
    ):
        found = run_filter(r.recording, settings, r.pdr, r.start, found=r.detected).footfalls
        error = np.abs(np.degrees(found.heading - simulated.turn))
        axis.plot(found.t / 60, np.maximum(error, 1e-3), style, color=colour, lw=1.2, label=label)
    axis.set_yscale("log")
    axis.set_ylim(1e-3, None)
    axis.set_xlabel("time (min)")
    axis.set_ylabel("heading error (deg)")
    axis.set_title(
        "a  A perfect IMU on a simulated foot: all error is the filter's own", loc="left", fontsize=10
    )
    # Below the axes: wherever the lines run, they leave no room within.
    axis.legend(frameon=False, fontsize=8, loc="upper left", bbox_to_anchor=(-0.02, -0.13))

    axis = axes[0, 1]
    names = list(pairs)
    at = np.arange(len(names))
    for k, (label, colour) in enumerate((("the paper's filter", "#c1440e"), ("default", "#1f6fb4"))):
        sizes = [max(abs(pairs[name][k]), 1e-4) for name in names]
        axis.barh(at + 0.2 - 0.4 * k, sizes, 0.38, color=colour, label=label)
    axis.set_xscale("log")
    axis.set_yticks(at, names)
    axis.invert_yaxis()
    axis.grid(axis="y", visible=False)
    axis.set_xlabel("turned away from dead reckoning with the bias at rest (deg/s)")
    axis.set_title("b  Real feet: false bias of the filter, less is better", loc="left", fontsize=10)
    axis.legend(frameon=False, fontsize=8, ncols=2, loc="upper left", bbox_to_anchor=(-0.02, -0.13))
    save(figure, path)
