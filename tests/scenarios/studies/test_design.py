"""Designs: grids, lists and samples, and which of their points are the same."""

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.scenarios.studies.design import DesignTable, labels, points, unit_cube
from footfall.toml import checked


def own(address):
    """Of two methods."""
    area = address.partition(".")[0]
    return area if area in ("hdr", "iez") else None


def made(whole=(), **table):
    return points(checked(table, DesignTable, "study.toml"), own, lambda address: address in whole)


def refused(**table):
    with pytest.raises(InputError) as told:
        checked(table, DesignTable, "study.toml")
    return str(told.value)


def test_without_axes_there_is_one_point():
    (point,) = made()
    assert (point.shared, point.own) == ({}, {})


def test_a_grid_multiplies_what_is_shared_and_each_method_apart():
    found = made(
        axes={
            "imu": ["a", "b"],
            "hdr.x": [1, 2, 3],
            "iez.y": [True, False],
            "pdr.z": [0.1, 0.2],
            "hdr.v": [7, 8],
        }
    )
    assert [point.shared for point in found] == [
        {"imu": imu, "pdr.z": z} for imu in ("a", "b") for z in (0.1, 0.2)
    ]
    for point in found:
        assert list(point.own["hdr"]) == [{"hdr.x": x, "hdr.v": v} for x in (1, 2, 3) for v in (7, 8)]
        assert list(point.own["iez"]) == [{"iez.y": True}, {"iez.y": False}]


def test_ranges_are_linear_or_logarithmic_and_keep_their_ends():
    (point,) = made(axes={"hdr.x": {"from": 0.1, "to": 1, "steps": 4, "scale": "log"}})
    assert [one["hdr.x"] for one in point.own["hdr"]] == [0.1, 0.215443, 0.464159, 1.0]
    (point,) = made(axes={"hdr.x": {"from": -1, "to": 2, "steps": 4}})
    assert [one["hdr.x"] for one in point.own["hdr"]] == [-1.0, 0.0, 1.0, 2.0]


def test_whole_numbers_are_whole_and_none_comes_twice():
    (point,) = made(whole={"hdr.n"}, axes={"hdr.n": {"from": 1, "to": 3, "steps": 5}})
    values = [one["hdr.n"] for one in point.own["hdr"]]
    assert values == [1, 2, 3]
    assert all(type(value) is int for value in values)
    assert len(made(axes={"imu": ["a", "b", "a"]})) == 2


def test_a_list_joins_what_is_meant_together():
    found = made(
        kind="list",
        points=[
            {"imu": "a", "hdr.x": 1},
            {"imu": "a", "hdr.x": 2},
            {"imu": "b"},
            {"hdr.x": 1, "imu": "a"},
        ],
    )
    assert [point.shared for point in found] == [{"imu": "a"}, {"imu": "b"}]
    assert list(found[0].own["hdr"]) == [{"hdr.x": 1}, {"hdr.x": 2}]
    assert found[1].own == {}


@pytest.mark.parametrize("kind", ["random", "sobol", "latin-hypercube"])
def test_samples_lie_within_their_ranges_and_are_the_same_again(kind):
    axes = {
        "pdr.a": {"from": 1.0, "to": 100.0, "scale": "log"},
        "pdr.b": {"from": -1.0, "to": 1.0},
        "imu": ["u", "v"],
    }
    found = made(kind=kind, samples=64, seed=5, axes=axes)
    assert len(found) == 64
    a, b, imu = (np.array([point.shared[name] for point in found]) for name in axes)
    assert ((a >= 1) & (a <= 100)).all()
    assert ((b >= -1) & (b <= 1)).all()
    assert abs(np.median(np.log10(a)) - 1) < 0.3
    assert set(imu) == {"u", "v"}
    assert found == made(kind=kind, samples=64, seed=5, axes=axes)
    assert found != made(kind=kind, samples=64, seed=6, axes=axes)


def test_even_designs_are_even():
    for kind in ("sobol", "latin-hypercube"):
        cube = unit_cube(kind, 3, 16, 2)
        assert (np.sort((cube * 16).astype(int), axis=0) == np.arange(16)[:, None]).all()
    slices = np.sort((unit_cube("random", 3, 16, 2) * 16).astype(int), axis=0)
    assert (slices != np.arange(16)[:, None]).any()


def test_what_people_call_an_axis():
    table = {"axes": {"imu": {"values": ["a"], "label": "grade"}, "hdr.x": [1]}}
    assert labels(checked(table, DesignTable, "s")) == {"imu": "grade"}


@pytest.mark.parametrize(
    ("table", "sentence"),
    [
        ({"kind": "gird"}, "kind = 'gird'"),
        ({"axes": {"a": []}}, "axes.a: "),
        ({"axes": {"a": {"from": 1, "to": 2}}}, "a: how many steps from 1 to 2?"),
        ({"axes": {"a": {"from": 2, "to": 1, "steps": 3}}}, "expected to beyond from"),
        ({"axes": {"a": {"from": 0, "to": 1, "steps": 3, "scale": "log"}}}, "expected a positive number"),
        ({"axes": {"a": {"from": 0, "to": 1, "step": 3}}}, "unknown key 'axes.a.step'"),
        ({"kind": "list"}, "points: expected"),
        ({"points": [{"a": 1}]}, "points: expected"),
        ({"kind": "list", "points": [{"a": 1}], "axes": {"b": [1]}}, "has points instead"),
        ({"kind": "sobol", "axes": {"a": [1]}}, "how many samples"),
        ({"kind": "random", "samples": 3}, "expected axes"),
        ({"samples": 3, "axes": {"a": [1]}}, 'kind = "grid" has none'),
        ({"kind": "sobol", "samples": 100, "axes": {"a": [1]}}, "64 or 128"),
        (
            {"kind": "random", "samples": 3, "axes": {"a": {"from": 0, "to": 1, "steps": 3}}},
            "samples are not on steps",
        ),
    ],
)
def test_mistakes_are_told_in_a_sentence(table, sentence):
    told = refused(**table)
    assert told.startswith("study.toml: ")
    assert sentence in told
    assert "\n" not in told
