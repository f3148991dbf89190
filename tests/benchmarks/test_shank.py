"""The benchmark of the shank: what it counts, and what its tables make of that."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.validation import shank
from footfall.pdr.detectors import DETECTORS
from footfall.scenarios.trial import setup
from tests.helpers.synthetic import synthetic_walk


@pytest.fixture(scope="module")
def one():
    """A foot in closed form, judged with an IMU without error."""
    walk = synthetic_walk(strides=12)
    walk = replace(walk, meta={**walk.meta, "subject": "nobody"})
    made = setup(shank.block(1.3), imu="perfect", methods=["pdr"])
    return shank.judged(
        replace(made, pdr=replace(made.pdr, detector=DETECTORS["patient"])), "patient", 0, walk
    )


def test_a_foot_whose_stances_are_found_is_not_warned_of(one):
    assert (one.missed, one.more, one.warned) == (0, 0, ())
    assert one.footfalls >= 11
    assert abs(one.distance_pct["pdr"]) < 1.0
    assert one.stride_m == pytest.approx(1.4, abs=0.05)


def test_the_block_is_walked_once_round():
    route = shank.block(1.0).path.route
    assert np.hypot(route.x[-1] - route.x[0], route.y[-1] - route.y[0]) < 5.0
    assert route.length == pytest.approx(160, abs=10)
    assert shank.block(0.7).plan(0).gait.pace_m_s == 0.7


def test_tables_sum_footfalls_and_take_medians(one):
    told = dict.fromkeys(shank.METHODS, 1.0)
    base = replace(one, mount="shank", imu="consumer", pace_m_s=1.3, footfalls=50)
    base = replace(base, distance_pct=told, heading_deg=told, final_m=told)
    refused = dict.fromkeys(shank.METHODS)
    rows = [
        replace(base, missed=2, warned=("far",)),
        replace(base, missed=1, more=3, distance_pct={**told, "hdr": -4.0}, final_m=refused),
        replace(base, distance_pct={**told, "hdr": -2.0}, final_m=refused, heading_deg=refused),
    ]
    clean = [replace(base, imu="perfect", distance_pct={**told, "pdr": error}) for error in (-2.0, -4.0)]
    rows += clean
    stances = {tuple(row[:3]): row[3:] for row in shank.stances_sheet(rows).rows}
    assert stances["`shank`", "`patient`", "1.3"][:3] == ["150", "3", "3"]
    assert stances["`shank`", "`patient`", "1.3"][4:] == ["1 of 3", "-3.00"]
    methods = {tuple(row[:2]): row[2:] for row in shank.methods_sheet(rows).rows}
    assert methods["`hdr`", "`consumer`"][3:6] == ["-2.00", "1.00", "1.00"]
    assert methods["`hdr`", "`consumer`"][:3] == ["refused"] * 3
