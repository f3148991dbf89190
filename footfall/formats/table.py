"""CSV and Parquet: which columns are meant, and their numbers as samples, block by block."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from footfall.columns import ACCEL, GYRO
from footfall.errors import InputError
from footfall.formats.dialect import Dialect, find_dialect
from footfall.formats.explain import not_understood
from footfall.formats.files import HEAD_BYTES, Content
from footfall.formats.layout import Header, Layout, find_layouts
from footfall.formats.options import Reading
from footfall.formats.samples import MIRRORED, Samples, Source
from footfall.formats.stamps import DAY, Clock, is_stamp, likely_unit, seconds
from footfall.formats.text import Batch, TextTable, floats, row_bytes
from footfall.formats.units import UNITS
from footfall.late import late
from footfall.recording import refuse_truth
from footfall.tables import META_KEY

pa, pq = late("pyarrow"), late("pyarrow.parquet")

BLOCK_ROWS = 1 << 16
PAGE_BYTES = 1 << 18
MOST_SENSORS = 20
LONG_HEAD_BYTES = 1 << 22


@dataclass(frozen=True)
class Opened:
    """A table whose columns are known.

    Attributes
    ----------
    header : names, units and preamble
    dialect : of a text; None of Parquet
    file : Arrow's, of Parquet
    rows : cells of its first rows
    head : first bytes of a text, down to these rows
    """

    content: Content
    header: Header
    dialect: Dialect | None = None
    file: Any = None
    rows: tuple[tuple[str, ...], ...] = ()
    head: bytes = b""


def open_header(content: Content, columns: Sequence[str]) -> Opened:
    """Names, units and first rows of a CSV or Parquet file.

    columns : names in place of those that the file has; () for its own

    Raises
    ------
    InputError
        Not a readable table, or more names than columns.
    """
    if content.head.startswith(b"PAR1"):
        file, names = _open_parquet(content)
        rows = _first_rows(file)
        return Opened(content, Header(_renamed(content.path, names, columns)), file=file, rows=rows)
    head = content.head
    dialect = find_dialect(head, whole=len(head) < HEAD_BYTES)
    if (dialect is None or not dialect.rows) and content.size > HEAD_BYTES:  # below a long preamble
        with open(content.at, "rb") as file:
            head = file.read(LONG_HEAD_BYTES)
        dialect = find_dialect(head, whole=len(head) < LONG_HEAD_BYTES) or dialect
    if dialect is None:
        raise InputError("no table of numbers, text or binary, that any known format has", content.path)
    own = dialect.names or ("",) * dialect.width
    header = Header(_renamed(content.path, own, columns), dialect.units, dialect.preamble)
    return Opened(content, header, dialect, rows=dialect.rows, head=head)


def _renamed(path: Path, own: Sequence[str], columns: Sequence[str]) -> tuple[str, ...]:
    if not columns:
        return tuple(own)
    if len(columns) > len(own):
        raise InputError(f"{len(columns)} names were given for {len(own)} columns", path)
    named = ["" if name in ("-", "_", "") else name for name in columns]
    return (*named, *[""] * (len(own) - len(columns)))


def open_table(content: Content, name: str, reading: Reading) -> Source:
    """Open a CSV or Parquet file.

    Parameters
    ----------
    name : the format, a key of `LAYOUTS`, or "auto"

    Raises
    ------
    InputError
        Not readable, without the columns of that format, several sensors and none chosen, or the truth of a
        walk.
    """
    opened = open_header(content, reading.columns)
    refuse_truth(content.path, opened.header.names)
    found = find_layouts(content.path, opened.header, name)
    if not found:
        raise not_understood(content.path, opened.header, opened.rows, name)
    layout = _with_a_clock(chosen(content.path, found, reading.sensor), opened)
    rate_hz = reading.rate_hz or layout.rate_hz
    if "t" not in layout.columns and rate_hz is None:
        raise InputError("no column of time, and no rate (Hz) was given instead (--rate)", content.path)
    if reading.rate_hz is not None:
        layout = replace(layout, columns={k: v for k, v in layout.columns.items() if k != "t"}, finer="")
    reading = replace(reading, rate_hz=rate_hz)
    notes: list[str] = []
    blocks = _Rows(opened, layout, reading, notes)
    unstated = frozenset(
        kind for kind in ("gyro", "accel") if kind not in reading.sizes and layout.sizes[f"{kind}_x"] is None
    )
    meta = _meta(content.path, opened.file) if opened.file is not None else {}
    if opened.file is not None:
        rows = opened.file.metadata.num_rows
    else:
        assert opened.dialect is not None
        rows = content.size // row_bytes(opened.head, opened.dialect)
    return Source(content.path, layout.format, rows, iter(blocks), meta, notes, unstated)


def _with_a_clock(layout: Layout, opened: Opened) -> Layout:
    """Without a column of time that is empty, where the rate stands above the table."""
    name = layout.columns.get("t")
    if name is None or not opened.rows or layout.rate_hz is None:
        return layout
    place = list(opened.header.names).index(name)
    if any(row[place] for row in opened.rows if place < len(row)):
        return layout
    return replace(layout, columns={k: v for k, v in layout.columns.items() if k != "t"}, finer="")


def chosen(path: Path, found: Sequence[Layout], sensor: str | None) -> Layout:
    """The layout of the sensor that is wanted.

    Raises
    ------
    InputError
        There are several and none is wanted, or none of that name.
    """
    if len(found) == 1 and (sensor is None or found[0].id or sensor == found[0].sensor):
        return found[0]
    names = [one.sensor or "unnamed" for one in found]
    if sensor is None:
        raise InputError(f"holds {len(found)} sensors, choose one with --sensor: {', '.join(names)}", path)
    if sensor not in names:
        raise InputError(f"holds no sensor {sensor!r}, but {', '.join(names)}", path)
    return found[names.index(sensor)]


class _Rows:
    """Samples of a table, block by block, as the file has them."""

    def __init__(self, opened: Opened, layout: Layout, reading: Reading, notes: list[str]) -> None:
        self.opened, self.layout, self.reading, self.notes = opened, layout, reading, notes
        self.path = opened.content.path
        self.size = {channel: size or 1.0 for channel, size in layout.sizes.items()}
        for channel in self.size:
            self.size[channel] = reading.sizes.get(channel.partition("_")[0], self.size[channel])
        self.row, self.own = 0, 0
        self.clock = Clock()
        self.sensors: dict[str, None] = {}

    def __iter__(self) -> Iterator[Samples]:
        for batch in self._batches():
            batch = self._of_sensor(batch)
            samples = self._samples(batch)
            yield samples
        if len(self.sensors) > 1 and self.reading.sensor is None:
            self._refuse_several()
        if self.reading.sensor is not None and self.layout.id and self.reading.sensor not in self.sensors:
            names = ", ".join(self.sensors) or "none"
            raise InputError(f"holds no sensor {self.reading.sensor!r}, but {names}", self.path)
        if self.layout.mirrored:
            self.notes.append(MIRRORED)
        if self.clock.rounds:
            self.notes.append(f"t starts anew {self.clock.rounds} times: made to go on")

    def _batches(self) -> Iterator[Batch]:
        wanted = [*self.layout.columns.values(), *self.layout.valid]
        wanted += [name for name in (self.layout.finer, self.layout.id) if name]
        texts = [name for name in (self.layout.id,) if name]
        if self._stamped():
            texts.append(self.layout.columns["t"])
        if self.opened.dialect is None:
            return _parquet(self.opened, wanted, texts)
        return iter(
            TextTable(
                self.opened.content, self.opened.dialect, self.opened.header.names, wanted, texts, self.notes
            )
        )

    def _stamped(self) -> bool:
        """Whether t is written as dates or clocks."""
        name = self.layout.columns.get("t")
        if name is None:
            return False
        if self.opened.dialect is None:
            schema, own = self.opened.file.schema_arrow, list(self.opened.header.names)
            if not _is_text(schema.types[own.index(name)]):
                return False
        place = list(self.opened.header.names).index(name)
        cells = [row[place] for row in self.opened.rows[:10] if row[place]]
        return any(map(is_stamp, cells))

    def _of_sensor(self, batch: Batch) -> Batch:
        """The rows of the sensor that is wanted."""
        name = self.layout.id
        if not name or len(self.sensors) > MOST_SENSORS:
            return batch
        whose = ["" if one is None else str(one) for one in batch[name]]
        self.sensors.update(dict.fromkeys(one for one in dict.fromkeys(whose) if one))
        if len(self.sensors) > MOST_SENSORS or self.reading.sensor is None:
            return batch
        rows = np.array([one == self.reading.sensor for one in whose], dtype=bool)
        return {
            column: [value for value, own in zip(values, rows, strict=True) if own]
            if isinstance(values, list)
            else values[rows]
            for column, values in batch.items()
        }

    def _refuse_several(self) -> None:
        if 1 < len(self.sensors) <= MOST_SENSORS:
            raise InputError(
                f"holds {len(self.sensors)} sensors by its column {self.layout.id!r}, choose one with "
                f"--sensor: {', '.join(self.sensors)}",
                self.path,
            )

    def _samples(self, batch: Batch) -> Samples:
        layout, size = self.layout, self.size
        found = {
            channel: batch[name] if size[channel] == 1 else batch[name] * size[channel]
            for channel, name in layout.columns.items()
            if channel != "t"
        }
        gyro = np.column_stack([found[name] for name in GYRO])
        accel = np.column_stack([found[name] for name in ACCEL]) * (-1 if layout.mirrored else 1)
        distrusted = np.zeros(len(gyro), dtype=bool)
        for name in layout.valid:
            distrusted |= batch[name] == 0
        gyro[distrusted] = accel[distrusted] = np.nan
        t = self._time(batch, len(gyro))
        for values, names in ((gyro, GYRO), (accel, ACCEL)):
            if names[0] in layout.increments and len(t) > 1:
                values /= np.median(np.diff(t))
        block = Samples(self.row, t, gyro, accel, found.get("temperature"))
        self.row += len(gyro)
        return block

    def _time(self, batch: Batch, n: int) -> np.ndarray:
        name = self.layout.columns.get("t")
        if name is None:
            return np.arange(self.row, self.row + n) / (self.reading.rate_hz or 1.0)
        values = batch[name]
        if isinstance(values, list):
            return self.clock(seconds(values) + self._day(values))
        if self.layout.finer:
            return self.clock(values + 1e-9 * batch[self.layout.finer])
        if self.row == 0 and self.layout.sizes["t"] is None and "t" not in self.reading.sizes and n > 1:
            unit = likely_unit(values)
            if unit != "s":
                self.size["t"] = UNITS["t"][unit]
                self.notes.append(f"t is taken for {unit}")
        return self.clock(values) * self.size["t"]

    def _day(self, values: list[str]) -> float:
        """s from the day of the file's first stamp to that of this block's."""
        from footfall.formats.stamps import ordinal

        first = next((one for one in values if one and is_stamp(one)), None)
        day = 0 if first is None else ordinal(first)
        self._begin = getattr(self, "_begin", day)
        return DAY * (day - self._begin)


def _open_parquet(content: Content) -> tuple[Any, list[str]]:
    try:
        # Page by page: left to itself Arrow reads ahead, and holds what it has read to the end.
        file = pq.ParquetFile(content.at, pre_buffer=False, buffer_size=PAGE_BYTES)
        names = [_flat(name) for name in file.schema_arrow.names]
        if "__index_level_0__" in names:  # pandas' index without a name: a time, if it is one
            place = names.index("__index_level_0__")
            names[place] = "time" if pa.types.is_timestamp(file.schema_arrow.types[place]) else names[place]
    except (pa.ArrowException, OSError) as error:
        raise InputError(
            f"not a readable Parquet file ({str(error).splitlines()[0]})", content.path
        ) from None
    return file, names


def _flat(name: str) -> str:
    """pandas writes columns of two levels as tuples."""
    import ast

    if name.startswith("('"):
        try:
            return " ".join(map(str, ast.literal_eval(name)))
        except (ValueError, SyntaxError):
            return name
    return name


def _first_rows(file: Any) -> tuple[tuple[str, ...], ...]:
    try:
        batch = next(file.iter_batches(batch_size=5, use_threads=False), None)
    except (pa.ArrowException, OSError):
        return ()
    if batch is None:
        return ()
    return tuple(tuple(str(cell) for cell in row.values()) for row in batch.to_pylist())


def _parquet(opened: Opened, wanted: Sequence[str], texts: Sequence[str]) -> Iterator[Batch]:
    file, path = opened.file, opened.content.path
    own = dict(zip(opened.header.names, file.schema_arrow.names, strict=True))
    for name in wanted:
        kind = file.schema_arrow.field(own[name]).type
        numeric = pa.types.is_floating(kind) or pa.types.is_integer(kind) or pa.types.is_boolean(kind)
        numeric = numeric or pa.types.is_decimal(kind) or pa.types.is_duration(kind)
        if not (numeric or name in texts or pa.types.is_timestamp(kind)):
            raise InputError(f"column {name!r} holds {kind}, expected numbers", path)
    try:
        columns = list(dict.fromkeys(own[name] for name in wanted))
        for batch in file.iter_batches(batch_size=BLOCK_ROWS, columns=columns, use_threads=False):
            yield {name: _values(batch.column(own[name]), name in texts) for name in wanted}
    except (pa.ArrowException, OSError) as error:
        raise InputError(f"not a readable Parquet file ({str(error).splitlines()[0]})", path) from None


def _is_text(kind: Any) -> bool:
    return bool(pa.types.is_string(kind) or pa.types.is_large_string(kind))


def _values(column: Any, text: bool) -> Any:
    if text:
        return column.to_pylist()
    if pa.types.is_decimal(column.type):
        return floats(column.cast(pa.float64()))
    if pa.types.is_timestamp(column.type) or pa.types.is_duration(column.type):
        unit = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}[column.type.unit]
        return floats(column.cast(pa.int64())) * unit
    return floats(column)


def _meta(path: Path, file: Any) -> Mapping[str, Any]:
    try:
        meta = json.loads((file.schema_arrow.metadata or {}).get(META_KEY, b"{}"))
    except ValueError:
        meta = None
    if not isinstance(meta, dict):
        raise InputError(f"its metadata {META_KEY.decode()!r} is not a JSON object", path)
    return meta
