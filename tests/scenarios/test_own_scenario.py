"""A scenario in a file of one's own: what arrives where, and what is refused by file, key and value."""

import math
import pickle
import re
import shutil
from dataclasses import fields, replace

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.models.imu import TemperatureProfile, load_spec
from footfall.models.imu.spec import SHEETS
from footfall.scenarios.on_the_way import PaceTable, StopTable
from footfall.scenarios.parameters import documents, with_values
from footfall.scenarios.scenario import (
    STOCK,
    DisturbanceTable,
    GaitTable,
    SensorTable,
    build_scenario,
    load_scenario,
    read_document,
    stock_scenarios,
)
from footfall.simulate.plan import Disturbance, Gait, Pace, Plan, Stop

IHDE_NAMES = ("ihde-test1", "ihde-test2", "ihde-test3")


OWN = """
description = "mine"
subjects = ["taller", { name = "me", height_m = 1.72, mass_kg = 80.0 }]

[path]
elements = [
  { kind = "straight", length_m = 50 },
  { kind = "corner", turn_deg = 90.0 },
  { kind = "straight", length_m = 30.0 },
]

[gait]
pace_m_s = 1.2

[temperature]
indoors_degC = 21.0
outdoors_degC = 21.0

[sensor]
imu = "nimu"

[seeds]
base = 40
walks = 3
units = [7, 9]
"""


@pytest.fixture
def own(tmp_path):
    """Write OWN with replacements to a file of its own."""

    def write(*replacements):
        text = OWN
        for old, new in replacements:
            assert old in text
            text = text.replace(old, new)
        path = tmp_path / "mine.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


def test_a_users_file_works_as_a_stock_name_does(own):
    scenario = load_scenario(own())
    assert (scenario.name, scenario.file.description) == ("mine", "mine")
    assert scenario.path.route.length == pytest.approx(77 + 1.5 * math.pi / 2)
    assert [subject.name for subject in scenario.subjects] == ["taller", "me"]
    assert scenario.subjects[1].mass_kg == 80
    assert [scenario.plan(walk).seed for walk in range(scenario.seeds.walks)] == [40, 41, 42]
    assert [scenario.unit_seed(walk) for walk in range(4)] == [7, 9, 7, 9]
    sensor = scenario.sensor
    assert (sensor.calibration_s, sensor.bias_time_s, sensor.bias_shift_deg_s) == (30, 25, 0)
    without = load_scenario(own(("units = [7, 9]", "")))
    assert [without.unit_seed(walk) for walk in range(3)] == [40, 41, 42]


def test_one_subject_may_stand_without_a_list(own):
    several = own(('["taller", { name = "me", height_m = 1.72, mass_kg = 80.0 }]', '"shorter"'))
    assert [subject.name for subject in load_scenario(several).subjects] == ["shorter"]
    heavier = with_values(documents(str(several)), {"scenario.subjects[0].mass_kg": 90.0}).setup()
    assert [subject.mass_kg for subject in heavier.scenario.subjects] == [90]


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("pace = 1.2", "unknown key 'gait.pace' = 1.2; did you mean pace_m_s?"),  # and pace_m_s is missing
        ("pace_m_s = 1.2\nwandr_m = 0.1", "unknown key 'gait.wandr_m' = 0.1; did you mean wander_m?"),
        (
            "pace_m_s = 1.2\ncolour = 3",
            "unknown key 'gait.colour' = 3; expected one of pace_m_s, ",
        ),
    ],
)
def test_an_unknown_key_is_told_before_one_that_is_missing_with_what_was_meant(own, written, meant):
    with pytest.raises(InputError, match=re.escape(f"mine.toml: {meant}")):
        load_scenario(own(("pace_m_s = 1.2", written)))


def test_an_unknown_key_of_an_element_is_told_by_its_number_from_1(own):
    path = own(("turn_deg = 90.0", "turn_deg = 90.0, radius = 3"))
    sentence = "unknown key 'path.elements no. 2, radius' = 3; did you mean radius_m?"
    with pytest.raises(InputError, match=re.escape(sentence)):
        load_scenario(path)


def test_a_document_that_is_changed_is_built_and_refused_as_a_file_is(own):
    path = own()
    document = read_document(path)
    assert (document.name, document.folder, document.table["gait"]) == (
        "mine",
        path.parent,
        {"pace_m_s": 1.2},
    )
    brisk = build_scenario(document.changed("gait", pace_m_s=1.6))
    assert (brisk.gait.pace_m_s, brisk.plan(0).gait.pace_m_s) == (1.6, 1.6)
    assert load_scenario(path).changed("gait", pace_m_s=1.6).file == brisk.file
    assert build_scenario(document).gait.pace_m_s == 1.2
    with pytest.raises(
        InputError, match=rf"^{re.escape(str(path))}: gait.pace_m_s = 1.9: expected at most 1.7"
    ):
        build_scenario(document.changed("gait", pace_m_s=1.9))
    # One that comes from no file is spoken of by its name.
    with pytest.raises(InputError, match=r"^mine: unknown key 'sensor.imo' = 3; did you mean imu\?$"):
        build_scenario(replace(document.changed("sensor", imo=3), source=""))


def test_a_setting_has_one_name_in_file_and_plan():
    """Where a file may give one for each walk, the plan has this walk's."""
    assert set(GaitTable.model_fields) == {field.name for field in fields(Gait)}
    assert set(StopTable.model_fields) == {field.name for field in fields(Stop)}
    assert set(PaceTable.model_fields) == {field.name for field in fields(Pace)}
    assert set(DisturbanceTable.model_fields) == {field.name for field in fields(Disturbance)}
    shared = {"calibration_s", "rate_hz"}
    assert shared <= set(SensorTable.model_fields) & {field.name for field in fields(Plan)}


def test_everything_of_a_gait_arrives_in_the_plan(own):
    gait = Gait(0.9, 0.5, 0.25, 0.75, 1.5, 0.125, 0.0625, 8.0)
    keys = "\n".join(f"{field.name} = {getattr(gait, field.name)}" for field in fields(Gait))
    disturbed = "[disturbance]\npush_Ns = 3.0\nevery_s = 7.0\n\n[path]"
    plan = load_scenario(own(("pace_m_s = 1.2", keys), ("[path]", disturbed))).plan(0)
    assert (plan.gait, plan.disturbance) == (gait, Disturbance(3.0, 7.0))
    assert load_scenario(own()).plan(0).disturbance is None


def test_a_scenario_goes_to_another_process(own):
    scenario = load_scenario(own())
    there = pickle.loads(pickle.dumps(scenario))
    assert (there.file, there.imu, there.plan(1).gait) == (scenario.file, scenario.imu, scenario.plan(1).gait)


def test_temperatures_are_used_in_turn_and_one_serves_every_walk(own):
    warm, cold = TemperatureProfile.step(21.0, 21.0), TemperatureProfile.step(19.0, -4.0)
    assert [load_scenario(own()).temperature_of(walk) for walk in range(2)] == [warm, warm]
    more = "[[temperature]]\nindoors_degC = 19.0\noutdoors_degC = -4.0\n[sensor]"
    scenario = load_scenario(own(("[temperature]", "[[temperature]]"), ("[sensor]", more)))
    assert [scenario.temperature_of(walk) for walk in range(4)] == [warm, cold, warm, cold]


def test_variability_arrives_in_the_plan_whole_and_in_parts(own):
    names = ("variability", "placement_variability", "cadence_variability", "toe_out_variability")
    for values in ((1.0, 1.0, 1.0, 1.0), (0.3, 0.5, 2.0, 0.0)):
        keys = "".join(
            f"{name} = {value}\n" for name, value in zip(names, values, strict=True) if value != 1.0
        )
        plan = load_scenario(own(("pace_m_s = 1.2", f"pace_m_s = 1.2\n{keys}"))).plan(0)
        assert tuple(getattr(plan.gait, name) for name in names) == values


def test_the_side_of_a_bias_shift_is_its_units(own):
    keys = 'imu = "nimu"\nbias_time_s = 4.0\nbias_shift_deg_s = 0.2'
    scenario = load_scenario(own(('imu = "nimu"', keys)))
    assert scenario.sensor.bias_time_s == 4
    assert [scenario.unit_bias_shift(seed) for seed in (7, 8)] == pytest.approx(np.radians([0.2, -0.2]))


@pytest.mark.parametrize("name", IHDE_NAMES)
def test_the_ihde_papers_walks_rest_for_five_seconds_with_the_imu_on_the_left_foot(name):
    scenario = load_scenario(name)
    assert (scenario.sensor.calibration_s, scenario.sensor.bias_time_s) == (5, 5)
    assert scenario.plan(0).mount.foot == "left"
    shift = {"ihde-test1": 0.215, "ihde-test2": 0.108, "ihde-test3": 0.047}[name]
    assert scenario.unit_bias_shift(3) == pytest.approx(np.radians(shift))


@pytest.mark.parametrize("name", stock_scenarios())
def test_a_copy_of_a_stock_file_is_the_same_scenario(name, tmp_path):
    stock, copy = load_scenario(name), load_scenario(shutil.copy(STOCK / f"{name}.toml", tmp_path))
    assert np.array_equal(copy.path.route.x, stock.path.route.x)
    assert np.array_equal(copy.path.route.z, stock.path.route.z)
    assert (copy.name, copy.file, copy.imu) == (stock.name, stock.file, stock.imu)


def test_a_sheet_of_ones_own_lies_beside_the_scenario(own, tmp_path, monkeypatch):
    shutil.copy(SHEETS / "nimu.toml", tmp_path / "my-imu.toml")
    scenario = load_scenario(own(('imu = "nimu"', 'imu = "my-imu.toml"')))
    monkeypatch.chdir("/")
    assert load_spec(scenario.imu).gyro == load_spec("nimu").gyro


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("walks = 3", "wlaks = 3", r"unknown key 'seeds.wlaks' = 3"),
        ("[gait]", "[gate]", r"key 'gait' is missing|unknown key 'gate'"),
        ('description = "mine"', "", r"key 'description' is missing"),
        ("pace_m_s = 1.2", "pace_m_s = 1.8", r"gait.pace_m_s = 1.8: expected at most 1.7"),
        (
            "[path]",
            "paces = [{ at_m = 20.0, m_s = 2.5 }]\n[path]",
            r"paces no. 1, m_s = 2.5: expected at most 1.7",
        ),
        (
            "[path]",
            "paces = [{ at_m = 20.0, m_s = 1.5 }, { at_m = 10.0, m_s = 1.0 }]\n[path]",
            r"paces no. 2, at_m = 10: expected beyond the change \(or the start\) before it at 20 m",
        ),
        (
            "[path]",
            "paces = [{ at_m = 900.0, m_s = 1.5 }]\n[path]",
            r"paces no. 1, at_m = 900: expected .* end at",
        ),
        ("pace_m_s = 1.2", "pace_m_s = nan", r"gait.pace_m_s = nan: .* finite"),
        ("pace_m_s = 1.2", 'pace_m_s = "1.2"', r"gait.pace_m_s = '1.2': expected a number"),
        (
            "length_m = 50 ",
            "length_m = -50 ",
            r"path.elements no. 1, length_m = -50(.0)?: expected more than 0",
        ),
        ("turn_deg = 90.0", "turn_deg = inf", r"path.elements no. 2, turn_deg = inf: .* finite"),
        (
            "turn_deg = 90.0",
            "turn_deg = 90.0, radius_m = -1.0",
            r"path.elements no. 2, radius_m = -1.0: .* 0",
        ),
        (
            "length_m = 30.0",
            "length_m = 1.0",
            r"path.elements no. 3, length_m = 1: too short for",
        ),
        ("turn_deg = 90.0", "turn_deg = 90.0, radius = 3", r"unknown key 'path.elements no. 2, radius' = 3"),
        (
            'kind = "corner"',
            'kind = "cornr"',
            r"path.elements no. 2, kind = 'cornr': unknown; did you mean corner\?",
        ),
        ("[gait]", "closed = true\n[gait]", r"path.closed = true: .* \(50.000, 30.000\) m, 58.310 m from"),
        ('["taller",', '["giant",', r"subjects no. 1 = 'giant' is unknown; expected one of reference, "),
        ("mass_kg = 80.0", "mass_kg = 120.0", r"subject 'me': mass_kg = 120 is outside"),
        ("mass_kg = 80.0", "age = 33", r"unknown key 'subjects no. 2, age' = 33"),
        ('imu = "nimu"', 'imu = "nimo"', r"IMU '.*nimo': neither a stock IMU"),
        ('imu = "nimu"', 'imu = "nimu"\nmount = "hat"', r"sensor.mount = 'hat' is unknown; expected one of "),
        (
            'imu = "nimu"',
            'imu = "nimu"\nrate_hz = 300',
            r"sensor.rate_hz: rate = 300 Hz does not divide the physics rate",
        ),
        ("pace_m_s = 1.2", "pace_m_s = 1.2\nwander_m = 0.6", r"gait.wander_m = 0.6: expected at most 0.5"),
        ("pace_m_s = 1.2", 'pace_m_s = 1.2\nwander_m = "0.1"', r"gait.wander_m = '0.1': expected a number"),
        (
            "pace_m_s = 1.2",
            "pace_m_s = 1.2\nplacement_variability = -0.1",
            r"gait.placement_variability = -0.1: expected at least 0",
        ),
        (
            "pace_m_s = 1.2",
            "pace_m_s = 1.2\ncadence_variability = 2.1",
            r"gait.cadence_variability = 2.1: expected at most 2",
        ),
        (
            "pace_m_s = 1.2",
            "pace_m_s = 1.2\ntoe_out_variability = nan",
            r"gait.toe_out_variability = nan: .* finite",
        ),
        ("pace_m_s = 1.2", "pace_m_s = 1.2\nwander_m = []", r"gait.wander_m: expected at least 1"),
        (
            "pace_m_s = 1.2",
            "pace_m_s = 1.2\nwander_time_s = [4.0, 0.1]",
            r"gait.wander_time_s no. 2 = 0.1: expected at least 0.5",
        ),
        ("base = 40", "base = -1", r"seeds.base = -1: expected at least 0"),
        ("base = 40", "base = 1.5", r"seeds.base = 1.5: expected a whole number"),
        ("walks = 3", "walks = 0", r"seeds.walks = 0: expected at least 1"),
        ("units = [7, 9]", "units = [7, -9]", r"seeds.units no. 2 = -9"),
        ("units = [7, 9]", "units = []", r"seeds.units"),
        ("[sensor]", "[sensor", r"not valid TOML"),
        ("outdoors_degC = 21.0", "outdoors_degC = -400.0", r": temperature.outdoors_degC = -400.0: "),
        ("outdoors_degC = 21.0", "", r": key 'temperature.outdoors_degC' is missing"),
        (
            "[temperature]",
            "[[temperature]]\nindoors_degC = 20.0\noutdoors_degC = 99.0\n[[temperature]]",
            r": temperature no. 1, outdoors_degC = 99.0: expected at most 85",
        ),
        (
            "[temperature]",
            "[[temperature]]\nindoors_degC = 20.0\n[[temperature]]",
            r": key 'temperature no. 1, outdoors_degC' is missing",
        ),
        (
            "[temperature]\nindoors_degC = 21.0\noutdoors_degC = 21.0\n\n[sensor]",
            "[sensor]",
            r": key 'temperature' is missing",
        ),
    ],
)
def test_mistakes_are_refused_by_file_key_value_and_reason(own, old, new, message):
    path = own((old, new))
    with pytest.raises(InputError, match=message) as caught:
        load_scenario(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert "\n" not in str(caught.value)


def test_a_list_of_temperatures_is_of_at_least_one_and_of_tables(own):
    table = "[temperature]\nindoors_degC = 21.0\noutdoors_degC = 21.0\n"
    for value, reason in (
        ("[]", r"temperature: expected at least 1 item"),
        ("[5.0]", r"temperature no. 1 = 5.0: expected a table"),
    ):
        path = own((table, ""), ("subjects =", f"temperature = {value}\nsubjects ="))
        with pytest.raises(InputError, match=rf"{re.escape(str(path))}: {reason}"):
            load_scenario(path)


def test_a_path_that_meets_itself_at_another_height_is_refused_with_its_file(own):
    path = own(
        (
            '  { kind = "corner", turn_deg = 90.0 },\n',
            '  { kind = "straight", length_m = 40.0, grade_percent = 3.0 },\n'
            '  { kind = "straight", length_m = 20.0 },\n'
            '  { kind = "arc", turn_deg = 270.0, radius_m = 20.0 },\n'
            '  { kind = "straight", length_m = 40.0 },\n',
        )
    )
    with pytest.raises(
        InputError, match=re.escape(str(path)) + r": path.elements: .* comes within 3 m of itself"
    ):
        load_scenario(path)


def test_a_name_that_is_nothing_is_refused_with_what_there_is():
    with pytest.raises(
        InputError,
        match=r"scenario 'loop': neither a stock .*; did you mean closed-loop or closed-loop-gentle\?",
    ):
        load_scenario("loop")
