"""Points of CSV, GPX and GeoJSON: the same way in each, on a plane; and every refusal."""

import json

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.scenarios.waypoints.read import projected, read_points

# About 1.1 km to the east and 2.2 km to the north.
PLACES = [(11.50, 48.10), (11.515, 48.10), (11.515, 48.12)]


def line(*places, kind="LineString"):
    return {"type": kind, "coordinates": [list(place) for place in places]}


def gpx(tag, *groups):
    point = {"trk": "trkpt", "rte": "rtept"}.get(tag, "wpt")
    inner = "".join(
        f"<{tag}>" + "".join(f'<{point} lat="{lat}" lon="{lon}"/>' for lon, lat in group) + f"</{tag}>"
        if tag != "wpt"
        else "".join(f'<wpt lat="{lat}" lon="{lon}"/>' for lon, lat in group)
        for group in groups
    )
    return f'<gpx xmlns="http://www.topografix.com/GPX/1/1">{inner}</gpx>'


def written(folder, name, content):
    file = folder / name
    file.write_text(content if isinstance(content, str) else json.dumps(content), encoding="utf-8")
    return file


def test_every_format_tells_the_same_way(tmp_path):
    expected = projected(np.array(PLACES))
    rows = "".join(f"{lat},{lon},0\n" for lon, lat in PLACES)
    points = [{"type": "Feature", "geometry": {"type": "Point", "coordinates": place}} for place in PLACES]
    for name, content in {
        "a.csv": f"Latitude,lon,note\n{rows}",
        "a.gpx": gpx("trk", PLACES),
        "b.gpx": gpx("rte", PLACES),
        "c.gpx": gpx("wpt", PLACES),
        "a.geojson": line(*PLACES),
        "b.geojson": {"type": "Feature", "geometry": line(*PLACES)},
        "c.json": {"type": "FeatureCollection", "features": points},
        "d.json": {"type": "GeometryCollection", "geometries": [line(*PLACES)]},
    }.items():
        np.testing.assert_allclose(
            read_points(written(tmp_path, name, content)).place, expected, err_msg=name
        )


def test_a_polygon_is_its_outline(tmp_path):
    ring = [*PLACES, PLACES[0]]
    hole = [[0, 0], [1, 1], [0, 0]]
    file = written(tmp_path, "a.geojson", {"type": "Polygon", "coordinates": [ring, hole]})
    assert len(read_points(file).place) == 4


def test_heights_are_read_where_there_are_any(tmp_path):
    up = [512.5, np.nan, 509.0]
    ele = gpx("trk", PLACES).split("/>")
    named = (">" + (f"<ele>{h}</ele>" if h == h else "") + "</trkpt>" for h in up)
    three = [[*place, *([h] if h == h else [])] for place, h in zip(PLACES, up, strict=True)]
    cells = ["512.5", "", "509"]
    rows = "".join(f"{lat},{lon},{h}\n" for (lon, lat), h in zip(PLACES, cells, strict=True))
    for name, content in {
        "a.csv": f"lat,lon,Altitude\n{rows}",
        "a.gpx": "".join(part + end for part, end in zip(ele, [*named, ""], strict=True)),
        "a.geojson": line(*three),
    }.items():
        np.testing.assert_array_equal(read_points(written(tmp_path, name, content)).height, up, err_msg=name)


def test_a_plane_begins_at_its_first_point(tmp_path):
    file = written(tmp_path, "a.csv", "t,x,y\n0,5,7\n1,8,11\n")
    np.testing.assert_array_equal(read_points(file).place, [[0, 0], [3, 4]])
    assert np.isnan(read_points(file).height).all()


def test_a_degree_on_the_ellipsoid():
    """WGS 84: a degree of latitude is 110.574 km at the equator and 111.133 km at 45 deg; of longitude
    111.320 km at the equator and 78.847 km at 45 deg."""
    for at, north, east in ((0.0, 110.574, 111.320), (45.0, 111.133, 78.847)):
        d = 1e-3
        x, y = projected(np.array([[10, at - d / 2], [10 + d, at + d / 2]]))[1] / d / 1000
        assert (x, y) == (pytest.approx(east, abs=0.002), pytest.approx(north, abs=0.002))


def test_the_date_line_is_no_way_round_the_earth():
    x, y = projected(np.array([[179.999, 0.0], [-179.999, 0.0]]))[1]
    assert (x, y) == (pytest.approx(0.002 * 111319.49, rel=1e-6), 0)


@pytest.mark.parametrize(
    ("name", "content", "reason"),
    [
        ("a.kml", "", r"a\.kml: expected a name that ends in \.csv"),
        ("a.csv", "", "expected columns x, y"),
        ("a.csv", "a,b\n1,2\n", "expected columns x, y"),
        ("a.csv", "x,y\n1,2\n3,four\n", "point no. 2 is not two numbers: '3,four'"),
        ("a.csv", "x,y\n1,2\n3\n", "point no. 2 is not two numbers"),
        ("a.csv", "x,y\n1,2\n3,nan\n", "point no. 2 is not finite"),
        ("a.csv", "x,y\n1,2\n", "1 points, expected at least 2"),
        ("a.csv", "lat,lon\n11,2\n48,181\n", "point no. 2 at latitude 48, longitude 181"),
        ("a.csv", "lat,lon\n11,2\n-90,18\n", "point no. 2 at latitude -90"),
        ("a.gpx", "<gpx>", "not valid XML"),
        ("a.gpx", "<gpx/>", "no points in it"),
        ("a.gpx", '<gpx><wpt lat="1"/><wpt lat="2" lon="3"/></gpx>', "a point without lat and lon"),
        ("a.gpx", gpx("trk", PLACES, PLACES), "2 ways in it, expected one"),
        ("a.json", "{", "not valid JSON"),
        ("a.json", "[]", "no points in it"),
        ("a.json", '{"type": "LineString", "coordinates": [1, 2]}', "not pairs of longitude and latitude"),
        ("a.json", {"type": "MultiLineString", "coordinates": [PLACES, PLACES]}, "2 ways in it"),
    ],
)
def test_what_is_refused(tmp_path, name, content, reason):
    with pytest.raises(InputError, match=reason) as error:
        read_points(written(tmp_path, name, content))
    assert name in str(error.value)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(InputError, match=r"a\.gpx: cannot be read"):
        read_points(tmp_path / "a.gpx")
