"""Real feet in the filter: ends and footprints met by one set of defaults, and the paper's false bias."""

import numpy as np
import pytest

from benchmarks.validation._real import find
from footfall.hdr.methods import Reckoning
from footfall.hdr.tracks import pdr_track
from footfall.pdr.detectors import DETECTORS
from footfall.pdr.filter.ins import FilterSettings
from footfall.pdr.reckoning import PdrParams
from footfall.pdr.rest import still_time
from footfall.scenarios.judge.reference import score_footprints


@pytest.fixture
def real(real_data):
    """Recordings by name."""
    return {one.name: one for one in find(real_data)}


def reckoning(one, detector="threshold"):
    params = PdrParams(bias_s=still_time(one.recording), detector=DETECTORS[detector])
    return Reckoning(one.recording, pdr=params)


@pytest.mark.parametrize(
    ("name", "metres"),
    [("openshoe 31", 0.39), ("openshoe 44", 0.39), ("xio short", 0.3), ("xio long", 0.3)],
)
def test_walks_return_to_their_start(real, name, metres):
    """OpenShoe within 0.5 % of its 78 m, x-io within 0.3 m."""
    found = reckoning(real[name]).filtered(FilterSettings()).footfalls
    assert np.hypot(*(found.position[-1] - found.position[0])[:2]) < metres


@pytest.mark.parametrize("name", ["gdin 32", "gdin 36", "gdin 45"])
def test_footprints_are_met(real, name):
    found = reckoning(real[name]).filtered(FilterSettings()).footfalls
    prints = real[name].footprints
    assert len(found) == len(prints)
    assert score_footprints(pdr_track(found), prints).footprint_rmse_m < 0.35


@pytest.mark.parametrize("name", ["openshoe 31", "openshoe 44", "xio long"])
def test_the_papers_filter_turns_by_itself_and_the_default_does_not(real, name):
    one = reckoning(real[name], "shoe")
    t, heading = one.footfalls.t, one.footfalls.heading

    def turned(settings):
        off = one.filtered(settings).footfalls.heading[-1] - heading[-1]
        return abs(np.degrees(off)) / (t[-1] - t[0])

    assert turned(FilterSettings.paper()) > 0.2
    assert turned(FilterSettings()) < 0.006
