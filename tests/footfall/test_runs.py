"""Runs of true flags."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from footfall.runs import runs


def test_runs_are_half_open_and_cover_the_flags():
    flags = np.array([True, True, False, True, False, False, True])
    assert runs(flags).tolist() == [[0, 2], [3, 4], [6, 7]]
    assert runs(np.zeros(3, dtype=bool)).shape == (0, 2)


@given(st.lists(st.booleans()))
def test_what_is_in_no_run_is_false(flags):
    found = runs(np.array(flags, dtype=bool))
    marked = [False] * len(flags)
    for start, stop in found:
        marked[start:stop] = [True] * (stop - start)
    assert marked == flags
    assert (found[1:, 0] > found[:-1, 1]).all()  # of two that touch, one would do
