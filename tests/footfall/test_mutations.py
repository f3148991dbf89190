"""A good file spoilt in every way that comes to mind: no traceback, and no wrong track without a word."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from footfall.errors import InputError
from footfall.formats.options import Reading
from footfall.hdr.tracking import track
from tests.footfall.test_text_tables import NAMES, foot, table

__all__ = ["foot"]

WRONG_M = 0.3


@pytest.fixture(scope="module")
def good(foot, tmp_path_factory):
    """The file's lines, and its track."""
    path = tmp_path_factory.mktemp("good") / "a.csv"
    path.write_text(table(foot))
    return table(foot).splitlines(), track(path).track


def judged(lines, good, folder, reading=None):
    """What is told of a spoilt file, be it why it is refused; and how far its track is off (m)."""
    path = folder / "spoilt.csv"
    path.write_text("\n".join(lines) + "\n")
    refused = None
    try:
        found = track(path, reading=reading)
    except InputError as error:
        refused = str(error)
    if refused is not None:
        assert refused.startswith(f"{path}: ")
        return refused, 0.0
    theirs = found.track
    assert np.isfinite(theirs.position).all()
    end = [np.interp(good[1].t[-1], one.t, one.position[:, 0]) for one in (theirs, good[1])]
    off = abs(end[0] - end[1])
    return " ".join([*found.findings.sentences(), *found.warnings]), off


def cells(lines):
    return [line.split(",") for line in lines]


def joined(rows):
    return [",".join(row) for row in rows]


def changed(lines, rows, column, value):
    table = cells(lines)
    for row in rows:
        table[row][column] = value(table[row][column]) if callable(value) else value
    return joined(table)


# Name -> lines from lines, with a row `i` and a column `j` in the walk.
SPOILT = {
    "rows lost": lambda x, i, j, n: x[:i] + x[i + n :],
    "rows doubled": lambda x, i, j, n: x[: i + n] + x[i:],
    "rows swapped": lambda x, i, j, n: x[:i] + x[i : i + n][::-1] + x[i + n :],
    "zeros": lambda x, i, j, n: x[:i] + [row.split(",")[0] + ",0" * 6 for row in x[i : i + n]] + x[i + n :],
    "frozen": lambda x, i, j, n: (
        x[:i] + [row.split(",")[0] + "," + x[i].partition(",")[2] for row in x[i : i + n]] + x[i + n :]
    ),
    "empty cells": lambda x, i, j, n: changed(x, range(i, i + n), j, ""),
    "words": lambda x, i, j, n: changed(x, range(i, i + n), j, "ERR"),
    "a channel zeroed": lambda x, i, j, n: changed(x, range(i, i + n), j, "0.0"),
    "overflow": lambda x, i, j, n: changed(x, [i], j, "32767"),
    "infinite": lambda x, i, j, n: changed(x, [i], j, "inf"),
    "a sign": lambda x, i, j, n: changed(x, range(1, len(x)), j, lambda cell: f"{-float(cell):.6f}"),
    "degrees": lambda x, i, j, n: changed(x, range(1, len(x)), j, lambda cell: f"{57.3 * float(cell):.6f}"),
    "a column lost": lambda x, i, j, n: joined(row[:j] + row[j + 1 :] for row in cells(x)),
    "a name changed": lambda x, i, j, n: changed(x, [0], j, "what"),
    "columns exchanged": lambda x, i, j, n: joined(
        [row[:1] + row[4:] + row[1:4] if k else row for k, row in enumerate(cells(x))]
    ),
    "cut": lambda x, i, j, n: [*x[:i], x[i][: 3 + n % 20]],
    "a torn line": lambda x, i, j, n: [*x[:i], x[i][: 3 + n % 20], *x[i + 1 :]],
    "a time jump": lambda x, i, j, n: changed(x, range(i, len(x)), 0, lambda t: f"{float(t) + n / 20:.4f}"),
    "a clock set back": lambda x, i, j, n: changed(
        x, range(i, len(x)), 0, lambda t: f"{float(t) - n / 20:.4f}"
    ),
    "another rate": lambda x, i, j, n: changed(x, range(1, len(x)), 0, lambda t: f"{2 * float(t):.4f}"),
    "begun later": lambda x, i, j, n: x[:1] + x[i:],
    "every second row": lambda x, i, j, n: x[:1] + x[1::2],
}
# Parts of the same walk are no wrong tracks.
PARTS = ("begun later", "cut")


@settings(max_examples=60)
@given(
    name=st.sampled_from(sorted(SPOILT)),
    row=st.integers(500, 2100),
    column=st.integers(1, 6),
    count=st.integers(1, 120),
)
def test_no_spoilt_file_makes_a_wrong_track_without_a_word(good, tmp_path_factory, name, row, column, count):
    lines = SPOILT[name](list(good[0]), row, column, count)
    told, off = judged(lines, good, tmp_path_factory.getbasetemp())
    assert told or off < WRONG_M or name in PARTS, f"{off:.2f} m off without a word"


def test_an_offset_rate_is_told(good, tmp_path):
    lines = joined(row[1:] for row in cells(good[0]))
    told, _ = judged(lines, good, tmp_path, Reading(rate_hz=400.0))
    assert told


def test_the_good_file_is_good(good, tmp_path):
    assert judged(good[0], good, tmp_path) == ("", 0.0)
    assert good[0][0] == ",".join(NAMES)
