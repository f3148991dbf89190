"""Every setting of navigation has an address, and is refused there as it is refused in code."""

import math
from dataclasses import replace

import pytest

from footfall.errors import InputError
from footfall.hdr.directions import DirectionParams
from footfall.hdr.hde import Hde2010Params, HdeParams
from footfall.hdr.hdr import HdrParams
from footfall.hdr.ihde import IhdeParams
from footfall.hdr.ihde_plus import IhdePlusParams
from footfall.hdr.jimenez import FilterHdrParams, JimenezParams
from footfall.pdr.detectors import DETECTORS
from footfall.pdr.filter.ins import FilterSettings
from footfall.pdr.reckoning import PdrParams
from footfall.settings import changed, leaves

ALL = [
    HdrParams(),
    HdrParams.basic(),
    Hde2010Params(),
    HdeParams(),
    IhdeParams(),
    IhdePlusParams(),
    JimenezParams(),
    FilterHdrParams(),
    DirectionParams(),
    FilterSettings(),
    FilterSettings.paper(),
    *(PdrParams(detector=detector) for detector in DETECTORS.values()),
]
LEAVES = [(params, leaf) for params in ALL for leaf in leaves(params)]


def names(pair):
    return [f"{type(params).__name__}.{leaf.name}" for params, leaf in pair]


@pytest.mark.parametrize("params", ALL, ids=lambda params: type(params).__name__)
def test_defaults_given_back_change_nothing(params):
    assert changed(params, {leaf.name: leaf.value for leaf in leaves(params)}) == params


@pytest.mark.parametrize(("params", "leaf"), LEAVES, ids=names(LEAVES))
def test_numbers_have_bounds_and_angles_their_unit(params, leaf):
    number = leaf.type in (int, float, float | None, tuple[float, ...])
    assert not number or leaf.unit.startswith("deg") or (leaf.ge, leaf.gt) != (None, None)
    assert leaf.name.endswith("_s") or leaf.unit != "s" or leaf.name == "gamma_t"
    assert not leaf.name.endswith("_s") or leaf.unit in ("s", "deg/s")


def owner(params, path):
    """The dataclass that a dotted name leads to, and the field's name."""
    *nested, last = path.split(".")
    for name in nested:
        params = getattr(params, name)
    return params, last.removesuffix("_s").removesuffix("_deg") if "_deg" in last else last


BOUNDED = [(params, leaf) for params, leaf in LEAVES if leaf.type in (int, float)]


@pytest.mark.parametrize(("params", "leaf"), BOUNDED, ids=names(BOUNDED))
def test_the_address_and_the_dataclass_refuse_alike(params, leaf):
    holder, field = owner(params, leaf.name)
    tried = [-1, 0, 1, 2, 1e9] if leaf.type is int else [-1.0, -1e-9, 0.0, 0.5, 1.0, 1e9, math.inf, math.nan]
    refused = {}
    for value in tried:
        inside = math.radians(value) if leaf.unit in ("deg", "deg/s") else value
        value = int(value) if leaf.type is int else value
        refused[value] = []
        for attempt in (
            lambda value=value: changed(params, {leaf.name: value}),
            lambda inside=inside: replace(holder, **{field: inside}),
        ):
            try:
                attempt()
                refused[value].append(False)
            except InputError as error:
                assert field in str(error)  # noqa: PT017
                refused[value].append(True)
    assert all(one == two for one, two in refused.values()), refused
    assert any(one for one, _ in refused.values())
