"""What notebooks show: pandas with units, a table of HTML, and a figure."""

import numpy as np
import pytest

from footfall import Recording, Track
from footfall.scenarios.evaluate import Rows
from footfall.scenarios.judge.score import Score
from footfall.scenarios.trial import Row
from footfall.shown import STYLE, styled, table_html

mpl = pytest.importorskip("matplotlib")
mpl.use("agg")
pytest.importorskip("pandas")


@pytest.fixture(autouse=True)
def closed():
    from matplotlib import pyplot

    yield
    pyplot.close("all")


def recording(n=400, temperature=True):
    t = np.arange(n) / 200
    still = np.tile([0.0, 0.0, 9.8], (n, 1))
    gyro = np.column_stack([np.sin(t), np.cos(t), t])
    return Recording(t, gyro, still, 20 + t if temperature else None, meta={"unit_seed": 7})


def track():
    t = np.arange(5.0)
    return Track(
        t,
        np.column_stack([t, 2 * t, 0 * t]),
        np.radians([0, 90, 180, 270, 360]),
        evidence={"rate": t / 10},
        units={"rate": "rad/s"},
        meta={"method": "mine"},
    )


def rows():
    def row(method, number, mean):
        score = None if mean is None else Score(mean, 2 * mean, 1, 0, 1, 1)
        return Row("s", 0, 1, "Ada", "nimu", number, number, method, score, error="" if score else "lost")

    return Rows((row("pdr", 1, 10.0), row("pdr", 2, 30.0), row("<hdr>", 1, 5.0), row("<hdr>", 2, None)))


def test_a_recording_in_pandas():
    frame = recording().to_pandas()
    assert list(frame) == ["t", "gyro_x", "gyro_y", "gyro_z", "accel_x", "accel_y", "accel_z", "temperature"]
    assert frame.attrs["units"] == {
        "t": "s",
        **{f"gyro_{axis}": "rad/s" for axis in "xyz"},
        **{f"accel_{axis}": "m/s2" for axis in "xyz"},
        "temperature": "degC",
    }
    assert frame.attrs["meta"] == {"unit_seed": 7}
    assert (frame.gyro_z == frame.t).all()
    assert "temperature" not in recording(temperature=False).to_pandas()


def test_a_track_in_pandas_has_its_evidence():
    frame = track().to_pandas()
    assert list(frame) == ["t", "x", "y", "z", "heading", "rate"]
    assert frame.attrs["units"]["rate"] == "rad/s"
    assert frame.y.tolist() == [0, 2, 4, 6, 8]


def test_scores_in_pandas():
    frame = rows().to_pandas()
    assert frame.heading_error_final_deg.tolist()[:3] == [20, 60, 10]
    assert np.isnan(frame.heading_error_mean_deg[3])
    assert frame.attrs["units"]["return_error_pct"] == "%"
    assert "method" not in frame.attrs["units"]
    assert len(Rows(()).to_pandas()) == 0


def test_a_walk_in_pandas_as_a_table_and_drawn(workshop):
    from footfall.simulate.walk import read_walk
    from footfall.tables import read_table, read_units

    walk = read_walk(workshop / "walk.parquet")
    frame = walk.to_pandas()
    columns, meta = read_table(workshop / "walk.parquet")
    assert list(frame) == list(columns)
    for name, values in columns.items():
        np.testing.assert_array_equal(frame[name], values)
    units = read_units(workshop / "walk.parquet")
    assert frame.attrs["units"] == {name: unit for name, unit in units.items() if unit}
    assert frame.attrs["meta"] == meta
    axes = walk.plot()
    x, y = axes[0].lines[0].get_data()
    np.testing.assert_array_equal(x, walk.footfalls.position[:, 0])
    np.testing.assert_array_equal(y, walk.footfalls.position[:, 1])
    assert 1.5 < np.ptp(axes[1].lines[0].get_xdata()) < 4  # two strides
    told = walk._repr_html_()
    assert f"Walk: {len(walk.t):,} rows" in told
    assert "<th>px<br><small>m</small></th>" in told


def test_tables_of_html():
    told = recording()._repr_html_()
    assert "Recording: 400 rows" in told
    assert "<th>gyro_x<br><small>rad/s</small></th>" in told
    assert told.count("<tr>") == 1 + 3 + 1 + 3
    assert "<td>...</td>" in told
    assert "<td>1.995</td>" in told
    assert track()._repr_html_().count("<tr>") == 6
    told = rows()._repr_html_()
    assert "Rows (4) by method" in told
    assert "&lt;hdr&gt;" in told
    assert "<hdr>" not in told
    assert "<td>20</td>" in told  # median of 10 and 30
    assert table_html("<x>", {}, {}).startswith("<p>&lt;x&gt;: 0 rows")


def test_figures():
    rates, forces = recording().plot()
    np.testing.assert_allclose(rates.lines[2].get_ydata(), np.degrees(recording().t))
    assert rates.get_ylabel() == "rate (deg/s)"
    np.testing.assert_allclose(forces.lines[2].get_ydata(), 9.8)
    way, heading = track().plot()
    np.testing.assert_array_equal(way.lines[0].get_xydata(), track().position[:, :2])
    np.testing.assert_allclose(heading.lines[0].get_ydata(), [0, 90, 180, 270, 360])
    mean, final = rows().plot()
    assert sorted(mean.lines[0].get_xdata()) == [10, 30]
    assert final.lines[1].get_xdata() == [40]
    assert [label.get_text() for label in mean.get_yticklabels()] == ["PDR", "<hdr>"]


def test_the_style_is_the_packages_and_leaves_yours_alone():
    from matplotlib import pyplot, style

    before = mpl.rcParams["axes.spines.top"]
    with styled():
        assert not mpl.rcParams["axes.spines.top"]
    assert mpl.rcParams["axes.spines.top"] == before
    assert STYLE.is_file()
    with style.context("footfall.footfall"):
        assert not pyplot.rcParams["axes.spines.right"]
