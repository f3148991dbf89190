"""TOML from outside, checked by a pydantic model at the edge."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from footfall.errors import InputError


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
        first = error.errors()[0]
        key = ".".join(_written(table, first["loc"]))
        if first["type"] == "extra_forbidden":
            raise InputError(f"unknown key {key!r} = {first['input']!r}", source) from None
        if first["type"] == "missing":
            raise InputError(f"key {key!r} is missing", source) from None
        # A whole table is no help; the message of a model's own check says what is wrong with it.
        value = "" if isinstance(first["input"], dict | list) else f" = {first['input']!r}"
        reason = first["msg"] if "error" not in first.get("ctx", {}) else str(first["ctx"]["error"])
        raise InputError(f"{key}{value}: {reason}" if key else reason, source) from None


def _written(content: object, location: Sequence[int | str]) -> Iterator[str]:
    """The parts of a key as they stand in the file: pydantic puts the tags of alternatives between them."""
    for i, part in enumerate(location):
        listed = isinstance(content, list) and isinstance(part, int)
        if listed or (isinstance(content, dict) and part in content):
            content = content[part]  # type: ignore[index]
        elif not isinstance(content, dict) or i < len(location) - 1:  # or else a key that is missing
            continue
        yield str(part)
