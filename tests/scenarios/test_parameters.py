"""Addresses: what is listed can be set, a value repeats the stage that it says, a mistake is one sentence."""

import re
from dataclasses import replace

import numpy as np
import pytest

from footfall.addresses import pattern
from footfall.errors import InputError
from footfall.hdr.methods import METHODS
from footfall.identity import digest_of
from footfall.models.imu import draw_unit, load_spec
from footfall.models.imu.override import CONSTANTS, overridden
from footfall.models.subject import SUBJECTS
from footfall.scenarios.listing import STAGES, parameters
from footfall.scenarios.parameters import documents, parsed, sensor, with_values
from footfall.scenarios.scenario import stock_scenarios
from tests.helpers.places import DOCS


@pytest.fixture(scope="module")
def base():
    return documents("straight", methods=METHODS)


def stages(setup):
    """What each stage depends on, as digests, for walk number 0 with unit 5."""
    scenario = setup.scenario
    unit = overridden(draw_unit(setup.spec, 5), setup.unit)
    plan = replace(scenario.plan(0), name="")
    air = [scenario.temperature_of(number) for number in range(scenario.seeds.walks)]
    return {
        "walk": digest_of(plan),
        "record": digest_of(unit, air, scenario.unit_bias_shift(5), setup.without, scenario.seeds.units),
        "reckon": digest_of(setup.pdr),
        "track": digest_of(setup.guided, [method.params for method in setup.methods]),
    }


def other(parameter):
    """Another value that is allowed."""
    now = parameter.default
    if parameter.address.startswith("unit."):
        return np.full(CONSTANTS[parameter.address.removeprefix("unit.")].shape, 1e-3).tolist()
    if isinstance(now, list):
        now = now[0]
    if isinstance(now, bool):
        return not now
    if now == float("inf"):
        return 1.0
    if isinstance(now, int | float):
        return now + 1 if parameter.type.endswith("whole number") else now * 0.999 or 1e-3
    return None


def test_every_address_is_listed_once(base):
    every = [one.address for one in parameters(documents("curving", methods=METHODS))]
    assert len(every) == len(set(every)) > 150
    for address in (
        "scenario.gait.pace_m_s",
        "scenario.path.elements[kind=arc].radius_m",
        "scenario.sensor.calibration_s",
        "imu.gyro.angle_random_walk_deg_rt_h",
        "imu.thermal.time_constant_s",
        "unit.gyro.scale",
        "unit.gyro.g_sensitivity_deg_s_g",
        "pdr.detector",
        "pdr.tilt_gain",
        "filter.sigma_velocity",
        "hdr.theta_w_deg_s",
        "ihde.directions.count",
    ):
        assert address in every


def test_what_is_told_of_an_address(base):
    told = {one.address: one for one in parameters(base)}
    assert told["scenario.gait.pace_m_s"][1:] == ("number", "m/s", 1.4, ">= 0.7, <= 1.7", "walk")
    assert told["imu.gyro.flicker_deg_h"].unit == "deg/h"
    assert told["imu.accel.noise_density_ug_rt_hz"].unit == "ug/rt-Hz"
    assert told["hdr.theta_w_deg_s"][2:] == ("deg/s", 0.25, "> 0, <= inf", "track")
    assert told["pdr.tilt_gain"].stage == "reckon"
    assert told["scenario.sensor.bias_shift_deg_s"].stage == "record"
    assert {one.stage for one in told.values()} == set(STAGES)


@pytest.mark.parametrize("name", stock_scenarios())
def test_a_value_set_to_what_it_is_changes_nothing(name):
    base = documents(name, methods=METHODS)
    before = stages(base.setup())
    values = {
        one.address: one.default
        for one in parameters(base)
        if one.default not in (None, "drawn")
        and not isinstance(one.default, list | tuple)
        # Elements differ in what they leave to its default.
        and not one.address.startswith("scenario.path.elements")
    }
    assert len(values) > 90
    assert stages(with_values(base, values).setup()) == before


def test_a_new_value_repeats_the_stage_that_it_says_and_none_before(base):
    tried, before = 0, stages(base.setup())
    for one in parameters(base):
        if one.address.startswith(("scenario.seeds", "scenario.terrain", "scenario.path.closure")):
            continue  # which walks there are; a level path has no cells; a tolerance moves nothing
        if one.address == "scenario.path.vertical_transition_m":
            continue  # nor slopes
        if (value := other(one)) is None:
            continue
        try:
            after = stages(with_values(base, {one.address: value}).setup())
        except InputError:
            continue
        changed = [stage for stage in STAGES if after[stage] != before[stage]]
        assert changed[:1] == [one.stage], one.address
        tried += 1
    assert tried > 120


def test_a_method_of_two_names_has_two_sets_of_parameters():
    pair = [METHODS["hdr"], METHODS["hdr"].renamed("mine")]
    made = with_values(documents("straight", methods=pair), {"mine.theta_w_deg_s": 0.5}).setup()
    first, second = (method.params.theta_w for method in made.methods)
    assert np.degrees(first) == pytest.approx(0.25)
    assert np.degrees(second) == pytest.approx(0.5)


def test_a_stock_subject_becomes_a_table_when_something_in_it_is_set():
    made = with_values(documents("straight"), {"scenario.subjects[0].height_m": 1.8}).setup()
    entry = documents("straight").scenario.table["subjects"][0]
    assert made.scenario.subjects[0] == replace(SUBJECTS[entry], height_m=1.8)
    assert made.scenario.subjects[1:] == documents("straight").setup().scenario.subjects[1:]


def test_every_arc_of_a_path_is_set_at_once():
    made = with_values(documents("curving"), {"scenario.path.elements[kind=arc].radius_m": 77.0}).setup()
    before = documents("curving").setup().scenario.path.route
    assert (
        np.ptp(1 / np.abs(made.scenario.path.route.curvature[made.scenario.path.route.curvature != 0])) < 1e-6
    )
    assert len(np.unique(np.round(np.abs(before.curvature), 6))) > 2


def test_constants_of_a_unit_are_in_the_units_of_the_sheet():
    spec, constants = sensor("nimu", {"unit.gyro.g_sensitivity_deg_s_g": np.eye(3).tolist()})
    unit = overridden(draw_unit(spec, 3), constants)
    np.testing.assert_allclose(np.degrees(unit.gyro.g) * 9.80665, np.eye(3), atol=1e-12)
    np.testing.assert_array_equal(unit.gyro.scale, draw_unit(spec, 3).gyro.scale)
    spec, _ = sensor("nimu", {"imu.gyro.angle_random_walk_deg_rt_h": 2 * 4.32})
    assert spec.gyro.white != load_spec("nimu").gyro.white
    assert replace(spec.gyro, white=0) == replace(load_spec("nimu").gyro, white=0)


def test_texts_are_values_as_in_toml():
    assert parsed(
        ["a.b=1", "c = 0.5", "d=[1, 2]", 'e="x y"', "f=nimu", "g=true", "h[kind=arc].r=3", "i="]
    ) == {
        "a.b": 1,
        "c": 0.5,
        "d": [1, 2],
        "e": "x y",
        "f": "nimu",
        "g": True,
        "h[kind=arc].r": 3,
        "i": "",
    }
    with pytest.raises(InputError, match=r"--set a\.b: expected ADDRESS=VALUE"):
        parsed(["a.b"])
    with pytest.raises(InputError, match="--set a: given twice"):
        parsed(["a=1", "a=2"])


@pytest.mark.parametrize(
    ("address", "value", "message"),
    [
        (
            "scenario.gait.pace",
            1.0,
            r"^scenario\.gait\.pace: unknown; did you mean .*pace_m_s\?$",
        ),
        ("scenario.gait.pace_m_s", 9.0, r"gait\.pace_m_s = 9\.0: expected at most 1\.7"),
        ("scenario.gait.pace_m_s", "fast", r"gait\.pace_m_s = 'fast': expected a number"),
        ("scenario.path.elements.radius_m", 3.0, "unknown; did you mean scenario"),
        ("scenario.path.elements[99].radius_m", 3.0, r"path\.elements has \d+ elements, and \[99\] is none"),
        ("scenario.sensor.imu", "perfect", "scenario.sensor.imu: set imu, or use the option --imu"),
        (
            "imu.gyro.g_sensitivity_deg_s_g",
            0.1,
            r"did you mean imu\.gyro\.g_sensitivity_sigma_deg_s_g \(of the sheet\) or "
            r"unit\.gyro\.g_sensitivity_deg_s_g \(of a unit\)\?",
        ),
        ("imu.gyro.flicker", 1.0, "imu.gyro.flicker: unknown; did you mean imu.gyro.flicker_deg_h"),
        ("imu.gyro.flicker_deg_h", -1.0, r"gyro\.flicker_deg_h = -1\.0"),
        ("unit.gyro.scale", [1.0], r"unit\.gyro\.scale = \[1\.0\]: expected a list of 3 numbers"),
        ("unit.gyro.scale", "x", "expected a list of 3 numbers"),
        ("unit.gyro.g2_deg_s_g2", [1.0, 1.0, 1.0], "expected a list of 3 rows of 3 numbers"),
        ("unit.gyro.turn_on", [1.0] * 3, "unit.gyro.turn_on: unknown"),
        ("pdr.detector", "best", "detector 'best' is unknown"),
        ("pdr.tilt", 0.1, r"pdr\.tilt: unknown; did you mean pdr\.tilt_gain"),
        ("pdr.tilt_gain", 2.0, r"pdr\.tilt_gain = 2\.0: expected a number, 0 to 1"),
        ("filter.sigma", 0.1, r"filter\.sigma: unknown"),
        ("hdr.theta", 0.1, r"hdr\.theta: unknown; did you mean .*theta_w_deg_s"),
        ("hdr.theta_w_deg_s", "wide", r"hdr\.theta_w_deg_s = wide: expected a positive number"),
        ("ihde.window", 5, "ihde.window: method 'ihde' is not among hdr, pdr"),
        ("hdrr.theta_w_deg_s", 5, "hdrr.theta_w_deg_s: unknown area; did you mean hdr"),
        ("", 5, "unknown area"),
    ],
)
def test_a_mistake_is_one_sentence_that_names_it(address, value, message):
    with pytest.raises(InputError, match=message) as caught:
        with_values(documents("curving"), {address: value}).setup()
    assert "\n" not in str(caught.value)


def test_the_command_shows_and_the_options_take_them(cli, here):
    code, out, _ = cli("parameters theta_w --json")
    assert code == 0
    assert '"hdr.theta_w_deg_s"' in out
    assert cli("parameters nowhere")[0] == 2
    assert cli("walk short.toml -o slow.parquet --set scenario.gait.pace_m_s=1.0")[0] == 0
    assert cli("record slow.parquet -o rec2.parquet --set imu.gyro.flicker_deg_h=0 --only flicker")[0] == 0
    code, out, err = cli("record slow.parquet -o rec3.parquet --set scenario.gait.pace_m_s=1.0")
    assert (code, out) == (2, "")
    assert "footfall record takes addresses of imu, unit alone" in err
    assert not (here / "rec3.parquet").exists()


def test_the_page_names_addresses_that_exist_and_its_code_runs():
    page = (DOCS / "parameters.md").read_text()
    known = {pattern(one.address) for name in ("curving", "turning") for one in parameters(documents(name))}
    known |= {pattern(one.address) for one in parameters(documents("ihde-test1", methods=METHODS))}
    areas = "scenario|imu|unit|pdr|filter|hdr|ihde"
    named = set(re.findall(rf"(?<![\w.])((?:{areas})(?:\.[a-z]\w*(?:\[[^\]]*\])?)+)(?=[=`\s])", page))
    assert len(named) > 12
    assert {one for one in named if pattern(one) not in known} == {"scenario.temperature"}  # a whole table
    for block in re.findall(r"```python\n(.*?)```", page, flags=re.DOTALL):
        exec(block, {})
