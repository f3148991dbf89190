"""`footfall report`: the page of results that are there, written anew."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from footfall.cli.terminal import say


def report(
    folder: Annotated[Path, typer.Argument(help="What `footfall run`, `sweep` or `gate` wrote.")],
) -> None:
    """Write the report.html of a folder of results again, from its files.

    The page opens without a network. It has tracks on a map, errors and their causes, tables that can be
    sorted, parameters, seeds, versions and the command that makes the results again.
    """
    from footfall.scenarios.report.page import write_page

    say(f"The page is {write_page(folder)}")
