"""A study's document: what it may say, and how its mistakes are told."""

from pathlib import Path

import numpy as np
import pytest

import footfall
from footfall.errors import InputError
from footfall.scenarios.studies.plan import plan_of
from footfall.scenarios.studies.study import STOCK, Study, stock_studies
from tests.helpers.study import study

NAV = """
import numpy as np
import footfall

def stands(recording, start, params={"window": 7}):
    t = recording.t[[0, -1]]
    return footfall.Track(t, np.tile(start.position, (2, 1)), np.full(2, start.heading))
"""


def refused(made):
    with pytest.raises(InputError) as told:
        plan_of(made)
    assert "\n" not in str(told.value)
    return str(told.value)


@pytest.mark.parametrize("name", stock_studies())
def test_stock_studies_can_be_planned(name):
    plan = plan_of(Study.read(name))
    assert plan.rows > 0
    assert plan.study.file.description


def test_a_study_is_read_by_name_or_file(tmp_path):
    assert Study.read("hdr-threshold").folder == STOCK
    (tmp_path / "mine.toml").write_text('description = "d"\nscenarios = ["straight"]\nmethods = ["pdr"]\n')
    made = Study.read(tmp_path / "mine.toml")
    assert (made.name, made.file.cases.units) == ("mine", 20)
    with pytest.raises(InputError, match="study 'nothing': neither a stock study"):
        Study.read("nothing")


def test_values_and_cases_can_be_changed():
    made = study().set({"pdr.tilt_gain": 0.3}).of(units=7)
    assert made.documents()["straight"].pdr == {"tilt_gain": 0.3}
    assert made.file.cases.units == 7
    assert made.file.cases.walks == 1


def test_methods_come_by_name_with_parameters_from_files_and_as_objects(tmp_path):
    (tmp_path / "nav.py").write_text(NAV)
    table = {
        "description": "d",
        "scenarios": ["straight"],
        "methods": [
            "pdr",
            {"use": "hdr", "name": "wide", "params": {"theta_w_deg_s": 0.5}},
            {"use": "nav.py:stands", "params": {"window": 9}},
            {"name": "cpp", "command": ["true", "{recording}", "{track}"], "timeout_s": 3},
        ],
    }
    made = Study("mine", table, tmp_path).add("object", lambda recording, start: None)
    names = [method.name for method in made.methods]
    assert names == ["pdr", "wide", "stands", "cpp", "object"]
    assert np.degrees(made.methods[1].params.theta_w) == pytest.approx(0.5)
    assert made.methods[2].params == {"window": 9}
    assert made.methods[3].run.timeout_s == 3
    assert plan_of(made).rows == 20 * 5


def test_files_are_found_beside_the_study(tmp_path, monkeypatch):
    sheet = Path(footfall.__file__).parent / "models" / "imu" / "sheets" / "nimu.toml"
    (tmp_path / "own.toml").write_text(sheet.read_text())
    scenario = Path(footfall.__file__).parent / "scenarios" / "stock" / "straight.toml"
    (tmp_path / "path.toml").write_text(scenario.read_text())
    monkeypatch.chdir("/")
    table = {"description": "d", "scenarios": ["path.toml"], "methods": ["pdr"]}
    made = Study("mine", table | {"design": {"axes": {"imu": ["own.toml", "nimu"]}}}, tmp_path)
    (base,) = made.documents().values()
    assert base.scenario.name == "path"
    names = {setting.documents.sheet.name for task in plan_of(made).tasks for setting in task.settings}
    assert names == {"own.toml", "nimu"}


def test_a_sheet_and_a_detector_are_chosen_before_what_is_inside_of_them():
    inside = {"imu.gyro.flicker_deg_h": 0.0, "pdr.detector.window_s": 0.1}
    values = inside | {"pdr.detector": "shoe", "imu": "mtig710"}
    (made,) = study().set(values).documents().values()
    assert made.sheet.name == "mtig710"
    assert made.sheet.table["gyro"]["flicker_deg_h"] == 0.0
    assert made.setup().pdr.detector.window_s == 0.1


@pytest.mark.parametrize(
    ("table", "sentence"),
    [
        ({"scenarios": []}, "scenarios: "),
        ({"scenarios": ["strait"]}, "scenario 'strait': neither"),
        ({"scenarios": ["straight", "straight"]}, "scenario 'straight' is given twice"),
        ({"methods": []}, "methods: expected at least one"),
        ({"methods": ["hrd"]}, "method 'hrd' is unknown"),
        ({"methods": ["hdr", "hdr"]}, "method 'hdr' is given twice"),
        ({"methods": [{"use": "hdr", "params": {"theta": 1}}]}, "hdr.theta: unknown; did you mean"),
        ({"methods": [{"use": "hdr", "command": ["x"]}]}, "a use (such as hdr or nav.py:Mine) or a command"),
        ({"methods": [{"name": "mine"}]}, "a use (such as hdr or nav.py:Mine) or a command"),
        ({"cases": {"units": 0}}, "cases.units = 0"),
        ({"cases": {"unit": 1}}, "unknown key 'cases.unit'"),
        ({"without": ["wind"]}, "wind"),
        ({"set": {"pdr.tilt": 1}}, "pdr.tilt: unknown; did you mean pdr.tilt_gain?"),
        ({"design": {"axes": {"hdr.theta_w": [1]}}}, "hdr.theta_w: unknown; did you mean"),
        ({"design": {"axes": {"hdr.theta_w_deg_s": [-1]}}}, "hdr.theta_w_deg_s = -1"),
        ({"design": {"axes": {"iez.sigma_velocity": [1.0]}}}, "method 'iez' is not among hdr, pdr"),
        ({"design": {"axes": {"sky.colour": [1]}}}, "unknown area"),
        ({"design": {"axes": {"imu": ["nimoo"]}}}, "'nimoo': neither"),
        ({"design": {"axes": {"scenario.gait.pace_m_s": [9.0]}}}, "gait.pace_m_s = 9.0"),
        ({"design": {"axes": {"scenario.path.elements[7].length_m": [9.0]}}}, "[7] is none of them"),
        ({"set": {"imu": "nimu"}, "design": {"axes": {"imu": ["nimu"]}}}, "imu: an axis, and set for"),
        ({"description": ""}, "description = ''"),
        ({"colour": 1}, "unknown key 'colour'"),
    ],
)
def test_mistakes_are_told_in_a_sentence_with_the_studys_name(table, sentence):
    told = refused(study(**table))
    assert told.startswith("small: ")
    assert sentence in told


def test_a_mistake_in_one_of_several_scenarios_names_it():
    told = refused(
        study(
            scenarios=["straight", "closed-loop"],
            design={"axes": {"scenario.path.elements[5].length_m": [60.0]}},
        )
    )
    assert "scenario straight" in told
