"""How good must a sensor be until heading correction no longer pays?"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np

from benchmarks._page import Sheet
from benchmarks.studies._results import AVERAGE, FINAL, Results, combinations, figure, pair
from footfall.scenarios.report.style import entitle, head, label_edges, new_panels, save

COLD = "scenario.temperature[*].outdoors_degC"
SHEETS = ("tactical", "mtig710", "industrial", "consumer", "nimu", "phone")  # by what they leave uncorrected
BINS = (0, 2, 4, 8, 16, 32, 64, 128, np.inf)  # deg, of the uncorrected average error
_COLOURS = dict(zip(SHEETS, ("#2a9d8f", "#444f9b", "#6a9f3a", "#c98a00", "#c1440e", "#7b4fa3"), strict=True))


def sheets(results: Results) -> list[Sheet]:
    """By sheet and temperature, and by what was left uncorrected."""
    shapes = results.shapes
    found = []
    for name, score, at, title in (
        ("median", AVERAGE, 50, "Average heading error, median"),
        ("p90", AVERAGE, 90, "Average heading error, 90th percentile"),
        ("final", FINAL, 50, "Final heading error, median"),
    ):
        sheet = Sheet(
            name, f"{title} (deg): pdr / hdr (hdr worse, %)", ["sheet", "outdoors (degC)", *shapes], left=2
        )
        for cold in sorted(results.values(COLD), reverse=True):
            for imu in SHEETS:
                rows = results.where({"imu": imu, COLD: cold})
                cells = [pair(*_methods(rows.where(scenario=shape)), score, at) for shape in shapes]
                sheet.rows.append([f"`{imu}`", f"{cold:g}", *cells])
        found.append(sheet)
    return [*found, _gain(results, shapes), _walks(results, shapes)]


def _methods(rows: Results) -> tuple[Results, Results]:
    return rows.where(method="hdr"), rows.where(method="pdr")


def _gain(results: Results, shapes: list[str]) -> Sheet:
    """In how many cases HDR was better, by the case's uncorrected error."""
    names = [f"{low:g} to {high:g}" if high < np.inf else f"over {low:g}" for low, high in pairwise(BINS)]
    sheet = Sheet(
        "gain", "hdr better (% of cases, of how many), by pdr's average error (deg)", ["shape", *names]
    )
    for shape in shapes:
        both = (rows := _methods(results.where(scenario=shape)))[0].beside(rows[1])
        cells = []
        for low, high in pairwise(BINS):
            inside = both[(both[:, 1] >= low) & (both[:, 1] < high)]
            better = 100 * np.mean(inside[:, 0] < inside[:, 1]) if len(inside) else np.nan
            cells.append(f"{better:.0f} ({len(inside)})" if len(inside) >= 5 else "-")
        sheet.rows.append([shape, *cells])
    return sheet


def _walks(results: Results, shapes: list[str]) -> Sheet:
    """Walk by walk, with a good and a poor sensor: what is the walk's, not the sensor's."""
    seeds = sorted(results.values("walk_seed"))
    heads = ["shape", "sheet", *(f"walk {seed}" for seed in seeds)]
    sheet = Sheet("walks", "Average error by walk, medians (deg): pdr / hdr", heads, left=2)
    for shape in shapes:
        for imu in ("tactical", "nimu"):
            rows = [results.where(scenario=shape, imu=imu, walk_seed=seed) for seed in seeds]
            cells = [
                " / ".join(figure(np.median(r.score())) for r in reversed(_methods(one))) for one in rows
            ]
            sheet.rows.append([shape, f"`{imu}`", *cells])
    return sheet


def draw(results: Results, path: Path) -> None:
    """Each case's error by HDR over its error without."""
    shapes = results.shapes
    image, axes = new_panels(len(shapes), 3.6, 3.3, sharex=True, sharey=True)
    for axis, shape in zip(axes, shapes, strict=True):
        for (cold,), rows in combinations(results.where(scenario=shape), COLD):
            for imu in SHEETS:
                both = (found := _methods(rows.where(imu=imu)))[0].beside(found[1])
                colour, warm = _COLOURS[imu], cold > 0
                axis.plot(
                    both[:, 1],
                    both[:, 0],
                    "o",
                    ms=3,
                    mew=0.7,
                    mfc="none" if warm else colour,
                    mec=colour,
                    alpha=0.7,
                    label=None if warm else imu,
                )
        axis.set(xscale="log", yscale="log", xlim=(0.3, 2000), ylim=(0.3, 2000))
        axis.plot([0.3, 2000], [0.3, 2000], color="#222222", lw=0.8, label="no gain, no loss")
        entitle(axis, shape)
    label_edges(axes, "uncorrected average error (deg)", "HDR's average error (deg)")
    head(image, "Below the line HDR pays. Filled: out into the cold; open: no change of temperature", axes)
    save(image, path)
