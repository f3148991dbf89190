"""Methods as documents name them: of studies, and of gates."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag, model_validator

from footfall.errors import InputError
from footfall.hdr.method import Method
from footfall.hdr.methods import find_method
from footfall.toml import Strict


class MethodTable(Strict):
    """A method with parameters or of others: `find_method`."""

    name: str | None = None
    use: str | None = None
    command: Annotated[tuple[str, ...], Field(strict=False, min_length=1)] | None = None
    format: str = "f64"
    timeout_s: float = Field(default=60.0, gt=0)
    params: dict[str, Any] = Field(default={})
    needs: Literal["footfalls", "samples"] | None = None

    @model_validator(mode="after")
    def _one(self) -> MethodTable:
        if (self.use is None) == (self.command is None):
            raise ValueError("a method has a use (such as hdr or nav.py:Mine) or a command")
        return self


MethodEntry = Annotated[
    Annotated[str, Tag("name")] | Annotated[MethodTable, Tag("table")],
    Discriminator(lambda entry: "name" if isinstance(entry, str) else "table"),
]


def method_of(entry: str | MethodTable, folder: Path) -> Method:
    """The method that an entry means; its files lie in `folder`, if they are there.

    Raises
    ------
    InputError
        None that can be found, or parameters that it refuses.
    """
    if isinstance(entry, str):
        return find_method(_placed(entry, folder))
    told = entry.model_dump(exclude={"use", "command", "params"})
    use = None if entry.use is None else _placed(entry.use, folder)
    command = None if entry.command is None else [beside(word, folder) for word in entry.command]
    found = find_method(use, command=command, **told)
    try:
        return found.with_params(entry.params) if entry.params else found
    except InputError as error:
        raise InputError(f"{found.name}.{error}") from None


def beside(name: str, folder: Path) -> str:
    """A file in the folder, if there is one of this name; else the name."""
    file = folder / name
    return str(file) if "." in name and not Path(name).is_absolute() and file.is_file() else name


def _placed(use: str, folder: Path) -> str:
    """`nav.py:Mine`, in the folder if it is there."""
    place, colon, name = use.rpartition(":")
    return f"{beside(place, folder)}:{name}" if colon and place.endswith(".py") else use
