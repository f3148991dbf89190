"""The numbers of a text file, read in blocks: memory holds one, however long the file."""

from __future__ import annotations

import io
import os
import re
from collections.abc import Iterator, Sequence
from typing import IO, Any

import numpy as np

from footfall.errors import InputError
from footfall.formats.dialect import Dialect, split
from footfall.formats.files import Content
from footfall.formats.samples import TORN
from footfall.late import late
from footfall.tables import numbers

pa, pa_csv = late("pyarrow"), late("pyarrow.csv")

BLOCK_BYTES = 1 << 22
SHOWN = 40  # letters of a cell in a message
MOST_BAD = 0.01  # share of rows or cells that a recorder may spoil; more, and the file is another one
_EMPTY = ["", "-", "--", "?", "NaN", "nan", "NAN", "-nan", "-NaN", "NA", "N/A", "n/a", "#N/A", "#NA", "NULL",
          "null", "None", "none", "nil", "undefined", "*"]  # fmt: skip
_COMMENT = ("#", "%", "//")

Batch = dict[str, Any]  # column -> (n,) floats, or a list of texts


class TextTable:
    """A table in a text file.

    Parameters
    ----------
    content : the file
    dialect : how it is written
    names : of its columns, in order
    wanted : those that are read
    texts : those of `wanted` that are read as text
    notes : filled while it is read
    """

    def __init__(
        self,
        content: Content,
        dialect: Dialect,
        names: Sequence[str],
        wanted: Sequence[str],
        texts: Sequence[str],
        notes: list[str],
    ) -> None:
        self.content, self.dialect, self.notes = content, dialect, notes
        self.names = [name or f"column {place + 1}" for place, name in enumerate(names)]
        self.wanted, self.texts = list(dict.fromkeys(wanted)), set(texts)
        self.rows = 0
        self._torn: list[str] = []

    def __iter__(self) -> Iterator[Batch]:
        if not self.dialect.rows:
            raise InputError("no rows of samples", self.content.path)
        try:
            yield from self._batches(self._numeric, pa.float64(), 0)
        except pa.ArrowInvalid as error:
            if "conversion error" not in str(error):
                raise self._unreadable(error) from None
            self._torn.clear()
            try:
                yield from self._cell_by_cell()
            except pa.ArrowException as again:
                raise self._unreadable(again) from None
        except pa.ArrowException as error:
            raise self._unreadable(error) from None
        self._judge_torn()

    def _batches(self, convert: Any, kind: Any, skip: int) -> Iterator[Batch]:
        types = {name: pa.string() if name in self.texts else kind for name in self.wanted}
        with self._opened() as file:
            reader = pa_csv.open_csv(
                file,
                read_options=pa_csv.ReadOptions(
                    block_size=BLOCK_BYTES,
                    column_names=self.names,
                    use_threads=False,
                    # Numbers are ASCII, and damaged bytes must not stop the reader.
                    encoding=self._wide or "latin-1",
                ),
                parse_options=pa_csv.ParseOptions(
                    delimiter="\t" if self.dialect.delimiter == " " else self.dialect.delimiter,
                    invalid_row_handler=self._skip,
                ),
                convert_options=pa_csv.ConvertOptions(
                    include_columns=self.wanted,
                    column_types=types,
                    null_values=_EMPTY,
                    strings_can_be_null=True,
                    decimal_point=self.dialect.decimal,
                ),
            )
            for batch in reader:
                rows, skip = batch.num_rows, skip - batch.num_rows
                if skip >= 0:
                    continue
                batch = batch.slice(rows + skip) if -skip < rows else batch
                skip = 0
                made = {name: convert(name, batch.column(name)) for name in self.wanted}
                self.rows += batch.num_rows
                yield made

    def _numeric(self, name: str, column: Any) -> Any:
        return column.to_pylist() if name in self.texts else floats(column)

    def _cell_by_cell(self) -> Iterator[Batch]:
        """The rest of a table in which some cells hold no numbers: those are lost samples."""
        bad: dict[str, list[str]] = {}

        def convert(name: str, column: Any) -> Any:
            cells = column.to_pylist()
            if name in self.texts:
                return cells
            values = np.full(len(cells), np.nan)
            for row, cell in enumerate(cells):
                try:
                    values[row] = np.nan if cell is None else float(cell.replace(self.dialect.decimal, "."))
                except ValueError:
                    bad.setdefault(name, []).append(cell)
            return values

        def judge(most: float) -> None:
            for name, cells in bad.items():
                if len(cells) > most:
                    raise InputError(
                        f"column {name!r} holds {_short(cells[0])}, expected numbers", self.content.path
                    )

        for batch in self._batches(convert, pa.string(), self.rows):
            judge(max(3, 0.2 * self.rows))
            yield batch
        judge(max(3, MOST_BAD * self.rows))
        first = next(iter(bad.values()))[0]
        count = max(map(len, bad.values()))
        self.notes.append(f"{count} rows hold no numbers, the first of them {_short(first)}: lost samples")

    def _opened(self) -> IO[bytes]:
        file: Any = self.content.at.open("rb")
        file.seek(self.dialect.offset)
        if self.dialect.delimiter == " ":
            return io.BufferedReader(_Tabbed(file, self._wide or "latin-1"))
        return file

    @property
    def _wide(self) -> str:
        """The encoding, where a letter has two bytes."""
        name = self.dialect.encoding
        return name if name.startswith("utf-16") and self.dialect.delimiter != " " else ""

    def _skip(self, row: Any) -> str:
        if not row.text.lstrip().startswith(_COMMENT):
            self._torn.append(row.text)
        return "skip"

    def _judge_torn(self) -> None:
        """A recorder that was switched off leaves half a line at the end; elsewhere few may be damaged."""
        torn = [text for text in self._torn if text.strip()]
        if not torn:
            return
        if len(torn) == 1 and self._ends_with(torn[0]):
            self.notes.append(TORN)
            return
        told = (
            f"{len(torn)} rows have another number of columns than the header's {len(self.names)}, "
            f"the first is {torn[0][:60]!r}"
        )
        if len(torn) > MOST_BAD * max(self.rows, 1):
            raise InputError(told, self.content.path)
        self.notes.append(f"{told}: lost samples")

    def _ends_with(self, text: str) -> bool:
        with open(self.content.at, "rb") as file:
            file.seek(-min(self.content.size, len(text.encode("latin-1", "replace")) + 4), os.SEEK_END)
            return file.read().rstrip(b"\r\n").endswith(text.encode("latin-1", "replace").rstrip(b"\r\n"))

    def _unreadable(self, error: Exception) -> InputError:
        reason = str(error).splitlines()[0]
        if "Empty CSV" in reason:
            return InputError("no rows of samples", self.content.path)
        return InputError(f"not a readable CSV file ({reason})", self.content.path)


class _Tabbed(io.RawIOBase):
    """Text whose cells stand apart by any blanks, with a tab between them."""

    def __init__(self, file: IO[bytes], encoding: str) -> None:
        self._file, self._encoding, self._rest = file, encoding, b""

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: Any) -> int:
        while not self._rest:
            lines = b"".join(self._file.readlines(1 << 20))
            if not lines:
                return 0
            lines = re.sub(rb"[ \t]+", b"\t", lines)
            self._rest = re.sub(rb"(?m)^\t|\t(?=\r?$)", b"", lines)
        count = min(len(buffer), len(self._rest))
        buffer[:count], self._rest = self._rest[:count], self._rest[count:]
        return count

    def close(self) -> None:
        self._file.close()
        super().close()


def floats(column: Any) -> np.ndarray:
    """Numbers of an Arrow column (n,), NaN where there is none."""
    return numbers([column]).astype(float, copy=False)


def row_bytes(head: bytes, dialect: Dialect) -> int:
    """Bytes of a line of numbers, on average."""
    lines = head[dialect.offset :].splitlines(keepends=True)
    whole = lines[:-1] or lines
    return max(1, sum(map(len, whole)) // len(whole)) if whole else 1


__all__ = ["TextTable", "floats", "row_bytes", "split"]


def _short(cell: str) -> str:
    """A cell, quoted: what a logger leaves in it may be kilobytes."""
    text = repr(cell)
    return text if len(text) <= SHOWN else text[:SHOWN] + "..."
