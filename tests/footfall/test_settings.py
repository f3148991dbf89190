"""Settings by their address: units, bounds, degrees at the edge, radians inside."""

import math
from dataclasses import FrozenInstanceError, dataclass, field
from typing import Literal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from footfall.errors import InputError
from footfall.settings import changed, leaves, require, setting


@dataclass(frozen=True)
class Inner:
    count: int = setting(4, ge=1)
    reference: float | None = setting(0.5, unit="rad")


@dataclass(frozen=True)
class Params:
    tau_s: float = setting(8.0, unit="s", ge=0)
    theta_w: float = setting(math.radians(0.25), unit="rad/s", gt=0, le=math.inf)
    share: float = setting(0.5, gt=0, lt=1)
    gain: float = setting(0.2, ge=0, le=1)
    slope: float = setting(math.radians(0.1), unit="rad/step", ge=0)
    match: float = setting(math.radians(5.0), unit="rad", ge=0, le=math.pi / 2)
    slopes: tuple[float, ...] = setting((math.radians(0.6), math.radians(2.5)), unit="rad", gt=0)
    source: Literal["yaw", "course"] = "course"
    fallback: bool = True
    directions: Inner = field(default_factory=Inner)
    hook: object = None

    def __post_init__(self) -> None:
        require("mine", self)


def leaf(name, params=None):
    return next(one for one in leaves(params or Params()) if one.name == name)


def test_names_say_degrees_where_the_edge_is_in_degrees():
    assert [one.name for one in leaves(Params())] == [
        "tau_s",
        "theta_w_deg_s",
        "share",
        "gain",
        "slope",
        "match_deg",
        "slopes_deg",
        "source",
        "fallback",
        "directions.count",
        "directions.reference_deg",
    ]  # and no hook, which nobody can write down


def test_values_and_bounds_at_the_edge_are_in_degrees():
    assert leaf("theta_w_deg_s")[1:] == (0.25, float, "deg/s", None, 0, math.inf, None)
    assert leaf("match_deg")[1:] == (5.0, float, "deg", 0, None, 90.0, None)
    assert leaf("slopes_deg").value == (0.6, 2.5)
    assert leaf("slope")[1:4] == (math.radians(0.1), float, "rad/step")  # no ending: stays what it is
    assert leaf("directions.reference_deg").value == pytest.approx(28.6479, abs=1e-4)
    assert leaf("directions.reference_deg", Params(directions=Inner(reference=None))).value is None


def test_a_change_is_in_radians_inside():
    found = changed(Params(), {"theta_w_deg_s": 0.3, "directions.count": 2, "slopes_deg": [1, 2.0]})
    assert found.theta_w == math.radians(0.3)
    assert found.directions == Inner(count=2)
    assert found.slopes == (math.radians(1), math.radians(2))
    assert found == changed(found, {})


@given(st.floats(1e-300, 1e6), st.floats(-1e3, 1e3), st.floats(0, math.pi / 2))
def test_what_is_told_and_given_back_changes_no_bit(theta_w, reference, match):
    params = Params(theta_w=theta_w, match=match, directions=Inner(reference=reference))
    told = {one.name: one.value for one in leaves(params)}
    assert changed(params, told) == params
    # and a neighbour's settings come back as near as degrees can tell radians
    copied = changed(Params(), told)
    assert copied.theta_w == pytest.approx(theta_w, rel=1e-15)
    assert copied.directions.reference == pytest.approx(reference, rel=1e-15)


@given(st.floats(-1e6, 1e6))
def test_degrees_are_those_of_the_circle(degrees):
    found = changed(Params(), {"directions.reference_deg": degrees})
    assert (
        found.directions.reference == degrees / 180 * math.pi
        or found.directions.reference == pytest.approx(degrees * math.pi / 180, rel=1e-15)
    )


def test_defaults_are_told_in_the_digits_that_they_were_written_in():
    for degrees in (0.007, 0.25, 0.3, 2.5, 5.0, 12.0, 15.0, 60.0, 29.7):
        assert leaf("theta_w_deg_s", Params(theta_w=math.radians(degrees))).value == degrees


@pytest.mark.parametrize(
    ("name", "value", "sentence"),
    [
        ("theta_w_deg_s", -1, "theta_w_deg_s = -1: expected a positive number"),
        ("theta_w_deg_s", 0, "theta_w_deg_s = 0: expected a positive number"),
        ("theta_w_deg_s", math.nan, "theta_w_deg_s = nan: expected a positive number"),
        ("theta_w_deg_s", "0.3", "theta_w_deg_s = 0.3: expected a positive number"),
        ("theta_w_deg_s", True, "theta_w_deg_s = True: expected a positive number"),
        ("tau_s", math.inf, "tau_s = inf: expected a number, 0 or more"),
        ("tau_s", -1e-9, "tau_s = -1e-09: expected a number, 0 or more"),
        ("gain", 1.5, "gain = 1.5: expected a number, 0 to 1"),
        ("share", 1, "share = 1: expected a number, between 0 and 1"),
        ("match_deg", 90.1, "match_deg = 90.1: expected a number, 0 to 90"),
        ("slopes_deg", [1, -1], "slopes_deg = [1, -1]: expected a list of positive numbers"),
        ("slope", -1, "slope = -1: expected a number, 0 or more (rad/step)"),
        ("source", "foot", 'source = foot: expected "yaw" or "course"'),
        ("fallback", 1, "fallback = 1: expected true or false"),
        ("directions.count", 0, "directions.count = 0: expected a whole number, at least 1"),
        ("directions.count", 2.0, "directions.count = 2.0: expected a whole number, at least 1"),
        ("directions.reference_deg", "n", "directions.reference_deg = n: expected a number or none"),
    ],
)
def test_a_value_that_cannot_be_is_refused_in_a_sentence(name, value, sentence):
    with pytest.raises(InputError) as refused:
        changed(Params(), {name: value})
    assert str(refused.value) == sentence


@pytest.mark.parametrize(
    ("name", "value"),
    [("theta_w_deg_s", math.inf), ("tau_s", 0), ("gain", 1), ("gain", 0), ("match_deg", 90), ("share", 1e-9)],
)
def test_bounds_belong_to_what_is_allowed(name, value):
    assert leaf(name, changed(Params(), {name: value})).value == value


def test_none_can_be_written():
    assert changed(Params(), {"directions.reference_deg": "none"}).directions.reference is None
    assert changed(Params(), {"directions.reference_deg": None}).directions.reference is None


@pytest.mark.parametrize(
    ("name", "ending"),
    [
        ("theta_w", "; did you mean theta_w_deg_s?"),
        ("count", "; did you mean directions.count?"),
        ("directions.cuont", "; did you mean directions.count?"),
        ("tau", "; did you mean tau_s?"),
        ("zzz", "; expected one of tau_s, theta_w_deg_s, "),
        ("hook", "; expected one of tau_s, "),
    ],
)
def test_an_unknown_name_is_told_the_nearest(name, ending):
    with pytest.raises(InputError) as refused:
        changed(Params(), {name: 1})
    assert str(refused.value).startswith(f"{name}: unknown{ending}")


def test_nothing_to_set_is_said():
    @dataclass(frozen=True)
    class Empty:
        pass

    with pytest.raises(InputError, match=r"^a: unknown; there is nothing to set$"):
        changed(Empty(), {"a": 1})


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"tau_s": -1.0}, "mine: tau_s = -1.0, expected 0 or more"),
        ({"tau_s": math.inf}, "mine: tau_s = inf, expected 0 or more"),
        ({"theta_w": math.nan}, "mine: theta_w = nan rad/s, expected a positive number"),
        ({"gain": 2.0}, "mine: gain = 2.0, expected 0 to 1"),
        ({"slopes": (0.1, 0.0)}, "mine: slopes = (0.1, 0.0) rad, expected positive numbers"),
    ],
)
def test_a_dataclass_refuses_by_the_same_bounds(given, sentence):
    with pytest.raises(InputError) as refused:
        Params(**given)
    assert str(refused.value) == sentence


def test_a_field_without_bounds_is_finite_and_other_values_are_not_asked():
    @dataclass(frozen=True)
    class Free:
        angle: float | None = setting(0.0, unit="rad")
        text: str = setting("")

        def __post_init__(self) -> None:
            require("free", self)

    assert Free(angle=None, text="x").angle is None
    with pytest.raises(InputError, match=r"^free: angle = nan rad, expected a finite number$"):
        Free(angle=math.nan)


def test_settings_are_read_only():
    params = Params()
    changed(params, {"tau_s": 1.0, "directions.count": 2})
    assert params == Params()
    with pytest.raises(AttributeError):
        leaf("tau_s").value = 3
    with pytest.raises(FrozenInstanceError):
        params.tau_s = 3
    with pytest.raises(TypeError):
        Params.__dataclass_fields__["tau_s"].metadata["footfall"] = None


def test_what_a_dataclass_refuses_in_itself_is_refused():
    @dataclass(frozen=True)
    class Pair:
        low: float = setting(0.0)
        high: float = setting(1.0)

        def __post_init__(self) -> None:
            if self.low > self.high:
                raise InputError("low above high")

    with pytest.raises(InputError, match="low above high"):
        changed(Pair(), {"low": 2.0})
    assert changed(Pair(), {"low": 2.0, "high": 3.0}) == Pair(2.0, 3.0)
