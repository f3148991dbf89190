"""What a task costs on a cluster beside its work, and what grows with the number of walks.

A scheduler and workers of this machine, on loopback. First real tasks of a study whose work is left out: what
is left is sending, waiting and sending home. Then the walk that each worker is given. Last, on invented rows,
what a study of many walks costs this process alone: planning, parts, looking what is left, the one dataset.

python -m benchmarks.speed.cluster
"""

from __future__ import annotations

import pickle
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks._common import options, out, write_json
from benchmarks._usage import resident_bytes
from benchmarks.speed.sweep import invented
from footfall.scenarios.report.tables import new_table
from footfall.scenarios.studies.cluster import Cluster, Craft, Piece
from footfall.scenarios.studies.parts import StudyFolder
from footfall.scenarios.studies.plan import plan_of
from footfall.scenarios.studies.spreading import spread_over
from footfall.scenarios.studies.study import Study
from footfall.scenarios.studies.task import Done, Task
from footfall.scenarios.trial import Trial
from footfall.simulate.cache import cached_walk
from footfall.simulate.walk import Walk


def first(task: Task) -> Trial:
    """A trial on the task's walk."""
    trials, _ = next(task.trials())
    return trials[0]


def no_work(task: Task, walk: Walk) -> Done:
    """Invented rows, as many as the task has."""
    return next(invented([task]))


def study(walks: int, units: int) -> Study:
    """The closed loop, pdr and hdr."""
    table = {"description": "many", "scenarios": ["closed-loop"], "methods": ["pdr", "hdr"]}
    return Study("many", table | {"cases": {"walks": walks, "units": units}})


def overhead(cluster: Cluster, tasks: Sequence[Task]) -> dict[str, float]:
    """Seconds a task, less what inventing its rows takes; and of the first, with the walk."""
    from benchmarks.speed import cluster as here  # by name: workers import it

    craft: Craft[Task, Done] = Craft(here.first, here.no_work, lambda task, error, stage: no_work(task, None))  # type: ignore[arg-type]
    pieces = [Piece(task.walk, task, at) for at, task in enumerate(tasks)]
    start = time.perf_counter()
    began = ended = 0.0
    for at, _ in enumerate(cluster.work(pieces, craft)):
        began, ended = began or time.perf_counter(), time.perf_counter()
        count = at
    before = time.perf_counter()
    for task in tasks[:20]:
        no_work(task, None)  # type: ignore[arg-type]
    own = (time.perf_counter() - before) / 20 / len(cluster.workers)
    return {"first_s": began - start, "a_task_s": (ended - began) / count - own}


def many(walks: int, folder: Path) -> dict[str, float]:
    """Of a study of so many walks, a task each: s and bytes a walk in this process."""
    plan_of(study(20, 200))  # what planning itself loads
    before, start = resident_bytes() / 1e3, time.process_time()
    plan = plan_of(study(walks, walks * 10))
    told = {"planning_s": time.process_time() - start, "plan_kb": resident_bytes() / 1e3 - before}
    place = StudyFolder(folder)
    with place.alone():
        made = list(invented(plan.tasks))
        for what, do in (
            ("part_s", lambda: [place.put(done) for done in made]),
            ("left_s", lambda: place.left(plan.tasks)),
            ("dataset_s", lambda: place.compact(plan)),
        ):
            start = time.process_time()
            do()
            told[what] = time.process_time() - start
    told["part_kb"] = sum(file.stat().st_size for file in place.parts.iterdir()) / 1e3
    told["dataset_kb"] = place.results.stat().st_size / 1e3
    told["rows"] = plan.rows
    return {name: value / walks for name, value in told.items()}


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the tables."""
    from distributed import Client, LocalCluster

    parser = options(__doc__)
    parser.add_argument("--tasks", type=int, default=300, help="without work (default 300)")
    parser.add_argument("--walks", type=int, default=1000, help="of the study of many (default 1000)")
    chosen = parser.parse_args(arguments)
    figures: dict[str, Any] = {}
    with tempfile.TemporaryDirectory() as name:
        figures["many"] = many(chosen.walks, Path(name) / "many")
    shown = new_table(f"a study of {chosen.walks} walks, 10 units each: a walk", "value")
    for what, value in figures["many"].items():
        shown.add_row(what.replace("_", " "), f"{value:.4g}")
    out.print(shown)

    tasks = plan_of(study(1, chosen.tasks * 10)).tasks
    sizes = {"task_kb": len(pickle.dumps(tasks[0])) / 1e3}
    sizes["rows_kb"] = len(pickle.dumps(no_work(tasks[0], None).rows)) / 1e3  # type: ignore[arg-type]
    sizes["walk_mb"] = len(pickle.dumps(cached_walk(first(tasks[0]).plan))) / 1e6
    figures["sizes"] = sizes
    shown = new_table(f"{chosen.tasks} tasks of 10 units without their work", "ms a task", "first, s")
    for workers in (1, chosen.processes + 1):
        with (
            LocalCluster(workers, threads_per_worker=1, dashboard_address=None, host="127.0.0.1") as local,
            Client(local) as client,
            Cluster(client) as cluster,
        ):
            list(spread_over(cluster)(tasks[:2], stop=lambda: False, tick=lambda metres, compiling: None))
            found = figures[f"{workers} workers"] = overhead(cluster, tasks)
        shown.add_row(f"{workers} workers", f"{1e3 * found['a_task_s']:.1f}", f"{found['first_s']:.1f}")
    out.print(shown)
    told = (f"a task is {sizes['task_kb']:.1f} kB", f"its rows {sizes['rows_kb']:.1f} kB")
    out.print(f"{', '.join(told)}, a walk {sizes['walk_mb']:.0f} MB")
    write_json(chosen.json, figures)


if __name__ == "__main__":
    main()
