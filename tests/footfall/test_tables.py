"""Columns in files: what is written comes back, and nobody ever meets half a file."""

import errno
import os
import stat

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from footfall.errors import InputError
from footfall.tables import (
    META_KEY,
    numbers,
    read_meta,
    read_table,
    read_units,
    replacing,
    require_columns,
    write_table,
)

names = st.text(st.characters(codec="utf-8", exclude_characters="\0"), min_size=1, max_size=12)
kinds = st.sampled_from([np.float64, np.float32, np.int64, np.int32, np.uint8, np.bool_])
scalars = st.none() | st.booleans() | st.integers(-(2**53), 2**53) | st.floats(allow_nan=False) | names
metas = st.dictionaries(names, st.recursive(scalars, lambda inner: st.lists(inner, max_size=3), max_leaves=5))


@st.composite
def tables(draw):
    rows = draw(st.integers(0, 20))
    columns = draw(
        st.dictionaries(names, kinds.flatmap(lambda kind: hnp.arrays(kind, rows)), min_size=1, max_size=5)
    )
    return columns, draw(st.fixed_dictionaries({name: names | st.just("") for name in columns}))


@given(tables(), metas, st.booleans())
def test_columns_units_and_provenance_come_back(tmp_path_factory, table, meta, smooth):
    columns, units = table
    path = tmp_path_factory.mktemp("table") / "x.parquet"
    write_table(path, columns, units, meta, smooth=smooth)
    back, found = read_table(path)
    assert list(back) == list(columns)
    for name, values in columns.items():
        assert back[name].dtype == values.dtype
        assert back[name].tobytes() == values.tobytes()
        assert back[name].flags.writeable
    assert found == meta
    assert read_units(path) == units


def test_only_the_columns_that_are_needed_are_read(tmp_path):
    path = tmp_path / "x.parquet"
    write_table(path, {name: np.arange(3.0) for name in "abc"}, {}, {"who": "me"})
    columns, meta = read_table(path, ("c", "a"))
    assert set(columns) == {"a", "c"}
    assert meta == {"who": "me"}
    with pytest.raises(InputError, match=r"x\.parquet: column 'd' is missing"):
        read_table(path, ("a", "d"))


@given(
    hnp.arrays(np.float64, st.integers(0, 20), elements=st.floats(allow_nan=False, allow_infinity=False)),
    st.lists(st.booleans(), min_size=20, max_size=20),
)
def test_csv_holds_numbers_to_their_last_bit(tmp_path_factory, values, flags):
    columns = {"x": values, "flag": np.array(flags[: len(values)], dtype=bool)}
    path = tmp_path_factory.mktemp("table") / "x.csv"
    write_table(path, columns, {"x": "m", "flag": ""}, {"seed": 1})
    assert path.read_text().splitlines()[0] == "x,flag"
    if len(values):  # of no rows CSV does not say what they would hold
        back, meta = read_table(path)
        np.testing.assert_array_equal(back["x"], values)  # but for the sign of zero
        np.testing.assert_array_equal(back["flag"], columns["flag"])
        assert meta == read_meta(path) == {}


def test_smooth_columns_are_small_without_a_dictionary_and_quantised_ones_with_one(tmp_path):
    t = np.arange(50_000) / 200
    swing = np.sin(7 * t) + np.random.default_rng(0).normal(0, 1e-3, len(t))
    sizes = {}
    for kind, values in (("swing", swing), ("quantised", np.round(swing, 2))):
        for smooth in (False, True):
            path = tmp_path / "x.parquet"
            write_table(path, {"x": values}, {"x": ""}, {}, smooth=smooth)
            assert read_table(path)[0]["x"].tobytes() == values.tobytes()
            sizes[kind, smooth] = path.stat().st_size
    assert sizes["swing", True] < 0.85 * sizes["swing", False]
    assert sizes["quantised", False] < 0.85 * sizes["quantised", True]


def test_columns_may_be_slices_of_something_larger(tmp_path):
    values = np.arange(12.0).reshape(4, 3)
    write_table(tmp_path / "x.parquet", {"a": values[:, 1], "b": values[::-1, 2]}, {"a": "m", "b": "m"}, {})
    back, _ = read_table(tmp_path / "x.parquet")
    assert back["a"].tolist() == [1, 4, 7, 10]
    assert back["b"].tolist() == [11, 8, 5, 2]


ARROW = st.sampled_from([pa.float64(), pa.float32(), pa.int64(), pa.uint8(), pa.bool_()])


@given(ARROW, st.lists(st.lists(st.none() | st.integers(0, 1), max_size=20), max_size=3), st.data())
def test_numbers_are_those_of_arrow(kind, parts, data):
    """Nulls, slices that begin within a byte of bits, no rows, no parts."""
    arrays = [pa.array(part, pa.int64()).cast(kind) for part in parts]
    arrays = [array.slice(data.draw(st.integers(0, len(array)))) for array in arrays]
    expected = [array.to_numpy(zero_copy_only=False).astype(float) for array in arrays]
    found = numbers(arrays)
    np.testing.assert_array_equal(found, np.concatenate(expected) if expected else [])
    assert found.flags.writeable


def test_a_csv_reads_like_a_parquet_file(tmp_path):
    path = tmp_path / "X.CSV"
    path.write_text("t,x,ok\n0,1.5,true\n1,,false\n2,nan,true\n")
    columns, meta = read_table(path)
    assert columns["t"].tolist() == [0, 1, 2]
    np.testing.assert_array_equal(columns["x"], [1.5, np.nan, np.nan])
    assert columns["ok"].tolist() == [True, False, True]
    assert meta == {}


def test_a_folders_name_adds_no_column(tmp_path):
    folder = tmp_path / "seed=3"
    folder.mkdir()
    write_table(folder / "x.parquet", {"t": np.arange(3.0)}, {"t": "s"}, {})
    assert list(read_table(folder / "x.parquet")[0]) == ["t"]


def foreign(path, **columns):
    pq.write_table(pa.table(columns), path)


@pytest.mark.parametrize(
    ("name", "make", "message"),
    [
        ("gone.parquet", lambda path: None, "no such file"),
        ("folder.parquet", lambda path: path.mkdir(), "a folder, expected a file"),
        ("empty.parquet", lambda path: path.touch(), "not a readable Parquet file"),
        ("text.parquet", lambda path: path.write_text("t,x\n1,2\n"), "not a readable Parquet file"),
        ("empty.csv", lambda path: path.touch(), "not a readable CSV file"),
        ("ragged.csv", lambda path: path.write_text("t,x\n1,2\n3\n"), "not a readable CSV file"),
        ("binary.csv", lambda path: path.write_bytes(b"PAR1\0\xff\n\xff"), "not a readable CSV file"),
        (
            "words.csv",
            lambda path: path.write_text("t,x\n1,fast\n"),
            "column 'x' holds string, expected numbers",
        ),
        (
            "dates.parquet",
            lambda path: foreign(path, t=pa.array([1], pa.timestamp("ns"))),
            "column 't' holds time",
        ),
        ("twice.csv", lambda path: path.write_text("t,t\n1,2\n"), "two columns are called 't'"),
        ("nothing.parquet", lambda path: foreign(path, t=pa.nulls(3)), "column 't' holds null"),
    ],
)
def test_what_cannot_be_read_is_refused_by_name(tmp_path, name, make, message):
    path = tmp_path / name
    make(path)
    with pytest.raises(InputError, match=message) as caught:
        read_table(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert "\n" not in str(caught.value)


def test_a_torn_file_is_refused(tmp_path):
    path = tmp_path / "x.parquet"
    write_table(path, {"t": np.arange(1000.0)}, {"t": "s"}, {})
    whole = path.read_bytes()
    for length in (len(whole) // 2, len(whole) - 1, 5):
        path.write_bytes(whole[:length])
        with pytest.raises(InputError, match="not a readable Parquet file"):
            read_table(path)


@pytest.mark.parametrize("meta", [b"{torn", b"[1]", b"\xff"])
def test_metadata_that_is_no_json_object_is_refused(tmp_path, meta):
    path = tmp_path / "x.parquet"
    pq.write_table(pa.table({"t": [1.0]}).replace_schema_metadata({META_KEY: meta}), path)
    with pytest.raises(InputError, match="metadata 'footfall_meta' is not a JSON object"):
        read_table(path)


def test_missing_columns_are_named():
    with pytest.raises(InputError, match=r"a\.csv: column 'y' is missing \(expected x, y\)"):
        require_columns("a.csv", {"x": np.zeros(1)}, ("x", "y"))


# Writing


@pytest.mark.parametrize("trouble", [OSError(errno.ENOSPC, "No space left on device"), KeyboardInterrupt()])
def test_a_write_that_fails_half_way_leaves_the_old_file_and_nothing_else(tmp_path, monkeypatch, trouble):
    path = tmp_path / "x.parquet"
    write_table(path, {"t": np.arange(3.0)}, {"t": "s"}, {"old": True})
    before = path.read_bytes()

    def fail(table, where, **options):
        where.write_bytes(b"PAR1 half")
        raise trouble

    monkeypatch.setattr("footfall.tables.pq.write_table", fail)
    expected = InputError if isinstance(trouble, OSError) else KeyboardInterrupt
    with pytest.raises(expected) as caught:
        write_table(path, {"t": np.arange(9.0)}, {"t": "s"}, {})
    assert path.read_bytes() == before
    assert os.listdir(tmp_path) == ["x.parquet"]
    if expected is InputError:
        assert str(caught.value) == f"{path}: cannot be written (No space left on device)"


def test_nobody_sees_a_file_before_it_is_whole(tmp_path):
    path = tmp_path / "x.txt"
    with replacing(path) as temporary:
        temporary.write_text("half")
        assert not path.exists()
        temporary.write_text("whole")
    assert path.read_text() == "whole"
    assert os.listdir(tmp_path) == ["x.txt"]


def test_a_result_is_as_readable_as_any_new_file(tmp_path):
    (tmp_path / "plain").touch()
    with replacing(tmp_path / "ours") as temporary:
        temporary.write_text("x")
    modes = [stat.S_IMODE((tmp_path / name).stat().st_mode) for name in ("plain", "ours")]
    assert modes[0] == modes[1]


def test_a_folder_is_not_replaced_and_a_missing_one_not_made(tmp_path):
    (tmp_path / "taken").mkdir()
    for path in (tmp_path / "taken", tmp_path / "gone" / "x.parquet"):
        with pytest.raises(InputError, match="cannot be written") as caught:
            write_table(path, {"t": np.arange(3.0)}, {"t": "s"}, {})
        assert str(caught.value).startswith(f"{path}: ")
    assert os.listdir(tmp_path) == ["taken"]
    assert os.listdir(tmp_path / "taken") == []
