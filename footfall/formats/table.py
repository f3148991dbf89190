"""CSV and Parquet, read in blocks: memory holds one block, however long the file."""

from __future__ import annotations

import csv
import json
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from footfall.columns import ACCEL, GYRO
from footfall.errors import InputError
from footfall.formats.layout import LAYOUTS, Layout
from footfall.formats.samples import TORN, Samples, Source
from footfall.late import late
from footfall.recording import refuse_truth
from footfall.tables import META_KEY, numbers

pa, pa_csv, pq = late("pyarrow"), late("pyarrow.csv"), late("pyarrow.parquet")

BLOCK_BYTES = 1 << 22
BLOCK_ROWS = 1 << 16
PAGE_BYTES = 1 << 18
_HEADER_BYTES = 1 << 16


def open_table(
    path: Path, head: bytes, name: str, sizes: Mapping[str, float], rate_hz: float | None
) -> Source:
    """Open a CSV or Parquet file.

    Parameters
    ----------
    head : the file's first bytes
    name : the format, a key of `LAYOUTS`, or "auto"
    sizes : quantity -> size of its unit, from flags; they win over what a column's name says
    rate_hz : for a file without time

    Raises
    ------
    InputError
        Not readable, without the columns of that format, or the truth of a walk.
    """
    parquet = head.startswith(b"PAR1")
    if parquet:
        file, names = _open_parquet(path)
        meta, rows = _meta(path, file), file.metadata.num_rows
    else:
        delimiter, names = _header(head)
        meta, rows = {}, path.stat().st_size // max(_row_bytes(head), 1)
    refuse_truth(path, names)
    layout = _layout(path, names, name)
    if "t" not in layout.columns and rate_hz is None:
        raise InputError("no column of time, and no rate (Hz) was given instead", path)
    wanted = [*layout.columns.values(), *layout.valid]
    notes: list[str] = []
    batches = _parquet(path, file, wanted) if parquet else _csv(path, delimiter, names, wanted, notes)
    return Source(path, layout.format, rows, _samples(batches, layout, sizes, rate_hz), meta, notes)


def _layout(path: Path, names: Sequence[str], name: str) -> Layout:
    tried = LAYOUTS.values() if name == "auto" else [LAYOUTS[name]]
    for layout in tried:
        if (found := layout(names)) is not None:
            twice = [column for column in found.columns.values() if names.count(column) > 1]
            if twice:
                raise InputError(f"two columns are called {twice[0]!r}", path)
            return found
    if name in ("auto", "footfall"):
        lacking = next((column for column in ("t", *GYRO, *ACCEL) if column not in names), "t")
        wanted = ", ".join(("t", *GYRO, *ACCEL))
        raise InputError(f"column {lacking!r} is missing (expected {wanted})", path)
    raise InputError(f"not the columns of format {name!r} (found {', '.join(names[:8]) or 'none'})", path)


def _samples(
    batches: Iterator[Mapping[str, np.ndarray]],
    layout: Layout,
    sizes: Mapping[str, float],
    rate_hz: float | None,
) -> Iterator[Samples]:
    size = {channel: size or 1.0 for channel, size in layout.sizes.items()}
    for channel in size:
        size[channel] = sizes.get(channel.partition("_")[0], size[channel])

    row = 0
    for batch in batches:
        found = {
            channel: batch[name] if size[channel] == 1 else batch[name] * size[channel]
            for channel, name in layout.columns.items()
        }
        n = len(batch[layout.columns[GYRO[0]]])
        gyro = np.column_stack([found[name] for name in GYRO])
        accel = np.column_stack([found[name] for name in ACCEL])
        distrusted = np.zeros(n, dtype=bool)
        for name in layout.valid:
            distrusted |= batch[name] == 0
        gyro[distrusted] = accel[distrusted] = np.nan
        t = found["t"] if "t" in found else np.arange(row, row + n) / (rate_hz or 1.0)
        yield Samples(row, t, gyro, accel, found.get("temperature"))
        row += n


def _header(head: bytes) -> tuple[str, list[str]]:
    line = head.decode("utf-8-sig", errors="replace").splitlines()[0] if head else ""
    delimiter = max(",;\t", key=line.count)
    return delimiter, [name.strip() for name in next(csv.reader([line], delimiter=delimiter), [])]


def _row_bytes(head: bytes) -> int:
    lines = head.splitlines(keepends=True)[1:]
    whole = lines[:-1] or lines
    return sum(map(len, whole)) // len(whole) if whole else 1


def _csv(
    path: Path, delimiter: str, names: Sequence[str], wanted: Sequence[str], notes: list[str]
) -> Iterator[dict[str, np.ndarray]]:
    torn: list[str] = []

    def skip(row: Any) -> str:
        torn.append(row.text)
        return "skip"

    try:
        reader = pa_csv.open_csv(
            path,
            read_options=pa_csv.ReadOptions(
                block_size=BLOCK_BYTES,
                column_names=list(names),
                skip_rows=1,
                use_threads=False,
                encoding="latin-1",  # numbers are ASCII; damaged bytes must not stop the reader
            ),
            parse_options=pa_csv.ParseOptions(delimiter=delimiter, invalid_row_handler=skip),
            convert_options=pa_csv.ConvertOptions(
                include_columns=list(wanted), column_types=dict.fromkeys(wanted, pa.float64())
            ),
        )
        for batch in reader:
            yield {name: _numbers(batch.column(name)) for name in wanted}
    except pa.ArrowException as error:
        reason = str(error).splitlines()[0]
        if "Empty CSV" in reason:  # a header alone
            raise InputError("no rows of samples", path) from None
        if match := re.search(r"CSV column #(\d+): .*invalid value '(.*)'", reason):
            name = names[int(match[1])]
            raise InputError(f"column {name!r} holds {match[2]!r}, expected numbers", path) from None
        raise InputError(f"not a readable CSV file ({reason})", path) from None
    # A recorder that was switched off leaves half a line at the end; elsewhere the file is damaged.
    if torn and (len(torn) > 1 or not _ends_with(path, torn[0])):
        raise InputError(
            f"{len(torn)} rows have another number of columns than the header's {len(names)}, "
            f"the first is {torn[0][:60]!r}",
            path,
        )
    if torn:
        notes.append(TORN)


def _ends_with(path: Path, text: str) -> bool:
    with open(path, "rb") as file:
        file.seek(-min(path.stat().st_size, len(text.encode("latin-1")) + 2), os.SEEK_END)
        return file.read().rstrip(b"\r\n").endswith(text.encode("latin-1").rstrip(b"\r\n"))


def _open_parquet(path: Path) -> tuple[Any, list[str]]:
    try:
        # Page by page: left to itself Arrow reads ahead, and holds what it has read to the end.
        file = pq.ParquetFile(path, pre_buffer=False, buffer_size=PAGE_BYTES)
    except (pa.ArrowException, OSError) as error:
        raise InputError(f"not a readable Parquet file ({str(error).splitlines()[0]})", path) from None
    return file, list(file.schema_arrow.names)


def _parquet(path: Path, file: Any, wanted: Sequence[str]) -> Iterator[dict[str, np.ndarray]]:
    for name in wanted:
        kind = file.schema_arrow.field(name).type
        if not (pa.types.is_floating(kind) or pa.types.is_integer(kind) or pa.types.is_boolean(kind)):
            raise InputError(f"column {name!r} holds {kind}, expected numbers", path)
    try:
        for batch in file.iter_batches(batch_size=BLOCK_ROWS, columns=list(wanted), use_threads=False):
            yield {name: _numbers(batch.column(name)) for name in wanted}
    except (pa.ArrowException, OSError) as error:
        raise InputError(f"not a readable Parquet file ({str(error).splitlines()[0]})", path) from None


def _numbers(column: Any) -> np.ndarray:
    return numbers([column]).astype(float, copy=False)


def _meta(path: Path, file: Any) -> dict[str, Any]:
    try:
        meta = json.loads((file.schema_arrow.metadata or {}).get(META_KEY, b"{}"))
    except ValueError:
        meta = None
    if not isinstance(meta, dict):
        raise InputError(f"its metadata {META_KEY.decode()!r} is not a JSON object", path)
    return meta
