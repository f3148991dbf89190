"""What the judgement of a recording goes by: its stillest instants, and which way is up."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy.signal import find_peaks
from scipy.spatial.transform import Rotation

from footfall.formats.closure import lowest, upright

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
