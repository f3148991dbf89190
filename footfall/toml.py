"""TOML from outside, checked by a pydantic model at the edge."""

from __future__ import annotations

import os
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from footfall.errors import InputError, reworded
from footfall.settings import did_you_mean


class Strict(BaseModel):
    """Base of every model of a file: refuses unknown keys, wrong types and numbers that are not finite."""

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False, frozen=True)


Model = TypeVar("Model", bound=BaseModel)


def parse_toml(path: str | os.PathLike[str]) -> dict[str, Any]:
    """The content of a TOML file, unchecked.

    Raises
    ------
    InputError
        No such file, or not TOML.
    """
    source = Path(path)
    try:
        return tomllib.loads(source.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"cannot be read ({error.strerror})", source) from None
    except UnicodeDecodeError as error:
        raise InputError(f"not UTF-8 text ({error.reason})", source) from None
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"not valid TOML ({error})", source) from None


def no_such_file(what: str, name: str, stock: Iterable[str]) -> InputError:
    """The error about a name that is neither one of `stock` nor a file's; `what` it should be of."""
    if Path(name).is_dir():
        return InputError("a folder, expected a TOML file", f"{what} {name!r}")
    return InputError(
        f"neither a stock {what} nor a TOML file that exists{did_you_mean(name, stock)}", f"{what} {name!r}"
    )


def checked(table: Mapping[str, Any], model: type[Model], source: str) -> Model:
    """`table`, which came from `source`, as a `model`.

    Raises
    ------
    InputError
        The first key that the model refuses, with its value and the reason.
    """
    try:
        return model.model_validate(table)
    except ValidationError as error:
        # An unknown key explains one that is missing, so it comes first.
        first = min(error.errors(), key=lambda one: one["type"] != "extra_forbidden")
        key = _key(table, first["loc"])
        if first["type"] == "extra_forbidden":
            told = f"unknown key {key!r} = {first['input']!r}{_meant(model, table, first['loc'])}"
            raise InputError(told, source) from None
        if first["type"] == "missing":
            raise InputError(f"key {key!r} is missing", source) from None
        if first["type"] == "union_tag_invalid":
            tag, known = first["ctx"]["tag"], re.findall(r"'(.*?)'", first["ctx"]["expected_tags"])
            asked = first["ctx"]["discriminator"].strip("'")
            raise InputError(f"{key}, {asked} = {tag!r}: unknown{did_you_mean(tag, known)}", source) from None
        # A whole table is no help; the message of a model's own check says what is wrong with it.
        value = "" if isinstance(first["input"], dict | list) else f" = {first['input']!r}"
        reason = str(first.get("ctx", {}).get("error") or reworded(first["msg"]))
        raise InputError(f"{key}{value}: {reason}" if key else reason, source) from None


def _key(table: Mapping[str, Any], location: Sequence[int | str]) -> str:
    """A key in words: `path.elements no. 2, radius_m`, elements of a list counted from 1."""
    told, dot = "", ""
    for part in _written(table, location):
        told += f" no. {part + 1}" if isinstance(part, int) else f"{dot}{part}"
        dot = ", " if isinstance(part, int) else "."
    return told


def _meant(model: type[BaseModel], table: Mapping[str, Any], location: Sequence[int | str]) -> str:
    """The end of a message about an unknown key: which one of its table it may have been."""
    # Late: what addresses are is told on top of this module.
    from footfall.addresses import keys

    *above, unknown = ("[*]" if isinstance(part, int) else f".{part}" for part in _written(table, location))
    head, known = "".join(above), []
    for key in keys(model):
        address = "." + re.sub(r"\[[^\]]*\]", "[*]", key.address)
        if address.startswith(f"{head}."):
            known.append(re.split(r"[.\[]", address[len(head) + 1 :])[0])
    return did_you_mean(unknown.lstrip("."), dict.fromkeys(known))


def _written(content: object, location: Sequence[int | str]) -> Iterator[int | str]:
    """The parts of a key as they stand in the file: pydantic puts the tags of alternatives between them."""
    for i, part in enumerate(location):
        listed = isinstance(content, list) and isinstance(part, int)
        if listed or (isinstance(content, dict) and part in content):
            content = content[part]  # type: ignore[index]
        elif not isinstance(content, dict) or i < len(location) - 1:  # or else a key that is missing
            continue
        yield part
