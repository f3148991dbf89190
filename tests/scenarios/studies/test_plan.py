"""From a study to its tasks: what is shared, what is the same by content, and what it costs."""

import pickle

import pytest

from footfall.scenarios.studies import plan as planning
from footfall.scenarios.studies.describe import cost_line, document, headline
from footfall.scenarios.studies.plan import cost_of, plan_of
from tests.helpers.study import study

AXES = {"imu": ["nimu", "mtig710"], "hdr.theta_w_deg_s": [0.1, 0.2, 0.4], "pdr.tilt_gain": [0.1, 0.2]}


def cells(plan):
    return {key for task in plan.tasks for key in task.cells}


def recordings(plan):
    return {task.key for task in plan.tasks}


def changed(**table):
    """What is new beside the small study: cells, and recordings."""
    before, after = plan_of(study()), plan_of(study(**table))
    return bool(cells(after) - cells(before)), bool(recordings(after) - recordings(before))


def test_a_task_is_a_walk_a_sheet_and_some_units_with_all_settings_and_methods_inside():
    plan = plan_of(study(cases={"walks": 2, "units": 25}, design={"axes": AXES}))
    # 13 units on the first walk, 12 on the second, in tens, for two sheets.
    assert sorted(len(task.seeds) for task in plan.tasks) == [2, 2, 3, 3, 10, 10, 10, 10]
    for task in plan.tasks:
        assert len(task.settings) == 2
        assert [len(setting.cells) for setting in task.settings] == [4, 4]
        assert {unit % 2 for unit, _ in task.seeds} == {task.number}
        assert task.walk_seed == task.number + 1
    assert plan.rows == 2 * 2 * 25 * 4
    assert [task.number for task in plan.tasks] == [0] * 4 + [1] * 4
    assert len(plan.entries) == 8 * 8
    assert plan.kinds == {"hdr.theta_w_deg_s": "number", "pdr.tilt_gain": "number"}


def test_every_row_knows_its_point():
    plan = plan_of(study(design={"axes": AXES}))
    assert all({"imu", "pdr.tilt_gain"} <= set(entry.values) for entry in plan.entries)
    by_method = [len(entry.values) for entry in plan.entries]
    assert sorted(by_method) == [2] * 4 + [3] * 12


def test_units_and_methods_that_are_added_leave_what_is_there():
    before = plan_of(study(cases={"walks": 1, "units": 20}))
    longer = plan_of(study(cases={"walks": 1, "units": 25}))
    assert cells(before) < cells(longer)
    assert recordings(before) < recordings(longer)
    more = plan_of(study(cases={"walks": 1, "units": 20}, methods=["pdr", "hdr", "iez"]))
    assert cells(before) < cells(more)
    assert recordings(before) == recordings(more)
    assert all(
        {cell.method.name for setting in task.without(cells(before)).settings for cell in setting.cells}
        == {"iez"}
        for task in more.tasks
    )
    assert all(task.without(cells(more)) is None for task in more.tasks)


@pytest.mark.parametrize(
    ("table", "cell", "recording"),
    [
        ({"description": "another"}, False, False),
        ({"design": {"axes": {"hdr.theta_w_deg_s": [0.25]}}}, False, False),  # the default, said aloud
        ({"design": {"axes": {"hdr.theta_w_deg_s": [0.3]}}}, True, False),
        ({"set": {"pdr.tilt_gain": 0.3}}, True, False),
        ({"set": {"pdr.detector": "shoe"}}, True, False),
        ({"set": {"scenario.sensor.bias_time_s": 20.0}}, True, False),
        ({"methods": ["pdr", {"use": "hdr", "name": "other"}]}, True, False),
        ({"set": {"imu": "mtig710"}}, True, True),
        ({"set": {"imu.gyro.flicker_deg_h": 1.0}}, True, True),
        ({"set": {"unit.gyro.scale": [0.0, 0.0, 0.01]}}, True, True),
        ({"set": {"scenario.temperature.outdoors_degC": -3.0}}, True, True),
        ({"set": {"scenario.sensor.bias_shift_deg_s": 0.1}}, True, True),
        ({"set": {"scenario.gait.pace_m_s": 1.1}}, True, True),
        ({"without": ["white"]}, True, True),
        ({"cases": {"walks": 1, "units": 3, "first_unit": 2000}}, True, True),
        ({"cases": {"walks": 1, "units": 3, "seed": 9}}, True, True),
        ({"cases": {"walks": 1, "units": 3, "noises": 2}}, True, True),
    ],
)
def test_keys_tell_what_makes_a_row_and_nothing_else(table, cell, recording):
    assert changed(**table) == (cell, recording)


def test_code_of_a_stage_is_part_of_the_keys(monkeypatch):
    before = plan_of(study())
    real = planning.stage_digest
    for stage, recording in (("record", True), ("reckon", True), ("score", True), ("track", False)):
        monkeypatch.setattr(
            planning, "stage_digest", lambda name, stage=stage: real(name) + "!" * (name == stage)
        )
        after = plan_of(study())
        assert not cells(after) & cells(before)
        assert (recordings(after) != recordings(before)) == recording


def test_points_that_differ_in_no_recording_share_it():
    plan = plan_of(study(design={"axes": {"scenario.sensor.bias_time_s": [10.0, 20.0]}}))
    (task,) = plan.tasks
    assert [trial.setup.pdr.bias_s for trial in next(task.trials())[0]] == [10.0, 20.0]
    assert plan.rows == 2 * 3 * 2


def test_points_that_are_the_same_are_done_once_and_told_twice():
    points = [{"hdr.theta_w_deg_s": 0.25, "pdr.tilt_gain": 0.2}, {"pdr.tilt_gain": 0.2}]
    plan = plan_of(study(design={"kind": "list", "points": [*points, {}]}))
    (task,) = plan.tasks
    assert len(set(task.cells)) == len(task.cells) == 2
    assert len(plan.entries) > 2
    assert plan.rows == 3 * len(plan.entries)


def test_tasks_are_plain_data():
    (task,) = plan_of(study()).tasks
    again = pickle.loads(pickle.dumps(task))
    assert again == task
    assert len(pickle.dumps(task)) < 20_000
    trials, cells = next(again.trials())
    assert [method.name for method in trials[0].setup.methods] == ["pdr", "hdr"]
    assert [cell.key for cell in cells[0]] == list(task.cells)


def test_what_it_costs():
    plan = plan_of(study(cases={"walks": 2, "units": 10}, design={"axes": AXES}))
    cost = cost_of(plan, plan.tasks)
    assert (cost.walks, cost.recordings, cost.reckonings, cost.rows) == (2, 20, 40, 160)
    assert cost.seconds > cost_of(plan, plan.tasks[:2]).seconds > 0
    assert "20 recordings; 40 reckonings; 160 rows; about" in cost_line(cost, 2)
    assert cost_line(cost_of(plan, []), 2) == "nothing is left to do"
    assert headline(plan) == "small: 1 scenario x 2 IMU x 2 tilt gain x 10 units x (pdr + hdr 3): 160 rows"


def test_a_study_says_what_it_is():
    plan = plan_of(study(design={"axes": AXES}, set={"pdr.bias_s": 20.0}))
    told = document(plan, "footfall sweep small.toml")
    assert told["format"] == "footfall study 1"
    assert told["command"] == "footfall sweep small.toml"
    assert told["scenarios"] == ["straight"]
    assert [method["name"] for method in told["methods"]] == ["pdr", "hdr"]
    assert told["methods"][1]["parameters"]["tau_s"] == 8.0
    assert told["axes"]["hdr.theta_w_deg_s"] == {
        "values": [0.1, 0.2, 0.4],
        "unit": "deg/s",
        "label": "theta w",
    }
    assert told["set"] == {"pdr.bias_s": 20.0}
    assert told["cases"]["units"] == 3
    assert {"numpy", "footfall"} <= set(told["versions"])
