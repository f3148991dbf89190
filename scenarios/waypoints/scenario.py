"""A scenario's file from points on the way."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path as File

import numpy as np

from footfall.errors import InputError
from footfall.late import late
from footfall.scenarios.path import DEFAULT_CORNER_M, Arc, Corner, Path, PathSpec, Straight, build_path
from footfall.scenarios.waypoints.fit import Fit, fit
from footfall.scenarios.waypoints.read import read_points
from footfall.tables import replacing

spatial = late("scipy.spatial")

TOLERANCE_M = 0.5
_FLAT_M = 0.05  # between heights: less is not worth a word


@dataclass(frozen=True)
class Traced:
    """A path, and the points that it was fitted to.

    Attributes
    ----------
    path, elements : of the scenario
    points : (n, 2) m, turned and moved as the path is: it begins at the origin, heading along x
    off : (n,) m, of each point to the path
    east : rad, course of the east in these coordinates
    climb : m, from the lowest to the highest point, which the path leaves out; 0 where no height is known
    """

    path: Path
    elements: tuple[Straight | Arc | Corner, ...]
    points: np.ndarray
    off: np.ndarray
    east: float
    climb: float


def trace(
    source: str | os.PathLike[str], tolerance: float = TOLERANCE_M, corner_radius: float = DEFAULT_CORNER_M
) -> Traced:
    """The path along the points of a CSV, GPX or GeoJSON file.

    Parameters
    ----------
    tolerance : m, how far points may lie off straights and arcs; corners are rounded besides
    corner_radius : m, to which corners are rounded where there is room

    Raises
    ------
    InputError
        As `read_points` and `fit`; a path that cannot be laid out.
    """
    points, height = read_points(source)
    try:
        found, path = _closed_if_it_can(fit(points, tolerance, corner_radius))
    except InputError as error:
        raise error.about(source) from None
    c, s = math.cos(found.heading), math.sin(found.heading)
    here = (points - found.origin) @ np.array([[c, -s], [s, c]])
    off, _ = spatial.cKDTree(np.column_stack([path.route.x, path.route.y])).query(here)
    known = height[np.isfinite(height)]
    climb = float(np.ptp(known)) if known.size else 0.0
    return Traced(path, found.elements, here, np.asarray(off), -found.heading, climb)


def _closed_if_it_can(found: Fit) -> tuple[Fit, Path]:
    """Circles that were drawn in can leave a gap, which a closed path may not have: it is open then."""
    if found.closed:
        try:
            return found, build_path(_spec(found))
        except InputError:
            last = isinstance(found.elements[-1], Corner)
            found = replace(found, closed=False, elements=found.elements[: -1 if last else None])
    return found, build_path(_spec(found))


def _spec(found: Fit) -> PathSpec:
    return PathSpec.model_validate({"elements": found.elements, "closed": found.closed})


def told(traced: Traced) -> str:
    """What the path is made of, in one line."""
    counts = []
    for kind, name in ((Straight, "straight"), (Corner, "corner"), (Arc, "arc")):
        if count := sum(isinstance(element, kind) for element in traced.elements):
            counts.append(f"{count} {name}{'s' if count > 1 else ''}")
    way = "closed path" if traced.path.closed else "path"
    level = f"; level, although heights differ by {traced.climb:.1f} m" if traced.climb >= _FLAT_M else ""
    return (
        f"{way} of {traced.path.route.length:.0f} m: {', '.join(counts)}; "
        f"at most {traced.off.max():.1f} m off the {len(traced.points)} points{level}"
    )


def scenario_text(traced: Traced, source: str | os.PathLike[str]) -> str:
    """The scenario in TOML: the path along the points, and for the rest what most paths are walked with."""
    name = File(source).name.replace('"', "'").replace("\\", "/")
    elements = "\n".join(f"  {{ {', '.join(_keys(element))} }}," for element in traced.elements)
    return f'''# The path follows {name}; {told(traced)}.
# It sets out along x, {_compass(traced.east):.0f} deg clockwise from north (of a plane: from its y axis).

description = "{traced.path.route.length:.0f} m along the points of {name}"
subjects = ["reference"]

[path]
closed = {str(traced.path.closed).lower()}
elements = [
{elements}
]

[gait]
pace_m_s = 1.3
wander_m = 0.1

[temperature]
indoors_degC = 20.0
outdoors_degC = 20.0

[sensor]
imu = "nimu"

[seeds]
base = 1
walks = 1
'''


def write_scenario(traced: Traced, source: str | os.PathLike[str], output: str | os.PathLike[str]) -> None:
    """Write `scenario_text` of the points of the file `source`."""
    with replacing(output) as temporary:
        temporary.write_text(scenario_text(traced, source), encoding="utf-8")


def _compass(east: float) -> float:
    """Where the x axis points, clockwise from north (deg), from the course of the east in its frame."""
    return (90 + math.degrees(east)) % 360


def _keys(element: Straight | Arc | Corner) -> Iterable[str]:
    told = element.model_dump(exclude_defaults=True)
    yield f'kind = "{element.kind}"'
    for key, value in told.items():
        if key != "kind":
            yield f"{key} = {value!r}"
