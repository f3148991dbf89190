"""What a recording costs, beside the strapdown kernel in the same run: trust the ratios more than the times.

Twenty minutes at 200 Hz of a foot in closed form, heard by a nIMU with every effect (CPU time, the least of
several runs; compiling apart).

python -m benchmarks.speed.recording
"""

from __future__ import annotations

import time
import tracemalloc
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from benchmarks._common import options, write_json
from footfall.models.imu import EFFECTS, ImuUnit, TemperatureProfile, _plain, draw_unit, load_spec
from footfall.models.imu.effects import Channel, sensed
from footfall.pdr import _kernels
from footfall.simulate.record import record, record_with_budget
from tests.helpers.synthetic import synthetic_walk

SENSORS = ("gyro", "accel")
COLD = TemperatureProfile.step(20.0, -5.0)


def complete_unit() -> ImuUnit:
    """A nIMU that has non-linearity and quadratic errors of temperature too."""
    spec = load_spec("nimu")
    more = {"non_linearity_sigma": 1e-4, "temperature2_sigma": 1e-6}
    return draw_unit(replace(spec, gyro=replace(spec.gyro, **more), accel=replace(spec.accel, **more)), 7)


def seconds(work: Callable[[], object], repeats: int = 5) -> float:
    """CPU time of the quickest of several runs."""
    best = np.inf
    for _ in range(repeats):
        start = time.process_time()
        work()
        best = min(best, time.process_time() - start)
    return best


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table."""
    parser = options(__doc__, processes=False)
    parser.add_argument("--minutes", type=float, default=20.0, help="of walking (default 20)")
    chosen = parser.parse_args(arguments)
    walk, unit = synthetic_walk(strides=round(60 * chosen.minutes / 1.1)), complete_unit()
    n = len(walk.t)

    def per_sample(work: Callable[[], object], repeats: int = 5) -> float:
        return 1e9 * seconds(work, repeats) / n

    def of_both(work: Callable[[Channel], object], repeats: int = 5) -> float:
        die = COLD.die(walk.t, unit.spec.thermal.time_constant)
        told = {"force": walk.accel, "die": die, "interval": walk.interval, "seed": 1}
        channels = [Channel.of(unit, name, getattr(walk, name), **told) for name in SENSORS]
        return per_sample(lambda: [work(channel) for channel in channels], repeats)

    def whole() -> object:
        return record(walk, unit, seed=1, temperature=COLD)

    begin = time.process_time()
    whole()
    first = time.process_time() - begin
    level = np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3), np.zeros(3)

    def strapdown() -> object:
        return _kernels.integrate(walk.t, walk.gyro, walk.accel, *level)

    strapdown()
    kernel = per_sample(strapdown)
    table = {"record, all effects": per_sample(whole)}
    table["record with its drift budget"] = per_sample(
        lambda: record_with_budget(walk, unit, seed=1, temperature=COLD), 3
    )
    table |= {f"  {name}": of_both(lambda channel, name=name: alone(channel, name)) for name in EFFECTS}
    table["  all, numpy and scipy"] = of_both(_plain.sensed, 2)
    most = peak_bytes(whole) / n

    print(f"{'strapdown kernel':32s}{kernel:8.1f} ns a sample")
    for name, cost in table.items():
        print(f"{name:32s}{cost:8.1f} ns a sample, {cost / kernel:5.2f} times the kernel")
    print(f"{'the first recording':32s}{first:8.2f} s, compiling or loading what is compiled included")
    hour = 3600 / walk.interval * most / 1e6
    print(f"{'memory at most':32s}{most:8.1f} bytes a sample, {hour:.0f} MB an hour")
    figures = {"strapdown_ns": kernel, "first_s": first, "peak_bytes": most}
    write_json(chosen.json, figures | {"ns": {name.strip(): cost for name, cost in table.items()}})


def peak_bytes(work: Callable[[], object]) -> float:
    """Most memory that `work` held at once, its result included."""
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def alone(channel: Channel, name: str) -> np.ndarray:
    """One effect on a perfect signal; the cost of copying the signal is in it."""
    return sensed(channel, [other for other in EFFECTS if other != name])


if __name__ == "__main__":
    main()
