"""A path: straights, arcs, corners and slopes, laid out in closed form.

A corner stands at a vertex: it rounds the angle between its neighbours with an arc whose tangent points
lie r tan(|a| / 2) from the vertex. A straight beside it is trimmed by that much, so that its stated length
is the distance between vertices. An arc is never trimmed, which would change its angle: an arc beside a
corner begins (or ends) at the corner's tangent point, with its full length and turn. So

    length = sum of straights + sum of r |a| over arcs and corners
             - sum of r tan(|a| / 2) over those sides of corners on which a straight lies.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from pydantic import Field, model_validator

from footfall.errors import InputError
from footfall.models.route import Route
from footfall.toml import Strict

MIN_RADIUS_M = 1.5  # of an arc that is walked as such; corners may be sharper
DEFAULT_CORNER_M = 1.5
UNROUNDED_M = 0.05  # the radius that stands for none
MAX_GRADE_PERCENT = 8.0
MAX_LENGTH_M = 50_000.0
SPACING_M = 0.1

Positive = Annotated[float, Field(gt=0)]


class Element(Strict):
    """What all elements have: their grade, uphill positive."""

    grade_percent: float = Field(0.0, ge=-MAX_GRADE_PERCENT, le=MAX_GRADE_PERCENT)


class Straight(Element):
    """A straight; beside a corner its length counts to the corner's vertex."""

    kind: Literal["straight"] = "straight"
    length_m: Positive


class Arc(Element):
    """An arc, given by its turn (left positive) or by its length and the side to which it turns."""

    kind: Literal["arc"] = "arc"
    radius_m: Positive
    turn_deg: float | None = None
    length_m: Positive | None = None
    side: Literal["left", "right"] | None = None

    @model_validator(mode="after")
    def _one_way(self) -> Arc:
        by_turn, by_length = self.turn_deg is not None, self.length_m is not None
        if by_turn == by_length or by_length != (self.side is not None):
            raise ValueError("an arc needs radius_m and either turn_deg (left positive) or length_m and side")
        if self.turn_deg == 0:
            raise ValueError("turn_deg = 0: an arc must turn")
        return self

    @property
    def turn(self) -> float:
        """Change of heading (rad), left positive."""
        if self.turn_deg is not None:
            return math.radians(self.turn_deg)
        assert self.length_m is not None
        return math.copysign(self.length_m / self.radius_m, 1 if self.side == "left" else -1)


class Corner(Element):
    """A corner: turn (left positive) at a vertex, rounded to a radius."""

    kind: Literal["corner"] = "corner"
    turn_deg: float = Field(gt=-180, lt=180)
    radius_m: float = Field(DEFAULT_CORNER_M, ge=0)

    @model_validator(mode="after")
    def _turns(self) -> Corner:
        if self.turn_deg == 0:
            raise ValueError("turn_deg = 0: a corner must turn")
        return self

    @property
    def turn(self) -> float:
        """Change of heading (rad), left positive."""
        return math.radians(self.turn_deg)

    @property
    def radius(self) -> float:
        """Radius of the line (m): a corner that is not rounded is as good as one of 5 cm."""
        return max(self.radius_m, UNROUNDED_M)

    @property
    def tangent(self) -> float:
        """From the vertex to either end of the corner's arc (m)."""
        return self.radius * math.tan(abs(self.turn) / 2)


class PathSpec(Strict):
    """A path as it stands in a scenario's TOML.

    Attributes
    ----------
    elements : in walking order; neighbouring straights join without a corner (to change the grade)
    closed : the path must end where it began, in place, heading and height; a corner at either end of the
        list then stands between the last element and the first, and trims both
    closure_tolerance_m, closure_tolerance_deg : how far a closed path may miss
    vertical_transition_m : the grade changes linearly over this length, centred where elements meet; the
        first and the last half of it must be level, for walks begin and end on level ground
    """

    elements: Annotated[
        tuple[Annotated[Straight | Arc | Corner, Field(discriminator="kind")], ...],
        Field(strict=False, min_length=1),
    ]
    closed: bool = False
    closure_tolerance_m: Positive = 0.05
    closure_tolerance_deg: Positive = 0.1
    vertical_transition_m: float = Field(10.0, ge=2.0, le=100.0)


@dataclass(frozen=True)
class Pieces:
    """Pieces of constant curvature and (before smoothing) constant grade, end to end.

    Attributes
    ----------
    length : (n,) m, as walked: after trimming
    curvature : (n,) 1/m, positive to the left
    grade : (n,) rise over run
    """

    length: np.ndarray
    curvature: np.ndarray
    grade: np.ndarray

    @property
    def start(self) -> np.ndarray:
        """(n,) m, the distance at which each piece begins."""
        return np.concatenate([[0.0], np.cumsum(self.length)[:-1]])

    @property
    def total(self) -> float:
        """Horizontal length of the path (m)."""
        return float(self.length.sum())


@dataclass(frozen=True)
class Closure:
    """End minus start: distance on the plane (m), heading (deg, in -180..180) and height (m)."""

    gap_m: float
    heading_deg: float
    climb_m: float


@dataclass(frozen=True)
class Path:
    """A path laid out.

    Attributes
    ----------
    route : sampled evenly, at most 0.1 m apart
    pieces : what it is made of
    transition : m, over which the grade changes
    closed : it was required to end where it began
    closure : how well it does
    """

    route: Route
    pieces: Pieces
    transition: float
    closed: bool
    closure: Closure

    @property
    def level(self) -> bool:
        """No slope anywhere."""
        return not self.pieces.grade.any()


def lay_out(spec: PathSpec, min_radius_m: float = MIN_RADIUS_M) -> Pieces:
    """Trim the straights by the corners and join the pieces.

    Raises
    ------
    InputError
        A radius below `min_radius_m`, a straight too short for its corners, or too long a path.
    """
    elements = spec.elements
    trims = np.zeros(len(elements))
    for i, element in enumerate(elements):
        if isinstance(element, Arc) and element.radius_m < min_radius_m:
            raise InputError(
                f"path.elements no. {i + 1}, radius_m = {element.radius_m:g}: "
                f"the walker cannot walk an arc of less than {min_radius_m:g} m (a corner may be sharper)"
            )
        if isinstance(element, Corner):
            for neighbour in (i - 1, i + 1):
                if spec.closed:
                    neighbour %= len(elements)
                if 0 <= neighbour < len(elements) and isinstance(elements[neighbour], Straight):
                    trims[neighbour] += element.tangent

    length, curvature = [], []
    for i, element in enumerate(elements):
        if isinstance(element, Straight):
            if element.length_m < trims[i]:
                raise InputError(
                    f"path.elements no. {i + 1}, length_m = {element.length_m:g}: "
                    f"too short for its corners, which take {trims[i]:.3f} m of it"
                )
            length.append(element.length_m - trims[i])
            curvature.append(0.0)
        else:
            radius = element.radius if isinstance(element, Corner) else element.radius_m
            length.append(abs(element.turn) * radius)
            curvature.append(math.copysign(1 / radius, element.turn))
    total = sum(length)
    if total > MAX_LENGTH_M:
        raise InputError(f"path.elements: {total:g} m in all, expected {MAX_LENGTH_M:g} m at most")
    if total <= 0:
        raise InputError("path.elements: nothing is left of the straights after trimming")
    grade = [element.grade_percent / 100 for element in elements]
    walked = np.asarray(length) > 0
    return Pieces(np.asarray(length)[walked], np.asarray(curvature)[walked], np.asarray(grade)[walked])


def plan(pieces: Pieces, s: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Exact pose at distances along the path; beyond its ends the outer pieces go on.

    Parameters
    ----------
    s : (n,) m

    Returns
    -------
    x, y : (n,) m, from the origin at s = 0
    heading : (n,) rad, unwrapped, 0 at s = 0
    curvature : (n,) 1/m, of the piece that begins or goes on at s
    """

    heading0 = np.concatenate([[0.0], np.cumsum(pieces.curvature * pieces.length)[:-1]])
    step = np.array(_chord(pieces.length, pieces.curvature, heading0))
    x0, y0 = np.concatenate([np.zeros((2, 1)), np.cumsum(step, axis=1)[:, :-1]], axis=1)
    i, u = _locate(pieces, s)
    dx, dy = _chord(u, pieces.curvature[i], heading0[i])
    return x0[i] + dx, y0[i] + dy, heading0[i] + pieces.curvature[i] * u, pieces.curvature[i]


def elevation(pieces: Pieces, transition: float, s: np.ndarray) -> np.ndarray:
    """Height at distances along the path, 0 at s = 0.

    The grade is averaged over `transition` metres centred on s: parabolic vertical curves, as roads have.

    Parameters
    ----------
    transition : m
    s : (n,) m

    Returns
    -------
    z : (n,) m
    """
    rise = pieces.grade * pieces.length
    once = np.concatenate([[0.0], np.cumsum(rise)[:-1]])
    twice = np.concatenate([[0.0], np.cumsum((once + rise / 2) * pieces.length)[:-1]])

    def second_integral(at: np.ndarray) -> np.ndarray:
        i, u = _locate(pieces, at)
        return twice[i] + once[i] * u + pieces.grade[i] * u**2 / 2

    def mean_height(at: np.ndarray) -> np.ndarray:
        return (second_integral(at + transition / 2) - second_integral(at - transition / 2)) / transition

    return mean_height(s) - mean_height(np.zeros(1))


def build_path(spec: PathSpec, min_radius_m: float = MIN_RADIUS_M) -> Path:
    """Lay out and sample a path, evenly and at most 0.1 m apart.

    Raises
    ------
    InputError
        What `lay_out` refuses, a slope at either end, or a closed path that does not close.
    """
    pieces = lay_out(spec, min_radius_m)
    _require_level_ends(spec, pieces)
    s = np.linspace(0.0, pieces.total, math.ceil(pieces.total / SPACING_M - 1e-9) + 1)
    x, y, heading, curvature = plan(pieces, s)
    z = elevation(pieces, spec.vertical_transition_m, s)
    closure = Closure(
        gap_m=math.hypot(x[-1], y[-1]),
        heading_deg=math.degrees(math.remainder(heading[-1], math.tau)),
        climb_m=float(z[-1]),
    )
    if spec.closed:
        _require_closed(spec, closure, (x[-1], y[-1]))
    route = Route(s, x, y, z, heading, curvature)
    return Path(route, pieces, spec.vertical_transition_m, spec.closed, closure)


def _locate(pieces: Pieces, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Index of the piece at s, and the distance into it."""
    i = np.clip(np.searchsorted(pieces.start, s, side="right") - 1, 0, len(pieces.length) - 1)
    return i, s - pieces.start[i]


def _chord(length: np.ndarray, curvature: np.ndarray, heading: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Chord (x, y) of an arc, from its first heading: exact, and regular at curvature 0."""
    half = curvature * length / 2
    size = length * np.sinc(half / np.pi)
    return size * np.cos(heading + half), size * np.sin(heading + half)


def _require_level_ends(spec: PathSpec, pieces: Pieces) -> None:
    sloping = np.flatnonzero(pieces.grade)
    if not len(sloping):
        return
    ends = pieces.start + pieces.length
    level = {"begins": pieces.start[sloping[0]], "ends": pieces.total - ends[sloping[-1]]}
    for verb, length in level.items():
        if length < spec.vertical_transition_m / 2:
            raise InputError(
                f"path.elements: the path {verb} with {length:g} m of level ground, expected "
                f"{spec.vertical_transition_m / 2:g} m at least (half of vertical_transition_m)"
            )


def _require_closed(spec: PathSpec, closure: Closure, end: tuple[float, float]) -> None:
    within, within_deg = spec.closure_tolerance_m, spec.closure_tolerance_deg
    if closure.gap_m > within:
        raise InputError(
            f"path.closed = true: the path ends at ({end[0]:.3f}, {end[1]:.3f}) m, "
            f"{closure.gap_m:.3f} m from its start, expected {within:g} m at most"
        )
    if abs(closure.heading_deg) > within_deg:
        raise InputError(
            f"path.closed = true: the path ends {closure.heading_deg:.3f} deg off the heading of its start, "
            f"expected {within_deg:g} deg at most"
        )
    if abs(closure.climb_m) > within:
        raise InputError(
            f"path.closed = true: the path ends {closure.climb_m:.3f} m above its start, "
            f"expected {within:g} m at most"
        )
