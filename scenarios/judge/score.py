"""How far a track is off the truth.

Nothing is fitted: the track is compared as it is, in the world's coordinates. A track of an unknown start
can be aligned first, by an option that says how much is fitted. Errors are estimate - truth; positions and
distances are horizontal.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from typing import Any, Literal, Protocol, cast, get_args

import numpy as np

from footfall.conventions import heading_of, wrap
from footfall.errors import InputError
from footfall.identity import WalkIdentity
from footfall.pdr.track import Track
from footfall.scenarios.judge.rigid import RigidMotion, rigid_fit, turn_between
from footfall.shown import Shown
from footfall.simulate.walk import TrueFootfalls, Walk

TIME_SLACK = 0.1  # s; an IMU's clock may run off by this much over a walk
UNCOVERED = 5.0  # s; a track that leaves out more of the walk's start or end is not judged

_UNITS = {"_deg": "deg", "_pct": "%", "_m": "m"}  # by the end of a figure's name

Align = Literal["none", "start", "yaw", "rigid"]


@dataclass(frozen=True)
class Score(Shown):
    """Errors of one track, or means over several.

    Attributes
    ----------
    heading_error_mean_deg, heading_error_final_deg : the absolute heading error, counted in full beyond
        180 deg: mean over the track's rows, and at the last one (the HDR paper's average and final E_psi)
    return_error_pct : distance between the ends of track and truth, in % of the distance travelled (P_err of
        Deng et al. 2018, section 3.2, where it is from the expected end, so that the path need not be closed)
    distance_error_pct : signed, in %: sums of the distances between rows, estimate against truth
    position_rmse_m : root mean square distance between track and truth at the track's rows
    position_error_final_m : distance between the ends of track and truth
    """

    heading_error_mean_deg: float
    heading_error_final_deg: float
    return_error_pct: float
    distance_error_pct: float
    position_rmse_m: float
    position_error_final_m: float

    def as_dict(self) -> dict[str, float]:
        """Plain numbers by name, for JSON."""
        return asdict(self)

    def _columns(self) -> dict[str, list[float]]:
        return {name: [value] for name, value in self.as_dict().items()}

    def _units(self) -> dict[str, str]:
        return {item.name: unit_of(item.name) for item in fields(self)}

    def _draw(self) -> np.ndarray:
        """A panel for each unit, a bar for each figure."""
        from matplotlib import pyplot

        units = list(_UNITS.values())
        _, axes = pyplot.subplots(1, len(units), figsize=(9, 1.6))
        for axis, unit in zip(axes, units, strict=True):
            names = [name for name, own in self._units().items() if own == unit]
            words = [name.rpartition("_")[0].replace("_", " ") for name in names]
            axis.barh(words, [getattr(self, name) for name in names], color="#1f6fb4", height=0.6)
            axis.axvline(0, color="#222222", lw=0.8)
            axis.invert_yaxis()
            axis.set_xlabel(unit)
        return np.asarray(axes)


def unit_of(score: str) -> str:
    """Of a figure of `Score`, by its name."""
    return next(unit for ending, unit in _UNITS.items() if score.endswith(ending))


@dataclass(frozen=True)
class Improvement:
    """By how many times a method's heading errors are smaller; infinite when nothing is left of them."""

    mean: float
    final: float


@dataclass(frozen=True)
class Comparison:
    """A track beside the truth, row by row.

    Attributes
    ----------
    t : (n,) s
    estimate, truth : (n, 2) m, on the plane
    heading : (n,) rad, the true one, continuous
    heading_error : (n,) rad, estimate - truth, continuous; from -pi to pi in row 0
    """

    t: np.ndarray
    estimate: np.ndarray
    truth: np.ndarray
    heading: np.ndarray
    heading_error: np.ndarray


class Poses(Protocol):
    """Of a `Walk` what a track is put beside."""

    @property
    def t(self) -> np.ndarray: ...
    @property
    def position(self) -> np.ndarray: ...
    @property
    def quaternion(self) -> np.ndarray: ...
    @property
    def footfalls(self) -> TrueFootfalls: ...
    @property
    def meta(self) -> Mapping[str, Any]: ...


def compare(track: Track, walk: Poses, align: Align = "none") -> Comparison:
    """Compare a track with the truth at the track's times.

    The true heading is read at the track's rows only: between stances the foot pitches through the vertical,
    where heading means nothing. Whole turns are counted by the walk's own footfalls, so that an error of more
    than half a turn is not mistaken for a small one.

    Parameters
    ----------
    align : what is fitted first, by a shift on the plane and a turn about the vertical
        "none": nothing; "start": position and heading of row 0 become the truth's (evo: `align_origin`);
        "yaw": the position of row 0 becomes the truth's and the turn is that of least squares over all rows;
        "rigid": shift and turn of least squares over all rows (evo: `align`; Umeyama 1991, without scale)

    Returns
    -------
    Comparison
        One row a row of the track: times, both positions (m), the true heading and its error (rad).

    Raises
    ------
    InputError
        The track is not finite, is too short, lies outside the walk's time or covers only a part of it, or
        was made of another walk.
    """
    require_scorable(track, walk)
    t = np.clip(track.t, walk.t[0], walk.t[-1])
    truth = np.column_stack([np.interp(t, walk.t, walk.position[:, axis]) for axis in (0, 1)])

    yaw = heading_of(_quaternion_at(walk, t))
    near = np.interp(t, walk.footfalls.t, walk.footfalls.heading)
    heading = near + wrap(yaw - near)
    # From row to row the error changes by far less than half a turn, even where footfalls were missed.
    error = np.unwrap(track.heading - heading)
    estimate = track.position[:, :2]
    if align != "none":
        motion = _motion(estimate, truth, float(error[0]), align)
        estimate, error = motion(estimate), error + motion.turn
    # Whole turns mean nothing at the start.
    return Comparison(track.t, estimate, truth, heading, error - error[0] + wrap(error[0]))


def _motion(estimate: np.ndarray, truth: np.ndarray, off: float, align: Align) -> RigidMotion:
    """What lays positions (n, 2) on the truth; `off` is the error of row 0's heading."""
    if align == "rigid":
        return rigid_fit(estimate, truth)
    here, there = estimate[0], truth[0]
    return RigidMotion(
        here, there, -off if align == "start" else turn_between(estimate - here, truth - there)
    )


def score(track: Track, walk: Walk, align: Align = "none") -> Score:
    """Score a track against its true walk.

    Parameters
    ----------
    align : as of `compare`

    Returns
    -------
    Score
        Six figures: heading (deg), return and distance error (%), position (m).

    Raises
    ------
    InputError
        As `compare`; or nothing was walked.
    """
    row = compare(track, walk, align)
    error_deg = np.degrees(np.abs(row.heading_error))
    off = np.hypot(*(row.estimate - row.truth).T)
    travelled, estimated = (
        float(np.hypot(*np.diff(points, axis=0).T).sum()) for points in (row.truth, row.estimate)
    )
    if travelled == 0:
        raise InputError("the truth does not move between its first and last row", "track")
    return Score(
        heading_error_mean_deg=float(error_deg.mean()),
        heading_error_final_deg=float(error_deg[-1]),
        return_error_pct=float(100 * off[-1] / travelled),
        distance_error_pct=100 * (estimated - travelled) / travelled,
        position_rmse_m=float(np.sqrt(np.mean(off**2))),
        position_error_final_m=float(off[-1]),
    )


def mean_score(scores: Sequence[Score]) -> Score:
    """Mean of each figure over walks.

    Raises
    ------
    InputError
        No scores.
    """
    if not scores:
        raise InputError("mean score: no walks were scored")
    rows = [score.as_dict() for score in scores]
    return Score(**{name: float(np.mean([row[name] for row in rows])) for name in rows[0]})


def improvement(before: Score, after: Score) -> Improvement:
    """Heading errors before over heading errors after. Of means: the ratio of means, as in the HDR paper."""

    def ratio(a: float, b: float) -> float:
        if b == 0:
            return math.inf if a > 0 else 1.0
        return a / b

    return Improvement(
        mean=ratio(before.heading_error_mean_deg, after.heading_error_mean_deg),
        final=ratio(before.heading_error_final_deg, after.heading_error_final_deg),
    )


def require_align(name: str) -> Align:
    """`name` as an alignment.

    Raises
    ------
    InputError
        There is none of that name.
    """
    if name not in get_args(Align):
        raise InputError(f"align = {name!r}: expected one of {', '.join(get_args(Align))}")
    return cast(Align, name)


def require_scorable(track: Track, walk: Poses) -> None:
    """Raise InputError where a track cannot be judged against a walk."""
    made, own = WalkIdentity.of(track.meta), WalkIdentity.of(walk.meta)
    if made is not None and own is not None and made != own:
        raise InputError(f"was made of the walk {made}, and cannot be judged against {own}", "track")
    if len(track) < 2:
        raise InputError(f"{len(track)} rows, expected at least 2", "track")
    for name in ("t", "position", "heading"):
        values = getattr(track, name)
        if not np.isfinite(values).all():
            row = int(np.argwhere(~np.isfinite(values))[0][0])
            raise InputError(f"{name} is not finite at row {row}", "track")
    step = np.diff(track.t)
    if (step <= 0).any():
        raise InputError(f"t does not increase at row {int(np.argmax(step <= 0)) + 1}", "track")
    begin, end = float(track.t[0]), float(track.t[-1])
    if begin < walk.t[0] - TIME_SLACK or end > walk.t[-1] + TIME_SLACK:
        raise InputError(
            f"{begin:.2f} to {end:.2f} s lies outside the walk, which lasts from {walk.t[0]:.2f} "
            f"to {walk.t[-1]:.2f} s",
            "track",
        )
    first, last = float(walk.footfalls.t[0]), float(walk.footfalls.t[-1])
    if begin > first + UNCOVERED or end < last - UNCOVERED:
        raise InputError(
            f"{begin:.2f} to {end:.2f} s covers only a part of the walk, whose footfalls last from "
            f"{first:.2f} to {last:.2f} s",
            "track",
        )


def _quaternion_at(walk: Poses, t: np.ndarray) -> np.ndarray:
    """(n, 4) attitude at (n,) times: linear between samples, which at a stance hardly differ."""
    i = np.clip(np.searchsorted(walk.t, t) - 1, 0, len(walk.t) - 2)
    before, after = walk.quaternion[i], walk.quaternion[i + 1]
    # q and -q are one attitude.
    after = np.where((before * after).sum(axis=1, keepdims=True) < 0, -after, after)
    share = ((t - walk.t[i]) / (walk.t[i + 1] - walk.t[i]))[:, None]
    between = (1 - share) * before + share * after
    return between / np.linalg.norm(between, axis=1, keepdims=True)
