"""How the benchmark of strides counts: a footfall missed, and one too many."""

import numpy as np
import pytest

from benchmarks.validation.strides import compare, true_stances

STANCES = np.array([[0.0, 2.0], [3.0, 3.5], [4.5, 5.0]])


@pytest.mark.parametrize(
    ("found", "missed", "more"),
    [
        ([1.9, 3.2, 4.7], [], 0),
        ([1.9, 3.2], [2], 0),
        ([1.9, 3.2, 3.4, 4.7], [], 1),
        ([1.9, 3.2, 4.0, 4.7], [], 1),
        ([1.9, 3.58, 4.42], [], 0),  # barely beside them
        ([1.9, 3.62, 4.7], [1], 1),
        ([], [0, 1, 2], 0),
    ],
)
def test_a_stance_answers_to_the_true_one_that_it_lies_in(found, missed, more):
    which, too_many = compare(STANCES, np.array(found))
    assert (np.flatnonzero(which).tolist(), too_many) == (missed, more)


def test_true_stances_are_cut_where_the_record_is_and_a_landing_is_one_with_what_follows():
    t = 0.01 * np.arange(400)
    stance = np.zeros(400, dtype=bool)
    stance[:50] = stance[150:160] = stance[165:200] = stance[300:] = True
    np.testing.assert_allclose(true_stances(t, stance), [[0, 0.49], [1.5, 1.99], [3.0, 3.99]])
