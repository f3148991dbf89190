"""Heading methods on long walks of real feet: recordings one after the other, with an IMU's errors on top.

The recordings last a minute each, too short to judge a heading by. Here they are chained sample by sample,
with one mount and a rest in front, each as it is, mirrored, backwards and both: four walks of one. Unit k
walks the pieces of a group in an order of its own until 900 s are over, and is given the errors that
`footfall record --from-recording` adds, as it cools from 20 to -5 degC. The true heading is that of dead
reckoning without these errors and without each recording's own drift, which its footprints or its return
tell. "Of none": mean heading error as a share of that without correction.

python -m benchmarks.validation.real_chains --page docs/hypotheses.md
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks._common import options, run_all, write_json
from benchmarks._page import Sheet, by_name, fill
from benchmarks.validation._chains import PATIENT, Piece, chain, piece_of
from benchmarks.validation._real import BESIDE, find
from footfall.hdr.methods import METHODS
from footfall.hdr.tracks import Reckoning, pdr_track
from footfall.models.imu import TemperatureProfile, draw_unit, load_spec
from footfall.pdr.reckoning import dead_reckon
from footfall.pdr.track import Track
from footfall.simulate.from_recording import add_errors

GROUPS: Mapping[str, tuple[str, ...]] = {
    "corridors": ("gdin 32", "gdin 36"),
    "mixed": ("gdin 32", "gdin 36", "gdin 45", "openshoe 31", "openshoe 44", "xio long", "xio short"),
    "rooms": ("gdin 45", "xio long", "xio short"),
    "figures of eight": ("openshoe 31", "openshoe 44"),
}
# Of the mean heading error without correction: with an IMU's errors on top, and for recordings as they are.
TARGETS = {"corridors": 1 / 3, "mixed": 1 / 4, "rooms": 2 / 3, "figures of eight": 2 / 3}
AS_IT_IS = 1.1
NONE = "pdr"
JUDGED = (NONE, "hdr", "ihde-plus", "hypotheses", "hypotheses-smooth")
LENGTH_S = 900.0
FIRST_UNIT = 1000
WORSE_DEG = 1.0
AIR = TemperatureProfile.step(20.0, -5.0)


@dataclass(frozen=True)
class Job:
    """A group's pieces, and whose order of them; `imu` is None for the recordings as they are."""

    group: str
    pieces: tuple[Piece, ...]
    unit: int
    imu: str | None


@dataclass(frozen=True)
class Judged:
    """Of one chain and one method: heading errors and the SD told at the end (deg), NaN where none is."""

    group: str
    added: bool
    unit: int
    method: str
    average: float
    final: float
    sd: float


def in_order(pieces: Sequence[Piece], seed: int) -> list[Piece]:
    """Variants of the pieces in an order that the seed draws, until they last `LENGTH_S`."""
    walks = [walk for piece in pieces for walk in piece.variants()]
    found: list[Piece] = []
    for place in np.random.default_rng(seed).permutation(len(walks)):
        if sum(piece.seconds for piece in found) < LENGTH_S:
            found.append(walks[place])
    return found


def judge(job: Job, methods: Sequence[str]) -> list[Judged]:
    """Every method on one chain."""
    walks = in_order(job.pieces, job.unit)
    truth = pdr_track(dead_reckon(chain(walks, job.unit, true=True), PATIENT))
    recording = chain(walks, job.unit)
    if job.imu is not None:
        recording = add_errors(
            recording, draw_unit(load_spec(job.imu), job.unit), seed=job.unit, temperature=AIR
        )
    given, found = Reckoning(recording, pdr=PATIENT), []
    for name in methods:
        track = METHODS[name].track(given)
        error = heading_error_deg(track, truth)
        sd = float(np.degrees(track.evidence["heading_sd"][-1])) if "heading_sd" in track.evidence else np.nan
        average, final = float(np.abs(error).mean()), float(error[-1])
        found.append(Judged(job.group, job.imu is not None, job.unit, name, average, final, sd))
    return found


def heading_error_deg(track: Track, truth: Track) -> np.ndarray:
    """Errors (n,) of a track's headings, deg, at its footfalls."""
    return np.degrees(track.heading - np.interp(track.t, truth.t, truth.heading))


def sheet(name: str, title: str, found: Sequence[Judged], targets: Mapping[str, float]) -> Sheet:
    """Errors by group and method beside those of no correction."""
    heads = ["recordings", "method", "average: mean", "median", "p90", "final: mean", "of none", "target"]
    made = Sheet(name, title, [*heads, "worse (%)", "normalised"], left=2)
    for group in dict.fromkeys(one.group for one in found):
        here = [one for one in found if one.group == group]
        none = np.array([one.average for one in here if one.method == NONE])
        for method in dict.fromkeys(one.method for one in here):
            mine = [one for one in here if one.method == method]
            average, final = (np.array([getattr(one, key) for one in mine]) for key in ("average", "final"))
            values = (average.mean(), np.median(average), np.percentile(average, 90), np.abs(final).mean())
            share, worse = average.mean() / none.mean(), 100 * (average > none + WORSE_DEG).mean()
            target = f"{targets[group]:.2f}" if method.startswith("hypotheses") else ""
            ratio = np.mean([(one.final / one.sd) ** 2 for one in mine])
            cells = [*(f"{value:.1f}" for value in values), f"{share:.2f}", target, f"{worse:.0f}"]
            made.rows.append([group, method, *cells, "" if np.isnan(ratio) else f"{ratio:.2f}"])
    return made


def main(arguments: Sequence[str] | None = None) -> None:
    """Judge, and tell."""
    parser = options(__doc__)
    parser.add_argument("--data", type=Path, default=BESIDE, help="folder of recordings")
    parser.add_argument("--units", type=int, default=20, help="a group (default 20)")
    parser.add_argument("--first-unit", type=int, default=FIRST_UNIT, help=f"seed (default {FIRST_UNIT})")
    parser.add_argument("--imu", default="nimu", help="whose errors are added (default nimu)")
    parser.add_argument("--methods", nargs="+", default=JUDGED, metavar="NAME")
    parser.add_argument("--page", type=Path, help="fill the tables of this page")
    args = parser.parse_args(arguments)
    reals = find(args.data)
    if not reals:
        raise SystemExit(f"{args.data}: no recordings here")
    pieces = {real.name: piece_of(real) for real in reals}
    jobs = []
    for group, names in GROUPS.items():
        own = tuple(pieces[name] for name in names if name in pieces)
        if own:
            units = range(args.first_unit, args.first_unit + args.units)
            jobs += [Job(group, own, unit, imu) for unit in units for imu in (None, args.imu)]
    methods = [NONE, *(name for name in args.methods if name != NONE)]
    work = partial(judge, methods=methods)
    found = [one for part in run_all(work, jobs, args.processes, "chains of recordings") for one in part]
    sheets = [
        sheet("real feet", f"Errors of {args.imu} added (deg)", [one for one in found if one.added], TARGETS),
        sheet(
            "real feet as they are",
            "Recordings as they are (deg)",
            [one for one in found if not one.added],
            dict.fromkeys(GROUPS, AS_IT_IS),
        ),
    ]
    for each in sheets:
        each.show()
    write_json(args.json, {"chains": [asdict(one) for one in found]})
    if args.page:
        fill(args.page, by_name(sheets))


if __name__ == "__main__":
    main()
