"""Errors of a track whose true walk is not known: from measured footprints, or from its start.

Of a real recording there is no true walk. Some have footprints that were measured, in a frame of their own;
others end where they began. Positions and distances are horizontal, of the IMU.
"""

from __future__ import annotations

import os
from dataclasses import asdict, dataclass

import numpy as np

from footfall.errors import InputError
from footfall.pdr.track import Track
from footfall.scenarios.judge.rigid import RigidMotion, rigid_fit
from footfall.tables import read_table, require_columns

NEAR_S = 0.6  # a footfall further from a footprint's time belongs to another one
FEWEST = 3  # of two points a fit leaves the difference of two distances, and nothing of the shape


@dataclass(frozen=True)
class Footprints:
    """Measured footfalls of the instrumented foot.

    Attributes
    ----------
    t : (n,) s, increasing, on the track's clock
    position : (n, 2) m, in any frame whose y is a quarter turn to the left of its x
    """

    t: np.ndarray
    position: np.ndarray

    def __len__(self) -> int:
        return len(self.t)


@dataclass(frozen=True)
class FootprintScore:
    """A track over measured footprints, after the shift and turn that fit best.

    Attributes
    ----------
    footprint_rmse_m, footprint_largest_m : distances of footfalls from their footprints
    footprints, matched : how many there are, and how many have a footfall near in time
    footfalls : rows of the track
    """

    footprint_rmse_m: float
    footprint_largest_m: float
    footprints: int
    matched: int
    footfalls: int

    def as_dict(self) -> dict[str, float]:
        """Plain numbers by name, for JSON."""
        return asdict(self)


@dataclass(frozen=True)
class ClosureScore:
    """A track of a walk that ends where it began.

    Attributes
    ----------
    return_error_m : distance between its first row and its last
    return_error_pct : the same in % of the distance travelled (P_err of Deng et al. 2018, section 3.2)
    distance_m : sum of the distances between its rows
    footfalls : rows of the track
    """

    return_error_m: float
    return_error_pct: float
    distance_m: float
    footfalls: int

    def as_dict(self) -> dict[str, float]:
        """Plain numbers by name, for JSON."""
        return asdict(self)


def read_footprints(path: str | os.PathLike[str]) -> Footprints:
    """Read footprints from CSV or Parquet: t (s, on the recording's clock), x, y (m).

    Raises
    ------
    InputError
        Missing columns, NaN, too few rows, or stamps that do not increase.
    """
    columns, _ = read_table(path)
    names = ("t", "x", "y")
    require_columns(str(path), columns, names)
    for name in names:
        if not np.isfinite(columns[name]).all():
            row = int(np.argmin(np.isfinite(columns[name])))
            raise InputError(f"{name} is not finite at row {row}", path)
    t = np.asarray(columns["t"], dtype=float)
    if len(t) < FEWEST or (np.diff(t) <= 0).any():
        raise InputError(f"expected at least {FEWEST} footprints with increasing t", path)
    return Footprints(t, np.column_stack([columns["x"], columns["y"]]).astype(float))


def matches(track: Track, prints: Footprints) -> tuple[np.ndarray, np.ndarray]:
    """Rows (k,) of the track's footfalls nearest in time to a footprint, and rows (k,) of those footprints.

    Footprints without a footfall within 0.6 s are left out.
    """
    nearest = np.abs(track.t[:, None] - prints.t).argmin(axis=0)
    near = np.abs(track.t[nearest] - prints.t) < NEAR_S
    return nearest[near], np.flatnonzero(near)


def laid_on(track: Track, prints: Footprints) -> RigidMotion:
    """The motion that lays a track best on footprints.

    Raises
    ------
    InputError
        Fewer than three footprints have a footfall near in time.
    """
    rows, of = matches(track, prints)
    if len(of) < FEWEST:
        raise InputError(
            f"{len(of)} of {len(prints)} footprints have a footfall within {NEAR_S:g} s, "
            f"expected at least {FEWEST}: their times are not the recording's",
            "track",
        )
    return rigid_fit(track.position[rows, :2], prints.position[of])


def score_footprints(track: Track, prints: Footprints) -> FootprintScore:
    """Judge a track against measured footprints. Their frame is not the track's: shift and turn are fitted.

    Raises
    ------
    InputError
        Fewer than three footprints have a footfall near in time.
    """
    motion, (rows, of) = laid_on(track, prints), matches(track, prints)
    off = np.hypot(*(motion(track.position[rows, :2]) - prints.position[of]).T)
    return FootprintScore(
        footprint_rmse_m=float(np.sqrt(np.mean(off**2))),
        footprint_largest_m=float(off.max()),
        footprints=len(prints),
        matched=len(of),
        footfalls=len(track),
    )


def score_closure(track: Track) -> ClosureScore:
    """Judge the track of a walk that ends where it began.

    Raises
    ------
    InputError
        The track does not move.
    """
    distance = float(np.hypot(*np.diff(track.position[:, :2], axis=0).T).sum())
    if distance == 0:
        raise InputError("it does not move", "track")
    end = float(np.hypot(*(track.position[-1] - track.position[0])[:2]))
    return ClosureScore(end, 100 * end / distance, distance, len(track))
