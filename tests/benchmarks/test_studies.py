"""The pages of the stock studies: what is chosen, compared and counted, on rows made up for it."""

import math
import tomllib
from itertools import product

import numpy as np
import pytest

from benchmarks.studies import _arc_radius, _grades, _mounts, _paces, _shapes
from benchmarks.studies._results import AVERAGE, Results, combinations, figure, pair, quantiles, read_results
from benchmarks.studies.pages import STUDIES, main
from footfall.scenarios.judge.score import Score
from footfall.scenarios.parameters import documents, with_values
from footfall.scenarios.scenario import load_scenario
from footfall.scenarios.studies.rows import kind_of, table, write_rows
from footfall.scenarios.trial import Row
from tests.helpers.places import ROOT

STOCK = ROOT / "scenarios" / "studies" / "stock"


def study(name):
    return tomllib.loads((STOCK / f"{name}.toml").read_text())


def made_up(name, error, units=3):
    """Rows of a study as its file asks for them; error(method, values of the axes, scenario, unit) -> deg."""
    asked = study(name)
    axes = asked["design"].get("axes", {})
    own = {address: values for address, values in axes.items() if address.startswith("hdr.")}
    shared = {address: values for address, values in axes.items() if address not in own}
    rows, told = [], []
    for scenario, *point in product(asked["scenarios"], *shared.values()):
        values = dict(zip(shared, point, strict=True))
        for unit, method in product(range(units), asked["methods"]):
            for mine in product(*own.values()) if method == "hdr" else [()]:
                all_values = values | dict(zip(own if mine else (), mine, strict=True))
                wrong = error(method, all_values, scenario, unit)
                score = None if wrong is None else Score(wrong, 2 * wrong, 0, 0.5, 0, 0)
                sha, imu = f"{scenario} {point} {unit}", values.get("imu", "nimu")
                row = Row(scenario, 0, 1, "reference", imu, unit, unit, method, score, recording_sha=sha)
                rows.append(row)
                told.append({key: value for key, value in all_values.items() if key != "imu"})
    kinds = {address: kind_of(values) for address, values in axes.items() if address != "imu"}
    return table(rows, told, kinds)


@pytest.fixture
def results(tmp_path):
    def read(name, error, units=3):
        (tmp_path / name).mkdir()
        write_rows(made_up(name, error, units), tmp_path / name / "results.parquet")
        return read_results(tmp_path / name / "results.parquet")

    return read


def columns(**lists):
    return Results({name: np.array(values) for name, values in lists.items()})


@pytest.mark.parametrize("name", STUDIES)
def test_every_value_of_a_stock_study_is_one_that_its_documents_take(name):
    asked = study(name)
    for scenario in asked["scenarios"]:
        base = documents(scenario, methods=asked["methods"])
        for address, values in asked["design"].get("axes", {}).items():
            for value in values:
                with_values(base, {address: value}).setup()


def test_the_radius_of_the_one_arc_leaves_straights_and_angle_as_they_are():
    for radius, turn in ((30.0, 180.0), (700.0, -180.0)):
        values = {_arc_radius.RADIUS: radius, _arc_radius.HAND: turn}
        route = with_values(documents("one-arc"), values).setup().scenario.path.route
        assert route.length == pytest.approx(240 + math.pi * radius, abs=1e-6)
        assert math.degrees(route.heading[-1]) == pytest.approx(turn)


def test_an_arc_turns_at_theta_w_where_its_radius_is_pace_over_theta_w():
    assert load_scenario("one-arc").gait.pace_m_s == 1.3
    assert _arc_radius.erased_radius(0.25) == pytest.approx(1.3 / 0.25 * 57.29578, rel=1e-6)


def test_rows_are_chosen_by_every_column_that_is_named():
    rows = columns(imu=["a", "a", "b"], unit=[1, 2, 1])
    assert len(rows.where(imu="a")) == 2
    assert rows.where({"imu": "a"}, unit=2)["unit"].tolist() == [2]
    assert [(key, len(some)) for key, some in combinations(rows, "imu")] == [(("a",), 2), (("b",), 1)]


def test_a_method_is_compared_with_another_on_the_same_recordings_alone():
    hdr = columns(recording_sha=["x", "y", "z", "w"], **{AVERAGE: [1.0, 5.0, 9.0, 2.0]})
    pdr = columns(recording_sha=["y", "x", "v", "w"], **{AVERAGE: [4.0, 2.0, 7.0, math.nan]})
    assert hdr.beside(pdr).tolist() == [[1.0, 2.0], [5.0, 4.0]]
    assert pair(hdr, pdr) == "3.0 / 3.0 (50)"
    twice = columns(recording_sha=["x", "x", "y"], **{AVERAGE: [1.0, 1.0, 5.0]})
    assert twice.beside(pdr).tolist() == [[1.0, 2.0], [5.0, 4.0]]
    assert pair(hdr.where(recording_sha="z"), pdr) == "-"


def test_what_failed_has_no_part_in_a_median_and_is_counted(results):
    rows = results("grades", lambda *of: None if of[3] == 0 else 10.0 * of[3])
    assert rows.failed == len(rows) / 3
    assert quantiles(rows.score(), (0, 50, 100)).tolist() == [10.0, 15.0, 20.0]


@pytest.mark.parametrize(("value", "said"), [(0.04, "0.0"), (9.96, "10.0"), (99.94, "99.9"), (123.4, "123")])
def test_figures_have_three_digits(value, said):
    assert figure(value) == said


def test_grades_say_from_which_uncorrected_error_on_hdr_pays(results):
    def error(method, values, scenario, unit):
        uncorrected = {"tactical": 1.0, "nimu": 50.0}.get(values["imu"], 10.0) + unit
        return uncorrected if method == "pdr" else 6.5

    median, p90, final, gain, walks = _grades.sheets(results("grades", error, units=6))
    assert [row[:3] for row in median.rows[:2]] == [
        ["`tactical`", "20", "3.5 / 6.5 (100)"],
        ["`mtig710`", "20", "12.5 / 6.5 (0)"],
    ]
    assert p90.rows[0][2] == "5.5 / 6.5 (100)"
    assert final.rows[0][2] == "7.0 / 13.0 (100)"
    row = dict(zip(gain.headings, gain.rows[0], strict=True))
    assert row["2 to 4"] == "-"  # 4 cases are too few to say
    assert row["4 to 8"] == "0 (6)"
    assert row["8 to 16"] == "100 (48)"
    assert row["32 to 64"] == "100 (12)"
    assert row["over 128"] == "-"
    assert walks.rows[:2] == [["straight", "`tactical`", "3.5 / 6.5"], ["straight", "`nimu`", "52.5 / 6.5"]]


def test_the_arc_is_told_by_radius_theta_w_and_hand(results):
    def error(method, values, scenario, unit):
        if method in ("pdr", "hypotheses-smooth"):
            return 1.0
        if method == "hypotheses":
            return 1.0 + values[_arc_radius.RADIUS] / 100
        right = values[_arc_radius.HAND] < 0
        return values[_arc_radius.RADIUS] * values[_arc_radius.THETA] + 5.0 * right

    alone, beside, hands, own = _arc_radius.sheets(results("arc-radius", error))
    assert alone.rows[0] == ["10", "7.45", "2.0 / 2.0", "7.5 / 12.5", "10.0 / 15.0", "15.0 / 20.0"]
    assert beside.rows[3][:4] == ["100", "2.0 / 2.0", "55.0 / 60.0", "100"]
    assert hands.rows == [
        ["left", *(figure(r / 2) for r in (10, 30, 60, 100, 150, 225, 300, 450, 1000))],
        ["right", *(figure(r / 2 + 10) for r in (10, 30, 60, 100, 150, 225, 300, 450, 1000))],
    ]
    assert own.headings[1:5] == ["perfect: hypotheses", "worse (%)", "smoothed", "worse (%)"]
    assert own.rows[0][1:5] == ["2.2 / 2.2", "0", "2.0 / 2.0", "0"]
    assert own.rows[3][1:5] == ["4.0 / 4.0", "100", "2.0 / 2.0", "0"]


def test_mounts_are_compared_unit_by_unit(results):
    def error(method, values, scenario, unit):
        worse = {"instep": 1.0, "medial": 2.0, "heel": 0.5 if unit else 4.0, "instep-left": 1.0}
        return 10.0 * (1 + unit) * worse[values[_mounts.MOUNT]] * (1 if method == "pdr" else 0.1)

    alone, median, _, _, against = _mounts.sheets(results("mounts", error))
    assert alone.rows[2][:4] == ["`medial`", "40.00", "4.00", "+0.50"]
    told = ["20.0 / 2.0 (0)", "20.0 / 2.0 (0)", "40.0 / 4.0 (0)", "15.0 / 1.5 (0)"]
    assert median.rows[0] == ["straight", "20", "`consumer`", *told]
    assert against.rows[0] == ["straight", "20", "`consumer`", "pdr", "1.00 (0)", "2.00 (100)", "0.75 (33)"]


def test_paces_are_told_by_theta_w(results):
    def error(method, values, scenario, unit):
        return 20.0 * values[_paces.PACE] if method == "pdr" else 40.0 * values[_paces.THETA] + unit

    average, final, worse = _paces.sheets(results("paces", error))
    assert average.rows[0] == ["straight", "0.7", "14.0 / 14.0", "6.0 / 6.8", "11.0 / 11.8", "21.0 / 21.8"]
    assert final.rows[0][2] == "28.0 / 28.0"
    assert worse.rows[0] == ["straight", "0.7", "0", "0", "100"]


def test_each_method_is_held_against_the_navigation_that_it_corrects(results):
    def error(method, values, scenario, unit):
        return {"pdr": 10.0, "hdr": 12.0, "iez": 20.0, "hde": 15.0}.get(method, 11.0)

    average, _, worse = _shapes.sheets(results("shapes", error))
    assert [row[0] for row in average.rows] == [f"`{name}`" for name in study("shapes")["methods"]]
    said = {row[0]: row[1] for row in worse.rows}
    assert (said["`hdr`"], said["`hde`"], said["`hde-2010`"]) == ("100", "0", "100")
    assert "`iez`" not in said


@pytest.mark.parametrize("name", ["shapes", "arc-radius", "grades"])
def test_a_page_is_filled_and_its_figure_drawn_by_one_command(name, results, tmp_path, capsys):
    results(name, lambda method, values, scenario, unit: 3.0 + unit)
    (tmp_path / "docs" / "images").mkdir(parents=True)
    (tmp_path / "docs" / "studies").mkdir()
    page = tmp_path / "docs" / "studies" / f"{name}.md"
    page.write_bytes((ROOT / "docs" / "studies" / f"{name}.md").read_bytes())
    main([name, "--made", "--out", str(tmp_path), "--docs", str(tmp_path / "docs")])
    assert "0 of them failed" in capsys.readouterr().out
    assert f"study_{name.replace('-', '_')}.png" in page.read_text()
    assert (tmp_path / "docs" / "images" / f"study_{name.replace('-', '_')}.png").stat().st_size > 10_000
