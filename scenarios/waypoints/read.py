"""Points on the way from CSV, GPX and GeoJSON, on a plane in metres."""

from __future__ import annotations

import csv
import json
import math
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple
from xml.etree import ElementTree

import numpy as np

from footfall.errors import InputError

# WGS 84: semi-major axis (m) and first eccentricity squared.
_A, _E2 = 6378137.0, 6.69437999014e-3
_PLANE = (("x", "y"), ("x_m", "y_m"), ("easting", "northing"), ("east_m", "north_m"))
_EARTH = tuple(
    (lon, lat) for lat in ("lat", "latitude", "lat_deg") for lon in ("lon", "lng", "longitude", "lon_deg")
)


_HEIGHT = ("ele", "elevation", "altitude", "alt", "height", "z", "z_m", "up_m")


class Points(NamedTuple):
    """Points on the way, in their order.

    place : (n, 2) m, to the east and to the north of the first one
    height : (n,) m, NaN where a point has none
    """

    place: np.ndarray
    height: np.ndarray


def read_points(path: str | os.PathLike[str]) -> Points:
    """The points of a file.

    Raises
    ------
    InputError
        Not CSV, GPX or GeoJSON by its ending; unreadable; without points, or with several ways; a point
        that is no place.
    """
    source = Path(path)
    read = _READERS.get(source.suffix.lower())
    if read is None:
        raise InputError(f"expected a name that ends in {', '.join(_READERS)}", source)
    try:
        text = source.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise InputError(f"cannot be read ({error.strerror})", source) from None
    except UnicodeDecodeError as error:
        raise InputError(f"not UTF-8 text ({error.reason})", source) from None
    try:
        points, heights, geodetic = read(text)
        if len(points) < 2:
            raise InputError(f"{len(points)} points, expected at least 2")
        found = np.asarray(points, dtype=float)
        if not np.isfinite(found).all():
            row = int(np.argmin(np.isfinite(found).all(axis=1)))
            raise InputError(f"point no. {row + 1} is not finite")
        return Points(projected(found) if geodetic else found - found[0], np.array(heights, dtype=float))
    except InputError as error:
        raise error.about(source) from None


def projected(degrees: np.ndarray) -> np.ndarray:
    """Longitude and latitude (n, 2) in degrees on the plane that touches the ellipsoid amid them.

    By the ellipsoid's radii of curvature there; within 0.1 % for ways of up to 10 km.

    Returns
    -------
    (n, 2) m, east and north of the first point

    Raises
    ------
    InputError
        A place that is none.
    """
    lon, lat = degrees.T
    for row in np.flatnonzero((np.abs(lat) >= 90) | (np.abs(lon) > 180)):
        raise InputError(
            f"point no. {row + 1} at latitude {lat[row]:g}, longitude {lon[row]:g}: expected within +-90 and "
            "+-180 deg"
        )
    middle = math.radians((lat.min() + lat.max()) / 2)
    bend = 1 - _E2 * math.sin(middle) ** 2
    north = _A * (1 - _E2) / bend**1.5  # meridian
    east = _A / math.sqrt(bend) * math.cos(middle)  # parallel
    away = (lon - lon[0] + 180) % 360 - 180  # across the date line too
    return np.column_stack([east * np.radians(away), north * np.radians(lat - lat[0])])


# Places, heights, and whether the places are longitude and latitude.
_Points = tuple[Sequence[Sequence[float]], Sequence[float], bool]


def _csv(text: str) -> _Points:
    rows = [row for row in csv.reader(text.splitlines()) if any(cell.strip() for cell in row)]
    names = [name.strip().lower() for name in rows[0]] if rows else []
    for pairs, geodetic in ((_EARTH, True), (_PLANE, False)):
        for pair in pairs:
            if set(pair) <= set(names):
                at = [names.index(name) for name in pair]
                places = [[_number(row, i, n) for i in at] for n, row in enumerate(rows[1:], 1)]
                up = next((names.index(name) for name in _HEIGHT if name in names), len(names))
                return places, [_height(row[up : up + 1]) for row in rows[1:]], geodetic
    raise InputError("expected columns x, y (m), or lat, lon (deg), named in the first line")


def _number(row: Sequence[str], column: int, number: int) -> float:
    try:
        return float(row[column])
    except (ValueError, IndexError):
        raise InputError(f"point no. {number} is not two numbers: {','.join(row)!r}") from None


def _height(told: Sequence[Any]) -> float:
    """The number that is told first, else NaN: a height is not needed."""
    try:
        return float(told[0])
    except (TypeError, ValueError, IndexError):
        return math.nan


def _gpx(text: str) -> _Points:
    try:
        root = ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        raise InputError(f"not valid XML ({error})") from None
    # A track that was recorded, else a route that was planned, else single waypoints in their order.
    ways = [list(way.iterfind(".//{*}trkpt")) for way in root.iterfind(".//{*}trk")]
    ways = (
        ways
        or [list(way.iterfind(".//{*}rtept")) for way in root.iterfind(".//{*}rte")]
        or [list(root.iterfind(".//{*}wpt"))]
    )
    points = _only(ways)
    try:
        places = [(float(point.attrib["lon"]), float(point.attrib["lat"])) for point in points]
    except (KeyError, ValueError):
        raise InputError("a point without lat and lon, expected numbers in degrees") from None
    return places, [_height([point.findtext("{*}ele")]) for point in points], True


def _geojson(text: str) -> _Points:
    try:
        told = json.loads(text)
    except ValueError as error:
        raise InputError(f"not valid JSON ({error})") from None
    shapes = list(_shapes(told))
    ways = [way for kind, way in shapes if kind == "way"]
    places = [place for kind, place in shapes if kind == "place"]
    points = _only(ways or [places])
    try:
        places = [(float(point[0]), float(point[1])) for point in points]
    except (TypeError, ValueError, IndexError):
        raise InputError("coordinates are not pairs of longitude and latitude") from None
    return places, [_height(point[2:]) for point in points], True


def _shapes(told: Any) -> Iterator[tuple[str, Any]]:
    """Ways and places of a GeoJSON object (RFC 7946), in their order."""
    kind = told.get("type") if isinstance(told, Mapping) else None
    if kind == "FeatureCollection":
        for feature in told.get("features", ()):
            yield from _shapes(feature)
    elif kind == "Feature":
        yield from _shapes(told.get("geometry"))
    elif kind == "GeometryCollection":
        for shape in told.get("geometries", ()):
            yield from _shapes(shape)
    elif kind in ("LineString", "MultiPoint"):
        yield "way", told.get("coordinates")
    elif kind in ("MultiLineString", "Polygon"):
        for line in told.get("coordinates", ())[: 1 if kind == "Polygon" else None]:
            yield "way", line
    elif kind == "Point":
        yield "place", told.get("coordinates")


def _only(ways: Sequence[Sequence[Any]]) -> Sequence[Any]:
    ways = [way for way in ways if way]
    if len(ways) != 1:
        raise InputError(f"{len(ways)} ways in it, expected one" if ways else "no points in it")
    return ways[0]


_READERS: Mapping[str, Callable[[str], _Points]] = {
    ".csv": _csv,
    ".gpx": _gpx,
    ".geojson": _geojson,
    ".json": _geojson,
}
