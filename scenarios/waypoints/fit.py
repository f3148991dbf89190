"""Points to straights, arcs and corners.

The path is a belt around pegs: a corner (or an end) is a peg without extent, an arc one with a radius.
Between two pegs the belt is their common tangent, so that arcs and straights join smoothly by construction.

1. Douglas and Peucker (1973): which points are needed to keep all others within the tolerance.
2. Where several of these in a row bend to one side and lie on a circle, the circle takes their place.
3. The belt gives straights and turns; a corner is rounded as far as the straights beside it allow.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from footfall.conventions import wrap
from footfall.errors import InputError
from footfall.scenarios.path import DEFAULT_CORNER_M, MIN_RADIUS_M, UNROUNDED_M, Arc, Corner, Straight

_SHARPEST = math.radians(60)  # turn of one point of an arc: what turns more is a corner
_LEAST = math.radians(20)  # turn of a whole arc: what turns less is a kink
_WIDEST_M = 2000.0  # radius: what is wider is straight
_SMOOTH = math.radians(15)  # off the circle's tangent where a straight runs into an arc
_NOTHING = math.radians(0.05)  # turn that needs no corner


@dataclass(frozen=True)
class Peg:
    """A place that the belt turns around.

    Attributes
    ----------
    centre : (2,) m
    radius : m, signed: positive to the left; 0 for a corner or an end
    turn : rad, about how much the belt turns there
    points : the first and the last of the points that it stands for
    """

    centre: np.ndarray
    radius: float
    turn: float
    points: tuple[int, int]


@dataclass(frozen=True)
class Fit:
    """Elements of a path, and where it lies among the points.

    Attributes
    ----------
    elements : straights, arcs and corners, in walking order
    closed : it ends where it began
    origin : (2,) m, of the path's start among the points
    heading : rad, there
    """

    elements: tuple[Straight | Arc | Corner, ...]
    closed: bool
    origin: np.ndarray
    heading: float


def fit(points: np.ndarray, tolerance: float, corner_radius: float = DEFAULT_CORNER_M) -> Fit:
    """Straights, arcs and corners along points.

    Parameters
    ----------
    points : (n, 2) m
    tolerance : m, how far points may lie off the line
    corner_radius : m, to which corners are rounded where there is room

    Raises
    ------
    InputError
        Points that cannot be walked along: all at one place, a way that turns back on itself, or points too
        near to each other for the turn between them.
    """
    kept = _apart(points)
    line = points[kept]
    if len(line) < 2:
        raise InputError("all points lie at one place")
    reach = float(np.max(np.hypot(*(line - line[0]).T)))
    closed = len(line) > 3 and math.dist(line[0], line[-1]) <= max(tolerance, 0.01 * reach)
    if closed:
        line = np.vstack([line[:-1], line[:1]])
    needed = simplified(line, tolerance)
    pegs, barred = _pegs(line, needed, tolerance, frozenset()), frozenset[int]()
    while (wrong := _wrong_arc(pegs)) is not None:  # a circle that the belt cannot go around: points again
        barred |= {pegs[wrong].points[0]}
        pegs = _pegs(line, needed, tolerance, barred)
    heading, lengths = _belt(pegs)
    elements = _elements(pegs, heading, lengths, closed, corner_radius, kept)
    origin, last = pegs[0].centre, elements[-1]
    if closed and isinstance(last, Corner) and lengths[0] > 0:  # the path begins where this corner ends
        origin = origin + last.tangent * np.array([math.cos(heading[0]), math.sin(heading[0])])
    return Fit(elements, closed, origin, float(heading[0]))


def _apart(points: np.ndarray, least: float = 0.01) -> np.ndarray:
    """Indices of the points that are not at the place of the one before them."""
    kept = [0]
    for i in range(1, len(points)):
        if math.dist(points[i], points[kept[-1]]) > least:
            kept.append(i)
    return np.array(kept)


def simplified(line: np.ndarray, tolerance: float) -> np.ndarray:
    """Indices of the points (n, 2) that keep the others within `tolerance` (m) of the straights between."""
    needed, ahead = {0, len(line) - 1}, [(0, len(line) - 1)]
    while ahead:
        first, last = ahead.pop()
        if last - first < 2:
            continue
        off = _off_segment(line[first + 1 : last], line[first], line[last])
        far = int(np.argmax(off))
        if off[far] > tolerance:
            middle = first + 1 + far
            needed.add(middle)
            ahead += [(first, middle), (middle, last)]
    return np.array(sorted(needed))


def _off_segment(points: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    along = b - a
    share = np.clip((points - a) @ along / max(float(along @ along), 1e-12), 0, 1)
    return np.asarray(np.hypot(*(points - a - share[:, None] * along).T))


def _pegs(line: np.ndarray, needed: np.ndarray, tolerance: float, barred: frozenset[int]) -> list[Peg]:
    """Corners and, where points lie on circles, arcs; none that begins at a point in `barred`."""
    corner = line[needed]
    step = np.diff(corner, axis=0)
    course = np.arctan2(step[:, 1], step[:, 0])
    turn = np.concatenate([[0.0], wrap(np.diff(course)), [0.0]])
    pegs: list[Peg] = []
    i = 0
    while i < len(needed):
        found = None if needed[i] in barred else _longest_arc(line, needed, turn, i, tolerance)
        if found is None:
            pegs.append(Peg(corner[i], 0.0, float(turn[i]), (int(needed[i]), int(needed[i]))))
            i += 1
            continue
        last, circle = found
        side = math.copysign(1, circle.radius)
        for end, which in ((i, 0), (last, -1)):
            # The circle's tangent there, against the straight that leads to it or from it.
            out = corner[end] - circle.centre
            tangent = math.atan2(out[1], out[0]) + side * math.pi / 2
            straight = end - 1 if which == 0 else end
            outer = end in (0, len(needed) - 1)
            sharp = outer or abs(wrap(course[straight] - tangent)) > _SMOOTH
            on_circle = circle.centre + out * (abs(circle.radius) / math.hypot(*out))
            peg = Peg(on_circle, 0.0, 0.0, (int(needed[end]), int(needed[end])))
            if which == 0:
                pegs += [peg, circle] if sharp else [circle]
            elif sharp:
                pegs.append(peg)
        i = last + 1
    return _touching(pegs)


def _longest_arc(
    line: np.ndarray, needed: np.ndarray, turn: np.ndarray, first: int, tolerance: float
) -> tuple[int, Peg] | None:
    """The arc that goes on for longest from a needed point: its last needed point, and its circle."""
    found = None
    for last in range(first + 2, len(needed)):
        inside = turn[first + 1 : last]
        if (np.sign(inside) != np.sign(inside[0])).any() or np.abs(inside).max() > _SHARPEST:
            break
        if last - first < 3:
            continue
        part = line[needed[first] : needed[last] + 1]
        middles = (part[1:] + part[:-1]) / 2
        centre, radius = circle_through(part)
        off = np.abs(np.hypot(*(np.vstack([part, middles]) - centre).T) - radius)
        if not MIN_RADIUS_M <= radius <= _WIDEST_M or off.max() > tolerance:
            continue
        about = float(inside.sum()) * (len(inside) + 1) / len(inside)
        if abs(about) >= _LEAST:
            side = math.copysign(radius, inside[0])
            found = last, Peg(centre, side, about, (int(needed[first]), int(needed[last])))
    return found


def circle_through(points: np.ndarray) -> tuple[np.ndarray, float]:
    """Centre (2,) and radius (m) of the circle of least algebraic squares (Kasa 1976) through (n, 2)."""
    middle = points.mean(axis=0)
    local = points - middle
    terms = np.column_stack([2 * local, np.ones(len(local))])
    (x, y, c), *_ = np.linalg.lstsq(terms, (local**2).sum(axis=1), rcond=None)
    return middle + np.array([x, y]), math.sqrt(max(c + x * x + y * y, 0.0))


def _touching(pegs: list[Peg]) -> list[Peg]:
    """Circles drawn in as far as their neighbours need for a common tangent: fits leave some too large."""
    made = list(pegs)
    for _ in range(20):
        calm = True
        for i in range(len(made) - 1):
            a, b = made[i], made[i + 1]
            apart = math.dist(a.centre, b.centre)
            over = abs(b.radius - a.radius) - apart
            if over <= 1e-9 * (1 + apart):
                continue
            calm = False
            small = i if abs(a.radius) > abs(b.radius) else i + 1
            one = made[small]
            radius = math.copysign(max(abs(one.radius) - over, 0.0), one.radius)
            made[small] = Peg(one.centre, radius, one.turn, one.points)
        if calm:
            break
    return made


def _belt(pegs: list[Peg]) -> tuple[np.ndarray, np.ndarray]:
    """Heading (rad) and length (m) of the tangent from each peg to the next."""
    ahead = np.diff([peg.centre for peg in pegs], axis=0)
    across = np.diff([peg.radius for peg in pegs])
    apart = np.hypot(*ahead.T)
    along = np.sqrt(np.maximum(apart**2 - across**2, 0.0))
    along[along < 1e-6 * (1 + apart)] = 0.0
    # The centres lie `along` ahead and, by the difference of the signed radii, to the left.
    heading = np.arctan2(ahead[:, 1], ahead[:, 0]) - np.arctan2(across, along)
    return heading, along


def _turns(pegs: list[Peg], heading: np.ndarray) -> np.ndarray:
    """Turn at each peg but the outer ones (rad): of an arc it may be more than half a turn."""
    about = np.array([peg.turn if peg.radius else 0.0 for peg in pegs[1:-1]])
    return about + wrap(np.diff(heading) - about)


def _wrong_arc(pegs: list[Peg]) -> int | None:
    """An arc that the belt would go around by the wrong side, or far more or less than the points do."""
    heading, _ = _belt(pegs)
    for i, (peg, turn) in enumerate(zip(pegs[1:-1], _turns(pegs, heading), strict=True), 1):
        if peg.radius and (turn * peg.radius <= 0 or abs(turn - peg.turn) > _SHARPEST):
            return i
        if peg.turn and abs(peg.radius) < MIN_RADIUS_M and peg.points[0] != peg.points[1]:
            return i  # drawn in too far
    return None


def _elements(
    pegs: list[Peg],
    heading: np.ndarray,
    lengths: np.ndarray,
    closed: bool,
    corner_radius: float,
    kept: np.ndarray,
) -> tuple[Straight | Arc | Corner, ...]:
    turns = np.concatenate([[0.0], _turns(pegs, heading), [0.0]])
    if closed:
        turns[-1] = wrap(heading[0] - heading[-1])
    sharp = np.array(
        [peg.radius == 0 and abs(turn) > _NOTHING for peg, turn in zip(pegs, turns, strict=True)]
    )
    for peg, turn in zip(pegs, np.where(sharp, turns, 0.0), strict=True):
        if abs(turn) > math.radians(179):
            raise InputError(f"{_named(peg, kept)}: the way turns back on itself there, expected a turn")
    half = np.where(sharp, np.tan(np.abs(turns) / 2), 0.0)
    # Half of each straight, or all of it where its other end is no corner.
    other = np.column_stack([sharp[:-1], sharp[1:]])
    if closed and sharp[-1]:
        other[0, 0] = True
    room = lengths / np.maximum(other.sum(axis=1), 1)
    elements: list[Straight | Arc | Corner] = []
    for i in range(len(pegs)):
        peg, turn = pegs[i], float(turns[i])
        if peg.radius and 0 < i < len(pegs) - 1:
            elements.append(
                Arc(
                    grade_percent=0.0,
                    radius_m=round(abs(peg.radius), 4),
                    turn_deg=round(math.degrees(turn), 6),
                )
            )
        elif sharp[i]:
            beside = [room[i - 1], room[i if i < len(room) else 0]]
            least = min((float(r) for r in beside if r > 0), default=0.0)
            radius = min(corner_radius, 0.98 * least / float(half[i]))
            if radius < UNROUNDED_M:
                raise InputError(
                    f"{_named(peg, kept)}: {least * 2:.2f} m to the next turn, too near for one of "
                    f"{abs(math.degrees(turn)):.0f} deg (a larger --tolerance leaves such points out)"
                )
            elements.append(
                Corner(
                    grade_percent=0.0,
                    turn_deg=round(math.degrees(turn), 6),
                    radius_m=math.floor(1000 * radius) / 1000,
                )
            )
        if i < len(lengths) and lengths[i] > 0:
            elements.append(Straight(grade_percent=0.0, length_m=round(float(lengths[i]), 4)))
    return tuple(elements)


def _named(peg: Peg, kept: np.ndarray) -> str:
    return f"point no. {int(kept[min(peg.points[0], len(kept) - 1)]) + 1}"
