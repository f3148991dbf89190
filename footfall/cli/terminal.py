"""What every command shares: where its words go, what it may write, and how its mistakes are told."""

from __future__ import annotations

import json
import logging
import math
import os
import shlex
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import typer
from rich.console import Console

from footfall.cli.logs import SAID
from footfall.errors import InputError

OUT = Console()
ERR = Console(stderr=True)
INTERRUPTED = 130  # as shells have it
RESUMABLE = 4  # stopped from outside: a full disk, a cluster that is gone

# Of what typer raises for wrong arguments; which library the class comes from depends on its version.
_USAGE_ERROR: type[BaseException] = typer.BadParameter.__mro__[1]


def print_json(document: Any) -> None:
    """The one document on standard output."""
    print(json.dumps(document, indent=2, allow_nan=False))


def say(text: str) -> None:
    """A line for people, on standard error."""
    logging.getLogger(SAID).info("%s", text)
    ERR.print(text, markup=False, highlight=False, soft_wrap=True)


def finite(value: float | None) -> float | None:
    """Callback of options that are numbers: neither NaN nor infinite."""
    if value is not None and not math.isfinite(value):
        raise typer.BadParameter(f"{value} is not a finite number")
    return value


@contextmanager
def blaming(file: Path | str, part: str = "recording") -> Iterator[None]:
    """Name the file in what is said of the `part` that was read from it."""
    try:
        yield
    except InputError as error:
        raise error.about(file, part) from None


TABLES = (".parquet", ".csv")  # what tables are written as


def require_output(file: Path, ending: str | tuple[str, ...], *inputs: Path) -> None:
    """Refuse a file that cannot or must not be written before any work is done.

    Raises
    ------
    InputError
        Another ending, a folder, no folder to write into, or one of `inputs`.
    """
    endings = (ending,) if isinstance(ending, str) else ending
    if file.suffix.lower() not in endings:
        raise InputError(f"expected a name that ends in {' or '.join(endings)}", file)
    if file.is_dir():
        raise InputError("a folder, expected a file to write", file)
    if not file.parent.is_dir():
        raise InputError(f"the folder {file.parent} does not exist", file)
    if not os.access(file.parent, os.W_OK):
        raise InputError(f"the folder {file.parent} cannot be written", file)
    for source in inputs:
        if file.exists() and source.exists() and file.samefile(source):
            raise InputError("would overwrite what it is made from", file)


def command_line(context: typer.Context, *but: str) -> str:
    """The command as it was given, to be given again, without the options of the parameters `but`."""
    words = context.command_path.split()
    for parameter in context.command.params:
        source = context.get_parameter_source(str(parameter.name))
        if parameter.name in but or source is None or source.name != "COMMANDLINE":
            continue
        value = context.params[parameter.name]
        values = value if isinstance(value, (list, tuple)) else [value]
        option = [] if parameter.param_type_name == "argument" else [parameter.opts[0]]
        words += option if value is True else [word for item in values for word in (*option, str(item))]
    return shlex.join(words)


def words_of(line: str, escape: str = "\\" if os.name == "posix" else "") -> list[str]:
    r"""The words of a command line in quotes or without; "\" is part of a word where paths have it.

    Raises
    ------
    ValueError
        A quotation has no end.
    """
    lexer = shlex.shlex(line, posix=True, punctuation_chars=False)
    lexer.whitespace_split, lexer.commenters, lexer.escape = True, "", escape
    return list(lexer)


def perform(app: typer.Typer, arguments: list[str] | None) -> int:
    """Run a command line, tell each mistake in one sentence, and return the exit code."""
    _print_what_it_can()
    try:
        code = int(app(arguments, standalone_mode=False, prog_name="footfall") or 0)
    except InputError as error:
        return _refuse(str(error), error.more)
    except OSError as error:  # a full disk, say
        return _refuse(f"{error.filename}: {error.strerror}" if error.filename else str(error))
    except (typer.Abort, KeyboardInterrupt):  # either, by typer's version
        code = INTERRUPTED
    except _USAGE_ERROR as error:
        command = getattr(getattr(error, "ctx", None), "command_path", "footfall")
        given = _given(error, sys.argv[1:] if arguments is None else arguments)
        told = error.format_message().rstrip(".")  # type: ignore[attr-defined]
        return _refuse(f"{told}{given} (see `{command} --help`)")
    if code == INTERRUPTED:
        print("footfall: interrupted", file=sys.stderr)
    return code


def _print_what_it_can() -> None:
    """A file or pipe in an encoding that lacks a character, as Windows' own do, is given "?" in its place."""
    if getattr(sys.stdout, "errors", None) == "strict" and hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="replace")


def _given(error: BaseException, arguments: Sequence[str]) -> str:
    """The value of the option that an error is about, which the message of typer leaves out."""
    for option in getattr(getattr(error, "param", None), "opts", ()):
        for at, argument in enumerate(arguments):
            if argument.startswith(f"{option}="):
                return f", got {argument.partition('=')[2]!r}"
            if argument == option and at + 1 < len(arguments):
                return f", got {arguments[at + 1]!r}"
    return ""


def _refuse(sentence: str, more: str = "") -> int:
    print(f"footfall: {sentence}" + (f"\n\n{more}" if more else ""), file=sys.stderr)
    return 2
