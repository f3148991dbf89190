"""From recording to track by a method's name, and from a better heading to a better track."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from footfall.errors import InputError
from footfall.hdr.correct import paper_positions, turned_positions
from footfall.hdr.hdr import HdrParams, trace
from footfall.hdr.methods import METHODS, Reckoning, hdr_track, pdr_track, track, tracks
from footfall.pdr.reckoning import PdrParams, StartPose, dead_reckon
from footfall.pdr.stance import ThresholdDetector
from footfall.pdr.track import read_track, write_track
from tests.helpers.synthetic_foot import footfalls, walk

DEG = np.pi / 180


@pytest.fixture(scope="module")
def drifting():
    """Straights and corners, and a gyro that drifts by 0.1 deg/s about the vertical once the walk begins."""
    scatter = 1 * DEG * np.random.default_rng(2).standard_normal(400)
    truth = walk(np.repeat([0, 90, 0, -90], 100) * DEG + scatter)
    up = Rotation.from_quat(truth.quaternion, scalar_first=True).inv().apply([0, 0, 1])
    return truth, truth.recording(gyro_error=np.where(truth.t[:, None] > 25, 0.1 * DEG * up, 0.0))


def test_hdr_removes_the_drift_that_dead_reckoning_integrates(drifting):
    truth, recording = drifting
    row = truth.at(np.array([25.0]))
    start = StartPose(tuple(truth.position[row[0]]), float(truth.heading(truth.t[row])[0]))
    found = tracks(Reckoning(recording, start), ["pdr", "hdr"])
    error = {name: np.abs(one.heading - truth.heading(one.t))[-1] for name, one in found.items()}
    lost = {
        name: np.linalg.norm((one.position - truth.position[truth.at(one.t)])[-1, :2])
        for name, one in found.items()
    }
    assert error["pdr"] == pytest.approx(0.1 * DEG * (found["pdr"].t[-1] - 25), rel=0.02)
    assert error["hdr"] < 0.3 * error["pdr"]
    assert lost["hdr"] < 0.4 * lost["pdr"]


def test_methods_share_one_detection(drifting):
    calls = []

    class Counting(ThresholdDetector):
        def __call__(self, t, gyro, accel):
            calls.append(len(t))
            return super().__call__(t, gyro, accel)

    found = tracks(Reckoning(drifting[1], pdr=PdrParams(detector=Counting())), METHODS)
    assert list(found) == list(METHODS)
    assert len(calls) == 1


@pytest.mark.parametrize("name", METHODS)
def test_every_method_writes_a_track_that_can_be_read_back(drifting, name, tmp_path):
    _, recording = drifting
    start = StartPose((1.0, 2.0, 3.0), 0.5)
    one = track(recording, name, start)
    assert METHODS[name].name == name
    assert METHODS[name].description
    np.testing.assert_allclose(one.position[0], start.position)
    assert one.heading[0] == pytest.approx(0.5)
    write_track(one, tmp_path / "track.parquet")
    back = read_track(tmp_path / "track.parquet")
    np.testing.assert_array_equal(back.position, one.position)
    assert set(back.evidence) == set(one.evidence)
    assert back.meta["method"] == name


def test_hdrs_evidence_is_what_the_controller_saw(drifting):
    walked = dead_reckon(drifting[1])
    one, found = hdr_track(walked), trace(walked)
    expected = {
        "raw_rate": (found.raw, "rad/s"),
        "rate_once": (found.once, "rad/s"),
        "rate_twice": (found.twice, "rad/s"),
        "attenuator": (found.attenuator, ""),
        "integrator": (found.integrator, "rad/s"),
    }
    assert set(one.evidence) == set(expected) == set(one.units)
    for name, (values, unit) in expected.items():
        np.testing.assert_array_equal(one.evidence[name], values)
        assert one.units[name] == unit


def test_an_unknown_method_is_refused(drifting):
    with pytest.raises(InputError, match=r"'hdx' is unknown; did you mean hdr\?"):
        track(drifting[1], "hdx")


def test_without_a_correction_the_track_is_dead_reckonings():
    walked = footfalls(np.random.default_rng(0).normal(0, 0.1, 50))
    np.testing.assert_allclose(turned_positions(walked, walked.heading), walked.position, atol=1e-12)
    np.testing.assert_array_equal(pdr_track(walked).position, walked.position)
    idle = hdr_track(walked, HdrParams(i_c=0.0))
    np.testing.assert_allclose(idle.position, walked.position, atol=1e-12)


@given(st.integers(0, 2**32 - 1))
def test_turning_keeps_every_strides_length_and_height(seed):
    rng = np.random.default_rng(seed)
    walked = footfalls(rng.normal(0, 0.1, 50), rng.uniform(0.8, 1.5, 50))
    walked.position[:, 2] = rng.normal(size=51)
    turned = turned_positions(walked, walked.heading + np.cumsum(rng.normal(0, 0.1, 51)))
    np.testing.assert_allclose(
        np.linalg.norm(np.diff(turned, axis=0), axis=1),
        np.linalg.norm(np.diff(walked.position, axis=0), axis=1),
        atol=1e-12,
    )
    np.testing.assert_allclose(turned[:, 2], walked.position[:, 2], atol=1e-12)


@given(st.floats(-0.01, 0.01), st.integers(0, 2**32 - 1))
def test_the_true_heading_gives_the_true_track(drift, seed):
    """Dead reckoning with a drift, turned back by that drift, lands where the walk without it did."""
    rate = np.random.default_rng(seed).normal(0, 0.1, 300)
    true, drifted = footfalls(rate), footfalls(rate + drift)
    np.testing.assert_allclose(turned_positions(drifted, true.heading), true.position, atol=1e-9)


def test_equation_12_goes_along_the_shoe():
    """x_i = x_{i-1} + D_i cos psi_i: the shoe's heading, not the displacement's."""
    walked = footfalls(np.random.default_rng(1).normal(0, 0.1, 50))
    found = paper_positions(walked, walked.heading)
    steps = np.diff(found[:, :2], axis=0)
    np.testing.assert_allclose(np.arctan2(steps[:, 1], steps[:, 0]), walked.heading[1:], atol=1e-9)
    np.testing.assert_allclose(np.hypot(*steps.T), walked.distance[1:], atol=1e-12)
    option = hdr_track(walked, paper_positions=True)
    np.testing.assert_array_equal(option.position, paper_positions(walked, option.heading))
    assert option.meta["paper_positions"] is True
