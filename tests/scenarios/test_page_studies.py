"""Pages of sweeps and of gates, as their source tells them."""

import json

import numpy as np
import pytest

from footfall.scenarios.report.page import write_page
from tests.helpers.commands import expect_one_sentence
from tests.helpers.pages import NASTY, Page, gate_folder, sweep_folder

MEAN, DISTANCE = {"score": "heading_error_mean_deg"}, {"score": "distance_error_pct"}
RADIUS, IMU, THETA = "axis-0", "axis-1", "axis-2"


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    return Page(write_page(sweep_folder(tmp_path_factory.mktemp("page") / "study")))


@pytest.fixture(scope="module")
def gates(tmp_path_factory):
    return Page(write_page(gate_folder(tmp_path_factory.mktemp("page") / "gates")))


# Sweeps


def test_each_axis_has_a_panel_of_each_score(study):
    places = [chart["place"] for chart in study.data["charts"] if chart["when"].items() >= MEAN.items()]
    assert places == [RADIUS, IMU, THETA]
    titles = [study.charts(place, **MEAN)[0]["x"]["title"] for place in places]
    assert titles == ["radius (m)", "IMU", "theta w (deg/s)"]
    assert len(study.charts(RADIUS)) == 6
    assert study.charts(RADIUS, **MEAN)[0]["y"]["title"] == "mean heading error (deg)"


def test_values_stand_side_by_side_in_the_studys_order_and_methods_beside_each_other(study):
    (chart,) = study.charts(IMU, **MEAN)
    assert chart["x"]["ticks"] == [[0.0, "phone"], [1.0, "nimu"]]
    (chart,) = study.charts(RADIUS, **MEAN)
    assert [label for _, label in chart["x"]["ticks"]] == ["5", "10", "20"]
    pdr, hdr = (study.trace(RADIUS, method, **MEAN)[0] for method in ("pdr", "hdr"))
    assert np.abs(pdr - np.round(pdr)).max() < 0.5
    for at in range(3):
        assert pdr[np.round(pdr) == at].max() < hdr[np.round(hdr) == at].min()


def test_cases_stand_behind_medians_and_nine_tenths(study):
    """Of hdr at a radius: two sheets, two thetas, ten units, of which one failed with one theta."""
    _, cases, hover = study.trace(RADIUS, "hdr", **MEAN)
    assert len(cases) == 3 * 2 * 2 * 10
    assert np.isnan(cases).sum() == 3 * 2
    assert set(hover["unit"]) == set(range(1000, 1010))
    for nth, which in ((1, np.median), (2, lambda values: np.percentile(values, 90))):
        x, y, hover = study.trace(RADIUS, "hdr", nth=nth, **MEAN)
        np.testing.assert_allclose(np.round(x), [0, 1, 2])
        for at, radius in enumerate((5, 10, 20)):
            own = [
                times * radius * theta * (1 + unit / 10)
                for times in (1, 2)
                for theta in (0.1, 0.25)
                for unit in range(10)
                if (theta, unit) != (0.1, 0)
            ]
            assert y[at] == pytest.approx(which(own), rel=1e-6)
        np.testing.assert_allclose(hover["cases"], 38)


def test_signed_scores_count_by_their_size(study):
    _, y, _ = study.trace(RADIUS, "pdr", **DISTANCE)
    assert y.min() > 0


def test_a_method_that_has_no_such_setting_is_a_level_line(study):
    (chart,) = study.charts(THETA, **MEAN)
    pdr = [trace for trace in chart["traces"] if trace["name"] == "pdr"]
    assert [(trace["mode"], trace["dash"]) for trace in pdr] == [("lines", "dot")]
    _, y, _ = study.trace(THETA, "pdr", **MEAN)
    np.testing.assert_allclose(y, np.median([t * r * 10 for t in (1, 2) for r in (5, 10, 20)]))
    assert pdr[0]["when"] == {"method": "pdr"}


def test_far_apart_is_logarithmic(study):
    assert study.charts(RADIUS, **MEAN)[0]["y"]["log"]
    assert not study.charts(RADIUS, score="return_error_pct")[0]["y"]["log"]


def test_many_values_are_drawn_where_they_lie(tmp_path):
    radii = [float(radius) for radius in np.geomspace(1, 300, 40).round(3)]
    page = Page(write_page(sweep_folder(tmp_path / "study", radii=radii, units=2, fail=False, kind="number")))
    (chart,) = page.charts(RADIUS, **MEAN)
    assert chart["x"]["log"]
    x, y, _ = page.trace(RADIUS, "pdr", **MEAN)
    assert sorted(set(np.round(x, 3))) == pytest.approx(radii, rel=1e-6)
    errors = [times * radius * 10 for times in (1, 2) for radius in radii for _ in "ab"]
    np.testing.assert_allclose(np.sort(y), np.sort(errors), rtol=1e-6)
    centres, medians, hover = page.trace(RADIUS, "pdr", nth=1, **MEAN)
    np.testing.assert_allclose(hover["cases"], 20)  # eight bins of as many cases each
    assert (np.diff(centres) > 0).all()
    assert (np.diff(medians) > 0).all()


def test_of_very_many_cases_some_are_drawn_and_all_are_counted(tmp_path):
    page = Page(write_page(sweep_folder(tmp_path / "study", units=300, fail=False)))
    x, _, _ = page.trace(RADIUS, "hdr", **MEAN)
    assert 1000 < len(x) <= 1800
    assert "Of 5,400 cases some 4,000 are drawn" in page.text
    np.testing.assert_allclose(page.trace(RADIUS, "hdr", nth=1, **MEAN)[2]["cases"], 1200)


def test_tables_tell_methods_settings_and_failures(study):
    rows = study.table("All cases of each method")
    assert rows[0][:3] == ["method", "cases", "failed"]
    assert rows[2][:3] == ["hdr", "120", "6"]
    rows = study.table("Every setting")
    assert len(rows) == 1 + 3 * 2 * 3
    assert ["one-arc", "nimu", "5", "0.1", "hdr", "10", "1"] in [row[:7] for row in rows]
    assert ["one-arc", "nimu", "5", "", "pdr", "10", "0", "50.00"] in [row[:8] for row in rows]
    assert study.table("Reasons")[1] == ["6", "hdr", "track", "the filter &lt;b&gt;diverged&lt;/b&gt;"]
    assert len(study.table("Failed cases")) == 1 + 6
    assert "180 rows, of which 6 failed" in study.text
    assert "One arc. " in study.text
    assert "footfall sweep arcs.toml" in study.text
    assert ["radius_m", "radius (m): 5, 10, 20"] in study.table("<caption>Axes")
    assert ["scenario.gait.pace_m_s", "1.3"] in study.table("The same for all")


def test_the_tracks_of_a_study_are_on_a_map_one_at_a_time(study):
    assert [chart["when"] for chart in study.charts("track")] == [{"track": "0"}, {"track": "1"}]
    assert all(chart["equal"] for chart in study.charts("track"))
    x, _, hover = study.trace("track", "hdr", track="1")
    assert len(x) == 20
    np.testing.assert_allclose(hover["error"], 0.02 * (hover["time"] - hover["time"][0]), atol=1e-4)
    assert "hdr, worst: one-arc, nimu, walk seed 1, unit 1002, radius_m 5" in study.text
    assert study.table("All cases")  # and without tracks the page is there, too


def test_a_study_without_tracks_axes_or_failures_has_a_page(tmp_path):
    folder = sweep_folder(tmp_path / "study", radii=(5,), fail=False)
    (folder / "tracks" / "index.json").unlink()
    page = Page(write_page(folder))
    assert not page.charts("track")
    assert [chart["x"]["title"] for chart in page.data["charts"]][::6] == ["IMU", "theta w (deg/s)"]
    assert "No case failed." in page.text


def test_no_text_of_a_study_becomes_markup(tmp_path):
    folder = sweep_folder(tmp_path / "study", methods=("pdr", NASTY), name=NASTY, description=NASTY)
    text = Page(write_page(folder)).text
    assert "<img" not in text
    assert "<b>div" not in text


# Gates


def test_each_gate_has_its_cases_in_order(gates):
    x, y, hover = gates.trace("gate-0", "hdr")
    np.testing.assert_allclose(x, np.arange(1, 21))
    np.testing.assert_allclose(y, np.arange(5, 101, 5))
    np.testing.assert_allclose(hover["unit"], 1000 + np.arange(1, 21))
    x, _, _ = gates.trace("gate-1", "hdr")
    np.testing.assert_allclose(x, 0.25)  # the ratio to pdr, case by case
    assert gates.charts("gate-1")[0]["x"]["title"] == "mean heading error over that of pdr"


def marks(page, place):
    (chart,) = page.charts(place)
    return [
        (m["axis"], round(m["low"], 6), round(m["high"], 6), m["colour"], m["dash"]) for m in chart["marks"]
    ]


def test_estimate_bounds_and_limit_are_drawn(gates):
    assert marks(gates, "gate-0") == [
        ("x", 6.0, 20.0, "soft", "solid"),  # there is no upper bound: up to the last case
        ("x", 10.5, 10.5, "soft", "solid"),
        ("x", 15.0, 15.0, "ink", "dash"),
        ("y", 50.0, 50.0, "soft", "dot"),
    ]
    assert marks(gates, "gate-1")[:3] == [
        ("x", 0.2, 0.3, "soft", "solid"),
        ("x", 0.25, 0.25, "soft", "solid"),
        ("x", 0.34, 0.34, "ink", "dash"),
    ]
    assert marks(gates, "gate-2") == [  # of a share, along the shares
        ("y", 65.0, 95.0, "soft", "solid"),
        ("y", 85.0, 85.0, "soft", "solid"),
        ("y", 90.0, 90.0, "ink", "dash"),
    ]


def test_what_has_no_cases_here_is_told_and_not_drawn(gates):
    assert [chart["place"] for chart in gates.data["charts"]] == ["gate-0", "gate-1", "gate-2"]
    assert "Not drawn: a gate of sameness, or one against a baseline" in gates.text


def test_the_table_of_verdicts_says_all(gates):
    rows = gates.table("The gates of this file")
    assert rows[0] == ["gate", "verdict", "estimate", "95 % bounds", "limit", "cases", "what", "why"]
    assert rows[1] == [
        "half below 15",
        "? undecided",
        "10.5 deg",
        "6.00 to none deg",
        "&lt;= 15.0 deg",
        "20",
        "median, mean heading error of hdr",
        "20 cases cannot tell",
    ]
    assert rows[2][1:5] == ["✓ pass", "-75 %", "-80 to -70 %", "&lt;= -66 %"]
    assert rows[3][1:5] == ["✗ fail", "85.0 %", "65.0 to 95.0 %", "&gt;= 90.0 %"]
    assert rows[5][1:5] == ["✗ fail", "3.00 cases", "", "within 0.1 %"]
    assert "2 passed, 2 failed, 1 undecided. Exit code 1." in gates.text
    assert gates.table("The cases of each method")[1][:4] == ["hdr", "20", "0", "10.50"]


def test_failed_cases_count_as_infinitely_bad(tmp_path):
    page = Page(write_page(gate_folder(tmp_path / "gates", fail=2)))
    x, y, _ = page.trace("gate-0", "hdr")
    assert len(x) == 18
    assert y[-1] == 90
    assert "2 failed cases count as infinitely bad and are not drawn" in page.text
    assert page.table("Reasons")[1] == ["2", "hdr", "track", "lost"]


@pytest.mark.parametrize(
    ("made", "file", "said"),
    [
        (sweep_folder, "results.parquet", r"results\.parquet: no such file"),
        (gate_folder, "cases.parquet", r"cases\.parquet: no such file"),
        (sweep_folder, "tracks/hdr-best.parquet", r"hdr-best\.parquet: no such file"),
    ],
)
def test_a_folder_that_lacks_a_file_is_one_sentence(cli, tmp_path, made, file, said):
    folder = made(tmp_path / "results")
    (folder / file).unlink()
    expect_one_sentence(*cli(f"report {folder}"), said)
    assert not (folder / "report.html").exists()


def test_documents_that_are_something_else_are_one_sentence(cli, tmp_path):
    folder = gate_folder(tmp_path / "gates")
    told = json.loads((folder / "gate.json").read_text())
    told["gates"][0]["strange"] = 1
    (folder / "gate.json").write_text(json.dumps(told))
    expect_one_sentence(*cli(f"report {folder}"), r"gate\.json: not as Footfall writes it")
