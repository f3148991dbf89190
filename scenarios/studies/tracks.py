"""Tracks that a study's report shows: the best, the median and the worst of each method, beside the truth."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from footfall.columns import FOOTFALLS
from footfall.errors import InputError
from footfall.hdr.tracks import told
from footfall.pdr.track import write_track
from footfall.scenarios.execute import hold
from footfall.scenarios.studies.parts import StudyFolder
from footfall.scenarios.studies.plan import Plan
from footfall.scenarios.studies.rows import read_rows
from footfall.scenarios.studies.task import Task
from footfall.scenarios.trial import reckoning, recording_of
from footfall.simulate.walk import Walk
from footfall.tables import numbers, replacing, write_table

MOST = 12
WHICH = ("median", "worst", "best")  # in this order, while there is room
ERROR = "heading_error_mean_deg"


def write_tracks(plan: Plan, place: StudyFolder, on_track: Callable[[], None]) -> None:
    """tracks/ of a study whose dataset is there: at most twelve tracks, true footfalls, index.json.

    What an earlier call made of the same rows stays.
    """
    rows = read_rows(place.results)
    chosen = [_entry(row, which, tuple(plan.kinds)) for row, which in chosen_rows(rows)]
    folder = place.path / "tracks"
    if _there(folder, chosen):
        return
    folder.mkdir(exist_ok=True)
    for file in (*folder.glob("*.parquet"), folder / "index.json"):
        file.unlink(missing_ok=True)
    tasks = {key: task for task in plan.tasks for key in task.cells}
    keys = [row["key"] for row, _ in chosen_rows(rows)]
    for entry, key in sorted(zip(chosen, keys, strict=True), key=lambda pair: tasks[pair[1]].walk):
        on_track()
        _write(entry, key, tasks[key], folder)
    with replacing(folder / "index.json") as temporary:
        temporary.write_text(json.dumps(chosen, indent=2) + "\n", encoding="utf-8")


def chosen_rows(rows: Any) -> Iterator[tuple[dict[str, Any], str]]:
    """The rows whose tracks are kept, and which they are of their method's."""
    methods = list(dict.fromkeys(rows["method"].to_pylist()))
    errors = numbers(rows[ERROR].chunks)
    names = np.array(rows["method"].to_pylist())
    ranked = {}
    for method in methods:
        own = np.flatnonzero((names == method) & np.isfinite(errors))
        if len(own):
            ranked[method] = own[np.argsort(errors[own], kind="stable")]
    left = MOST
    for which in WHICH:
        for own in ranked.values():
            at = {"best": 0, "median": (len(own) - 1) // 2, "worst": len(own) - 1}[which]
            if left and (which == "median" or at != (len(own) - 1) // 2):
                left -= 1
                yield rows.slice(int(own[at]), 1).to_pylist()[0], which


def _entry(row: Mapping[str, Any], which: str, axes: tuple[str, ...]) -> dict[str, Any]:
    return {
        "file": f"{row['method']}-{which}.parquet",
        "truth": f"walk-{row['walk_sha'][:8]}.footfalls.parquet",
        **{name: row[name] for name in ("method", "scenario", "walk_seed", "unit_seed", "noise_seed", "imu")},
        "axes": {axis: row[axis] for axis in axes},
        "which": which,
        ERROR: row[ERROR],
        "key": row["key"],
    }


def _there(folder: Path, chosen: list[dict[str, Any]]) -> bool:
    try:
        told = json.loads((folder / "index.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return False
    files = {one[name] for one in chosen for name in ("file", "truth")}
    return bool(told == chosen) and all((folder / name).is_file() for name in files)


def _write(entry: Mapping[str, Any], key: str, task: Task, folder: Path) -> None:
    for trials, cells in task.trials():
        if (trials[0].unit_seed, trials[0].noise_seed) != (entry["unit_seed"], entry["noise_seed"]):
            continue
        trial, method = next(
            (trial, cell.method)
            for trial, own in zip(trials, cells, strict=True)
            for cell in own
            if cell.key == key
        )
        walk = hold(trial, None)
        if isinstance(walk, InputError):  # which the dataset has rows of: taken from the cache meanwhile
            raise walk
        recording = recording_of(trial, walk)
        given = reckoning(trial.setup, walk, recording)
        made = told(method.track(given), recording.meta, given.pdr, given.start)
        write_track(made, folder / entry["file"])
        _write_truth(walk, folder / entry["truth"])
        return


def _write_truth(walk: Walk, path: Path) -> None:
    falls = walk.footfalls
    x, y, z = falls.position.T
    write_table(path, {"t": falls.t, "x": x, "y": y, "z": z, "heading": falls.heading}, FOOTFALLS, walk.meta)
