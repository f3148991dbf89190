"""Columns in Parquet or CSV, with units and provenance in the file's metadata.

Every file is written under a temporary name and renamed, so that a reader never meets half of one.
"""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from footfall.errors import InputError
from footfall.late import late

pa, pa_csv, pq = late("pyarrow"), late("pyarrow.csv"), late("pyarrow.parquet")

UNITS_KEY = b"footfall_units"
META_KEY = b"footfall_meta"

Columns = Mapping[str, np.ndarray]


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Yield a temporary path beside `path`; rename it to `path` when the block ends well.

    Raises
    ------
    InputError
        The folder does not exist or cannot be written, `path` is itself a folder, or the disk is full.
    """
    target = Path(path)
    try:
        handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.", suffix=".tmp")
        os.close(handle)
        temporary = Path(name)
        try:
            yield temporary
            # mkstemp makes a private file; a result is as readable as any other new file.
            umask = os.umask(0)
            os.umask(umask)
            temporary.chmod(0o666 & ~umask)
            temporary.replace(target)
        finally:
            temporary.unlink(missing_ok=True)
    except OSError as error:
        raise InputError(f"cannot be written ({error.strerror or error})", target) from None


def is_csv(path: str | os.PathLike[str]) -> bool:
    """Whether a file's name ends so; any other is Parquet."""
    return Path(path).suffix.lower() == ".csv"


def write_table(
    path: str | os.PathLike[str],
    columns: Columns,
    units: Mapping[str, str],
    meta: Mapping[str, Any],
    *,
    smooth: bool = False,
) -> None:
    """Write equally long one-dimensional columns to Parquet, or to CSV where the name ends so.

    CSV holds the numbers to their last bit, and neither units nor provenance.

    Parameters
    ----------
    columns : name -> (n,) array
    units : name -> unit ("" for none), stored in the schema
    meta : JSON-serialisable provenance (versions, seed, scenario)
    smooth : floats hardly ever repeat, and neighbours are alike: each byte of them is stored as a column of
        its own. What is quantised, as a recording is, has a dictionary of its values, which is smaller then.
    """
    schema_meta = {UNITS_KEY: json.dumps(dict(units)), META_KEY: json.dumps(dict(meta))}
    table = pa.table({name: _array(values) for name, values in columns.items()})
    split = [name for name, values in columns.items() if smooth and values.dtype.kind == "f"]
    with replacing(path) as temporary:
        if is_csv(path):
            with temporary.open("wb") as file:
                file.write(",".join(table.column_names).encode() + b"\n")  # pyarrow quotes them
                pa_csv.write_csv(table, file, pa_csv.WriteOptions(include_header=False, quoting_style="none"))
            return
        pq.write_table(
            table.replace_schema_metadata(schema_meta),
            temporary,
            compression="zstd",
            compression_level=1,
            use_dictionary=[name for name in columns if name not in split],
            use_byte_stream_split=split or False,
        )


def read_table(
    path: str | os.PathLike[str], only: Sequence[str] | None = None
) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """Read a Parquet or (by its ending) CSV file.

    Parameters
    ----------
    only : the columns that are needed, of Parquet; others of a large file are left unread

    Returns
    -------
    columns : name -> (n,) float or bool array
    meta : provenance; empty for a file that Footfall did not write

    Raises
    ------
    InputError
        The file is absent, unreadable, or a column is not numeric; one of `only` is missing.
    """
    source = _file(path)
    kind = "CSV" if is_csv(source) else "Parquet"
    try:
        if kind == "CSV":
            table = pa_csv.read_csv(source)
        else:
            table = pq.ParquetFile(source).read(None if only is None else list(only))
        names = table.column_names
    except (pa.ArrowException, OSError, UnicodeDecodeError) as error:
        raise _unreadable(source, kind, error) from None
    columns: dict[str, np.ndarray] = {}
    for name, column in zip(names, table.columns, strict=True):
        holds = column.type
        if name in columns:
            raise InputError(f"two columns are called {name!r}", source)
        if not (pa.types.is_floating(holds) or pa.types.is_integer(holds) or pa.types.is_boolean(holds)):
            raise InputError(f"column {name!r} holds {holds}, expected numbers", source)
        columns[name] = numbers(column.chunks)
    require_columns(str(source), columns, tuple(only or ()))
    return columns, _meta(source, table.schema)


def read_meta(path: str | os.PathLike[str]) -> dict[str, Any]:
    """The provenance in a Parquet file, without its columns; empty for CSV and for others' files.

    Raises
    ------
    InputError
        The file is absent or unreadable.
    """
    source = _file(path)
    return {} if is_csv(source) else _meta(source, _schema(source))


def read_units(path: str | os.PathLike[str]) -> dict[str, str]:
    """Column -> unit as a Parquet file says it; empty for CSV and for others' files.

    Raises
    ------
    InputError
        The file is absent or unreadable.
    """
    source = _file(path)
    return {} if is_csv(source) else _told(source, _schema(source), UNITS_KEY)


def _schema(source: Path) -> Any:
    try:
        return pq.read_schema(source)
    except (pa.ArrowException, OSError) as error:
        raise _unreadable(source, "Parquet", error) from None


def column_names(path: str | os.PathLike[str]) -> list[str]:
    """What the columns of a Parquet or CSV file are called.

    Raises
    ------
    InputError
        The file is absent or unreadable.
    """
    source = _file(path)
    if not is_csv(source):
        return list(_schema(source).names)
    try:
        with pa_csv.open_csv(source) as opened:
            return list(opened.schema.names)
    except (pa.ArrowException, OSError, UnicodeDecodeError) as error:
        raise _unreadable(source, "CSV", error) from None


def _file(path: str | os.PathLike[str]) -> Path:
    source = Path(path)
    if source.is_dir():
        raise InputError("a folder, expected a file", source)
    if not source.is_file():
        raise InputError("no such file", source)
    return source


def numbers(chunks: Sequence[Any]) -> np.ndarray:
    """Numeric Arrow arrays, one after the other, as one array (n,); nulls become NaN, for readers to judge.

    A copy: Arrow's memory may be read-only, for which compiled kernels would have to be compiled once more.
    By their buffers: Arrow's own way (`to_numpy`, and `array` back) imports pandas wherever there is one.
    """
    parts = [_values(chunk) for chunk in chunks]
    return np.concatenate(parts) if parts else np.empty(0)


def _values(chunk: Any) -> np.ndarray:
    valid, data = chunk.buffers()
    rows = slice(chunk.offset, chunk.offset + len(chunk))
    if pa.types.is_boolean(chunk.type):
        values = _bits(data)[rows]
    else:
        values = np.frombuffer(data or b"", chunk.type.to_pandas_dtype())[rows]
    return np.where(_bits(valid)[rows], values.astype(float), np.nan) if chunk.null_count else values


def _bits(buffer: Any) -> np.ndarray:
    return np.unpackbits(np.frombuffer(buffer or b"", np.uint8), bitorder="little").astype(bool)


def _array(values: np.ndarray) -> Any:
    data = np.packbits(values, bitorder="little") if values.dtype == bool else np.ascontiguousarray(values)
    kind = pa.from_numpy_dtype(values.dtype)
    return pa.Array.from_buffers(kind, len(values), [None, pa.py_buffer(data)])


def _unreadable(source: Path, kind: str, error: Exception) -> InputError:
    return InputError(f"not a readable {kind} file ({str(error).splitlines()[0]})", source)


def _meta(source: Path, schema: Any) -> dict[str, Any]:
    return _told(source, schema, META_KEY)


def _told(source: Path, schema: Any, key: bytes) -> dict[str, Any]:
    try:
        found = json.loads((schema.metadata or {}).get(key, b"{}"))
    except ValueError:
        found = None
    if not isinstance(found, dict):
        raise InputError(f"its metadata {key.decode()!r} is not a JSON object", source)
    return found


def require_columns(source: str, columns: Columns, names: tuple[str, ...]) -> None:
    """Raise InputError when any of `names` is missing."""
    missing = [name for name in names if name not in columns]
    if missing:
        raise InputError(f"column {missing[0]!r} is missing (expected {', '.join(names)})", source)
