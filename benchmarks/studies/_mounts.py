"""Where on the shoe does the IMU sit best?"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks._page import Sheet
from benchmarks.studies._results import AVERAGE, FINAL, Results, pair, quantiles
from footfall.scenarios.report.style import COLOURS, entitle, head, label_edges, new_figure, save

MOUNT, COLD = "scenario.sensor.mount", "scenario.temperature[*].outdoors_degC"
_SHEETS = ("consumer", "nimu")
_PLACES = ("instep", "instep-left", "medial", "heel")  # the first is what the others are held against


def sheets(results: Results) -> list[Sheet]:
    """By place: an IMU without error, then two sheets in two temperatures."""
    mounts, shapes = _places(results), results.shapes
    alone = Sheet("alone", "IMU without error: average heading error and distance error, medians", ["mount"])
    for shape in shapes:
        alone.headings += [f"{shape}: pdr (deg)", "hdr (deg)", "distance (%)"]
    for mount in mounts:
        cells = [f"`{mount}`"]
        for shape in shapes:
            rows = results.where({"imu": "perfect", MOUNT: mount, "scenario": shape})
            pdr, hdr = rows.where(method="pdr"), rows.where(method="hdr")
            cells += [f"{np.median(one.score()):.2f}" for one in (pdr, hdr)]
            cells.append(f"{np.median(pdr.score('distance_error_pct')):+.2f}")
        alone.rows.append(cells)
    found = [alone]
    for name, score, at, title in (
        ("median", AVERAGE, 50, "Average heading error, median"),
        ("p90", AVERAGE, 90, "Average heading error, 90th percentile"),
        ("final", FINAL, 50, "Final heading error, median"),
    ):
        heads = ["shape", "outdoors (degC)", "sheet", *mounts]
        sheet = Sheet(name, f"{title} (deg): pdr / hdr (hdr worse, %)", heads, left=3)
        for shape in shapes:
            for cold in sorted(results.values(COLD), reverse=True):
                for imu in _SHEETS:
                    rows = results.where({"imu": imu, COLD: cold, "scenario": shape})
                    places = [rows.where({MOUNT: mount}) for mount in mounts]
                    cells = [
                        pair(one.where(method="hdr"), one.where(method="pdr"), score, at) for one in places
                    ]
                    sheet.rows.append([shape, f"{cold:g}", f"`{imu}`", *cells])
        found.append(sheet)
    return [*found, _against(results, mounts, shapes)]


def _places(results: Results) -> list[str]:
    return sorted(results.values(MOUNT), key=_PLACES.index)


def _against(results: Results, mounts: list[str], shapes: list[str]) -> Sheet:
    """The other places against the instep, unit by unit on the same steps."""
    heads = ["shape", "outdoors (degC)", "sheet", "method", *mounts[1:]]
    title = f"Average error against {mounts[0]}: ratio of medians (worse in % of units)"
    sheet = Sheet("against", title, heads, left=4)
    for shape in shapes:
        for cold in sorted(results.values(COLD), reverse=True):
            for imu in _SHEETS:
                for method in ("pdr", "hdr"):
                    rows = results.where({"imu": imu, COLD: cold, "scenario": shape, "method": method})
                    base = _by_unit(rows.where({MOUNT: mounts[0]}))
                    cells = []
                    for mount in mounts[1:]:
                        mine = _by_unit(rows.where({MOUNT: mount}))
                        both = np.array([(mine[unit], base[unit]) for unit in mine if unit in base])
                        ratio = np.median(both[:, 0]) / np.median(both[:, 1])
                        cells.append(f"{ratio:.2f} ({100 * np.mean(both[:, 0] > both[:, 1]):.0f})")
                    sheet.rows.append([shape, f"{cold:g}", f"`{imu}`", method, *cells])
    return sheet


def _by_unit(rows: Results) -> dict[tuple[int, int], float]:
    return dict(zip(zip(rows["walk_seed"], rows["unit_seed"], strict=True), rows[AVERAGE], strict=True))


def draw(results: Results, path: Path) -> None:
    """Median and 90th percentile by place, sheet and shape; two temperatures."""
    mounts, shapes, colds = _places(results), results.shapes, sorted(results.values(COLD))
    image, grid = new_figure(len(shapes), len(_SHEETS), 7.2, 5.2, sharey="col", sharex=True)
    for line, shape in zip(grid, shapes, strict=True):
        for axis, imu in zip(line, _SHEETS, strict=True):
            for m, method in enumerate(("pdr", "hdr")):
                for c, cold in enumerate(colds):
                    place = np.arange(len(mounts)) + 0.2 * (2 * m + c - 1.5)
                    rows = results.where({"imu": imu, COLD: cold, "scenario": shape, "method": method})
                    low, high = np.transpose([quantiles(rows.where({MOUNT: one}).score()) for one in mounts])
                    fill = COLOURS[method] if c == 0 else "none"
                    axis.vlines(place, low, high, color=COLOURS[method], alpha=0.5, lw=1.5)
                    label = f"{'uncorrected' if method == 'pdr' else 'HDR'}, {cold:g} degC"
                    axis.plot(place, low, "o", ms=4.5, mfc=fill, mec=COLOURS[method], ls="none", label=label)
            axis.set(yscale="log")
            axis.set_xticks(range(len(mounts)), mounts, fontsize=7)
            entitle(axis, f"{shape}, {imu}")
    label_edges(list(grid.flat), "", "average error (deg)")
    head(image, "Average heading error by mount: median, and a line to the 90th percentile", list(grid.flat))
    save(image, path)
