"""The truth of one walk: the IMU's pose, what a perfect IMU measures, and the true footfalls."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from footfall.columns import ACCEL, FOOTFALLS, GYRO, PLACE, POSITION, QUATERNION, VELOCITY, WALK
from footfall.conventions import heading_of
from footfall.errors import InputError
from footfall.identity import content_digest
from footfall.shown import Shown, draw_walk
from footfall.tables import Columns, read_table, require_columns, write_table


@dataclass(frozen=True)
class TrueFootfalls:
    """The middle of each stance of the instrumented foot.

    Attributes
    ----------
    t : (m,) s
    position : (m, 3) m, of the IMU site in the world
    heading : (m,) rad, unwrapped, of the IMU's x axis
    """

    t: np.ndarray
    position: np.ndarray
    heading: np.ndarray


@dataclass(frozen=True)
class Walk(Shown):
    """The truth of one simulated walk at the IMU site. Row 0 is the start pose.

    The walker stands for the first `meta["calibration_s"]` seconds, of which the static bias is taken; row 0
    of the footfalls ends them. `meta["ends"]` is "standing", or "in mid-gait" where it failed to stop.

    Attributes
    ----------
    t : (n,) s, evenly spaced, ends of the sampling intervals
    position : (n, 3) m; quaternion : (n, 4) body to world, scalar first; velocity : (n, 3) m/s
    gyro : (n, 3) rad/s and accel : (n, 3) m/s2: what a perfect IMU measures over the interval up to t
    contact : (n,) share of the body weight on the instrumented foot
    stance : (n,) bool, the foot is on the ground at rest
    footfalls : the true footfalls
    meta : its identity (`footfall.identity.WalkIdentity`), pace, rate, calibration, how it ends, versions
    """

    t: np.ndarray
    position: np.ndarray
    quaternion: np.ndarray
    velocity: np.ndarray
    gyro: np.ndarray
    accel: np.ndarray
    contact: np.ndarray
    stance: np.ndarray
    footfalls: TrueFootfalls
    meta: Mapping[str, Any] = field(default_factory=dict)

    @property
    def interval(self) -> float:
        """Sampling interval (s)."""
        return float(self.t[-1] - self.t[0]) / (len(self.t) - 1)

    @property
    def calibration_s(self) -> float:
        """Length of the motionless start (s)."""
        return float(self.meta.get("calibration_s", 0.0))

    @cached_property
    def sha(self) -> str:
        """Hash of the content: the same for the same bits, whatever they are called."""
        falls = self.footfalls
        return content_digest(
            *(self.t, self.position, self.quaternion, self.velocity, self.gyro, self.accel, self.contact),
            *(self.stance, falls.t, falls.position, falls.heading),
        )

    def _columns(self) -> dict[str, np.ndarray]:
        triads = (
            (POSITION, self.position),
            (QUATERNION, self.quaternion),
            (VELOCITY, self.velocity),
            (GYRO, self.gyro),
            (ACCEL, self.accel),
        )
        columns = {"t": self.t}
        for names, values in triads:
            columns |= dict(zip(names, values.T, strict=True))
        return columns | {"contact": self.contact, "stance": self.stance}

    def _units(self) -> Mapping[str, str]:
        return WALK

    def _draw(self) -> np.ndarray:
        return draw_walk(self)

    def pose_at_rest(self, after_s: float) -> tuple[tuple[float, float, float], float]:
        """Position (m) and heading (rad) of the IMU `after_s` into the motionless start, or at its end."""
        at = min(after_s, float(self.footfalls.t[0] - self.t[0]))
        row = max(int(np.searchsorted(self.t - self.t[0], at + 1e-6)) - 1, 0)
        x, y, z = (float(value) for value in self.position[row])
        return (x, y, z), float(heading_of(self.quaternion[row]))


def footfalls_path(path: str | os.PathLike[str]) -> Path:
    """The file beside a walk that holds its footfalls: walk.parquet -> walk.footfalls.parquet."""
    source = Path(path)
    return source.with_name(f"{source.stem}.footfalls{source.suffix}")


def write_walk(walk: Walk, path: str | os.PathLike[str]) -> None:
    """Write the walk and, beside it, its footfalls."""
    f = walk.footfalls
    columns = {
        "t": f.t,
        "x": f.position[:, 0],
        "y": f.position[:, 1],
        "z": f.position[:, 2],
        "heading": f.heading,
    }
    # The footfalls first, so that a walk that is there has its footfalls.
    write_table(footfalls_path(path), columns, FOOTFALLS, walk.meta)
    write_table(path, walk._columns(), WALK, walk.meta, smooth=True)


def read_walk(path: str | os.PathLike[str]) -> Walk:
    """Read a walk that `write_walk` wrote.

    Raises
    ------
    InputError
        Missing file, columns or footfalls; values that are not finite; times that do not increase.
    """
    columns, meta = read_table(path)
    _require_rows(path, columns, tuple(WALK))
    beside = footfalls_path(path)
    falls, _ = read_table(beside)
    _require_rows(beside, falls, tuple(FOOTFALLS))
    return Walk(
        t=columns["t"],
        position=_stack(columns, POSITION),
        quaternion=_stack(columns, QUATERNION),
        velocity=_stack(columns, VELOCITY),
        gyro=_stack(columns, GYRO),
        accel=_stack(columns, ACCEL),
        contact=columns["contact"],
        stance=columns["stance"].astype(bool),
        footfalls=TrueFootfalls(t=falls["t"], position=_stack(falls, PLACE), heading=falls["heading"]),
        meta=meta,
    )


def _stack(columns: Columns, names: tuple[str, ...]) -> np.ndarray:
    # In memory as a walk that comes from the simulator, so that the same bits come out of it.
    return np.column_stack([columns[name] for name in names]).astype(float)


def _require_rows(path: str | os.PathLike[str], columns: Columns, names: tuple[str, ...]) -> None:
    """Refuse missing columns, numbers that are not finite, and times (the first of `names`) out of order."""
    require_columns(str(path), columns, names)
    for name in names:
        if not np.isfinite(columns[name]).all():
            raise InputError(
                f"{name} is not finite at row {int(np.argmin(np.isfinite(columns[name])))}", path
            )
    t = columns[names[0]]
    if len(t) < 2 or (np.diff(t) <= 0).any():
        raise InputError(f"expected at least two rows with increasing {names[0]}", path)
