"""Cases of the drift budget over the cores."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import groupby

from footfall.errors import InputError
from footfall.scenarios.execute import CHUNK, cores, worker_pool
from footfall.scenarios.studies.budget import Case, case_of
from footfall.scenarios.trial import Trial, walk_of
from footfall.scenarios.warm import warm

Lost = tuple[Trial, str]


def listened(
    trials: Sequence[Trial],
    *,
    workers: int | None = None,
    on_progress: Callable[[int, int], None] | None = None,
) -> list[Case | Lost]:
    """Every trial dead-reckoned with its drift budget, in their order; of one that came to no end, why.

    Parameters
    ----------
    workers : processes; one a core when None; 1 works in this process
    on_progress : called with how many trials are done, and how many there are
    """
    jobs = list(_jobs(trials))
    report = on_progress or (lambda done, all_: None)
    found: list[Case | Lost] = []
    count = min(workers or cores(), len(jobs))
    if count <= 1:
        for job in jobs:
            found += _job(job)
            report(len(found), len(trials))
    else:
        warm(trials[0], walks=True)  # or every worker would compile the same
        with worker_pool(count) as (pool, _):
            for part in pool.map(_job, jobs):
                found += part
                report(len(found), len(trials))
    return found


def _jobs(trials: Sequence[Trial]) -> list[list[Trial]]:
    """Neighbours on one walk, not too many at once."""
    jobs = []
    for _, group in groupby(trials, key=lambda trial: (trial.number, trial.walk_seed)):
        same = list(group)
        jobs += [same[first : first + CHUNK] for first in range(0, len(same), CHUNK)]
    return jobs


def _job(trials: Sequence[Trial]) -> list[Case | Lost]:
    """In a worker: trials on one walk."""
    try:
        walk = walk_of(trials[0])
    except InputError as error:
        return [(trial, str(error)) for trial in trials]
    found: list[Case | Lost] = []
    for trial in trials:
        try:
            found.append(case_of(trial, walk))
        except InputError as error:
            found.append((trial, str(error)))
    return found
