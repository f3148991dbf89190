"""HDE, IHDE, IHDE+, iHDE and HDR in the filter, and the methods by name: what they make of a corridor."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from footfall.hdr.hde import Hde
from footfall.hdr.ihde import Ihde
from footfall.hdr.ihde_plus import IhdePlus
from footfall.hdr.jimenez import FilterHdr, Jimenez
from footfall.hdr.methods import METHODS, Reckoning, on_papers_filter, told_directions, tracks
from footfall.hdr.tracks import corrected_track
from footfall.pdr.detectors import Shoe
from footfall.pdr.filter.ins import FilterSettings
from footfall.pdr.filter.run import run_filter
from footfall.pdr.reckoning import PdrParams, StartPose
from footfall.pdr.stance import ThresholdDetector
from tests.helpers.synthetic_foot import walk

DEG = math.pi / 180


def test_the_filter_tells_strides_and_what_it_turned(corridor):
    """A stride leads from the corrected footfall before; what was turned is what the heading changed by."""
    seen, turned = [], []

    class Teller:
        def __call__(self, step):
            seen.append(step)
            return (2 * DEG, 3 * DEG) if step.index % 3 == 0 else None

        def applied(self, by):
            turned.append(by)

    filtered = run_filter(corridor[1], corrector=Teller())
    places = filtered.footfalls.position
    for step in seen:
        np.testing.assert_allclose(step.position - step.stride, places[step.index - 1], atol=1e-12)
    asked = [step for step in seen if step.index % 3 == 0]
    assert len(turned) == len(asked) == 39
    for step, by in zip(asked, turned, strict=True):
        assert filtered.footfalls.heading[step.index] == pytest.approx(step.heading + by, abs=1e-9)
        assert 0 < by < 2 * DEG


def test_what_is_learned_without_fallback_leaves_other_straights_alone():
    """`ihde-learned`: corridors at 0 and 90 deg, then a way at 30 deg, whose mean heading ihde feeds back."""
    recording = walk(np.repeat([0.0, 90.0, 30.0], 15) * DEG).recording()
    found = tracks(Reckoning(recording), ["ihde", "ihde-learned"])
    learned, given_ = (np.isfinite(found[name].evidence["innovation"]) for name in ("ihde-learned", "ihde"))
    assert learned[12:15].all()
    assert learned[24:29].all()
    assert not learned[36:].any()
    assert given_[36:].all()
    assert found["ihde-learned"].meta["params"]["fallback"] is False


@pytest.fixture(scope="module")
def corridor():
    """Two straights and a corner, and a gyro that drifts by 0.1 deg/s about the vertical."""
    scatter = 0.7 * DEG * np.random.default_rng(2).standard_normal(120)
    scatter[0] = 0.0
    truth = walk(np.repeat([0, 90], 60) * DEG + scatter)
    up = Rotation.from_quat(truth.quaternion, scalar_first=True).inv().apply([0, 0, 1])
    return truth, truth.recording(gyro_error=np.where(truth.t[:, None] > 25, 0.1 * DEG * up, 0.0))


@pytest.mark.parametrize(
    "method", ["hdr-filter", "hde-2010", "hde", "ihde", "ihde-learned", "ihde-jimenez", "ihde-plus"]
)
def test_every_method_takes_drift_out_of_a_corridor(corridor, method):
    truth, recording = corridor
    found = tracks(Reckoning(recording), ["iez", method])
    error = {name: np.abs(one.heading - truth.heading(one.t)) for name, one in found.items()}
    assert error["iez"][-1] == pytest.approx(0.1 * DEG * (found["iez"].t[-1] - 25), rel=0.1)
    # HDR knows no direction: it can only slow the drift down, the others can take it back.
    assert error[method][-1] < (0.9 if method == "hdr-filter" else 0.35) * error["iez"][-1]


@pytest.mark.parametrize("corrector", [Hde, Ihde, Jimenez, IhdePlus])
def test_a_wrong_start_is_put_right(corridor, corrector):
    """The sign: an error of +4 deg shrinks."""
    truth, _ = corridor
    settings = FilterSettings(heading_sd=4 * DEG)
    filtered = run_filter(
        truth.recording(), settings, start=StartPose(heading=4 * DEG), corrector=corrector()
    )
    error = filtered.footfalls.heading - truth.heading(filtered.footfalls.t)
    assert error[0] == pytest.approx(4 * DEG)
    assert np.abs(error[40:59]).max() < 2 * DEG


@pytest.mark.parametrize("corrector", [Hde, Ihde, FilterHdr, Jimenez, IhdePlus])
def test_the_record_has_a_row_a_footfall_and_is_what_the_filter_was_told(corridor, corrector):
    asked = corrector()
    one = corrected_track(Reckoning(corridor[1]), asked, name="mine")
    filtered = run_filter(corridor[1], corrector=corrector())
    assert set(asked.units) <= set(one.evidence)
    assert all(len(one.evidence[name]) == len(one) for name in asked.units)
    np.testing.assert_array_equal(one.evidence["innovation"], filtered.innovation)
    assert one.meta["params"]["sigma"] == asked.params.sigma


@pytest.mark.parametrize("name", ["hde", "ihde", "ihde-jimenez", "ihde-plus", "hdr-filter"])
def test_what_a_filter_believes_under_a_heading_method_can_be_told(corridor, name):
    unsure = FilterSettings(gyro_bias_sd=0.5 * DEG)
    told = tracks(Reckoning(corridor[1], guided=unsure), [name])[name]
    untold = tracks(Reckoning(corridor[1]), [name])[name]
    assert told.meta["filter"]["gyro_bias_sd"] == 0.5 * DEG
    assert untold.meta["filter"] == vars(FilterSettings())
    assert np.abs(told.heading - untold.heading).max() > 0.05 * DEG


@pytest.mark.parametrize("name", ["iez-paper", "hde-paper", "ihde-paper"])
def test_the_papers_methods_have_the_papers_filter_and_detector(corridor, name):
    """Whatever detector finds the stances of the others."""
    found = [
        tracks(Reckoning(corridor[1], pdr=PdrParams(detector=detector)), [name])[name]
        for detector in (ThresholdDetector(), Shoe())
    ]
    np.testing.assert_array_equal(found[0].heading, found[1].heading)
    assert found[0].meta["filter"] == vars(FilterSettings.paper())
    other = run_filter(corridor[1], FilterSettings.paper())
    assert len(other.footfalls.t) != len(found[0]) or np.abs(other.footfalls.t - found[0].t).max() > 0


@pytest.mark.parametrize("name", METHODS)
def test_directions_turn_with_the_start(corridor, name):
    """Corridors are counted from the heading at the start: turn the building, and the track turns with it."""
    by = 33 * DEG
    start = [Reckoning(corridor[1], StartPose(heading=heading)) for heading in (0.0, by)]
    straight, turned = (tracks(one, [name])[name] for one in start)
    np.testing.assert_allclose(turned.heading - by, straight.heading, atol=1e-6)


def told_heading(recording, name, directions=None, reference=None):
    start = StartPose(heading=20 * DEG)
    told = told_directions(name, directions, reference)
    return tracks(Reckoning(recording, start, directions=told), [name])[name].heading


@pytest.mark.parametrize("name", [method.name for method in METHODS.values() if method.directions == "all"])
def test_directions_can_be_told(corridor, name):
    """Any one of the directions stands for all, however many there are."""
    four = told_heading(corridor[1], name, 4, 20 * DEG)
    np.testing.assert_allclose(told_heading(corridor[1], name, reference=110 * DEG), four, atol=1e-9)
    eight = told_heading(corridor[1], name, 8, 20 * DEG)
    np.testing.assert_allclose(told_heading(corridor[1], name, 8, -25 * DEG), eight, atol=1e-9)
    if name != "ihde-paper":  # whose filter here turns away from all of them at once
        beside = told_heading(corridor[1], name, reference=23 * DEG)  # corridors turned by 3 deg
        assert np.abs(beside - four).max() > 0.3 * DEG


@pytest.mark.parametrize("name", [method.name for method in METHODS.values() if method.directions == "all"])
def test_untold_directions_count_from_where_the_walk_sets_out(corridor, name):
    """And not from where the foot points, which may be beside it."""
    reckoning = Reckoning(corridor[1], StartPose(heading=20 * DEG))
    if name.endswith("-paper"):  # its own stances
        reckoning = on_papers_filter(reckoning)
    reference = reckoning.setting_out
    assert reference == pytest.approx(20 * DEG, abs=1 * DEG)
    told = told_heading(corridor[1], name, reference=reference)
    np.testing.assert_allclose(told_heading(corridor[1], name), told, atol=1e-9)


def test_a_walk_sets_out_over_its_first_five_metres():
    """Not over its first stride, and not round its corner; a shorter walk over all that it has."""
    course = np.concatenate([[25.0], np.zeros(9), np.full(5, 90)]) * DEG
    recording = walk(course, stride=1.0).recording()
    straight = np.mean([12.5, 12.5, 0, 0, 0]) * DEG
    assert Reckoning(recording, StartPose(heading=25 * DEG)).setting_out == pytest.approx(
        straight, abs=3 * DEG
    )
    short = walk(np.array([0.0, 0, 30, 30]) * DEG, stride=1.0).recording()
    assert Reckoning(short).setting_out == pytest.approx(15 * DEG, abs=1 * DEG)


def test_the_directions_that_are_learned_can_be_counted(corridor):
    """Three corridors 120 deg apart are not those of this building."""
    four, three = (told_heading(corridor[1], "ihde-learned", count) for count in (4, 3))
    np.testing.assert_array_equal(four, told_heading(corridor[1], "ihde-learned"))
    assert np.abs(three - four).max() > 0.3 * DEG
