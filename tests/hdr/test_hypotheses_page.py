"""The page of the method tells the parameters that it has."""

import math
import re
from dataclasses import fields
from pathlib import Path

import pytest

from footfall.hdr.hypotheses.params import HypothesesParams

PAGE = Path(__file__).parents[2] / "docs" / "hypotheses.md"
SECTION = PAGE.read_text(encoding="utf-8").partition("## Parameters")[2].partition("\n## ")[0]
TOLD = dict(re.findall(r"^\| `(\w+)` \| ([^|]+?) \|", SECTION, flags=re.M))


@pytest.mark.parametrize("name", [item.name for item in fields(HypothesesParams)])
def test_the_page_has_each_parameter_as_it_is(name):
    value = getattr(HypothesesParams(), name)
    in_degrees = next((other for other in TOLD if other.startswith(f"{name}_deg")), None)
    told, size = TOLD[in_degrees or name], math.degrees(1) if in_degrees else 1.0
    if value is None:
        assert told == "none"
    else:
        values = [size * each for each in (value if isinstance(value, tuple) else (value,))]
        assert [float(part) for part in told.split(", ")] == pytest.approx(values, rel=5e-3)


def test_the_page_has_no_other_parameter():
    assert len(TOLD) == len(fields(HypothesesParams))
