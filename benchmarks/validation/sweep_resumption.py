"""kill -9 of a sweep at random moments, then of its workers: is the dataset the same, and what is done twice?

A small study on one short walk is done once without disturbance. Then it is started again and again, and
its driver killed each time, as often as asked; and once more with one of its workers killed now and then.
Compared are the bytes of results.parquet. A method of the study writes down each recording that it is given,
which tells what was done twice.

python -m benchmarks.validation.sweep_resumption --kills 20
"""

from __future__ import annotations

import hashlib
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path

from benchmarks._common import err, options, out, write_json
from footfall.scenarios.report.tables import new_table
from footfall.scenarios.studies.plan import CHUNK

SCENARIO = """
description = "thirty metres round one corner"
subjects = ["reference"]
[path]
elements = [
  { kind = "straight", length_m = 16.0 },
  { kind = "corner", turn_deg = 90.0, radius_m = 2.5 },
  { kind = "straight", length_m = 16.0 },
]
[gait]
pace_m_s = 1.3
[temperature]
indoors_degC = 20.0
outdoors_degC = 20.0
[sensor]
imu = "nimu"
calibration_s = 26.0
[seeds]
base = 3
"""
METHOD = """
import os
import time
import numpy as np
import footfall

def counted(recording, start):
    time.sleep(0.03)
    name = f"{recording.sha} "
    with open(os.environ["FOOTFALL_COUNTED"], "ab", buffering=0) as log:
        log.write((name + chr(10)).encode())
    t = recording.t[[0, -1]]
    return footfall.Track(t, np.tile(start.position, (2, 1)), np.full(2, start.heading))
"""
STUDY = """
description = "to be killed"
scenarios = ["short.toml"]
methods = ["pdr", "hdr", "counted.py:counted"]
[cases]
walks = 1
units = {units}
[design.axes]
"hdr.theta_w_deg_s" = [0.1, 0.25, 0.5]
"""


class Sweep:
    """The study in a folder of results of its own."""

    def __init__(self, folder: Path, name: str, workers: int) -> None:
        self.folder, self.name, self.workers = folder, name, workers
        self.log = folder / f"{name}.log"

    def start(self) -> subprocess.Popen[str]:
        """As a process."""
        line = [sys.executable, "-m", "footfall", "sweep", "study.toml", "--out", self.name]
        line += ["--workers", str(self.workers)]
        env = os.environ | {"FOOTFALL_COUNTED": str(self.log)}
        return subprocess.Popen(
            line, cwd=self.folder, env=env, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
        )

    @property
    def parts(self) -> int:
        """How many tasks are kept."""
        return len(list((self.folder / self.name / "parts").glob("*.parquet")))

    @property
    def digest(self) -> str:
        """Of the dataset."""
        content = (self.folder / self.name / "results.parquet").read_bytes()
        return hashlib.sha256(content).hexdigest()

    @property
    def again(self) -> int:
        """Recordings that the method was given once more."""
        counts = Counter(self.log.read_text(encoding="utf-8").split())
        return sum(count - 1 for count in counts.values())

    @property
    def leftovers(self) -> int:
        """Files that were being written."""
        return len(list((self.folder / self.name).rglob("*.tmp")))


def children(pid: int) -> list[int]:
    """Processes that one has started; Linux."""
    try:
        told = Path(f"/proc/{pid}/task/{pid}/children").read_text()
    except OSError:
        return []
    return [int(one) for one in told.split()]


def works(pid: int) -> bool:
    """Whether a process is one of the pool's, and not what keeps its semaphores."""
    try:
        return b"spawn_main" in Path(f"/proc/{pid}/cmdline").read_bytes()
    except OSError:
        return False


def wait_until(what: Callable[[], bool], process: subprocess.Popen[str]) -> None:
    """Something holds, or the process has ended."""
    while process.poll() is None and not what():
        time.sleep(0.01)


def drivers(sweep: Sweep, kills: int, tasks: int, rng: random.Random) -> int:
    """Kill the driver until that was done so often, then let it end; the most processes left behind."""
    left = 0
    for kill in range(kills):
        before = sweep.parts
        ahead = max(tasks - before - 2, 0) / (kills - kill)  # spread over what is to be done
        wanted = before + rng.randint(0, max(round(2 * ahead), 1))
        process = sweep.start()
        wait_until(lambda wanted=wanted: sweep.parts >= wanted, process)
        time.sleep(rng.random() * 2.0 if wanted == before else rng.random() * 0.4)
        own = children(process.pid)
        process.kill()
        process.communicate()
        time.sleep(1.0)
        left = max(left, sum(works(pid) for pid in own))
        err.print(f"killed after {sweep.parts} of {tasks} tasks")
    process = sweep.start()
    process.communicate()
    assert process.returncode == 0
    return left


def workers(sweep: Sweep, kills: int, tasks: int, rng: random.Random) -> int:
    """Kill one of the workers now and then; how often that was done."""
    process, done = sweep.start(), 0
    for kill in range(kills):
        wanted = max((kill + 1) * tasks // (kills + 1), sweep.parts + 1)
        wait_until(lambda wanted=wanted: sweep.parts >= wanted, process)
        own = [pid for pid in children(process.pid) if works(pid)]
        if process.poll() is None and own:
            os.kill(rng.choice(own), signal.SIGKILL)
            done += 1
            err.print(f"worker killed after {sweep.parts} of {tasks} tasks")
    _, said = process.communicate()
    assert process.returncode == 0, said
    return done


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table."""
    if not Path("/proc").is_dir():
        raise SystemExit("needs /proc, which tells what a process has started: Linux")
    parser = options(__doc__)
    parser.add_argument("--kills", type=int, default=20, help="of the driver (default 20)")
    parser.add_argument("--worker-kills", type=int, default=5, help="of a worker (default 5)")
    parser.add_argument("--tasks", type=int, default=40, help="of the study (default 40)")
    parser.add_argument("--seed", type=int, default=1, help="of the moments")
    chosen = parser.parse_args(arguments)
    rng = random.Random(chosen.seed)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "short.toml").write_text(SCENARIO, encoding="utf-8")
        (folder / "counted.py").write_text(METHOD, encoding="utf-8")
        (folder / "study.toml").write_text(STUDY.format(units=chosen.tasks * CHUNK), encoding="utf-8")
        calm, stormy, hurt = (Sweep(folder, name, chosen.processes) for name in ("calm", "stormy", "hurt"))
        calm.start().communicate()
        left = drivers(stormy, chosen.kills, chosen.tasks, rng)
        done = workers(hurt, chosen.worker_kills, chosen.tasks, rng)
        table = new_table("killed", "times", "same bytes", "recordings\nagain", "allowed", "half files")
        figures = {}
        for what, sweep, kills in (("driver", stormy, chosen.kills), ("worker", hurt, done)):
            same = sweep.digest == calm.digest
            again = sweep.again - calm.again  # but for the tracks of the report
            allowed = kills * chosen.processes * CHUNK  # a task a worker
            figures[what] = {
                "kills": kills,
                "identical": same,
                "recordings_again": again,
                "allowed": allowed,
                "half_files": sweep.leftovers,
            }
            told = ("yes" if same else "NO", f"{again}", f"{allowed}", f"{sweep.leftovers}")
            table.add_row(what, f"{kills}", *told)
        out.print(table)
        out.print(f"{chosen.tasks} tasks of {CHUNK} recordings; workers left after a killed driver: {left}")
        write_json(chosen.json, figures | {"workers_left": left})


if __name__ == "__main__":
    main()
