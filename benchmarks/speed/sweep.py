"""What a sweep costs beside the bare work: CPU time of the same units by hand and as a study, two processes
against one, and how soon a finished study of 100,000 rows says that nothing is left.

Times of the clock mean something on an idle machine alone; CPU times, and their ratios, on a busy one, too.

python -m benchmarks.speed.sweep --units 400
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks._common import options, out, write_json
from benchmarks._usage import children_cpu_s
from footfall.scenarios.evaluate import cases
from footfall.scenarios.judge.score import Score, score
from footfall.scenarios.report.tables import new_table
from footfall.scenarios.scenario import load_scenario
from footfall.scenarios.store import footfalls_file, footfalls_folder
from footfall.scenarios.studies.local import spread
from footfall.scenarios.studies.plan import plan_of
from footfall.scenarios.studies.study import Study
from footfall.scenarios.studies.sweep import sweep
from footfall.scenarios.studies.task import Done, Task
from footfall.scenarios.trial import Trial, blank_row, reckoning, recording_of, setup, walk_of
from footfall.simulate.walk import Walk

ROWS = """
description = "100,000 rows"
scenarios = ["straight", "curving"]
methods = ["pdr", "hdr"]
[cases]
walks = 2
units = 231
[design.axes]
imu = ["nimu", "mtig710"]
"pdr.tilt_gain" = [0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.55]
"hdr.theta_w_deg_s" = { from = 0.1, to = 1.0, steps = 10, scale = "log" }
"""
MANY_POINTS = """
description = "100,000 rows at 500 points"
scenarios = ["straight"]
methods = ["pdr", "hdr"]
[cases]
walks = 1
units = 100
[design]
kind = "latin-hypercube"
samples = 500
[design.axes]
"imu.gyro.angle_random_walk_deg_rt_h" = { from = 0.44, to = 13.0, scale = "log" }
"imu.gyro.flicker_deg_h" = { from = 1.0, to = 30.0, scale = "log" }
"pdr.tilt_gain" = { from = 0.1, to = 0.4 }
"""


FEW = 10  # units, of a study that takes little but what every study does once
LABELS = {
    "by_hand": "a unit by hand",
    "study": "a unit of a study",
    "once": "a study, once",
    "tracks": "of this, its report's tracks",
}


def by_hand(trials: Sequence[Trial], walk: Walk) -> None:
    """The bare stages."""
    for trial in trials:
        recording = recording_of(trial, walk)
        given = reckoning(trial.setup, walk, recording)
        for method in trial.setup.methods:
            score(method.track(given), walk)
        assert recording.sha


def cpu(work: Callable[[], Any]) -> float:
    """CPU seconds of this process."""
    start = time.process_time()
    work()
    return time.process_time() - start


def units_on_one_walk(units: int) -> Study:
    """The study that is timed."""
    table = {"description": "units on one walk", "scenarios": ["closed-loop"], "methods": ["pdr", "hdr"]}
    return Study(f"speed-{units}", table | {"cases": {"walks": 1, "units": units}})


def forget(trials: Sequence[Trial], walk: Walk) -> None:
    """Their kept footfalls, or nothing would be recorded and reckoned."""
    for trial in trials:
        footfalls_file(footfalls_folder(), trial, walk.sha).unlink(missing_ok=True)


def overhead(study: Study, folder: Path) -> dict[str, float]:
    """CPU seconds of the units of a study, in turns by hand and as a study, in this process.

    What a study does once, however many units it has (plan, ground, walk), is told apart: it is what the
    first study of a few units takes beyond its share.
    """
    scenario = load_scenario(study.file.scenarios[0])
    made = setup(scenario, methods=study.methods)
    units = study.file.cases.units
    trials = cases(made, units=units, walks=1)
    walk = walk_of(trials[0])
    by_hand(trials[:1], walk)  # compiled
    place = folder / "overhead"

    def study_of_few(name: str) -> None:
        forget(trials, walk)
        list(sweep(units_on_one_walk(FEW), folder / name, 1))
        forget(trials, walk)

    def all_of_it() -> None:
        list(sweep(study, place, 1))

    hand = cpu(lambda: by_hand(trials[::2], walk))
    first, some = (cpu(lambda at=at: study_of_few(at)) for at in ("first", "second"))
    whole = cpu(all_of_it)
    hand += cpu(lambda: by_hand(trials[1::2], walk))
    shutil.rmtree(place / "tracks")
    again = cpu(all_of_it)  # the report's tracks alone
    nothing = cpu(all_of_it)
    each = (whole - some) / (units - FEW)
    return {"by_hand": hand / units, "study": each, "once": first - FEW * each, "tracks": again - nothing}


def two_against_one(study: Study) -> dict[str, float]:
    """Units a second of the clock, in this process and over two workers.

    What starts and compiles them is left out: a study of hours does it once.
    """
    tasks = plan_of(study).tasks
    found = {}
    for workers in (1, 2):
        begun: list[float] = []

        def tick(metres: object, compiling: bool, begun: list[float] = begun) -> None:
            if not compiling:
                begun.append(time.perf_counter())

        units = sum(len(done.task.seeds) for done in spread(tasks, workers=workers, tick=tick))
        found[f"units_a_second_{workers}"] = units / (time.perf_counter() - begun[0])
    found["ratio"] = found["units_a_second_2"] / found["units_a_second_1"]
    return found


def invented(tasks: Sequence[Task], **keys: Any) -> Iterator[Done]:
    """Rows with invented scores."""
    rng = np.random.default_rng(1)
    for task in tasks:
        rows, cells = [], []
        for trials, settings in task.trials():
            for trial, own in zip(trials, settings, strict=True):
                blank = replace(blank_row(trial, "reference", "0" * 64), footfalls=900)
                for cell in own:
                    given = Score(*rng.random(6).tolist())
                    rows.append(replace(blank, method=cell.method.name, score=given, recording_sha=cell.key))
                    cells.append(cell.key)
        yield Done(task, tuple(rows), tuple(cells), {"all": 1.0}, "here")


def nothing_left(text: str, folder: Path) -> dict[str, float]:
    """What the command takes to find that a study of invented rows is finished."""
    file = folder / "study.toml"
    file.write_text(text, encoding="utf-8")
    place = folder / "finished"
    start = time.process_time()
    list(sweep(Study.read(file), place, invented))
    made = time.process_time() - start
    told: dict[str, float] = {"made_cpu_s": made, "parts": len(list((place / "parts").iterdir()))}
    line = [sys.executable, "-m", "footfall", "sweep", str(file), "--out", str(place)]
    took = []
    for _ in range(3):
        before, start = children_cpu_s(), time.perf_counter()
        done = subprocess.run(line, check=True, capture_output=True, text=True, env=os.environ)
        assert "nothing is left to do" in done.stderr
        took.append((children_cpu_s() - before, time.perf_counter() - start))
    told["cpu_s"], told["clock_s"] = min(took)[0], min(clock for _, clock in took)
    shutil.rmtree(place)
    return told


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the tables."""
    parser = options(__doc__, processes=False)
    parser.add_argument("--units", type=int, default=200, help="of the first two (default 200)")
    parser.add_argument("--only", choices=("overhead", "two", "start"), help="one of the three")
    chosen = parser.parse_args(arguments)
    study = units_on_one_walk(chosen.units)
    figures: dict[str, Any] = {"load": os.getloadavg()[0]}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if chosen.only in (None, "overhead"):
            found = figures["overhead"] = overhead(study, folder)
            share = found["study"] / found["by_hand"] - 1
            shown = new_table(f"{chosen.units} units of the closed loop, pdr and hdr, one process", "CPU s")
            for what, label in LABELS.items():
                shown.add_row(label, f"{found[what]:.3f}")
            out.print(shown)
            out.print(f"a unit of a study takes {share:+.1%} beside the work by hand")
        if chosen.only in (None, "two"):
            found = figures["two"] = two_against_one(study)
            out.print(
                f"{found['units_a_second_1']:.2f} units a second in one process, "
                f"{found['units_a_second_2']:.2f} in two: {found['ratio']:.2f} times "
                f"(load average before: {figures['load']:.1f})"
            )
        if chosen.only in (None, "start"):
            shown = new_table("a finished study, started again", "rows", "parts", "CPU s", "clock s")
            for what, text in (("grid", ROWS), ("500 points", MANY_POINTS)):
                rows = plan_of(Study.read(_written(folder, text))).rows
                found = figures[f"start, {what}"] = nothing_left(text, folder)
                values = (f"{found['parts']:.0f}", f"{found['cpu_s']:.2f}", f"{found['clock_s']:.2f}")
                shown.add_row(what, f"{rows:,}", *values)
            out.print(shown)
    write_json(chosen.json, figures)


def _written(folder: Path, text: str) -> Path:
    (folder / "study.toml").write_text(text, encoding="utf-8")
    return folder / "study.toml"


if __name__ == "__main__":
    main()
