"""What the judgement of a recording goes by: its stillest instants, and which way is up."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy.signal import find_peaks
from scipy.spatial.transform import Rotation

from footfall.formats.closure import lowest, misclosure, rests_of, strides_of, upright, velocities_left
from footfall.recording import Recording
from tests.helpers.synthetic_foot import walk

# Few different values make plateaus and ties; steps of an eighth are exact.
heights = hnp.arrays(float, st.integers(1, 60), elements=st.integers(0, 7).map(lambda k: k / 8))


@given(heights, st.sampled_from([0.25, 0.5, 1.0]), st.integers(1, 12))
def test_the_stillest_instants_are_scipys_peaks(x, most, apart):
    np.testing.assert_array_equal(lowest(x, most, apart), find_peaks(-x, height=-most, distance=apart)[0])


@given(hnp.arrays(float, 3, elements=st.floats(-20, 20)).filter(lambda up: np.linalg.norm(up) > 0.1))
def test_any_direction_can_be_up(up):
    quaternion = upright(up)
    assert np.linalg.norm(quaternion) == pytest.approx(1)
    turned = Rotation.from_quat(quaternion, scalar_first=True).apply(up)
    np.testing.assert_allclose(turned, [0, 0, np.linalg.norm(up)], atol=1e-9)


@pytest.mark.parametrize("up", [[0, 0, 9.8], [0, 0, -9.8], [9.8, 0, 0], [0, -9.8, 0]])
def test_an_axis_can_be_up(up):
    turned = Rotation.from_quat(upright(np.array(up)), scalar_first=True).apply(up)
    np.testing.assert_allclose(turned, [0, 0, 9.8], atol=1e-12)


def walked(strides=8, slower=1.0):
    truth = walk(np.zeros(strides + 1), still_s=4.0)
    return Recording(slower * truth.t[1:], truth.gyro[1:], truth.accel[1:])


@pytest.mark.parametrize(("slower", "found"), [(0.7, 8), (1.0, 8), (2.0, 8), (3.5, 8), (6.0, 0)])
def test_strides_of_any_clock_are_looked_at(slower, found):
    """A stride takes 1.1 s; to stand is none."""
    recording = walked(slower=slower)
    assert len(strides_of(recording, rests_of(recording))) == found


@pytest.mark.parametrize(("strides", "found"), [(4, 0), (5, 5), (50, 40)])
def test_few_strides_are_none_and_many_are_not_all_looked_at(strides, found):
    recording = walked(strides)
    assert len(strides_of(recording, rests_of(recording))) == found


def test_a_perfect_stride_leaves_little_and_a_steady_force_its_share_of_g():
    recording = walked()
    strides = strides_of(recording, rests_of(recording))
    left = velocities_left(recording, strides)
    assert np.abs(left[:, 2]).max() < 1e-3
    assert misclosure(recording, strides) < 5e-3
    more = Recording(recording.t, recording.gyro, 1.02 * recording.accel)
    np.testing.assert_allclose(velocities_left(more, strides)[:, 2], 0.02, atol=2e-3)
