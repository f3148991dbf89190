"""A recording of any size, written as CSV and tracked: time and memory at most.

A synthetic foot's stride, with noise, over and over; it is read and dead-reckoned block by block.

python -m benchmarks.speed.long_recording --gigabytes 2
"""

from __future__ import annotations

import argparse
import resource
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from footfall.columns import ACCEL, GYRO
from footfall.tracking import track
from tests.helpers.synthetic_foot import walk

RATE, PERIOD = 200, 220  # Hz, samples a stride
VARIANTS = 50  # strides that differ by their noise


def write(path: Path, size: float) -> tuple[int, int]:
    """Write `size` bytes of walk; returns rows and strides."""
    truth = walk(np.zeros(41), still_s=26.0)
    values = np.column_stack([truth.gyro, truth.accel])
    first = int(truth.at(truth.mid_stance[10:11])[0])
    rng = np.random.default_rng(0)

    def lines(rows: np.ndarray) -> list[str]:
        noisy = rows + rng.normal(0, 1e-3, rows.shape)
        return [",".join(f"{x:.9f}" for x in row) + "\n" for row in noisy]

    strides = [lines(values[first : first + PERIOD]) for _ in range(VARIANTS)]
    count = row = written = 0
    with open(path, "w", encoding="ascii") as file:

        def put(some: list[str]) -> None:
            nonlocal row, written
            written += file.write("".join(f"{(row + i) / RATE:.3f},{line}" for i, line in enumerate(some)))
            row += len(some)

        file.write(",".join(("t", *GYRO, *ACCEL)) + "\n")
        put(lines(values[:first]))
        while written < size:
            put(strides[count % VARIANTS])
            count += 1
        put(lines(np.repeat(values[-1:], 2 * RATE, axis=0)))
    return row, count


def main(arguments: Sequence[str] | None = None) -> None:
    """Write, track, tell."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--gigabytes", type=float, default=2.0, help="of CSV (default 2)")
    parser.add_argument("--method", default="hdr", help="of navigation (default hdr)")
    chosen = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "long.csv"
        rows, strides = write(path, 1e9 * chosen.gigabytes)
        begin = time.perf_counter()
        result = track(path, chosen.method)
        seconds = time.perf_counter() - begin
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)
    print(f"{rows} rows, {strides} strides in the middle of the walk, {len(result.track)} footfalls")
    print(f"{seconds:.0f} s, {most / 2**30:.2f} GiB of memory at most, everything included")


if __name__ == "__main__":
    main()
