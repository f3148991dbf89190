"""Footfall's own gates, quick, on a synthetic foot; and defects that gates must find."""

from dataclasses import replace

import pytest

from benchmarks.validation._defects import AT_REST, DEFECTS
from footfall.hdr.methods import METHODS
from footfall.scenarios.studies.gate import gate
from footfall.scenarios.studies.gate_file import read_gates, stock_gates
from tests.helpers.feet import round_a_block, walk_instead

SOUND = {**METHODS, "hdr-at-rest": replace(METHODS["hdr"], params=AT_REST)}


@pytest.fixture(scope="module")
def block():
    """100 strides a side, eight minutes in all: HDR shows what it can."""
    return round_a_block(100)


@pytest.fixture(scope="module")
def street():
    """As long, straight on."""
    return round_a_block(400, legs=1)


@pytest.fixture(scope="module")
def small_block():
    """Four minutes: enough to see what is wrong."""
    return round_a_block(50)


@pytest.mark.parametrize("name", stock_gates())
def test_footfall_passes_its_own_gates(name, block, street, monkeypatch):
    walk_instead(monkeypatch, street if name == "straight" else block)
    found = gate(name, quick=True)
    assert [(verdict.name, verdict.verdict) for verdict in found if verdict.verdict != "pass"] == []


def test_there_are_gates_of_what_is_promised():
    assert set(stock_gates()) >= {"closed-loop", "straight", "turning", "curving"}


@pytest.mark.parametrize("defect", DEFECTS, ids=[defect.name for defect in DEFECTS])
def test_a_defect_is_found_in_twenty_cases(defect, small_block, monkeypatch, tmp_path):
    """Where the released method is gated against; and the sound one is the same."""
    walk_instead(monkeypatch, small_block)
    keys = {"name": "no worse", "against": "released"} | defect.paired
    name = keys.pop("method")
    lines = "\n".join(f'{key} = "{value}"' for key, value in keys.items())
    file = tmp_path / "gates.toml"
    file.write_text(
        f'[cases]\nscenario = "closed-loop"\nunits = 20\n[[gates]]\nmethod = "now"\n{lines}\n',
        encoding="utf-8",
    )
    found = gate(file, methods={"now": defect.methods[name], "released": SOUND[name]})
    assert [(verdict.verdict, verdict.cases) for verdict in found] == [("fail", 20)]


def test_a_defect_is_one_of_what_the_gates_of_the_closed_loop_know():
    known = read_gates("closed-loop")
    for defect in DEFECTS:
        assert set(defect.methods) <= {method.name for method in known.setup.methods}
        assert defect.found_by in {one.name for one in known.gates}
