"""What a study's trials cost: many units on one walk of the closed loop, recorded, navigated and scored.

First with nothing kept, then the same units with other parameters of HDR, whose footfalls are kept. Beside
it the bare stages in one process, without what spreads the work: trust the ratios more than the times.

python -m benchmarks.speed.studies --units 1000
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from benchmarks._common import options, out, write_json
from benchmarks._usage import children_cpu_s, children_peak_bytes
from footfall.hdr.methods import METHODS
from footfall.scenarios.evaluate import cases
from footfall.scenarios.execute import execute
from footfall.scenarios.judge.score import score
from footfall.scenarios.parameters import documents, with_values
from footfall.scenarios.report.tables import new_table
from footfall.scenarios.trial import Trial, reckoning, recording_of, walk_of
from footfall.simulate.walk import Walk

BARE = 20  # units whose stages are timed one by one


def stages(trials: Sequence[Trial], walk: Walk) -> dict[str, float]:
    """CPU ms a unit of each stage, by itself."""
    spent: dict[str, float] = {}

    def timed(stage: str, work: Callable[[], Any]) -> Any:
        start = time.process_time()
        made = work()
        spent[stage] = spent.get(stage, 0.0) + 1e3 * (time.process_time() - start) / len(trials)
        return made

    for trial in trials:
        recording = timed("draw and record", lambda trial=trial: recording_of(trial, walk))
        given = timed("detect", lambda trial=trial, r=recording: reckoning(trial.setup, walk, r))
        timed("dead-reckon", lambda given=given: given.footfalls)
        made = [timed("hdr", lambda given=given: METHODS["hdr"].track(given)), METHODS["pdr"].track(given)]
        timed("score twice", lambda made=made: [score(track, walk) for track in made])
        timed("hash", lambda r=recording: r.sha)
    return spent


def spread(trials: Sequence[Trial], workers: int, store: Path) -> dict[str, float]:
    """Seconds of all trials over processes, and what they took of the processors and of memory."""
    before, start = children_cpu_s(), time.perf_counter()
    count = sum(1 for _ in execute(trials, workers=workers, store=store))
    return {
        "seconds": time.perf_counter() - start,
        "cpu_ms_a_unit": 1e3 * (children_cpu_s() - before) / count,
        "largest_worker_mb": children_peak_bytes() / 1e6,
    }


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table."""
    parser = options(__doc__)
    parser.add_argument("--units", type=int, default=1000, help="on the walk (default 1000)")
    parser.add_argument("--scenario", default="closed-loop", help="whose first walk it is")
    chosen = parser.parse_args(arguments)
    base = documents(chosen.scenario)
    todo = cases(base.setup(), units=chosen.units, walks=1)
    other = with_values(base, {"hdr.theta_w_deg_s": 0.3}).setup()
    again = [replace(trial, setup=other) for trial in todo]
    walk = walk_of(todo[0])  # into the cache
    stages(todo[:1], walk)  # compiled
    bare = stages(todo[:BARE], walk)
    with tempfile.TemporaryDirectory() as folder:
        first = spread(todo, chosen.processes, Path(folder))
        second = spread(again, chosen.processes, Path(folder))
    table = new_table("stage, one by one", "CPU ms a unit")
    for name, value in (*bare.items(), ("all", sum(bare.values()))):
        table.add_row(name, f"{value:.1f}")
    out.print(table)
    table = new_table(f"{len(todo)} units over {chosen.processes} processes", "s", "CPU ms\na unit", "MB")
    for name, value in (("record, pdr, hdr, scores", first), ("other parameters of hdr", second)):
        figures = (
            f"{value['seconds']:.1f}",
            f"{value['cpu_ms_a_unit']:.1f}",
            f"{value['largest_worker_mb']:.0f}",
        )
        table.add_row(name, *figures)
    out.print(table)
    out.print(f"over the bare stages: {first['cpu_ms_a_unit'] / sum(bare.values()):.2f} times their CPU time")
    write_json(chosen.json, {"stages": bare, "first": first, "again": second})


if __name__ == "__main__":
    main()
