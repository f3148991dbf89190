"""How good must a sensor be to do without HDR? All of the nIMU's gyro errors, smaller and larger together.

Units of the nIMU on walks are heard once; by the drift budget each is then one of a sheet all of whose
sigmas, flicker and random walks are so many times the nIMU's. Two crossings: where dead reckoning alone is as
good as the nIMU with HDR, and where HDR no longer helps the same sensor. Dots are the full chain. The nIMU's
low-pass, its rounding and its accelerometers stay.

python -m benchmarks.validation.without_hdr --figure without_hdr.png --page docs/without_hdr.md
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks._common import options, write_json
from benchmarks._page import Sheet, by_name, fill
from footfall.hdr.hdr import NOTHING, HdrParams, HdrSets
from footfall.scenarios.parameters import documents
from footfall.scenarios.report.progress import counting, showing
from footfall.scenarios.report.style import COLOURS, entitle, label_edges, label_of, new_panels, save
from footfall.scenarios.studies.budget import CAUSE_OF, METRICS, Case
from footfall.scenarios.studies.listening import listened
from footfall.scenarios.studies.points import Worn, evaluate_points

FACTORS = np.geomspace(0.01, 3.0, 31)
CHECKED = (0.03, 0.3, 3.0)
METHODS = {"pdr": NOTHING, "hdr": HdrParams()}


def curves(cases: Sequence[Case]) -> dict[str, np.ndarray]:
    """Method -> (factors, cases) mean heading errors in deg."""
    scaled = dict.fromkeys(CAUSE_OF.values(), FACTORS)
    return {
        name: np.stack(
            [case.errors_deg(HdrSets.of([params] * len(FACTORS)), scaled)[:, 0] for case in cases], axis=1
        )
        for name, params in METHODS.items()
    }


def crossing(difference: np.ndarray) -> float | None:
    """The largest factor up to which (factors,) differences are below zero; None where the first is not."""
    above = np.flatnonzero(difference > 0)
    if not len(above):
        return float(FACTORS[-1])
    after = int(above[0])
    if after == 0:
        return None
    low, high = difference[after - 1], difference[after]
    share = -low / (high - low)
    return float(FACTORS[after - 1] * (FACTORS[after] / FACTORS[after - 1]) ** share)


def deviations(medians: np.ndarray, full: np.ndarray) -> np.ndarray:
    """By how much (share) the curve of (factors,) medians exceeds those of the full chain at `CHECKED`."""
    return np.asarray(np.interp(np.log(CHECKED), np.log(FACTORS), medians) / full - 1)


def accuracy(found: dict[str, dict[str, Any]]) -> Sheet:
    """By factor and method: the least and the greatest deviation of the curves over the paths, in %."""
    sheet = Sheet("accuracy", "Curves beside the full chain, least and greatest path", ["factor", *METHODS])
    for at, factor in enumerate(CHECKED):
        off = {name: [100 * made["off"][name][at] for made in found.values()] for name in METHODS}
        cells = [f"{round(min(own)):+d} to {round(max(own)):+d} %" for own in off.values()]
        sheet.rows.append([f"{factor:g}", *cells])
    return sheet


def scaled_sheet(base: Any, factor: float) -> dict[str, float]:
    """Address -> value of a sheet all of whose scaled errors are `factor` times as large."""
    gyro = base.sheet.table["gyro"]
    return {f"imu.gyro.{key}": factor * gyro[key] for key in CAUSE_OF if gyro.get(key)}


def draw(found: dict[str, dict[str, Any]], path: Path) -> None:
    """A panel a scenario: medians, 10 to 90 % of the units, the full chain's medians, both crossings."""
    figure, axes = new_panels(len(found), 3.4, 2.7, columns=min(2, len(found)), sharey=True)
    for axis, (scenario, made) in zip(axes, found.items(), strict=True):
        for name, errors in made["errors"].items():
            low, middle, high = np.percentile(errors, [10, 50, 90], axis=1)
            axis.fill_between(FACTORS, low, high, color=COLOURS[name], alpha=0.13, lw=0)
            axis.loglog(FACTORS, middle, color=COLOURS[name], lw=1.6, label=label_of(name))
            axis.plot(list(CHECKED), made["full"][name], "o", ms=5, mfc="white", mec=COLOURS[name])
        now = float(np.interp(0.0, np.log(FACTORS), np.median(made["errors"]["hdr"], axis=1)))
        axis.axhline(now, color=COLOURS["hdr"], lw=0.8, ls=":")
        told = []
        for key, style, text in (
            ("as_nimu", "--", "PDR as good as the nIMU with HDR"),
            ("no_help", ":", "HDR helps from here on"),
        ):
            if made[key] is not None:
                axis.axvline(made[key], color="#444444", lw=1.0, ls=style)
                told.append(f"{'- -' if style == '--' else '· ·'}  {text}: {made[key]:.2g}")
        axis.text(
            0.02, 0.98, "\n".join(told), transform=axis.transAxes, va="top", fontsize=7,
            bbox={"fc": "white", "ec": "none", "alpha": 0.8, "pad": 1.5},
        )  # fmt: skip
        entitle(axis, scenario)
        axis.set_xticks([0.01, 0.03, 0.1, 0.3, 1, 3], ["0.01", "0.03", "0.1", "0.3", "1", "3"])
        axis.set_yticks([0.1, 0.3, 1, 3, 10, 30, 100], ["0.1", "0.3", "1", "3", "10", "30", "100"])
        axis.minorticks_off()
    axes[0].legend(frameon=False, fontsize=8, loc="lower right")
    label_edges(axes, "gyro errors, in those of the nIMU", "mean heading error (deg)")
    figure.suptitle(
        "How good must a sensor be to do without HDR?\nMedian and 10 to 90 % of the units; dots: in full",
        x=0.01,
        ha="left",
        fontsize=10,
    )
    save(figure, path)


def main(arguments: Sequence[str] | None = None) -> None:
    """Hear, scale, print, draw."""
    parser = options(__doc__)
    parser.add_argument("scenarios", nargs="*", default=["closed-loop", "straight", "curving", "turning"])
    parser.add_argument("--units", type=int, default=20, help="on the walks of each scenario (default 20)")
    parser.add_argument("--walks", type=int, default=2, help="of each scenario (default 2)")
    parser.add_argument("--figure", type=Path, metavar="PNG", help="draw the curves there")
    parser.add_argument("--page", type=Path, metavar="MD", help="fill its tables")
    chosen = parser.parse_args(arguments)
    worn = Worn(walks=chosen.walks, units=chosen.units)
    found: dict[str, dict[str, Any]] = {}
    title = "Factor on all of the nIMU's gyro errors"
    columns = ["path", "pdr, 1", "hdr, 1", "pdr as the nIMU with HDR", "HDR helps from", "off"]
    sheet = Sheet("without-hdr", title, columns)
    for scenario in chosen.scenarios:
        base = documents(scenario, imu="nimu", methods=list(METHODS))
        with counting(scenario) as heard:
            cases = listened(worn.deal(base.setup()), workers=chosen.processes, on_progress=heard)
        errors = curves([case for case in cases if isinstance(case, Case)])
        points = [scaled_sheet(base, factor) for factor in CHECKED]
        with showing() as progress:
            full = evaluate_points(
                base, points, worn.deal, METRICS[0], workers=chosen.processes, on_progress=progress
            ).errors
        medians = {name: np.median(own, axis=1) for name, own in errors.items()}
        own = {name: np.median(full[i], axis=1) for i, name in enumerate(METHODS)}
        one = {name: float(np.interp(0.0, np.log(FACTORS), own_)) for name, own_ in medians.items()}
        off = {name: deviations(medians[name], own[name]) for name in METHODS}
        made = found[scenario] = {
            "errors": errors,
            "full": {name: value.tolist() for name, value in own.items()},
            "off": {name: value.tolist() for name, value in off.items()},
            "as_nimu": crossing(medians["pdr"] - one["hdr"]),
            "no_help": crossing(medians["pdr"] - medians["hdr"]),
        }
        told = ["-" if made[key] is None else f"{made[key]:.2g}" for key in ("as_nimu", "no_help")]
        cells = [
            f"{one['pdr']:.1f}",
            f"{one['hdr']:.1f}",
            *told,
            f"{100 * np.abs([*off.values()]).mean():.0f} %",
        ]
        sheet.rows.append([scenario, *cells])
    sheets = [sheet, accuracy(found)]
    for one_sheet in sheets:
        one_sheet.show()
    if chosen.figure is not None:
        draw(found, chosen.figure)
    if chosen.page is not None:
        fill(chosen.page, by_name(sheets))
    plain = {
        scenario: {**made, "errors": {name: own.tolist() for name, own in made["errors"].items()}}
        for scenario, made in found.items()
    }
    write_json(chosen.json, {"factors": FACTORS.tolist(), "scenarios": plain})


if __name__ == "__main__":
    main()
