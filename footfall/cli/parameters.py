"""`footfall parameters`: every value that can be set, by its address."""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable
from typing import Annotated

import typer

from footfall.cli.options import JsonOption
from footfall.cli.terminal import OUT, print_json
from footfall.errors import InputError


def parameters(
    word: Annotated[
        str | None, typer.Argument(help="Show only addresses that contain this.", show_default=False)
    ] = None,
    scenario: Annotated[
        str, typer.Option(help="The scenario whose values are shown: a name or your TOML file.")
    ] = "closed-loop",
    imu: Annotated[
        str | None,
        typer.Option(
            help="The data sheet whose values are shown. Default: the scenario's.", show_default=False
        ),
    ] = None,
    methods: Annotated[
        str | None,
        typer.Option(
            help="Methods whose parameters are shown, separated by commas. Default: all.",
            show_default=False,
        ),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """List every parameter: its address, type, unit, value, bounds, and the first stage that it repeats.

    Set one with --set ADDRESS=VALUE in run, walk, record and track.
    """
    from footfall.hdr.methods import METHODS
    from footfall.scenarios.listing import STAGES
    from footfall.scenarios.listing import parameters as listed
    from footfall.scenarios.parameters import documents
    from footfall.scenarios.report.tables import new_table

    chosen = list(METHODS) if methods is None else methods.split(",")
    every = list(listed(documents(scenario, imu=imu, methods=chosen)))
    found = [one for one in every if word is None or word.lower() in one.address.lower()]
    if not found:
        raise InputError(f"no address contains {word!r}{_meant(str(word), [one.address for one in every])}")
    if as_json:
        print_json({one.address: {**one._asdict(), "default": _plain(one.default)} for one in found})
        return
    table = new_table("address", "value", "allowed", "repeats", left=4)
    table.columns[0].no_wrap = True  # to be copied
    for one in found:
        value = f"{_text(one.default)} {one.unit}" if one.default is not None else one.unit
        table.add_row(one.address, value, ", ".join(filter(None, (one.type, one.bounds))), one.stage)
    OUT.print(table)
    OUT.print("[dim]repeats: the first stage that a new value changes: " + ", ".join(STAGES) + "[/dim]")


def _meant(word: str, addresses: Iterable[str]) -> str:
    """The end of a message about a word that is in no address: the names most like it."""
    parts = dict.fromkeys(part for address in addresses for part in address.split("."))
    near = difflib.get_close_matches(word, parts, n=2)
    return f"; did you mean {' or '.join(near)}?" if near else "; `footfall parameters` lists them all"


def _plain(value: object) -> object:
    """As JSON can hold it."""
    if isinstance(value, float) and math.isinf(value):
        return str(value)
    return list(value) if isinstance(value, tuple) else value


def _text(value: object) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, list | tuple):
        return ", ".join(map(_text, value))
    return "" if value is None else str(value)
