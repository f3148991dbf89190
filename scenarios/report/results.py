"""Write the results of a run, all of them or none."""

from __future__ import annotations

import json
import os
import re
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from footfall.errors import InputError
from footfall.hdr.methods import METHODS
from footfall.pdr.track import write_track
from footfall.recording import write_recording
from footfall.scenarios.report.figures import FIGURES, run_figures
from footfall.scenarios.report.heading_figures import HEADING_FIGURES, heading_figures
from footfall.scenarios.report.page import write_page
from footfall.scenarios.run import Result
from footfall.simulate.budget import write_budget
from footfall.simulate.walk import write_walk

_FIGURES = "|".join((*FIGURES, *HEADING_FIGURES))


@contextmanager
def results_folder(folder: Path) -> Iterator[None]:
    """Make `folder` before any work is done; where the work fails, take away what was made.

    Raises
    ------
    InputError
        The folder cannot be made or written.
    """
    made = [part for part in (folder, *folder.parents) if not part.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"the folder cannot be made ({error.strerror})", folder) from None
    if not os.access(folder, os.W_OK):
        raise InputError("the folder cannot be written", folder)
    try:
        yield
    except BaseException:
        for part in made:
            with suppress(OSError):  # another's file in it by now
                part.rmdir()
        raise


def write_results(results: Sequence[Result], document: Mapping[str, Any], folder: Path) -> None:
    """scores.json, every walk's Parquet files, the figures and the page, into the existing `folder`.

    They are written aside and moved in when all are there, so that nothing half-written is ever seen. What an
    earlier run left there under such names goes: the folder speaks of one run alone.

    Raises
    ------
    InputError
        The folder cannot be written.
    """
    try:
        with tempfile.TemporaryDirectory(dir=folder, prefix=".writing-") as temporary:
            staging = Path(temporary)
            _write_all(results, document, staging)
            blocked = sorted(file.name for file in staging.iterdir() if (folder / file.name).is_dir())
            if blocked:
                raise InputError(f"{folder / blocked[0]}: a folder stands where a result is to be written")
            ours = _names_of_a_run(folder)
            earlier = {file.name for file in folder.iterdir() if ours.fullmatch(file.name)}
            written = {file.name for file in staging.iterdir()}
            for name in written:
                (staging / name).replace(folder / name)
            for name in earlier - written:
                (folder / name).unlink()
    except OSError as error:
        raise InputError(f"cannot be written ({error.strerror})", folder) from None


def _names_of_a_run(folder: Path) -> re.Pattern[str]:
    """What files of a run are called, of the run that was written there too: its scores tell its methods."""
    methods = set(METHODS)
    with suppress(OSError, ValueError, LookupError, TypeError):
        for walk in json.loads((folder / "scores.json").read_text(encoding="utf-8"))["walks"]:
            methods |= set(walk["methods"])
    tracks = "|".join(map(re.escape, sorted(methods)))
    return re.compile(rf"walk-\d+(\.(footfalls|recording|drift|{tracks}))?\.parquet|({_FIGURES})\.png")


def _write_all(results: Sequence[Result], document: Mapping[str, Any], folder: Path) -> None:
    for result in results:
        stem = f"walk-{result.trial.number + 1}"
        write_walk(result.walk, folder / f"{stem}.parquet")
        write_recording(result.recording, folder / f"{stem}.recording.parquet")
        write_budget(result.budget, folder / f"{stem}.drift.parquet", dict(result.recording.meta))
        for name, track in result.tracks.items():
            write_track(track, folder / f"{stem}.{name}.parquet")
    run_figures(results, folder)
    heading_figures(results, folder)
    (folder / "scores.json").write_text(json.dumps(document, indent=2) + "\n", encoding="utf-8")
    write_page(folder)
