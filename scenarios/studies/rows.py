"""Rows of scores as a table: one explicit schema for a study's results and a gate's baseline.

Without it a reader takes the schema of the first file that it meets: a column that is all null there breaks
on the next, and one that only later files have vanishes.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any, Literal

from footfall.errors import InputError
from footfall.late import late
from footfall.scenarios.judge.score import Score, unit_of
from footfall.scenarios.trial import Row
from footfall.tables import META_KEY, UNITS_KEY, replacing

pa, pq = late("pyarrow"), late("pyarrow.parquet")

Kind = Literal["number", "integer", "truth", "text"]

FORMAT = "footfall rows 1"
CASE = ("scenario", "number", "walk_seed", "subject", "imu", "unit_seed", "noise_seed", "method")
SCORES = tuple(item.name for item in fields(Score))
AFTER = ("footfalls", "stage", "error", "walk_sha", "recording_sha", "key")

_INTEGERS = {"number", "walk_seed", "unit_seed", "noise_seed", "footfalls"}
_FIRST = ("scenario", "number", "walk_seed", "imu")  # that rows are sorted by, before the axes
_LAST = ("unit_seed", "noise_seed", "method")  # and after them


def kind_of(values: Iterable[Any]) -> Kind:
    """What a column of these values of an axis holds; lists, tables and mixtures are text, as JSON."""
    kinds = {type(value) for value in values}
    if kinds == {bool}:
        return "truth"
    if kinds == {int}:
        return "integer"
    return "number" if kinds and kinds <= {int, float} else "text"


def column_value(value: Any, kind: Kind) -> Any:
    """A value of an axis as its column holds it."""
    if value is None or kind in ("truth", "integer"):
        return value
    if kind == "number":
        return float(value)
    return value if isinstance(value, str) else json.dumps(value, sort_keys=True, default=str)


def schema(axes: Mapping[str, Kind] | None = None) -> Any:
    """The columns of rows: the case, one an axis, the scores, and what became of it.

    Parameters
    ----------
    axes : address -> kind, in their order

    Returns
    -------
    pyarrow.Schema
        With the units of the scores in its metadata, as in every file of Footfall.

    Raises
    ------
    InputError
        An axis has the name of another column.
    """
    types = {"number": pa.float64(), "integer": pa.int64(), "truth": pa.bool_(), "text": pa.string()}
    taken = {*CASE, *SCORES, *AFTER}
    columns = [(name, _type(name)) for name in CASE]
    for axis, kind in (axes or {}).items():
        if axis in taken:
            raise InputError("this column is there already; an axis is called by its address", axis)
        columns.append((axis, types[kind]))
    columns += [(name, pa.float64()) for name in SCORES]
    columns += [(name, _type(name)) for name in AFTER]
    units = {name: unit_of(name) for name in SCORES}
    told = {UNITS_KEY: json.dumps(units), META_KEY: json.dumps({"format": FORMAT, "axes": list(axes or {})})}
    return pa.schema(columns, metadata=told)


def table(
    rows: Iterable[Row],
    values: Iterable[Mapping[str, Any]] | None = None,
    axes: Mapping[str, Kind] | None = None,
    keys: str | Iterable[str] = "",
) -> Any:
    """Rows as a table, in their order.

    Parameters
    ----------
    values : of each row, address -> value of its axes; what is left out, as another method's axis is, is null
    axes : as of `schema`
    keys : of the task that made them: one for all, or one a row

    Returns
    -------
    pyarrow.Table
        Of `schema(axes)`. Scores of failed rows are null.
    """
    rows, known = list(rows), axes or {}
    told = [{} for _ in rows] if values is None else list(values)
    tasks = [keys] * len(rows) if isinstance(keys, str) else list(keys)
    made = []
    for row, own, key in zip(rows, told, tasks, strict=True):
        point = {axis: column_value(own.get(axis), kind) for axis, kind in known.items()}
        made.append(row.as_dict() | point | {"key": key})
    return pa.Table.from_pylist(made, schema(known))


def in_order(rows: Any, axes: Sequence[str] = ()) -> Any:
    """A table of rows sorted by scenario, walk, sheet, axes, unit, noise and method: the same whatever the
    order in which they were made."""
    return rows.sort_by([(name, "ascending") for name in (*_FIRST, *axes, *_LAST)])


def write_rows(rows: Any, path: str | os.PathLike[str]) -> None:
    """Write a table of rows to Parquet: the same rows, the same bytes.

    Raises
    ------
    InputError
        As of `replacing`.
    """
    with replacing(path) as temporary, temporary.open("r+b") as file:
        pq.write_table(rows, file, compression="zstd", compression_level=3)
        file.flush()
        os.fsync(file.fileno())  # or else a power cut may leave a name without content


def read_rows(path: str | os.PathLike[str]) -> Any:
    """The table in a file of rows.

    Raises
    ------
    InputError
        No such file, or not one of rows.
    """
    source = Path(path)
    if not source.is_file():
        raise InputError("no such file", source)
    try:
        found = pq.ParquetFile(source).read()
    except (pa.ArrowException, OSError) as error:
        raise InputError(f"not a readable Parquet file ({str(error).splitlines()[0]})", source) from None
    missing = next((name for name in (*CASE, *SCORES, *AFTER) if name not in found.column_names), None)
    if missing is not None:
        raise InputError(f"no rows of scores: column {missing!r} is missing", source)
    return found


def axes_of(rows: Any) -> tuple[str, ...]:
    """The addresses of a table's axes, in their order."""
    known = {*CASE, *SCORES, *AFTER}
    return tuple(name for name in rows.column_names if name not in known)


def _type(name: str) -> Any:
    return pa.int64() if name in _INTEGERS else pa.string()
