"""How a text file writes its table: encoding, delimiter, decimal sign; where names, units, numbers begin.

Found from its first bytes: the numbers are what most lines have in common; what stands above them in as many
cells are names, then perhaps units; all before that is preamble.
"""

from __future__ import annotations

import codecs
import csv
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from footfall.formats.units import INCREMENTS, UNITS, unit_size

LOOKED_AT = 60  # lines that tell what numbers look like
_NUMBER = re.compile(
    r"[-+]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][-+]?\d+)?|[-+]?(?:nan|inf(?:inity)?)", re.IGNORECASE
)
_COMMENT = re.compile(r"^\s*(?:#+|%+|//+)\s*")
_NO_QUANTITY = {
    *("", "-", "n/a", "na", "none", "no units", "unitless", "count", "counts", "raw", "deg", "°", "%", "hpa"),
    *("pa", "ut", "µt", "gauss", "local_flux", "v", "mv", "rad", "m", "bool", "hz", "#"),
}


@dataclass(frozen=True)
class Dialect:
    """How a table is written.

    Attributes
    ----------
    encoding : of the text
    delimiter : between cells; " " for any blanks
    decimal : "." or ","
    names : of the columns, "" where one has none; empty where no line holds names
    units : as written below the names, "" for none; as many as names, or empty
    offset : bytes before the first line of numbers
    preamble : lines before the names
    rows : cells of the first lines of numbers
    """

    encoding: str
    delimiter: str
    decimal: str
    names: tuple[str, ...]
    units: tuple[str, ...]
    offset: int
    preamble: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

    @property
    def width(self) -> int:
        """Cells in a line of numbers."""
        return len(self.rows[0]) if self.rows else len(self.names)


def encoding_of(head: bytes) -> str:
    """The encoding of a text, by its first bytes."""
    for mark, name in (
        (codecs.BOM_UTF8, "utf-8-sig"),
        (codecs.BOM_UTF16_LE, "utf-16-le"),
        (codecs.BOM_UTF16_BE, "utf-16-be"),
    ):
        if head.startswith(mark):
            return name
    some = head[:2000]
    if some[1::2].count(0) > len(some) / 4:
        return "utf-16-le"
    if some[::2].count(0) > len(some) / 4:
        return "utf-16-be"
    try:
        # The last character may be cut.
        codecs.getincrementaldecoder("utf-8")().decode(head)
    except UnicodeDecodeError:
        return "cp1252"
    return "utf-8"


def find_dialect(head: bytes, whole: bool) -> Dialect | None:
    """How a table is written that begins with `head`; None where there is none.

    whole : whether these are all its bytes; else the last line may be cut
    """
    encoding = encoding_of(head)
    mark = {"utf-8-sig": 3, "utf-16-le": 2, "utf-16-be": 2}.get(encoding, 0)
    mark = mark if head[:mark] in (codecs.BOM_UTF8, codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE) else 0
    plain = "utf-8" if encoding == "utf-8-sig" else encoding
    lenient = "surrogateescape" if plain == "utf-8" else "replace"
    text = head[mark:].decode(plain, errors=lenient)
    if _is_binary(text):
        return None
    ending = "\n" if "\n" in text else "\r"  # of old Macs
    lines = text.split(ending)
    if not whole and len(lines) > 1:
        lines = lines[:-1]
    lines = [line.rstrip("\r") for line in lines]
    found = _shape(lines)
    if found is None:
        return _names_alone(lines, encoding)
    delimiter, width, numeric = found
    cells = [split(line, delimiter) for line in lines]
    first = next((i for i, row in enumerate(cells) if _holds_numbers(row, width, numeric)), None)
    if first is None:
        return None
    names, units, preamble = _above(lines[:first], cells[:first], width)
    rows = [row for row in cells[first:] if len(row) == width][:LOOKED_AT]
    # Cell by cell: "1,5" is one number, for delimiters other than the comma only.
    commas = sum("," in row[j] for row in rows for j in numeric)
    points = sum("." in row[j] for row in rows for j in numeric)
    raw = head[mark:].split(ending.encode(plain))
    offset = mark + sum(len(line) + len(ending.encode(plain)) for line in raw[:first])
    if plain.startswith("utf-16"):  # a byte pair must not be taken apart
        text = head[mark:].decode(plain, errors="replace")
        offset = mark + len(ending.join([*text.split(ending)[:first], ""]).encode(plain))
    return Dialect(
        encoding=encoding,
        delimiter=delimiter,
        decimal="," if commas > points else ".",
        names=names,
        units=units,
        offset=offset,
        preamble=preamble,
        rows=tuple(map(tuple, rows)),
    )


def _is_binary(text: str) -> bool:
    """Whether many letters are none; zeros alone are what a logger leaves that lost its power."""
    some = text[:4000]
    controls = sum(letter < " " and letter not in "\t\n\r\x00\x1a\x0c" for letter in some)
    return controls > 0.02 * len(some)


def split(line: str, delimiter: str) -> list[str]:
    """The cells of a line."""
    if delimiter == " ":
        return line.split()
    try:
        return [
            cell.strip() for cell in next(csv.reader([line], delimiter=delimiter, skipinitialspace=True), [])
        ]
    except csv.Error:
        return [cell.strip() for cell in line.split(delimiter)]


def is_number(cell: str) -> bool:
    """Whether a cell holds a number, with either decimal sign."""
    return _NUMBER.fullmatch(cell) is not None


def _shape(lines: Sequence[str]) -> tuple[str, int, list[int]] | None:
    """Delimiter, cells in a line, and which of them are numbers, by what most lines agree on."""
    filled = [line for line in lines if line.strip() and not _COMMENT.match(line)]
    some = filled[-LOOKED_AT:] if len(filled) > 2 * LOOKED_AT else filled[len(filled) // 3 :]
    best, most = None, 0.0
    for delimiter in ("\t", ";", ",", "|", " "):
        cells = [split(line, delimiter) for line in some]
        widths = Counter(len(row) for row in cells if len(row) > 1 and any(map(is_number, row)))
        if not widths:
            continue
        width, count = max(widths.items(), key=lambda item: (item[1], item[0]))
        rows = [row for row in cells if len(row) == width and any(map(is_number, row))]
        numeric = [j for j in range(width) if _numeric([row[j] for row in rows])]
        score = len(numeric) * count / len(some)
        if len(numeric) > 1 and score > most:
            best, most = (delimiter, width, numeric), score
    return best


def _numeric(cells: Sequence[str]) -> bool:
    told = [cell for cell in cells if cell]
    return bool(told) and sum(map(is_number, told)) >= 0.8 * len(told)


def _holds_numbers(row: Sequence[str], width: int, numeric: Sequence[int]) -> bool:
    """Whether this is a line of the table's body: numbers where the others have them, or nothing."""
    if len(row) != width:
        return False
    told = [row[j] for j in numeric if row[j]]
    return len(told) > 1 and sum(map(is_number, told)) >= 0.8 * len(told)


def _above(
    lines: Sequence[str], cells: Sequence[Sequence[str]], width: int
) -> tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]:
    """Names, units and preamble of a table of `width` cells."""
    rows: list[list[str]] = []
    place = len(lines)
    while place > 0 and len(rows) < 4:
        row = list(cells[place - 1])
        if row and (match := _COMMENT.match(row[0])):
            row[0] = row[0][match.end() :]
            row = row if row[0] else row[1:]  # "# t gx gy"
        if not any(row):
            place -= 1
            if rows:
                break
            continue
        # A delimiter at the end of one kind of line but not of the other is common.
        if abs(len(row) - width) > 1 or sum(map(is_number, row)) > len(row) / 2:
            break
        rows.append((row + [""] * width)[:width])
        place -= 1
    preamble = tuple(line for line in lines[:place] if line.strip())
    units: list[str] = []
    if rows and _are_units(rows[0]) and len(rows) > 1:
        units = rows.pop(0)
    index = ""
    if len(rows) > 1 and rows[0][0] and not any(rows[0][1:]):  # pandas names its index below the columns
        index = rows.pop(0)[0]
    if not rows:
        return (), (), preamble
    names = rows[0]
    if len(rows) > 1 and len(set(filter(None, rows[1]))) <= max(2, len(names) // 3) and len(rows[1]) == width:
        names = [f"{above} {name}".strip() for above, name in zip(rows[1], names, strict=True)]
    if index:
        names = [index, *names[1:]]
    return tuple(names), tuple(units), preamble


def _are_units(row: Sequence[str]) -> bool:
    known = [cell for cell in row if _is_unit(cell)]
    return sum(map(bool, known)) >= 2 and len(known) >= 0.8 * len(row)


def _is_unit(cell: str) -> bool:
    text = cell.strip("()[] ").lower()
    tables = (UNITS, INCREMENTS)
    sizes = (unit_size(quantity, text, table) for table in tables for quantity in table)
    return text in _NO_QUANTITY or any(size is not None for size in sizes)


def _names_alone(lines: Sequence[str], encoding: str) -> Dialect | None:
    """A line of names without any numbers below it."""
    line = next((line for line in lines if line.strip() and "\x00" not in line), None)
    if line is None:
        return None
    delimiter = max("\t;,", key=line.count)
    if delimiter not in line:
        return None
    names = split(_COMMENT.sub("", line), delimiter)
    return Dialect(
        encoding, delimiter, ".", tuple(names), (), len(line.encode("utf-8", "replace")) + 1, (), ()
    )
