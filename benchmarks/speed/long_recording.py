"""Recordings of any length, written as CSV or Parquet and tracked: time, and memory at most.

A synthetic foot's stride, with noise, over and over; it is read and dead-reckoned block by block. Each length
is tracked by a process of its own, whose memory is told with everything included, beside that of a process
which only imports what tracking needs. More hours should cost more time and no more memory.

python -m benchmarks.speed.long_recording --hours 3 10 30
python -m benchmarks.speed.long_recording --hours 3 10 --format csv
"""

from __future__ import annotations

import multiprocessing
import tempfile
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from itertools import islice
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv
import pyarrow.parquet as pq

from benchmarks._common import options, write_json
from benchmarks._page import Sheet
from benchmarks._usage import peak_bytes
from footfall.columns import ACCEL, GYRO
from footfall.hdr.tracking import track
from tests.helpers.synthetic_foot import walk

RATE, PERIOD = 200, 220  # Hz, samples a stride
VARIANTS = 50  # strides that differ by their noise
BEGIN = 11  # footfalls before the first stride that is repeated
NAMES = ("t", *GYRO, *ACCEL)


def parts(strides: int) -> Iterator[np.ndarray]:
    """Rows (n, 6) of rate and force: a still start and ten strides, then these, then a stand."""
    truth = walk(np.zeros(41), still_s=26.0)
    values = np.column_stack([truth.gyro, truth.accel])
    first = int(truth.at(truth.mid_stance[10:11])[0])
    rng = np.random.default_rng(0)

    def noisy(rows: np.ndarray) -> np.ndarray:
        return np.asarray(rows + rng.normal(0, 1e-3, rows.shape))

    variants = [noisy(values[first : first + PERIOD]) for _ in range(VARIANTS)]
    yield noisy(values[:first])
    done = 0
    while done < strides:
        some = list(islice((variants[k % VARIANTS] for k in range(done, strides)), 300))
        yield np.concatenate(some)
        done += len(some)
    yield noisy(np.repeat(values[-1:], 2 * RATE, axis=0))


def write(path: Path, strides: int) -> int:
    """Write a walk with so many strides in its middle, by the path's ending; returns its rows."""
    schema = pa.schema([(name, pa.float64()) for name in NAMES])
    row = 0
    with (
        pq.ParquetWriter(path, schema) if path.suffix == ".parquet" else pa_csv.CSVWriter(path, schema)
    ) as file:
        for values in parts(strides):
            t = np.arange(row, row + len(values)) / RATE
            file.write_table(pa.table([t, *values.T.copy()], schema=schema))
            row += len(values)
    return row


def tracked(path: Path | None, method: str) -> tuple[int, float, float]:
    """Footfalls, s of processor time and the most MiB of this process; None tracks nothing."""
    begin = time.process_time()
    footfalls = 0 if path is None else len(track(path, method).track)
    return footfalls, time.process_time() - begin, peak_bytes() / 2**20


def alone(path: Path | None, method: str) -> tuple[int, float, float]:
    """`tracked` in a process of its own."""
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        return pool.submit(tracked, path, method).result()


def main(arguments: Sequence[str] | None = None) -> None:
    """Write, track, tell."""
    parser = options(__doc__, processes=False)
    parser.add_argument("--hours", type=float, nargs="+", default=[3.0, 10.0], help="(default 3 10)")
    parser.add_argument("--format", choices=("parquet", "csv"), default="parquet")
    parser.add_argument("--method", default="hdr", help="of navigation (default hdr)")
    chosen = parser.parse_args(arguments)
    title = f"{chosen.format}, {chosen.method}: processor time, memory at most"
    sheet = Sheet("long", title, ["hours", "MB", "rows", "strides", "footfalls", "s", "MiB"], left=0)
    _, _, bare = alone(None, chosen.method)
    sheet.rows.append(["0", "0", "0", "0", "0", "0", f"{bare:.0f}"])
    with tempfile.TemporaryDirectory() as folder:
        for hours in chosen.hours:
            path = Path(folder) / f"long.{chosen.format}"
            strides = round(hours * 3600 * RATE / PERIOD)
            rows = write(path, strides)
            footfalls, seconds, most = alone(path, chosen.method)
            counts = path.stat().st_size // 10**6, rows, strides, footfalls, round(seconds), round(most)
            sheet.rows.append([f"{hours:g}", *map(str, counts)])
    sheet.show()
    write_json(chosen.json, {"long_recordings": [sheet.headings, *sheet.rows]})


if __name__ == "__main__":
    main()
