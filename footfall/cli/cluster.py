"""Options of commands whose work can be done on a cluster, and how its end is told."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated

import typer

from footfall.cli.terminal import RESUMABLE, say
from footfall.errors import InputError

if TYPE_CHECKING:
    from footfall.scenarios.studies.spreading import Workers

SchedulerOption = Annotated[
    str | None,
    typer.Option(
        metavar="ADDRESS",
        help="Do it on a Dask cluster, as tcp://host:8786 (docs/cluster.md).",
        show_default=False,
    ),
]
PatienceOption = Annotated[
    float, typer.Option(min=1, help="Seconds without a result after which a cluster is given up.")
]


@contextmanager
def working(scheduler: str | None, patience: float, workers: int | None) -> Iterator[Workers]:
    """Where the work is done; where a cluster ends it, that is said, and the exit code tells it.

    Raises
    ------
    InputError
        Processes are told besides a cluster; or as of `Cluster`.
    """
    from footfall.scenarios.studies.task import StoppedError

    try:
        if scheduler is None:
            yield workers
            return
        if workers is not None:
            raise InputError("a cluster has the workers that it has: leave --workers or --scheduler out")
        from footfall.scenarios.studies.cluster import Cluster

        logging.getLogger("distributed").setLevel(logging.CRITICAL)  # what matters is said below
        with Cluster(scheduler, patience_s=patience, say=say) as cluster:
            yield cluster
    except StoppedError as error:
        say(f"footfall: stopped: {error}; start it again to go on")
        raise typer.Exit(RESUMABLE) from None
