"""Dotted addresses into a document that a pydantic model checks: which there are, and how a value is set.

`path.elements[kind=arc].radius_m`: tables are dotted, and an element of a list is chosen by its number
from 0, by a key's value, or all of them by `*`.
"""

from __future__ import annotations

import copy
import re
from collections.abc import Iterator, Mapping
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, NamedTuple, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from footfall.errors import InputError

_PART = re.compile(r"(?P<name>[A-Za-z_]\w*)(\[(?P<which>[^\[\]]+)\])?")
_BOUNDS = {"ge": ">=", "gt": ">", "le": "<=", "lt": "<"}


class Key(NamedTuple):
    """A value that a document may hold.

    address : with `[*]` for an element of a list, or `[kind=arc]` where only such an element has it
    type : in words; bounds : such as ">= 0, <= 5"; default : of the model, or None
    """

    address: str
    type: str
    bounds: str
    default: Any


class Part(NamedTuple):
    """One step of an address: a key and, for a list, which element."""

    name: str
    which: str | None


def parse(address: str) -> tuple[Part, ...]:
    """The steps of an address.

    Raises
    ------
    InputError
        It is not written as an address is.
    """
    found = []
    for text in re.split(r"\.(?![^\[]*\])", address):
        match = _PART.fullmatch(text)
        if match is None:
            raise InputError(f"{text!r} is no step of an address such as path.elements[0].length_m", address)
        found.append(Part(match["name"], match["which"]))
    return tuple(found)


def pattern(address: str) -> str:
    """The address with `[*]` for every choice of an element."""
    return re.sub(r"\[[^\[\]]+\]", "[*]", address)


def keys(model: type[BaseModel], prefix: str = "") -> Iterator[Key]:
    """Every value that a document of this model may hold, in the model's order."""
    for name, info in model.model_fields.items():
        yield from _of(info.annotation, [info], f"{prefix}{name}", _default(info))


def _default(info: FieldInfo) -> Any:
    return None if info.is_required() else info.get_default(call_default_factory=True)


def _of(annotation: Any, told: list[Any], address: str, default: Any) -> Iterator[Key]:
    """The keys below one annotation; `told` are the annotations that may bound it."""
    origin, inner = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        yield from _of(inner[0], [*told, *inner[1:]], address, default)
        return
    options = (
        [option for option in inner if option is not NoneType]
        if origin in (Union, UnionType)
        else [annotation]
    )
    leaf, bounds = [], [_bounds(told)]
    for option in options:
        base, extra = _bare(option)
        if isinstance(base, type) and issubclass(base, BaseModel):
            below = keys(base, f"{address}.")
            # What is absent as a whole has no values that hold.
            yield from (key._replace(default=None) for key in below) if NoneType in inner else below
        elif get_origin(base) is tuple and _models(get_args(base)[0]):
            yield from _elements(get_args(base)[0], address)
            if any(_bare(one)[0] is str for one in _options(get_args(base)[0])):
                yield Key(f"{address}[*]", "text", "", None)
        else:
            leaf.append(base)
            bounds += [_bounds(extra), *(_bounds(_bare(one)[1]) for one in get_args(base))]
    if leaf:
        words = " or ".join(dict.fromkeys(_words(one) for one in leaf))
        yield Key(address, words, ", ".join(dict.fromkeys(filter(None, bounds))), default)


def _elements(annotation: Any, address: str) -> Iterator[Key]:
    """Keys of the elements of a list of tables, which may be of several kinds."""
    models = _models(annotation)
    for model in models:
        kind = _default(model.model_fields["kind"]) if "kind" in model.model_fields else None
        choice = f"kind={kind}" if len(models) > 1 and kind else "*"
        yield from keys(model, f"{address}[{choice}].")


def _options(annotation: Any) -> list[Any]:
    base, _ = _bare(annotation)
    return list(get_args(base)) if get_origin(base) in (Union, UnionType) else [base]


def _models(annotation: Any) -> list[type[BaseModel]]:
    bare = [_bare(option)[0] for option in _options(annotation)]
    return [one for one in bare if isinstance(one, type) and issubclass(one, BaseModel)]


def _bare(annotation: Any) -> tuple[Any, list[Any]]:
    told: list[Any] = []
    while get_origin(annotation) is Annotated:
        annotation, *more = get_args(annotation)
        told += more
    return annotation, told


def _bounds(told: list[Any]) -> str:
    found = []
    for one in told:
        for part in one.metadata if isinstance(one, FieldInfo) else [one]:
            found += [f"{sign} {getattr(part, key):g}" for key, sign in _BOUNDS.items() if hasattr(part, key)]
    return ", ".join(found)


def _words(annotation: Any) -> str:
    base, _ = _bare(annotation)
    if get_origin(base) is Literal:
        return " or ".join(map(str, get_args(base)))
    if get_origin(base) is tuple:
        return f"list of {_words(get_args(base)[0])}s"
    return {float: "number", int: "whole number", str: "text", bool: "true or false"}.get(base, str(base))


def there(table: Mapping[str, Any], address: str) -> bool:
    """Whether a document has a place for a value: its lists have such elements; tables may be absent."""
    places: list[Any] = [table]
    for name, which in parse(address):
        below: list[Any] = []
        for place in places:
            if not isinstance(place, Mapping):
                continue  # text that stands for a table
            value = place.get(name)
            listed = isinstance(value, list) and any(isinstance(entry, Mapping) for entry in value)
            if which is None and not listed:
                below.append({} if value is None else value)
            elif which is not None and isinstance(value, list):
                key, _, text = which.partition("=")
                tables = [entry for entry in value if isinstance(entry, Mapping)]
                below += [entry for entry in tables if str(entry.get(key)) == text] if text else value
        if not below:
            return False
        places = below
    return True


def edited(table: Mapping[str, Any], address: str, value: Any) -> dict[str, Any]:
    """A copy of `table` with `value` at `address`; tables on the way that are absent are made.

    Raises
    ------
    InputError
        The address chooses no element of a list, or goes on below a value.
    """
    made = copy.deepcopy(dict(table))
    _set(made, parse(address), value, address, "")
    return made


def _set(table: dict[str, Any], parts: tuple[Part, ...], value: Any, address: str, before: str) -> None:
    (name, which), rest = parts[0], parts[1:]
    here = f"{before}.{name}" if before else name
    if which is None and not rest:
        table[name] = value
        return
    below = table.setdefault(name, {}) if which is None else table.get(name, [])
    if which is None and isinstance(below, list):
        raise InputError(f"{here} is a list of {len(below)}: say which, {here}[0] or {here}[*]", address)
    if which is None:
        if not isinstance(below, dict):
            raise InputError(f"{here} is {below!r}, there is nothing below it", address)
        _set(below, rest, value, address, here)
        return
    entries = below if isinstance(below, list) else [below]
    for index in _chosen(entries, which, address, here):
        if not rest:
            entries[index] = value
        elif isinstance(entries[index], dict):
            _set(entries[index], rest, value, address, f"{here}[{index}]")
        else:
            raise InputError(f"{here}[{index}] is {entries[index]!r}, there is nothing below it", address)


def _chosen(entries: list[Any], which: str, address: str, here: str) -> list[int]:
    """Indices of the elements that are meant."""
    if which == "*":
        found = list(range(len(entries)))
    elif re.fullmatch(r"\d+", which):
        found = [int(which)] if int(which) < len(entries) else []
    elif "=" in which:
        key, text = (part.strip() for part in which.split("=", 1))
        found = [
            i for i, entry in enumerate(entries) if isinstance(entry, dict) and str(entry.get(key)) == text
        ]
    else:
        raise InputError(f"[{which}] chooses nothing: expected a number from 0, * or key=value", address)
    if not found:
        raise InputError(f"{here} has {len(entries)} elements, and [{which}] is none of them", address)
    return found
