"""Footfalls by content: what a unit made of a walk is dead-reckoned once, whatever methods go over it."""

from __future__ import annotations

import os
from contextlib import suppress
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from footfall.errors import InputError
from footfall.identity import digest_of
from footfall.pdr.footfalls import Footfalls
from footfall.pdr.strides import Strides
from footfall.sources import stage_digest
from footfall.tables import replacing

if TYPE_CHECKING:
    from footfall.scenarios.trial import Trial
    from footfall.simulate.cache import CachedWalk

_FIELDS = ("t", "interval", "distance", "rate", "position", "heading")
_STRIDES = tuple(item.name for item in fields(Strides))


class Reckoned(NamedTuple):
    """Dead reckoning of a recording, and the hash of that recording's content."""

    footfalls: Footfalls
    recording_sha: str


def footfalls_file(folder: Path, trial: Trial, walk_sha: str) -> Path:
    """Where the footfalls of a trial are kept: by all that makes them, and by nothing else."""
    made, scenario = trial.setup, trial.setup.scenario
    key = digest_of(
        walk_sha,
        stage_digest("record"),
        stage_digest("reckon"),
        trial.worn,
        trial.noise_seed,
        scenario.temperature_of(trial.number),
        scenario.unit_bias_shift(trial.unit_seed),
        sorted(made.without),
        made.pdr,
    )
    return folder / key[:2] / f"{key[:32]}.npz"


def read_footfalls(file: Path) -> Reckoned | None:
    """What is kept in a file; None where there is none, or a damaged one."""
    try:
        with np.load(file, allow_pickle=False) as kept:
            columns = {name: kept[name] for name in _FIELDS}
            told = {name: kept[f"stride_{name}"] for name in _STRIDES if f"stride_{name}" in kept}
            strides = Strides(**told) if told else None
            found = Reckoned(Footfalls(**columns, strides=strides), str(kept["recording_sha"]))
        with suppress(OSError):  # when it was last used
            os.utime(file)
        return found
    except (OSError, ValueError, KeyError, EOFError):
        return None


def write_footfalls(file: Path, found: Reckoned) -> None:
    """Keep footfalls. A full disk costs only that they are reckoned again."""
    columns = {name: getattr(found.footfalls, name) for name in _FIELDS}
    strides = found.footfalls.strides
    columns |= {f"stride_{name}": getattr(strides, name) for name in _STRIDES if strides is not None}
    with suppress(OSError, InputError):
        file.parent.mkdir(parents=True, exist_ok=True)
        with replacing(file) as temporary, temporary.open("wb") as out:
            np.savez(out, recording_sha=np.array(found.recording_sha), **columns)


def footfalls_folder() -> Path:
    """Where studies keep footfalls: beside the walks, in the user's cache."""
    from footfall.simulate.cache import cache_folder

    return cache_folder() / "footfalls"


class KeptFile(NamedTuple):
    """Footfalls in the cache: size in bytes, and s since 1970 when they were last read or written."""

    file: Path
    size: int
    used: float


def kept_footfalls(folder: Path | None = None) -> list[KeptFile]:
    """What is kept, the last used first."""
    found = []
    for file in (folder or footfalls_folder()).glob("*/*.npz"):
        with suppress(OSError):  # removed meanwhile
            told = file.stat()
            found.append(KeptFile(file, told.st_size, told.st_mtime))
    return sorted(found, key=lambda one: (-one.used, one.file.name))


def prune(keep: int) -> tuple[list[CachedWalk], list[KeptFile]]:
    """Remove walks and footfalls that were not used for longest, until the others fit into `keep` bytes.

    Returns
    -------
    The walks and the footfalls that were removed.
    """
    from footfall.simulate import cache

    footfalls = kept_footfalls()
    every: list[CachedWalk | KeptFile] = [*cache.cached_walks(), *footfalls]
    every.sort(key=lambda one: (-one.used, one.file.name))
    total, walks, fits = 0, 0, True
    removed = []
    for one in every:
        fits = fits and total + one.size <= keep
        if not fits:
            removed += [one] if isinstance(one, KeptFile) else []
            continue
        total += one.size
        walks += 0 if isinstance(one, KeptFile) else one.size
    for one in removed:
        one.file.unlink(missing_ok=True)
    return cache.prune(walks), removed
