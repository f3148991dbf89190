"""Settings that have an address: units and bounds on the fields of a frozen dataclass, read and set by name.

Inside, angles are radians. At the edge a field in rad is called NAME_deg and one in rad/s NAME_deg_s, and its
value and bounds are in degrees; every other field keeps its name and unit. Nested settings are dotted.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, fields, is_dataclass, replace
from types import NoneType, UnionType
from typing import Any, Literal, NamedTuple, TypeVar, Union, get_args, get_origin, get_type_hints

from footfall.errors import InputError

Settings = TypeVar("Settings")

_KEY = "footfall"  # of a field's metadata
_EDGE = {"rad": ("_deg", "deg"), "rad/s": ("_deg_s", "deg/s")}  # unit inside: ending of the name, unit there


@dataclass(frozen=True)
class _Limits:
    """Unit and bounds of a field, as it is inside."""

    unit: str = ""
    ge: float | None = None
    gt: float | None = None
    le: float | None = None
    lt: float | None = None

    def admit(self, value: object) -> bool:
        """Whether a number, or each of several, lies within; what is no number is not asked."""
        if isinstance(value, tuple):
            return all(map(self.admit, value))
        if isinstance(value, bool) or not isinstance(value, int | float):
            return True
        return (
            (math.isfinite(value) or value in (self.le, self.ge))
            and (self.ge is None or value >= self.ge)
            and (self.gt is None or value > self.gt)
            and (self.le is None or value <= self.le)
            and (self.lt is None or value < self.lt)
        )

    def __str__(self) -> str:
        low = self.ge if self.gt is None else self.gt
        high = self.le if self.lt is None else self.lt
        if high is None or math.isinf(high):
            if low is None:
                return ""
            if low == 0:
                return "0 or more" if self.gt is None else "positive"
            return f"at least {low:g}" if self.gt is None else f"more than {low:g}"
        if low is None:
            return f"at most {high:g}" if self.lt is None else f"less than {high:g}"
        inside = self.gt is None and self.lt is None
        return f"{low:g} to {high:g}" if inside else f"between {low:g} and {high:g}"


class Leaf(NamedTuple):
    """A setting as it stands at the edge: angles in degrees, and the name says so.

    name : dotted; type : annotation of the field; unit : of value and bounds; ge, gt, le, lt : bounds or None
    """

    name: str
    value: Any
    type: Any
    unit: str = ""
    ge: float | None = None
    gt: float | None = None
    le: float | None = None
    lt: float | None = None

    @property
    def expected(self) -> str:
        """What may stand there, in words."""
        words, bounds = kind_of(self.type), str(_Limits("", self.ge, self.gt, self.le, self.lt))
        if bounds == "positive":
            words, bounds = words.replace("number", "positive number"), ""
        unit = _unnamed(self.name, self.unit)
        return words + (f", {bounds}" if bounds else "") + (f" ({unit})" if unit else "")


class _Place(NamedTuple):
    """Where a leaf belongs: the names of fields that lead to it, and its limits inside."""

    path: tuple[str, ...]
    limits: _Limits
    leaf: Leaf


def setting(
    default: Any,
    *,
    unit: str = "",
    ge: float | None = None,
    gt: float | None = None,
    le: float | None = None,
    lt: float | None = None,
) -> Any:
    """A field of a dataclass with its unit and bounds.

    Parameters
    ----------
    default : immutable
    unit : of the field as it is inside: "rad", "s", "m/s2"
    ge, gt, le, lt : bounds in that unit; numbers are finite but for an infinite `le` or `ge`, which allows it
    """
    return field(default=default, metadata={_KEY: _Limits(unit, ge, gt, le, lt)})


def require(name: str, params: Any) -> None:
    """Refuse what lies outside of the bounds of its fields: for `__post_init__`.

    Parameters
    ----------
    name : of what `params` belong to, for the message

    Raises
    ------
    InputError
        Names the field, its value and its bounds, in the unit inside.
    """
    for item in fields(params):
        limits, value = _limits(item), getattr(params, item.name)
        if not limits.admit(value):
            shown = f"{value} {_unnamed(item.name, limits.unit)}".rstrip()
            bounds = str(limits) or "finite"
            if bounds in ("positive", "finite"):
                bounds = f"{bounds} numbers" if isinstance(value, tuple) else f"a {bounds} number"
            raise InputError(f"{item.name} = {shown}, expected {bounds}", name)


def leaves(params: Any) -> Iterator[Leaf]:
    """Every setting of a frozen dataclass and of those nested in it, in their order.

    Fields that hold no number, text, yes or no, or a tuple of them have no address.
    """
    return (place.leaf for place in _places(params))


def changed(params: Settings, values: Mapping[str, Any]) -> Settings:
    """`params` with other values, by their names at the edge.

    A value that `leaves` tells, given back, changes no bit. "none" stands for None, which TOML lacks.

    Raises
    ------
    InputError
        No such name, with the nearest one; a value of another type or out of bounds; or what the dataclass
        itself refuses.
    """
    places = {place.leaf.name: place for place in _places(params)}
    new: dict[tuple[str, ...], Any] = {}
    for name, value in values.items():
        if name not in places:
            raise InputError(f"{name}: unknown{did_you_mean(name, places)}")
        place = places[name]
        if value != place.leaf.value or type(value) is not type(place.leaf.value):
            new[place.path] = _inside(place, value)
    return _replaced(params, new) if new else params


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """The end of a message about an unknown name: the nearest known ones, or all where none is near."""
    every = list(known)
    near = difflib.get_close_matches(name, every, n=1)
    near = near or [one for one in every if len(name) > 2 and name in one]
    # theta_w for theta_w_deg_s, count for directions.count
    near = [one for one in every if name and (one.startswith(name) or one.endswith(f".{name}"))] or near
    if near:
        return f"; did you mean {' or '.join(near)}?"
    return f"; expected one of {', '.join(every)}" if every else "; there is nothing to set"


def _unnamed(name: str, unit: str) -> str:
    """The unit, unless the name ends with it."""
    return "" if name.endswith("_" + unit.replace("/", "_")) else unit


def _limits(item: Any) -> _Limits:
    found = item.metadata.get(_KEY, _Limits())
    assert isinstance(found, _Limits)
    return found


def _places(params: Any, path: tuple[str, ...] = ()) -> Iterator[_Place]:
    if not is_dataclass(params):
        return
    try:
        hints = get_type_hints(type(params))
    except (NameError, TypeError) as error:
        raise InputError(f"the types of its fields cannot be read ({error})", type(params).__name__) from None
    for item in fields(params):
        value, here, hint = getattr(params, item.name), (*path, item.name), hints[item.name]
        if is_dataclass(value) and not isinstance(value, type):
            yield from _places(value, here)
        elif item.init and _addressable(hint):
            limits = _limits(item)
            ending, unit = _EDGE.get(limits.unit, ("", limits.unit))
            out: Callable[[Any], Any] = _degrees if ending else _same
            bounds = (out(bound) for bound in (limits.ge, limits.gt, limits.le, limits.lt))
            leaf = Leaf(".".join(here) + ending, out(value), hint, unit, *bounds)
            yield _Place(here, limits, leaf)


def _replaced(params: Any, new: Mapping[tuple[str, ...], Any]) -> Any:
    """All at once: what a dataclass refuses is the whole, not a stage on the way to it."""
    own = {path[0]: value for path, value in new.items() if len(path) == 1}
    for head in {path[0] for path in new if len(path) > 1}:
        inner = {path[1:]: value for path, value in new.items() if path[0] == head}
        own[head] = _replaced(getattr(params, head), inner)
    return replace(params, **own)


def _inside(place: _Place, value: Any) -> Any:
    """A value from the edge, checked, as its field holds it."""
    from pydantic import ConfigDict, TypeAdapter, ValidationError  # slow to load, and only needed here

    leaf = place.leaf
    given = tuple(value) if isinstance(value, list) else value
    given = None if given == "none" and NoneType in get_args(leaf.type) else given
    wrong = InputError(f"{leaf.name} = {value}: expected {leaf.expected}")
    try:
        given = TypeAdapter(leaf.type, config=ConfigDict(strict=True)).validate_python(given)
    except ValidationError:
        raise wrong from None
    inside = _radians(given) if place.limits.unit in _EDGE else given
    if not place.limits.admit(inside):
        raise wrong
    return inside


def _same(value: Any) -> Any:
    return value


def _degrees(value: Any) -> Any:
    """Angles in degrees, in as few digits as give the same bits back where any do."""
    if value is None or isinstance(value, tuple):
        return value if value is None else tuple(map(_degrees, value))
    exact = math.degrees(value)
    shorter = (float(f"{exact:.{digits}g}") for digits in (6, 9, 12, 15, 16))
    return next((one for one in shorter if math.radians(one) == value), exact)


def _radians(value: Any) -> Any:
    if value is None or isinstance(value, tuple):
        return value if value is None else tuple(map(_radians, value))
    return math.radians(value)


def _addressable(hint: Any) -> bool:
    if get_origin(hint) in (Union, UnionType, tuple):
        return all(one is Ellipsis or _addressable(one) for one in get_args(hint))
    return get_origin(hint) is Literal or hint in (bool, int, float, str, NoneType)


def kind_of(hint: Any) -> str:
    """The words for a type."""
    origin, inner = get_origin(hint), get_args(hint)
    if origin is Literal:
        *most, last = [f'"{one}"' if isinstance(one, str) else str(one) for one in inner]
        return f"{', '.join(most)} or {last}" if most else last
    if origin in (Union, UnionType):
        return " or ".join(map(kind_of, inner))
    if origin is tuple:
        if len(inner) == 2 and inner[1] is Ellipsis:
            return f"a list of {kind_of(inner[0]).removeprefix('a ')}s"
        return f"a list of {len(inner)}: {', '.join(map(kind_of, inner))}"
    return {bool: "true or false", int: "a whole number", float: "a number", str: "text", NoneType: "none"}[
        hint
    ]
