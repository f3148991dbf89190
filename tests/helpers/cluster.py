"""A Dask scheduler and its workers, as processes of their own on loopback."""

import os
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).parents[2]
OTHER = "import footfall\nfootfall.__version__ = '0.0.9'\n"
UP_S = 60.0


class Processes:
    """A scheduler, and as many workers as a test asks for."""

    def __init__(self, folder):
        self.folder = folder
        self._scheduler, self._workers, self._started = None, [], 0
        self.address = ""

    def scheduler(self):
        """Its address; one that is gone is started anew. One worker's end is enough to suspect a task."""
        if self._scheduler is None or self._scheduler.poll() is not None:
            self.kill_workers()
            file = self.folder / f"scheduler-{self._started}.json"
            line = ["scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard"]
            self._scheduler = self._start(*line, "--scheduler-file", str(file))
            _wait(file.is_file)
            _wait(lambda: "tcp://" in file.read_text())
            self.address = next(part for part in file.read_text().split('"') if part.startswith("tcp://"))
        return self.address

    def workers(self, count):
        """So many that are well are there; the scheduler's address."""
        address = self.scheduler()
        self._workers = [one for one in self._workers if one.poll() is None]
        while len(self._workers) > count:
            self.kill_worker()
        for _ in range(count - len(self._workers)):
            self._workers.append(self.worker())
        return address

    def worker(self, *more):
        """One more."""
        line = ["worker", self.scheduler(), "--nthreads", "1", "--no-nanny", "--no-dashboard"]
        line += ["--host", "127.0.0.1", "--memory-limit", "0", "--local-directory", str(self.folder)]
        return self._start(*line, *more)

    def other_worker(self):
        """One of another version of Footfall."""
        (self.folder / "other.py").write_text(OTHER)
        self._workers.append(self.worker("--preload", str(self.folder / "other.py")))

    def kill_worker(self):
        """One of them, as by kill -9."""
        one = self._workers.pop()
        one.kill()
        one.wait()

    def kill_workers(self):
        """All of them."""
        while self._workers:
            self.kill_worker()

    def kill_scheduler(self):
        """As by kill -9."""
        self._scheduler.kill()
        self._scheduler.wait()

    def end(self):
        """Nothing is left."""
        self.kill_workers()
        if self._scheduler is not None:
            self.kill_scheduler()

    def _start(self, *line):
        self._started += 1
        env = os.environ | {"PYTHONPATH": str(ROOT), "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "0"}
        env |= dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")
        log = open(self.folder / f"{self._started}-{line[0]}.log", "w")  # noqa: SIM115
        return subprocess.Popen(
            [sys.executable, "-m", "dask", *line], env=env, cwd=self.folder, stdout=log, stderr=log
        )


def _wait(what):
    until = time.monotonic() + UP_S
    while not what():
        assert time.monotonic() < until
        time.sleep(0.05)
