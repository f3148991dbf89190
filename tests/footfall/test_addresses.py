"""Dotted addresses into documents: what is listed is what can be set, and nothing else changes."""

import copy
from typing import Annotated, Literal

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import Field

from footfall.addresses import Key, Part, edited, keys, parse, pattern
from footfall.errors import InputError
from footfall.toml import Strict


class Left(Strict):
    kind: Literal["left"] = "left"
    turn_deg: float = Field(90.0, gt=-180, lt=180)


class Right(Strict):
    kind: Literal["right"] = "right"
    radius_m: Annotated[float, Field(gt=0)]


class Gait(Strict):
    pace_m_s: float = Field(ge=0.7, le=1.7)
    wander_m: tuple[Annotated[float, Field(ge=0)], ...] = (0.0,)


class Table(Strict):
    name: str
    gait: Gait
    path: tuple[Annotated[Left | Right, Field(discriminator="kind")], ...]
    subjects: tuple[str | Gait, ...] = ()
    push: Gait | None = None
    count: int | None = Field(None, ge=1)


DOCUMENT = {
    "name": "one",
    "gait": {"pace_m_s": 1.3},
    "path": [
        {"kind": "left", "turn_deg": 90.0},
        {"kind": "right", "radius_m": 5.0},
        {"kind": "right", "radius_m": 6.0},
    ],
    "subjects": ["reference", {"pace_m_s": 1.0}],
}


def test_every_value_of_a_model_is_listed_once_with_its_bounds():
    found = {key.address: key for key in keys(Table)}
    assert list(found) == [
        "name",
        "gait.pace_m_s",
        "gait.wander_m",
        "path[kind=left].kind",
        "path[kind=left].turn_deg",
        "path[kind=right].kind",
        "path[kind=right].radius_m",
        "subjects[*].pace_m_s",
        "subjects[*].wander_m",
        "subjects[*]",
        "push.pace_m_s",
        "push.wander_m",
        "count",
    ]
    assert found["gait.pace_m_s"] == Key("gait.pace_m_s", "number", ">= 0.7, <= 1.7", None)
    assert found["gait.wander_m"] == Key("gait.wander_m", "list of numbers", ">= 0", (0.0,))
    assert found["path[kind=left].turn_deg"].bounds == "> -180, < 180"
    assert found["path[kind=right].radius_m"].bounds == "> 0"
    assert found["push.wander_m"].default is None  # an absent table
    assert found["count"] == Key("count", "whole number", ">= 1", None)


@pytest.mark.parametrize(
    ("address", "expected"),
    [
        ("gait.pace_m_s", {("gait", "pace_m_s"): 9}),
        ("gait.new", {("gait", "new"): 9}),
        ("push.pace_m_s", {("push", "pace_m_s"): 9}),
        ("path[0].turn_deg", {("path", 0, "turn_deg"): 9}),
        ("path[kind=right].radius_m", {("path", 1, "radius_m"): 9, ("path", 2, "radius_m"): 9}),
        ("path[*].grade", {("path", i, "grade"): 9 for i in range(3)}),
        ("subjects[0]", {("subjects", 0): 9}),
        ("subjects[1].pace_m_s", {("subjects", 1, "pace_m_s"): 9}),
        ("name", {("name",): 9}),
    ],
)
def test_a_value_is_set_where_the_address_says_and_nowhere_else(address, expected):
    before = copy.deepcopy(DOCUMENT)
    wanted = copy.deepcopy(DOCUMENT)
    for path, value in expected.items():
        at = wanted
        for step in path[:-1]:
            at = at.setdefault(step, {}) if isinstance(at, dict) else at[step]
        at[path[-1]] = value
    assert edited(DOCUMENT, address, 9) == wanted
    assert before == DOCUMENT


@pytest.mark.parametrize(
    ("address", "message"),
    [
        ("path.radius_m", r"path is a list of 3: say which, path\[0\]"),
        ("path[3].radius_m", r"path has 3 elements, and \[3\] is none of them"),
        ("path[kind=up].radius_m", r"\[kind=up\] is none of them"),
        ("path[last].radius_m", r"\[last\] chooses nothing"),
        ("name.first", r"name is 'one', there is nothing below it"),
        ("subjects[0].pace_m_s", r"subjects\[0\] is 'reference', there is nothing below it"),
        ("gait..pace_m_s", "'' is no step of an address"),
        ("gait.pace m", "'pace m' is no step of an address"),
        ("", "'' is no step of an address"),
    ],
)
def test_an_address_that_leads_nowhere_is_refused(address, message):
    with pytest.raises(InputError, match=message):
        edited(DOCUMENT, address, 9)


def test_a_dot_in_a_choice_is_no_step():
    assert parse("path[radius_m=2.5].turn_deg") == (Part("path", "radius_m=2.5"), Part("turn_deg", None))
    assert pattern("a[0].b[kind=x].c") == "a[*].b[*].c"


@given(st.lists(st.sampled_from(["gait", "path[0]", "x1", "a_b[k=v]", "y[*]"]), min_size=1, max_size=4))
def test_what_is_parsed_is_what_was_written(steps):
    parts = parse(".".join(steps))
    assert [p.name + (f"[{p.which}]" if p.which else "") for p in parts] == steps
