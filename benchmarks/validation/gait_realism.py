"""Whether a simulated foot can be told from a real one.

Walks straight with several people at several paces and reads the IMU on the foot as it reads real
recordings: the same low-pass filter and rate, the same search for the foot's axes, its stances and its
steady, straight strides. Prints the figures of each beside the spread of the real ones and marks what lies
outside (*). What no foot IMU tells (ground force, support, step width) follows beside people's figures.

python -m benchmarks.validation.gait_realism
python -m benchmarks.validation.gait_realism --docs docs    also writes tables and the figure of docs/gait.md
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks._common import err, options, out, run_all, write_json
from benchmarks._page import by_name, fill
from benchmarks.validation._gait_distances import distances
from benchmarks.validation._gait_figure import draw
from benchmarks.validation._gait_kinetics import walk_figures
from benchmarks.validation._gait_page import bounds, sheets, tally
from benchmarks.validation._gait_rows import judged
from benchmarks.validation._gait_walks import Case, samples, walk_straight
from benchmarks.validation._real import BESIDE, find
from footfall.errors import InputError
from footfall.models.policy import load_policy, stock_policy
from footfall.pdr.gait.statistics import bands, foot_figures
from footfall.pdr.gait.strides import BANDWIDTH_HZ, Foot, normalised, read_foot

FEWEST = 3  # real recordings: fewer have no spread
FASTEST = 1.7  # m/s, of the walks here
DRAWN = "1.3"
# Name of the simulated foot -> its walk and its mount.
FEET = {
    "1.0": (Case("reference", 1.0), "instep"),
    DRAWN: (Case("reference", 1.3), "instep"),
    "1.5": (Case("reference", 1.5), "instep"),
    "shorter": (Case("shorter", 1.3), "instep"),
    "taller": (Case("taller", 1.3), "instep"),
    "heel": (Case("reference", 1.3), "heel"),
    "medial": (Case("reference", 1.3), "medial"),
}
WALKS = {
    "0.7": Case("reference", 0.7),
    "1.0": Case("reference", 1.0),
    DRAWN: Case("reference", 1.3),
    "1.5": Case("reference", 1.5),
    "1.7": Case("reference", 1.7),
    "shorter": Case("shorter", 1.3),
    "taller": Case("taller", 1.3),
}


@dataclass(frozen=True)
class Job:
    """A walk, the mounts to read it at, and how."""

    case: Case
    metres: float
    mounts: tuple[str, ...]
    bandwidth_hz: float
    weights: Path | None


@dataclass(frozen=True)
class Walked:
    """What came of a walk: its figures, and the foot as each mount has it."""

    figures: dict[str, float]
    feet: dict[str, Foot]


def perform(job: Job) -> Walked | str:
    """Walk, and read the foot at every mount; or why the walk came to no end."""
    policy = load_policy(job.weights) if job.weights else stock_policy()
    try:
        motion = walk_straight(job.case, job.metres, policy)
    except InputError as error:
        return str(error)
    feet = {mount: read_foot(samples(motion, mount), job.bandwidth_hz) for mount in job.mounts}
    return Walked(walk_figures(motion), feet)


def simulate(
    metres: float, bandwidth_hz: float, weights: Path | None, processes: int
) -> tuple[dict[str, Foot], dict[str, dict[str, float]]]:
    """Every simulated foot and the figures of every walk, by name; walks that came to no end are left out."""
    mounts: dict[Case, tuple[str, ...]] = dict.fromkeys(WALKS.values(), ())
    for case, mount in FEET.values():
        mounts[case] += (mount,)
    jobs = [Job(case, metres, seen, bandwidth_hz, weights) for case, seen in mounts.items()]
    walked: dict[Case, Walked] = {}
    for job, result in zip(jobs, run_all(perform, jobs, processes, "walking"), strict=True):
        if isinstance(result, str):
            err.print(f"[red]left out:[/red] {result}")
        else:
            walked[job.case] = result
    feet = {name: walked[case].feet[mount] for name, (case, mount) in FEET.items() if case in walked}
    return feet, {name: walked[case].figures for name, case in WALKS.items() if case in walked}


def read_real(folder: Path, bandwidth_hz: float) -> dict[str, Foot]:
    """The feet of a folder's recordings, by name.

    Raises
    ------
    InputError
        There are too few to have a spread, or one cannot be read.
    """
    found = find(folder)
    if len(found) < FEWEST:
        raise InputError(f"{folder}: {len(found)} recordings, expected {FEWEST} or more to judge by")
    return {one.name: read_foot(one.recording, bandwidth_hz) for one in found}


def all_figures(
    real: Mapping[str, Foot], simulated: Mapping[str, Foot]
) -> tuple[dict[str, dict[str, float]], dict[str, dict[str, float]]]:
    """Figures of the real and of the simulated feet, distances from the real ones among them."""
    feet = {**real, **simulated}
    strides = {name: normalised(foot) for name, foot in feet.items()}
    far = distances({name: each.mean(axis=0) for name, each in strides.items()}, list(real))
    figures = {name: foot_figures(feet[name]) | far[name] | bands(strides[name]) for name in feet}
    return {name: figures[name] for name in real}, {name: figures[name] for name in simulated}


def _plain(value: Any) -> Any:
    """JSON knows no nan."""
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    return None if isinstance(value, float) and not np.isfinite(value) else value


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the tables."""
    parser = options(__doc__)
    parser.add_argument(
        "--data",
        type=Path,
        default=BESIDE,
        metavar="FOLDER",
        help="real recordings (default: beside the checkout)",
    )
    parser.add_argument(
        "--metres", type=float, default=110.0, help="of each walk (default 110: some 80 strides)"
    )
    parser.add_argument(
        "--bandwidth", type=float, default=BANDWIDTH_HZ, metavar="HZ", help="low-pass of all (default 50)"
    )
    parser.add_argument(
        "--weights", type=Path, metavar="FILE", help="walk with these (default: shipped ones)"
    )
    parser.add_argument("--docs", type=Path, metavar="FOLDER", help="write gait.md's tables and figure there")
    chosen = parser.parse_args(arguments)

    try:
        policy = load_policy(chosen.weights) if chosen.weights else stock_policy()
        real = read_real(chosen.data, chosen.bandwidth)
    except InputError as error:
        sys.exit(str(error))
    simulated, walks = simulate(chosen.metres, chosen.bandwidth, chosen.weights, chosen.processes)
    if not simulated:
        sys.exit("no walk came to its end")
    of_real, of_simulated = all_figures(real, simulated)
    tables = sheets(of_real, of_simulated, walks)
    for table in tables:
        table.show()
    found = tally(of_real, of_simulated)
    # Recordings faster than any walk here make the spread wide: how it would be without them.
    slow = {name: foot for name, foot in real.items() if of_real[name]["speed_m_s"] <= FASTEST}
    without = tally(*all_figures(slow, simulated)) if len(slow) >= FEWEST else {}
    counts = [
        f"{sum(mark == 'inside' for mark in marks.values())} of {len(marks)} rows inside the spread of the "
        f"{len(feet)} real recordings{which}."
        for marks, feet, which in ((found, real, ""), (without, slow, f" at {FASTEST:g} m/s or less"))
        if marks
    ]
    for count in counts:
        out.print(count)
    document = {
        "walker": {"policy": policy.digest, **policy.meta},
        "bandwidth_hz": chosen.bandwidth,
        "metres": chosen.metres,
        "real": of_real,
        "simulated": of_simulated,
        "walks": walks,
        "spread": {row.key: bounds(row, of_real) for row in judged()},
        "verdicts": found,
        "verdicts_without_fast_recordings": without,
    }
    write_json(chosen.json, _plain(document))
    if chosen.docs is not None:
        counted = {"counts": f"Walker {policy.digest}. {' '.join(counts)}"}
        fill(chosen.docs / "gait.md", counted | by_name(tables))
        name = DRAWN if DRAWN in simulated else next(iter(simulated))
        title = f"One stride of a foot's IMU in the foot's axes, {chosen.bandwidth:g} Hz: simulated over real"
        strides = [normalised(foot) for foot in real.values()]
        (chosen.docs / "images").mkdir(exist_ok=True)
        draw(chosen.docs / "images" / "gait_strides.png", strides, normalised(simulated[name]), title)


if __name__ == "__main__":
    main()
