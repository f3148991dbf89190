"""How fast the error-state filter is, beside others on the same record in the same run: trust the ratios.

Beside it run its twin in numpy, and, where they are installed, a filter of the same fifteen states built on
filterpy's KalmanFilter, and gaitmap's RtsKalman, which is compiled and has nine states, but smooths too. The
slow ones run on the record's first part. Processor time is told, so that a busy machine changes little.

python -m benchmarks.speed.filter
"""

from __future__ import annotations

import importlib.util
import os
import time
from collections.abc import Callable, Sequence

import numpy as np
from rich.table import Table

from benchmarks._common import options, out, write_json
from benchmarks.speed.navigation import RATE, seconds, stepping
from footfall.pdr.filter._plain import PlainFilter
from footfall.pdr.filter.ins import ZERO_VELOCITY, Alignment, FilterSettings, InertialFilter
from footfall.pdr.filter.run import Step, align, run_filter, run_filters, updates
from footfall.pdr.reckoning import Detected, PdrParams, StartPose, detect
from footfall.recording import Recording

TARGET_NS = 1500.0
SHORT_S = 20.0  # of the record, for what is slow


def cores_used(work: Callable[[], object]) -> float:
    """Processor time over time."""
    start, clock = time.process_time(), time.perf_counter()
    work()
    return (time.process_time() - start) / (time.perf_counter() - clock)


def compiled(recording: Recording, found: Detected, settings: FilterSettings) -> Callable[[], InertialFilter]:
    """The filter by itself: detection is done, footfalls are not gathered."""
    start = align(recording, found, StartPose())
    update = updates(recording.t, found, None if settings.update == "stance" else 0.6)
    rows = slice(found.rest.last + 1, len(recording.t))

    def work() -> InertialFilter:
        one = InertialFilter(settings, start)
        one.advance(recording.t[rows], recording.gyro[rows], recording.accel[rows], update[rows])
        return one

    return work


def plain(
    recording: Recording, start: Alignment, update: np.ndarray, rows: range, settings: FilterSettings
) -> Callable[[], PlainFilter]:
    """The twin on some rows."""

    def work() -> PlainFilter:
        one = PlainFilter(settings, start)
        for k in rows:
            one.take(recording.t[k], recording.gyro[k], recording.accel[k], update[k])
        return one

    return work


def filterpy(
    recording: Recording, start: Alignment, update: np.ndarray, rows: range, settings: FilterSettings
) -> Callable[[], PlainFilter]:
    """The twin's strapdown with filterpy's predict and update instead of its own covariance."""
    from filterpy.kalman import KalmanFilter

    class OnFilterpy(PlainFilter):
        def __init__(self) -> None:
            super().__init__(settings, start)
            self.kalman = KalmanFilter(dim_x=15, dim_z=3)
            self.kalman.P = self.covariance
            self.kalman.H = np.eye(15)[3:6]
            self.kalman.R = settings.sigma_velocity**2 * np.eye(3)

        def _predicted(self, middle: np.ndarray, force: np.ndarray, dt: float) -> np.ndarray:
            noise = np.repeat(
                [
                    0,
                    settings.accel_noise,
                    settings.gyro_noise,
                    settings.accel_bias_walk,
                    settings.gyro_bias_walk,
                ],
                3,
            )
            self.kalman.predict(F=self.transition(middle, force, dt), Q=np.diag(noise**2 * dt))
            return self.kalman.P

        def _updated(
            self, h: np.ndarray, z: np.ndarray, sd: float, error: np.ndarray, turns: bool
        ) -> np.ndarray:
            self.kalman.x = np.zeros((15, 1))
            self.kalman.update(z)
            self.covariance = self.kalman.P
            return np.asarray(self.kalman.x[:, 0])

    def work() -> PlainFilter:
        one = OnFilterpy()
        for k in rows:
            one.take(recording.t[k], recording.gyro[k], recording.accel[k], update[k])
        return one

    return work


def gaitmap(recording: Recording) -> Callable[[], object]:
    """gaitmap's filter over the record, its own detector included."""
    import pandas as pd
    from gaitmap.trajectory_reconstruction import RtsKalman

    values = np.hstack([recording.accel, np.degrees(recording.gyro)])
    data = pd.DataFrame(values, columns=["acc_x", "acc_y", "acc_z", "gyr_x", "gyr_y", "gyr_z"])
    return lambda: RtsKalman().estimate(data, sampling_rate_hz=float(RATE))


def silent(step: Step) -> None:
    """A heading method that knows nothing."""


def main(arguments: Sequence[str] | None = None) -> None:
    """Time them, print the table."""
    parser = options(__doc__, processes=False)
    parser.add_argument("--minutes", type=float, default=20.0, help="of walking (default 20)")
    chosen = parser.parse_args(arguments)
    recording = stepping(chosen.minutes)
    found = detect(recording, PdrParams())
    n = len(recording.t) - found.rest.last - 1
    own, paper = FilterSettings(), FilterSettings.paper()
    cases: dict[str, float] = {
        "compiled, one update a stance": seconds(compiled(recording, found, own)) / n,
        "the same, 24 states": seconds(compiled(recording, found, FilterSettings(g_sensitivity=True))) / n,
        "compiled, an update every still sample": seconds(compiled(recording, found, paper)) / n,
        "a recording to footfalls, stances known": seconds(lambda: run_filter(recording, own, found=found))
        / n,
        "a recording to footfalls, detection included": seconds(lambda: run_filter(recording, own)) / n,
        "the same, a corrector asked": seconds(lambda: run_filter(recording, own, corrector=silent)) / n,
    }
    threads = os.cpu_count() or 1
    many = [recording] * (2 * threads)
    cores = cores_used(lambda: run_filters(many, own, threads=threads))

    first = found.rest.last + 1
    rows = range(first, first + min(n, round(SHORT_S * RATE)))
    start = align(recording, found, StartPose())
    short = recording.t, recording.gyro, recording.accel
    still = updates(recording.t, found, 0.6)
    cases["numpy twin, an update every still sample"] = seconds(
        plain(recording, start, still, rows, paper), 1
    ) / len(rows)
    if importlib.util.find_spec("filterpy"):
        only = np.minimum(still, ZERO_VELOCITY)
        cases["on filterpy, an update every still sample"] = seconds(
            filterpy(recording, start, only, rows, paper), 1
        ) / len(rows)
    if importlib.util.find_spec("gaitmap"):
        upto = slice(0, round(60 * RATE))
        part = Recording(*(column[upto] for column in short))
        cases["gaitmap RtsKalman (9 states, smooths)"] = seconds(gaitmap(part), 1) / len(part.t)

    base = cases["compiled, one update a stance"]
    table = Table(title=f"{n} samples at {RATE} Hz", title_justify="left")
    for heading in ("", "ns a sample", "times the first"):
        table.add_column(heading, justify="right" if heading else "left")
    for name, value in cases.items():
        table.add_row(name, f"{value * 1e9:,.0f}", f"{value / base:,.1f}")
    out.print(table)
    out.print(f"Target: {TARGET_NS:.0f} ns a sample on one core", highlight=False)
    out.print(f"{len(many)} recordings on {threads} threads kept {cores:.1f} cores busy", highlight=False)
    figures = {name: value * 1e9 for name, value in cases.items()}
    write_json(chosen.json, {"ns_a_sample": figures, "cores_busy": cores})


if __name__ == "__main__":
    main()
