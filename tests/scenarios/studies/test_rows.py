"""Rows of scores as a table: one schema, one order, the same bytes."""

import json

import numpy as np
import pyarrow as pa
import pytest

from footfall.errors import InputError
from footfall.scenarios.judge.score import Score
from footfall.scenarios.studies.rows import (
    axes_of,
    in_order,
    kind_of,
    read_rows,
    schema,
    table,
    write_rows,
)
from footfall.scenarios.trial import Row
from footfall.tables import UNITS_KEY

SCORE = Score(1.5, 2.5, 0.25, -0.5, 3.0, 4.0)


def row(number: int = 0, unit: int = 1000, method: str = "pdr", **other: object) -> Row:
    given = {"score": SCORE, "footfalls": 300, "walk_sha": "aa", "recording_sha": "bb"} | other
    return Row("straight", number, 1 + number, "reference", "nimu", unit, unit, method, **given)  # type: ignore[arg-type]


def test_columns_are_the_case_the_axes_the_scores_and_what_became_of_it():
    assert schema({"pdr.tilt_gain": "number", "imu.name": "text"}).names == [
        *("scenario", "number", "walk_seed", "subject", "imu", "unit_seed", "noise_seed", "method"),
        *("pdr.tilt_gain", "imu.name"),
        *("heading_error_mean_deg", "heading_error_final_deg", "return_error_pct", "distance_error_pct"),
        *("position_rmse_m", "position_error_final_m"),
        *("footfalls", "stage", "error", "walk_sha", "recording_sha", "key"),
    ]
    units = json.loads(schema().metadata[UNITS_KEY])
    assert units["heading_error_mean_deg"] == "deg"
    assert units["return_error_pct"] == "%"
    assert units["position_rmse_m"] == "m"


def test_a_row_keeps_its_values():
    (found,) = table([row()], [{"pdr.tilt_gain": 1}], {"pdr.tilt_gain": "number"}, "k").to_pylist()
    assert found["walk_seed"] == 1
    assert found["unit_seed"] == 1000
    assert found["pdr.tilt_gain"] == 1.0
    assert found["heading_error_mean_deg"] == 1.5
    assert found["position_error_final_m"] == 4.0
    assert found["footfalls"] == 300
    assert (found["walk_sha"], found["recording_sha"], found["key"]) == ("aa", "bb", "k")


def test_failures_have_no_scores_and_the_same_schema():
    lost = row(score=None, footfalls=0, stage="walk", error="fell")
    failures, whole = table([lost]), table([row()])
    assert failures.schema == whole.schema
    (found,) = failures.to_pylist()
    assert found["heading_error_mean_deg"] is None
    assert (found["stage"], found["error"]) == ("walk", "fell")
    assert len(pa.concat_tables([failures, whole])) == 2


def test_an_axis_of_another_method_is_null():
    axes = {"hdr.i_c_deg_s": "number"}
    found = table([row(), row(method="hdr")], [{}, {"hdr.i_c_deg_s": 0.1}], axes, ["a", "b"])
    assert found["hdr.i_c_deg_s"].to_pylist() == [None, 0.1]
    assert found["key"].to_pylist() == ["a", "b"]


@pytest.mark.parametrize(
    ("values", "kind"),
    [
        ([1, 2], "integer"),
        ([1, 0.5], "number"),
        ([0.5], "number"),
        ([True, False], "truth"),
        (["a", "b"], "text"),
        ([[1, 2], [3, 4]], "text"),
        ([1, "none"], "text"),
        ([True, 1], "text"),
        ([], "text"),
    ],
)
def test_kinds_of_axes(values, kind):
    assert kind_of(values) == kind


def test_lists_and_tables_are_written_as_json():
    axes = {"unit.gyro.scale": "text"}
    found = table([row()], [{"unit.gyro.scale": [0.003, 0, 0]}], axes)
    assert json.loads(found["unit.gyro.scale"][0].as_py()) == [0.003, 0, 0]
    assert table([row()], [{"unit.gyro.scale": "plain"}], axes)["unit.gyro.scale"][0].as_py() == "plain"


def test_an_axis_cannot_be_called_as_a_column():
    with pytest.raises(InputError, match="imu: this column is there already"):
        schema({"imu": "text"})


def test_whatever_the_order_of_making_the_file_is_the_same(tmp_path):
    axes = {"a.b": "number"}
    rows = [row(number, unit, method) for number in (0, 1) for unit in (1000, 1001) for method in "xy"]
    values = [{"a.b": value} for value in (2.0, 1.0)]
    pairs = [(one, point) for one in rows for point in values]
    rng = np.random.default_rng(0)
    files = []
    for i in range(3):
        shuffled = [pairs[j] for j in rng.permutation(len(pairs))]
        made = table([one for one, _ in shuffled], [point for _, point in shuffled], axes)
        write_rows(in_order(made, axes_of(made)), tmp_path / f"{i}.parquet")
        files.append((tmp_path / f"{i}.parquet").read_bytes())
    assert files[0] == files[1] == files[2]
    found = read_rows(tmp_path / "0.parquet").select(["number", "a.b", "unit_seed", "method"]).to_pylist()
    told = [tuple(one.values()) for one in found]
    assert told == sorted(told)
    assert len(told) == 16


def test_what_is_no_file_of_rows_is_refused(tmp_path):
    with pytest.raises(InputError, match="no such file"):
        read_rows(tmp_path / "none.parquet")
    (tmp_path / "text.parquet").write_text("no")
    with pytest.raises(InputError, match="not a readable Parquet file"):
        read_rows(tmp_path / "text.parquet")
    pa.parquet.write_table(pa.table({"scenario": ["a"]}), tmp_path / "other.parquet")
    with pytest.raises(InputError, match="column 'number' is missing"):
        read_rows(tmp_path / "other.parquet")
