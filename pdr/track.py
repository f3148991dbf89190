"""Estimated positions and headings, one row a footfall, with a method's own evidence beside them."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from footfall.columns import TRACK
from footfall.errors import InputError
from footfall.shown import Shown, draw_way
from footfall.tables import read_table, require_columns, write_table


@dataclass(frozen=True)
class Track(Shown):
    """The estimated positions and headings of the foot, by one method.

    Attributes
    ----------
    t : (n,) s
    position : (n, 3) m, world
    heading : (n,) rad, unwrapped, of the IMU's x axis
    evidence : name -> (n,) the method's own columns (HDR: raw and filtered rate, A, I)
    units : name -> unit of each evidence column
    meta : provenance (method, parameters, versions)
    """

    t: np.ndarray
    position: np.ndarray
    heading: np.ndarray
    evidence: Mapping[str, np.ndarray] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    meta: Mapping[str, Any] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.t)

    def _columns(self) -> dict[str, np.ndarray]:
        columns = {"t": self.t} | {axis: self.position[:, i] for i, axis in enumerate("xyz")}
        return columns | {"heading": self.heading, **self.evidence}

    def _units(self) -> Mapping[str, str]:
        return {**TRACK, **self.units}

    def _draw(self) -> np.ndarray:
        from matplotlib import pyplot

        _, axes = pyplot.subplots(1, 2, figsize=(8, 3.8), width_ratios=(1.3, 1))
        draw_way(axes[0], self.position[:, 0], self.position[:, 1])
        axes[0].set_title(f"{len(self)} footfalls")
        axes[1].plot(self.t, np.degrees(self.heading))
        axes[1].set_xlabel("time (s)")
        axes[1].set_ylabel("heading (deg)")
        return np.asarray(axes)


def write_track(track: Track, path: str | os.PathLike[str]) -> None:
    """Write `track` to Parquet: t, x, y, z, heading and the evidence."""
    write_table(path, track._columns(), track._units(), track.meta)


def read_track(path: str | os.PathLike[str]) -> Track:
    """Read a track from Parquet or CSV, by whatever program: t, x, y, z and heading are required.

    Raises
    ------
    InputError
        Missing columns, no rows, NaN, or stamps that do not increase.
    """
    columns, meta = read_table(path)
    require_columns(str(path), columns, tuple(TRACK))
    for name in TRACK:
        if not np.isfinite(columns[name]).all():
            row = int(np.argmin(np.isfinite(columns[name])))
            raise InputError(f"{name} is not finite at row {row}", path)
    t = np.asarray(columns["t"], dtype=float)
    if len(t) < 2 or (np.diff(t) <= 0).any():
        raise InputError("a track needs at least two rows with increasing t", path)
    evidence = {name: values for name, values in columns.items() if name not in TRACK}
    return Track(
        t=t,
        position=np.column_stack([columns[axis] for axis in "xyz"]).astype(float),
        heading=np.asarray(columns["heading"], dtype=float),
        evidence=evidence,
        meta=meta,
    )
