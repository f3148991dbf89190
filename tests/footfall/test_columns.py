"""Columns of files: docs/files.md, the table of names and units, and what is written say the same."""

import json
import re
from dataclasses import replace

import numpy as np
import pyarrow.parquet as pq
import pytest

from footfall import columns
from footfall.hdr.filtered import FILTER_UNITS
from footfall.hdr.hde import HDE_2010_UNITS, Hde
from footfall.hdr.ihde import Ihde
from footfall.hdr.ihde_plus import IhdePlus
from footfall.hdr.jimenez import FilterHdr, Jimenez
from footfall.hdr.tracks import HDR_UNITS
from footfall.models.imu import draw_unit, load_spec
from footfall.pdr.track import Track, write_track
from footfall.recording import write_recording
from footfall.simulate.budget import write_budget
from footfall.simulate.record import record_with_budget
from footfall.simulate.walk import footfalls_path, write_walk
from footfall.tables import META_KEY, UNITS_KEY
from tests.helpers.places import DOCS

OWN = [
    HDR_UNITS,
    HDE_2010_UNITS,
    FILTER_UNITS,
    *(one.units for one in (Hde, Ihde, IhdePlus, Jimenez, FilterHdr)),
]


def told(section):
    """Column -> unit of the table below a heading of docs/files.md that begins so."""
    text = (DOCS / "files.md").read_text(encoding="utf-8").split(f"\n## {section}", 1)[1].split("\n## ", 1)[0]
    found = {}
    for names, unit in re.findall(r"^\| (`[^|]+`) \|([^|]*)\|", text, re.MULTILINE):
        found |= dict.fromkeys(re.findall(r"`(\w+)`", names), unit.strip())
    return found, text


@pytest.mark.parametrize(
    ("section", "table"),
    [("Walk:", columns.WALK), ("Recording:", columns.RECORDING), ("Track:", columns.TRACK)],
)
def test_the_page_of_files_names_every_column_and_its_unit(section, table):
    assert told(section)[0] == dict(table)


def test_the_page_tells_what_footfalls_and_hdr_add():
    text = told("Walk:")[1]
    assert "`t` (s), `x`, `y`, `z` (m), `heading` (rad" in text
    assert dict(columns.FOOTFALLS) == {"t": "s", "x": "m", "y": "m", "z": "m", "heading": "rad"}
    own = told("Track:")[1]
    rates = [name for name, unit in HDR_UNITS.items() if unit == "rad/s"]
    assert f"HDR: {', '.join(f'`{name}`' for name in rates)} (rad/s), `attenuator`" in own
    drift = told("Drift budget:")[1]
    assert "`t`, `interval` (s), one column a cause and `total` (rad/s)" in drift


def schema(path):
    """Columns and their units, as the file has them."""
    found = pq.read_schema(path)
    assert META_KEY in found.metadata
    units = json.loads(found.metadata[UNITS_KEY])
    return {name: units[name] for name in found.names}


def test_files_have_the_columns_and_units_of_the_table(short_walk, tmp_path):
    path = tmp_path / "file.parquet"
    write_walk(short_walk, path)
    assert schema(path) == dict(columns.WALK)
    assert schema(footfalls_path(path)) == dict(columns.FOOTFALLS)
    recording, budget = record_with_budget(short_walk, draw_unit(load_spec("nimu"), 1), seed=1)
    write_recording(recording, path)
    assert schema(path) == dict(columns.RECORDING)
    write_recording(replace(recording, temperature=None), path)
    assert schema(path) == {name: unit for name, unit in columns.RECORDING.items() if name != "temperature"}
    write_budget(budget, path, {})
    assert schema(path) == dict(columns.BUDGET) | dict.fromkeys(budget.causes, columns.CAUSE)
    track = Track(np.arange(3.0), np.zeros((3, 3)), np.zeros(3), {"mine": np.zeros(3)}, {"mine": "V"})
    write_track(track, path)
    assert schema(path) == dict(columns.TRACK) | {"mine": "V"}


def test_a_name_has_one_unit_in_the_whole_house():
    units = {}
    for table in (columns.WALK, columns.RECORDING, columns.TRACK, columns.BUDGET, *OWN):
        for name, unit in table.items():
            assert units.setdefault(name, unit) == unit, name


def test_methods_columns_are_named_apart_from_those_of_every_track():
    assert not {name for table in OWN for name in table} & set(columns.TRACK)
