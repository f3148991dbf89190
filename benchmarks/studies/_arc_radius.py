"""One arc of 180 deg by its radius: what HDR takes for drift, and what is left of that."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from benchmarks._page import Sheet
from benchmarks.studies._results import FINAL, Results, figure, quantiles
from footfall.scenarios.report.style import COLOURS, entitle, head, new_figure, save
from footfall.scenarios.scenario import load_scenario

RADIUS, THETA = "scenario.path.elements[kind=arc].radius_m", "hdr.theta_w_deg_s"
HAND = "scenario.path.elements[kind=arc].turn_deg"
_NORMAL = 0.25  # deg/s, HDR's own theta_w
_OWN = {"hypotheses": "hypotheses", "hypotheses-smooth": "smoothed"}
_WORSE_DEG = 1.0
_COLOURS = {**COLOURS, "hypotheses": "#d16ba5", "hypotheses-smooth": "#6a9f3a"}
_THETA_COLOURS = {0.125: "#7b4fa3", 0.25: "#1f6fb4", 0.5: "#2a9d8f"}


def asked_pace() -> float:
    """m/s, of the scenario."""
    return load_scenario("one-arc").gait.pace_m_s


def erased_radius(theta_deg_s: float) -> float:
    """Radius (m) at which the arc, walked at the pace that is asked, turns at theta_w."""
    return asked_pace() / math.radians(theta_deg_s)


def sheets(results: Results) -> list[Sheet]:
    """By radius: HDR alone, and beside the uncorrected error of two sensors; by hand; this package's own."""
    return [_alone(results), _beside(results), _hands(results), _own(results)]


def _alone(results: Results) -> Sheet:
    thetas = sorted(results.values(THETA))
    heads = ["radius (m)", "turns at (deg/s)", "pdr", *(f"theta_w {theta:g}" for theta in thetas)]
    sheet = Sheet("alone", "Final heading error with an IMU without error, median and largest (deg)", heads)
    for radius in sorted(results.values(RADIUS)):
        rows = results.where({"imu": "perfect", RADIUS: radius})
        groups = [rows.where(method="pdr"), *(rows.where({THETA: theta}) for theta in thetas)]
        cells = [" / ".join(figure(x) for x in quantiles(group.score(FINAL), (50, 100))) for group in groups]
        sheet.rows.append([f"{radius:g}", f"{math.degrees(asked_pace() / radius):.2f}", *cells])
    return sheet


def _beside(results: Results) -> Sheet:
    imus = [imu for imu in results.values("imu") if imu != "perfect"]
    heads = ["radius (m)"]
    for imu in imus:
        heads += [f"{imu}: pdr", "hdr", "worse (%)"]
    sheet = Sheet("beside", "Final heading error, median and p90 (deg), theta_w 0.25 deg/s", heads)
    for radius in sorted(results.values(RADIUS)):
        cells = [f"{radius:g}"]
        for imu in imus:
            rows = results.where({"imu": imu, RADIUS: radius})
            pdr, hdr = rows.where(method="pdr"), rows.where({THETA: _NORMAL})
            both = hdr.beside(pdr, FINAL)
            cells += [" / ".join(figure(x) for x in quantiles(one.score(FINAL))) for one in (pdr, hdr)]
            cells.append(f"{100 * np.mean(both[:, 0] > both[:, 1]):.0f}")
        sheet.rows.append(cells)
    return sheet


def _hands(results: Results) -> Sheet:
    radii = sorted(results.values(RADIUS))
    sheet = Sheet(
        "hands",
        "HDR, final error by hand, IMU without error, median (deg)",
        ["hand", *(f"{r:g} m" for r in radii)],
    )
    for turn, name in ((180.0, "left"), (-180.0, "right")):
        rows = results.where({"imu": "perfect", HAND: turn, THETA: _NORMAL})
        sheet.rows.append(
            [name, *(figure(float(np.median(rows.where({RADIUS: r}).score(FINAL)))) for r in radii)]
        )
    return sheet


def _own(results: Results) -> Sheet:
    imus = results.values("imu")
    heads = ["radius (m)"]
    for imu in imus:
        heads += [f"{imu}: hypotheses", "worse (%)", "smoothed", "worse (%)"]
    sheet = Sheet("own", "Final heading error, median and p90 (deg), by hypotheses", heads)
    for radius in sorted(results.values(RADIUS)):
        cells = [f"{radius:g}"]
        for imu in imus:
            rows = results.where({"imu": imu, RADIUS: radius})
            for method in _OWN:
                mine = rows.where(method=method)
                both = mine.beside(rows.where(method="pdr"), FINAL)
                cells.append(" / ".join(figure(x) for x in quantiles(mine.score(FINAL))))
                cells.append(f"{100 * np.mean(both[:, 0] > both[:, 1] + _WORSE_DEG):.0f}")
        sheet.rows.append(cells)
    return sheet


def draw(results: Results, path: Path) -> None:
    """HDR alone by radius and by rate of turn; all methods with two sensors."""
    image, grid = new_figure(2, 2, 8.2, 6.6)
    alone, together, *others = grid.flat
    radii = np.array(sorted(results.values(RADIUS)))
    for theta in sorted(results.values(THETA)):
        rows = results.where({"imu": "perfect", THETA: theta})
        spread = np.array([quantiles(rows.where({RADIUS: r}).score(FINAL), (0, 50, 100)) for r in radii])
        colour, label = _THETA_COLOURS[theta], f"HDR, {theta:g} deg/s"
        alone.fill_between(radii, spread[:, 0], spread[:, 2], color=colour, alpha=0.18, lw=0)
        alone.plot(radii, spread[:, 1], "o-", ms=3.5, color=colour, label=label)
        alone.axvline(erased_radius(theta), color=colour, lw=0.8, ls=":")
        together.plot(radii / erased_radius(theta), spread[:, 1], "o-", ms=3.5, color=colour)
    together.axvline(1, color="#222222", lw=0.8, ls=":", label="arc at theta_w")
    for axis, imu in zip(others, (imu for imu in results.values("imu") if imu != "perfect"), strict=True):
        rows = results.where(imu=imu)
        for method in ("pdr", "hdr", *_OWN):
            mine = rows.where({THETA: _NORMAL} if method == "hdr" else {"method": method})
            spread = np.array([quantiles(mine.where({RADIUS: r}).score(FINAL), (10, 50, 90)) for r in radii])
            colour = _COLOURS[method]
            axis.fill_between(radii, spread[:, 0], spread[:, 2], color=colour, alpha=0.18, lw=0)
            names = {"pdr": "uncorrected", **_OWN}
            axis.plot(radii, spread[:, 1], "o-", ms=3.5, color=colour, label=names.get(method))
        axis.axvline(erased_radius(_NORMAL), color="#222222", lw=0.8, ls=":")
        entitle(axis, f"{imu}; band: 10 to 90 % of cases")
    entitle(alone, "IMU without error; band: all walks")
    entitle(together, "the same, by radius in units of pace / theta_w")
    for axis in grid.flat:
        axis.set(xscale="log", ylabel="final heading error (deg)", xlabel="radius (m)")
    alone.set_ylim(0, None)
    together.set_ylim(0, None)
    for axis in others:  # from tenths of a degree to turns
        axis.set(yscale="log", ylim=(0.1, 1000))
    together.set_xlabel("radius / (pace / theta_w)")
    title = "Half a circle between two straights: final heading error by radius"
    head(image, title, list(grid.flat))
    save(image, path)
