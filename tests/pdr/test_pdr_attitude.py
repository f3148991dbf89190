"""Attitudes and turns of a start, beside scipy's."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from footfall.pdr.attitude import quaternion_of, turned


@given(st.tuples(*[st.floats(-1, 1)] * 4).filter(lambda q: np.linalg.norm(q) > 0.1))
def test_the_quaternion_of_a_matrix_is_scipys_to_the_bit(quaternion):
    matrix = Rotation.from_quat(quaternion).as_matrix()
    expected = Rotation.from_matrix(matrix).as_quat(scalar_first=True)
    assert quaternion_of(matrix).tolist() == expected.tolist()


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("angle", [0.0, 0.1, 2.0, 3.1, np.pi, -3.1, -1e-9])
def test_the_quaternion_is_scipys_for_each_largest_element(axis, angle):
    matrix = Rotation.from_rotvec(angle * np.eye(3)[axis] + 1e-3).as_matrix()
    expected = Rotation.from_matrix(matrix).as_quat(scalar_first=True)
    assert quaternion_of(matrix).tolist() == expected.tolist()


def test_positions_turn_counter_clockwise_and_keep_their_height():
    np.testing.assert_allclose(
        turned(np.array([[1.0, 0, 5], [0, 2, -1]]), np.pi / 2), [[0, 1, 5], [-2, 0, -1]], atol=1e-15
    )


@given(st.floats(-7, 7))
def test_positions_turn_as_scipy_turns_them(heading):
    position = np.random.default_rng(1).normal(size=(20, 3))
    expected = Rotation.from_rotvec([0, 0, heading]).apply(position)
    np.testing.assert_allclose(turned(position, heading), expected, atol=1e-13)
