"""Cases of the drift budget over the cores."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import groupby

import numpy as np

from footfall.errors import InputError
from footfall.hdr.method import Method
from footfall.models.imu import ImuSpec
from footfall.scenarios.execute import CHUNK, cores, worker_pool
from footfall.scenarios.studies.budget import Case, Surrogate, case_of
from footfall.scenarios.trial import Trial, walk_of
from footfall.scenarios.warm import warm
from footfall.simulate.walk import Walk

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
    jobs = listening_jobs(trials)
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


def listening_jobs(trials: Sequence[Trial]) -> list[list[Trial]]:
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
    return heard(trials, walk)


def heard(trials: Sequence[Trial], walk: Walk) -> list[Case | Lost]:
    """Trials on one walk, one after the other."""
    found: list[Case | Lost] = []
    for trial in trials:
        try:
            found.append(case_of(trial, walk))
        except InputError as error:
            found.append((trial, str(error)))
    return found


class Heard:
    """The surrogate over cases. Those that came to no end have infinite errors.

    Parameters
    ----------
    heard : of `listened`; the others as of `Surrogate`

    Raises
    ------
    InputError
        As `Surrogate`.
    """

    def __init__(
        self,
        heard: Sequence[Case | Lost],
        spec: ImuSpec,
        method: Method,
        addresses: Sequence[str],
        metric: str,
    ) -> None:
        self._there = np.array([isinstance(one, Case) for one in heard], dtype=bool)
        cases = [one for one in heard if isinstance(one, Case)]
        self._model = Surrogate(cases, spec, method, addresses, metric)

    def __call__(self, points: np.ndarray) -> np.ndarray:
        """Errors (p, cases) in deg at points (p, addresses)."""
        errors = np.full((len(points), len(self._there)), np.inf)
        if self._there.any():
            errors[:, self._there] = self._model(points)
        return errors
