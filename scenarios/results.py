"""Write the results of a run, all of them or none."""

from __future__ import annotations

import json
import shutil
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from footfall.errors import InputError
from footfall.pdr.track import write_track
from footfall.recording import write_recording
from footfall.scenarios.figures import run_figures
from footfall.scenarios.run import Result
from footfall.simulate.budget import write_budget
from footfall.simulate.walk import write_walk


def write_results(results: Sequence[Result], document: Mapping[str, Any], folder: Path) -> None:
    """scores.json, every walk's Parquet files and the figures, into the existing `folder`.

    They are written beside it and moved in when all are there, so that nothing half-written is ever seen.

    Raises
    ------
    InputError
        The folder cannot be written.
    """
    try:
        staging = Path(tempfile.mkdtemp(dir=folder, prefix=".writing-"))
    except OSError as error:
        raise InputError(f"{folder}: cannot be written ({error.strerror})") from None
    try:
        for result in results:
            stem = f"walk-{result.task.number + 1}"
            write_walk(result.walk, staging / f"{stem}.parquet")
            write_recording(result.recording, staging / f"{stem}.recording.parquet")
            write_budget(result.budget, staging / f"{stem}.drift.parquet", dict(result.recording.meta))
            for name, track in result.tracks.items():
                write_track(track, staging / f"{stem}.{name}.parquet")
        run_figures(results, staging)
        (staging / "scores.json").write_text(json.dumps(document, indent=2) + "\n", encoding="utf-8")
        for file in staging.iterdir():
            file.replace(folder / file.name)
    finally:
        shutil.rmtree(staging, ignore_errors=True)
