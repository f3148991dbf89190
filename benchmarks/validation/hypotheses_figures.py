"""Figures of docs/hypotheses.md: errors along the walk over units, modes, told SD against error.

The first walk of each scenario is worn by units from 1000 on, on which nothing was tuned. Footfalls are
kept in --store and shared with hypotheses.py.

python -m benchmarks.validation.hypotheses_figures --figures docs/images
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks._common import options, out, run_all
from benchmarks.validation.hypotheses import FIRST_UNIT, Job, footfalls_of, setup_of
from footfall.hdr.methods import METHODS
from footfall.hdr.streamed import StreamedReckoning
from footfall.hdr.tracks import pdr_track
from footfall.pdr.track import Track
from footfall.scenarios.judge.score import compare
from footfall.scenarios.report.style import COLOURS, entitle, head, label_edges, new_figure, new_panels, save
from footfall.scenarios.trial import Trial, start_pose, walk_of

SCENARIOS = ("closed-loop", "closed-loop-gentle", "curving")
SHOWN = {"pdr": "uncorrected", "hdr": "HDR", "hypotheses": "hypotheses", "hypotheses-smooth": "smoothed"}
OWN = ("hypotheses", "hypotheses-smooth")
_COLOURS = {**COLOURS, "hypotheses": "#d16ba5", "hypotheses-smooth": "#6a9f3a"}
_MODES = {"straight": "#dfe7ee", "curve": "#c98a00", "turn": "#c1440e"}


@dataclass(frozen=True)
class Worn:
    """A unit on a walk: time (n,) s, and by method heading errors (n,) and told SD (n,) in deg.

    modes : (3, n) chances of the modes, causal; path : (n, 2) m, true
    """

    t: np.ndarray
    errors: Mapping[str, np.ndarray]
    sds: Mapping[str, np.ndarray]
    modes: np.ndarray
    path: np.ndarray


def wear(job: Job, store: Path) -> Worn:
    """All methods on one unit."""
    setup, (unit,) = setup_of(job), job.units
    trial = Trial(setup, job.number, setup.scenario.seeds.base + job.number, unit, unit)
    walk = walk_of(trial)
    feet = footfalls_of(trial, walk, store)
    start = start_pose(walk, setup.pdr.bias_s)
    tracks: dict[str, Track] = {"pdr": pdr_track(feet)}
    for name in list(SHOWN)[1:]:
        tracks[name] = METHODS[name].track(StreamedReckoning(lambda: feet, start))
    compared = {name: compare(track, walk) for name, track in tracks.items()}
    told = tracks["hypotheses"].evidence
    at = np.searchsorted(walk.t, feet.t).clip(max=len(walk.t) - 1)
    return Worn(
        t=feet.t - feet.t[0],
        errors={name: np.degrees(one.heading_error) for name, one in compared.items()},
        sds={name: np.degrees(tracks[name].evidence["heading_sd"]) for name in OWN},
        modes=np.array([told[mode] for mode in _MODES]),
        path=walk.position[at, :2],
    )


def fans(found: Mapping[str, Sequence[Worn]], path: Path) -> None:
    """Absolute heading error along the walk: median and 10 to 90 % of units."""
    figure, axes = new_panels(len(found), 3.4, 3.2)
    for axis, (scenario, units) in zip(axes, found.items(), strict=True):
        grid = np.linspace(0, min(one.t[-1] for one in units), 400)
        for method, label in SHOWN.items():
            lines = [np.interp(grid, one.t, np.abs(one.errors[method][: len(one.t)])) for one in units]
            low, middle, high = np.percentile(lines, [10, 50, 90], axis=0)
            colour = _COLOURS[method]
            axis.fill_between(grid / 60, low, high, color=colour, alpha=0.18, lw=0)
            axis.plot(grid / 60, middle, color=colour, lw=1.4, label=label)
        axis.set(yscale="symlog", ylim=(0, 500))
        axis.set_yscale("symlog", linthresh=1.0)
        axis.set_yticks([0, 1, 10, 100], ["0", "1", "10", "100"])
        entitle(axis, scenario)
    label_edges(axes, "time (min)", "heading error (deg)")
    many = len(next(iter(found.values())))
    head(figure, f"Heading error along the walk: median and 10 to 90 % of {many} units", axes)
    save(figure, path)


def modes(one: Worn, path: Path) -> None:
    """The loop by its likeliest mode, and the chances over the time."""
    figure, grid = new_figure(1, 2, 8.6, 3.6, gridspec_kw={"width_ratios": [1.0, 1.7]})
    where, chances = grid.flat
    likeliest = one.modes.argmax(axis=0)
    where.plot(*one.path.T, color="#999999", lw=0.8)
    for place, (mode, colour) in enumerate(_MODES.items()):
        rows = likeliest == place
        colour = "#6d8299" if mode == "straight" else colour
        where.plot(*one.path[rows].T, ".", ms=4, color=colour, label=mode)
    where.set(xlabel="x (m)", ylabel="y (m)")
    where.set_aspect("equal", adjustable="datalim")
    entitle(where, "likeliest mode")
    chances.stackplot(one.t / 60, one.modes, colors=["#6d8299", *list(_MODES.values())[1:]], lw=0)
    chances.set(xlabel="time (min)", ylabel="chance", ylim=(0, 1), xlim=(0, one.t[-1] / 60))
    entitle(chances, "chances, as they were known then")
    head(figure, "The closed loop as the filter sees it, one unit", [where])
    save(figure, path)


def honesty(found: Mapping[str, Sequence[Worn]], path: Path) -> None:
    """Told SD against error, at every twentieth footfall of every unit, causal."""
    figure, axes = new_panels(len(found), 3.2, 3.3)
    for axis, (scenario, units) in zip(axes, found.items(), strict=True):
        for method in OWN:
            sd = np.concatenate([one.sds[method][20::20] for one in units])
            error = np.concatenate([np.abs(one.errors[method][20::20]) for one in units])
            axis.plot(sd, error, ".", ms=2.5, alpha=0.5, color=_COLOURS[method], label=SHOWN[method])
            inside = 100 * float((error < 2 * sd).mean())
            out.print(f"{scenario}, {SHOWN[method]}: {inside:.0f} % of errors are below 2 SD")
        ends = np.array([0.05, 300])
        axis.plot(ends, ends, color="#222222", lw=0.8, label="error = SD")
        axis.plot(ends, 2 * ends, color="#222222", lw=0.8, ls=":", label="error = 2 SD")
        axis.set(xscale="log", yscale="log", xlim=(0.2, 200), ylim=(0.01, 500))
        entitle(axis, scenario)
    label_edges(axes, "told SD (deg)", "heading error (deg)")
    head(figure, "What the filter tells of its error, and the error", axes)
    save(figure, path)


def main() -> None:
    """Navigate, draw."""
    parser = options(__doc__)
    parser.add_argument("--units", type=int, default=12, help="of each scenario (default 12)")
    parser.add_argument("--store", type=Path, help="folder of footfalls (default a temporary one)")
    parser.add_argument("--figures", type=Path, required=True, metavar="FOLDER", help="draw there")
    args = parser.parse_args()
    worn = range(FIRST_UNIT, FIRST_UNIT + args.units)
    jobs = [Job(scenario, None, 0, (unit,)) for scenario in SCENARIOS for unit in worn]
    with tempfile.TemporaryDirectory() as folder:
        work = partial(wear, store=args.store or Path(folder))
        all_units = run_all(work, jobs, args.processes, "units")
    found = {
        scenario: all_units[place * args.units : (place + 1) * args.units]
        for place, scenario in enumerate(SCENARIOS)
    }
    args.figures.mkdir(parents=True, exist_ok=True)
    fans(found, args.figures / "hypotheses_fans.png")
    modes(found["closed-loop"][0], args.figures / "hypotheses_modes.png")
    honesty(found, args.figures / "hypotheses_sd.png")


if __name__ == "__main__":
    main()
