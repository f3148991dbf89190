"""Headings from attitudes, and angles in range."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from footfall.conventions import heading_of, wrap

turns = st.floats(-0.99 * np.pi, 0.99 * np.pi)


@given(st.floats(-3.0, 3.0), st.floats(-1.4, 1.4), st.floats(-3.0, 3.0))
def test_heading_is_the_direction_of_the_x_axis(yaw, pitch, roll):
    attitude = Rotation.from_euler("ZYX", [yaw, pitch, roll])
    x = attitude.apply([1.0, 0.0, 0.0])
    heading = heading_of(attitude.as_quat(scalar_first=True))
    assert heading == pytest.approx(np.arctan2(x[1], x[0]), abs=1e-9)
    assert heading == pytest.approx(yaw, abs=1e-9)


@given(st.lists(turns, min_size=1, max_size=40), st.booleans())
def test_heading_is_continuous_over_many_turns(steps, negated):
    heading = np.cumsum(steps) - steps[0]
    quaternion = Rotation.from_rotvec(np.outer(heading, [0, 0, 1])).as_quat(scalar_first=True)
    quaternion[::2] *= -1 if negated else 1  # one and the same attitude
    np.testing.assert_allclose(heading_of(quaternion), heading, atol=1e-9)


@given(st.floats(-1e3, 1e3))
def test_wrapping_takes_off_whole_turns(angle):
    inside = wrap(angle)
    assert -np.pi <= inside < np.pi
    assert (angle - inside) / (2 * np.pi) == pytest.approx(round((angle - inside) / (2 * np.pi)), abs=1e-9)
