"""Ranges and lists of values."""

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.scenarios.studies.factors import FactorTable, factors_of, points_at
from footfall.toml import Strict, checked


class File(Strict):
    parameters: dict[str, FactorTable]


def factors(**tables):
    return factors_of(checked({"parameters": tables}, File, "study.toml").parameters)


def test_shares_of_a_range():
    even, ratio, listed = factors(
        a={"from": 2, "to": 6}, b={"from": 1.0, "to": 100.0, "scale": "log"}, c={"values": [50, "x", [1, 2]]}
    )
    share = np.array([0.0, 0.5, 1.0])
    np.testing.assert_allclose(even.at(share), [2, 4, 6])
    np.testing.assert_allclose(ratio.at(share), [1, 10, 100])
    assert listed.at(np.array([0.0, 0.33, 0.34, 0.67, 1.0])).tolist() == [50, 50, "x", [1, 2], [1, 2]]
    assert (even.ends, listed.ends) == ((2, 6), (50, "x", [1, 2]))
    points = points_at((even, listed), np.array([[0.25, 0.0], [1.0, 1.0]]))
    assert points == [{"a": 3.0, "c": 50}, {"a": 6.0, "c": [1, 2]}]


def test_no_value_lies_beyond_its_range():
    for low, high in ((0.003, 0.03), (0.44, 13.0), (0.0011, 0.033)):
        (one,) = factors(a={"from": low, "to": high, "scale": "log"})
        ends = one.at(np.array([0.0, 1.0]))
        np.testing.assert_allclose(ends, [low, high])
        assert low <= ends[0]
        assert ends[1] <= high


@pytest.mark.parametrize(
    ("table", "reason"),
    [
        ({}, "either from and to, or values"),
        ({"from": 1, "to": 2, "values": [1, 2]}, "either from and to, or values"),
        ({"from": 1}, "to is missing"),
        ({"to": 1}, "from is missing"),
        ({"from": 2, "to": 2}, "not below"),
        ({"from": 0, "to": 2, "scale": "log"}, "logarithmic"),
        ({"values": [1]}, "at least 2"),
        ({"from": 0, "to": 2, "step": 1}, "step"),
    ],
)
def test_what_is_no_range_is_refused(table, reason):
    with pytest.raises(InputError, match=reason):
        factors(**{"hdr.tau_s": table})


def test_what_a_range_says_to_a_document():
    even, listed = factors(a={"from": 2, "to": 6}, c={"values": [50, "x"], "label": "which"})
    assert even.as_dict() == {"label": "a", "unit": "", "from": 2, "to": 6, "scale": "linear"}
    assert listed.as_dict() == {"label": "which", "unit": "", "values": [50, "x"]}
