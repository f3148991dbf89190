"""`footfall cache`: which walks and footfalls are kept, and how much of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from footfall.cli.options import JsonOption
from footfall.cli.terminal import OUT, print_json, say
from footfall.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from footfall.scenarios.store import KeptFile
    from footfall.simulate.cache import CachedWalk

cache = typer.Typer(help="List the cached walks and footfalls, or remove those unused for longest.")


@cache.callback(invoke_without_command=True)
def _cache(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        list_()


@cache.command("list")
def list_(as_json: JsonOption = False) -> None:
    """Show what is kept: size, scenario, seed and last use of each walk, and the footfalls of studies."""
    from footfall.scenarios.report.tables import new_table
    from footfall.scenarios.store import kept_footfalls
    from footfall.simulate.cache import cache_folder, cached_walks

    walks, footfalls = cached_walks(), kept_footfalls()
    if as_json:
        told = {"folder": str(cache_folder()), "bytes": _total(walks), "walks": _rows(walks)}
        print_json(told | {"footfalls": {"cases": len(footfalls), "bytes": _total(footfalls)}})
        return
    table = new_table("scenario", "subject", "seed", "size\nMB", "last used", "file", left=2)
    for one in walks:
        known = one.scenario is not None
        table.add_row(
            one.scenario or "damaged",
            one.subject or "",
            f"{one.seed}" if known else "",
            f"{one.size / 1e6:.1f}",
            _when(one).replace("T", " ")[:16],
            one.file.stem[:8],
        )
    if walks:
        OUT.print(table)
    count = "1 walk" if len(walks) == 1 else f"{len(walks)} walks"
    say(f"{count}, {_megabytes(walks)} in {cache_folder()}")
    if footfalls:
        say(f"and the footfalls of {len(footfalls):,} cases of studies, {_megabytes(footfalls)}")


@cache.command()
def prune(
    keep: Annotated[str, typer.Option(metavar="SIZE", help="Size to keep, such as 500MB or 10GB.")],
    as_json: JsonOption = False,
) -> None:
    """Remove the walks and footfalls unused for longest, until the others fit into --keep."""
    from footfall.scenarios.store import kept_footfalls
    from footfall.scenarios.store import prune as remove
    from footfall.simulate.cache import cached_walks

    removed, forgotten = remove(_bytes(keep))
    left, kept = cached_walks(), kept_footfalls()
    if as_json:
        told = {"removed": _rows(removed), "bytes_removed": _total(removed), "bytes": _total(left)}
        footfalls = {"cases_removed": len(forgotten), "cases": len(kept), "bytes": _total(kept)}
        print_json(told | {"footfalls": footfalls})
        return
    say(f"{len(removed)} removed, {_megabytes(removed)}; {len(left)} left, {_megabytes(left)}")
    if forgotten or kept:
        gone, stay = f"{len(forgotten):,} removed", f"{len(kept):,} left"
        say(f"footfalls: {gone}, {_megabytes(forgotten)}; {stay}, {_megabytes(kept)}")


def _bytes(text: str) -> int:
    from pydantic import ByteSize, TypeAdapter, ValidationError

    try:
        size = int(TypeAdapter(ByteSize).validate_python(text))
    except ValidationError:
        size = -1
    if size < 0:
        raise InputError(f"--keep {text!r}: expected a size such as 500MB or 10GB")
    return size


def _rows(walks: Sequence[CachedWalk]) -> list[dict[str, object]]:
    return [
        {
            "file": str(one.file),
            "scenario": one.scenario,
            "subject": one.subject,
            "seed": one.seed,
            "bytes": one.size,
            "last_used": _when(one),
        }
        for one in walks
    ]


def _when(one: CachedWalk) -> str:
    from datetime import datetime

    return datetime.fromtimestamp(one.used).astimezone().isoformat(timespec="seconds")


def _total(files: Sequence[CachedWalk | KeptFile]) -> int:
    return sum(one.size for one in files)


def _megabytes(files: Sequence[CachedWalk | KeptFile]) -> str:
    return f"{_total(files) / 1e6:,.0f} MB"
