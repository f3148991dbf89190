"""What the samples of a stride say, against errors whose every part is known."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from footfall.pdr.footfalls import Footfalls
from footfall.pdr.reckoning import dead_reckon
from tests.helpers.synthetic_foot import walk

HEADINGS = np.cumsum(np.random.default_rng(3).normal(0, 0.1, 24))
DEG = np.pi / 180


@pytest.fixture(scope="module")
def truth():
    return walk(HEADINGS, pauses={8: 30.0, 12: 5.0, 15: 9.0})


@pytest.fixture(scope="module")
def found(truth):
    warm = 20 - 0.1 * truth.t
    return dead_reckon(replace(truth.recording(), temperature=warm))


@pytest.mark.parametrize("which", range(3), ids=["g-sensitivity", "scale", "g-squared"])
def test_loads_foretell_what_an_error_of_the_gyro_turns(truth, found, which):
    """The heading that a matrix of errors adds, stride by stride, less what the static bias takes off."""
    matrix = np.random.default_rng(which).normal(0, [3e-4, 3e-3, 1e-5][which], (3, 3))
    cause = [truth.accel, truth.gyro, truth.accel**2][which]
    wrong = dead_reckon(truth.recording(gyro_error=cause @ matrix.T))
    added = np.diff(wrong.heading - found.heading)
    loads = found.strides.loads[1:, 9 * which : 9 * which + 9]
    foretold = loads @ matrix.ravel() * found.interval[1:]
    # By stance the tilt is another, too, and so the heading of an axis that is not level.
    total = np.cumsum(added)
    assert np.abs(total).max() > 0.05 * DEG
    np.testing.assert_allclose(np.cumsum(foretold), total, atol=0.1 * np.abs(total).max())


def test_standing_loads_nothing(found):
    """Of a long rest hardly a stride's load is left."""
    mean = np.abs(found.strides.loads).mean(axis=1)
    walking = np.setdiff1d(np.arange(1, len(found)), [8, 12, 15])
    assert mean[8] < 0.1 * mean[walking].min()
    assert (found.strides.loads[0] == 0).all()


def test_a_rest_tells_the_rate_in_its_quiet_middle(truth, found):
    resting = found.strides.rest_s
    assert np.flatnonzero(resting).tolist() == [8, 15]
    assert resting[8] == pytest.approx(30 - 5.5, abs=1.0)
    assert resting[15] == pytest.approx(9 - 5.5, abs=1.0)
    # A bias that comes with the first step, about the vertical.
    attitude = Rotation.from_quat(truth.quaternion, scalar_first=True)
    bias = attitude.inv().apply([0.0, 0.0, 0.1 * DEG]) * (truth.t > 26)[:, None]
    biased = dead_reckon(truth.recording(gyro_error=bias)).strides
    np.testing.assert_allclose(biased.rest_rate[[8, 15]], 0.1 * DEG, rtol=1e-3)
    assert abs(found.strides.rest_rate).max() < 1e-6
    middle = 20 - 0.1 * (found.t[8] - 1.5 - resting[8] / 2)
    assert found.strides.rest_temperature[8] == pytest.approx(middle, abs=0.05)


def test_temperature_is_that_of_the_stride_and_of_the_still_start(truth, found):
    assert found.strides.temperature[0] == pytest.approx(20 - 0.1 * 12.5, abs=0.01)
    middle = found.t[1:] - found.interval[1:] / 2
    np.testing.assert_allclose(found.strides.temperature[1:], 20 - 0.1 * middle, atol=2e-3)
    assert np.isnan(dead_reckon(truth.recording()).strides.temperature).all()


def test_a_stride_moves_until_the_foot_rests(found):
    assert found.strides.moving[0] == 0
    assert found.strides.moving[8] == pytest.approx(found.interval[8] - 30, abs=0.5)
    usual = np.setdiff1d(np.arange(1, len(found) - 1), [8, 12, 15])
    np.testing.assert_allclose(found.strides.moving[usual], found.interval[usual])


def test_footfalls_of_no_samples_have_none():
    assert Footfalls.at(np.arange(3.0), np.zeros((3, 3)), np.zeros(3)).strides is None
