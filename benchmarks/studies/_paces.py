"""At which pace does HDR work, and what has theta_w to do with it?"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks._page import Sheet
from benchmarks.studies._results import AVERAGE, FINAL, Results, figure, quantiles
from footfall.scenarios.report.style import COLOURS, entitle, head, new_figure, save

PACE, THETA = "scenario.gait.pace_m_s", "hdr.theta_w_deg_s"
_THETA_COLOURS = {0.125: "#7b4fa3", 0.25: "#1f6fb4", 0.5: "#2a9d8f"}


def sheets(results: Results) -> list[Sheet]:
    """By shape and pace: uncorrected, and HDR by theta_w."""
    thetas = sorted(results.values(THETA))
    heads = ["shape", "pace (m/s)", "pdr", *(f"theta_w {theta:g}" for theta in thetas)]
    found = []
    for name, score, title in (("average", AVERAGE, "Average"), ("final", FINAL, "Final")):
        sheet = Sheet(name, f"{title} heading error, median / p90 (deg)", heads, left=2)
        worse = Sheet("worse", "HDR worse than uncorrected (% of cases)", [*heads[:2], *heads[3:]], left=2)
        for shape in results.shapes:
            for pace in sorted(results.values(PACE)):
                rows = results.where({"scenario": shape, PACE: pace})
                pdr, hdr = rows.where(method="pdr"), [rows.where({THETA: theta}) for theta in thetas]
                cells = [" / ".join(figure(x) for x in quantiles(one.score(score))) for one in (pdr, *hdr)]
                sheet.rows.append([shape, f"{pace:g}", *cells])
                both = [one.beside(pdr) for one in hdr]
                worse.rows.append(
                    [shape, f"{pace:g}", *(f"{100 * np.mean(b[:, 0] > b[:, 1]):.0f}" for b in both)]
                )
        found.append(sheet)
    return [*found, worse]


def draw(results: Results, path: Path) -> None:
    """Average error over pace; HDR for three theta_w."""
    shapes, paces = results.shapes, np.array(sorted(results.values(PACE)))
    image, grid = new_figure(1, len(shapes), 4.1 * len(shapes), 3.9)
    for axis, shape in zip(grid[0], shapes, strict=True):
        rows = results.where(scenario=shape)
        lines = [("uncorrected", COLOURS["pdr"], {"method": "pdr"})]
        lines += [
            (f"HDR, theta_w = {t:g} deg/s", _THETA_COLOURS[t], {THETA: t})
            for t in sorted(results.values(THETA))
        ]
        for label, colour, chosen in lines:
            mine = rows.where(chosen)
            spread = np.array([quantiles(mine.where({PACE: p}).score(), (25, 50, 75)) for p in paces])
            axis.fill_between(paces, spread[:, 0], spread[:, 2], color=colour, alpha=0.13, lw=0)
            axis.plot(paces, spread[:, 1], "o-", ms=3.5, color=colour, label=label)
        axis.set(yscale="log", xlabel="pace that is asked (m/s)", ylabel="average error (deg)")
        entitle(axis, shape)
    head(image, "Average heading error by pace: median, and the middle half of the cases", list(grid[0]))
    save(image, path)
