"""Small studies, and tasks performed without any physics: scores that are made of the seeds."""

import numpy as np

from footfall.scenarios.judge.score import Score
from footfall.scenarios.studies.study import Study
from footfall.scenarios.studies.task import Done
from footfall.scenarios.trial import blank_row


def study(name="small", **table):
    """On the straight, with pdr and hdr, unless told otherwise."""
    base = {"description": "small", "scenarios": ["straight"], "methods": ["pdr", "hdr"]}
    return Study(name, base | {"cases": {"walks": 1, "units": 3}} | table)


def pretend(task, error="", failing=lambda row: False, walk="walk"):
    """What a task might give: numbers of its seeds and cells alone."""
    rows, keys = [], []
    for trials, cells in task.trials():
        for trial, own in zip(trials, cells, strict=True):
            for cell in own:
                row = blank_row(trial, "reference", walk)
                rng = np.random.default_rng([trial.unit_seed, int(cell.key[:8], 16)])
                score = Score(*(float(value) for value in rng.random(6)))
                given = {"method": cell.method.name, "recording_sha": "recording"}
                row = type(row)(**(vars(row) | given))
                lost = {"stage": "track", "error": error or "it failed"}
                kept = {"score": score, "footfalls": 9}
                rows.append(type(row)(**(vars(row) | (lost if error or failing(row) else kept))))
                keys.append(cell.key)
    return Done(task, tuple(rows), tuple(keys), {"all": 0.1}, "here")


class Pretending:
    """An executor that performs tasks so, up to `most` of them; it tells which it did."""

    def __init__(self, most=None, **how):
        self.done, self.most, self.how = [], most, how

    def __call__(self, tasks, *, stop, tick, **folders):
        for task in tasks:
            if stop() or len(self.done) == self.most:
                return
            tick({}, False)
            self.done.append(task)
            yield pretend(task, **self.how)
