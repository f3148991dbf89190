"""What a walk's file costs, beside Parquet with dictionaries (as pyarrow has it, zstd) in the same run.

Processor time is told; the walk is taken from the cache or walked first.

python -m benchmarks.speed.files
python -m benchmarks.speed.files straight --number 2
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from benchmarks.speed.navigation import seconds
from footfall.models.imu import draw_unit, load_spec
from footfall.recording import read_recording, write_recording
from footfall.scenarios.scenario import load_scenario
from footfall.simulate.cache import cached_walk
from footfall.simulate.record import record
from footfall.simulate.walk import read_walk, write_walk
from footfall.tables import read_table

REPEATS = 7


def with_dictionaries(path: Path) -> Callable[[], object]:
    """Write the columns of a Parquet file beside it, as pyarrow does when it is told no more than zstd."""
    columns, _ = read_table(path)
    meta = pq.read_schema(path).metadata

    def write() -> None:
        fresh = pa.table({name: pa.array(values) for name, values in columns.items()})
        pq.write_table(fresh.replace_schema_metadata(meta), path.with_name("old.parquet"), compression="zstd")

    return write


def line(name: str, path: Path, write: Callable[[], object], read: Callable[[], object]) -> None:
    """Print size and times of a file, written both ways."""
    old = with_dictionaries(path)
    ways = {"with dictionaries": (old, path.with_name("old.parquet")), "as it is": (write, path)}
    for way, (work, file) in ways.items():
        written = seconds(work, REPEATS)
        found = seconds(lambda file=file: pq.read_table(file, use_threads=False), REPEATS)
        size = file.stat().st_size / 1e6
        print(
            f"{name:9} {way:18} {size:6.1f} MB  {1e3 * written:5.0f} ms to write  {1e3 * found:4.0f} to read"
        )
    print(f"{name:9} {'read as we do':18} {'':9}  {'':14}  {1e3 * seconds(read, REPEATS):6.0f}")


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("scenario", nargs="?", default="closed-loop")
    parser.add_argument("--number", type=int, default=1, help="of the scenario's walks (default 1)")
    chosen = parser.parse_args(arguments)
    walk = cached_walk(load_scenario(chosen.scenario).plan(chosen.number - 1))
    recording = record(walk, draw_unit(load_spec("nimu"), 1), seed=1)
    print(f"{chosen.scenario}: {walk.t[-1] / 60:.1f} min, {len(walk.t)} samples")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "walk.parquet"
        write_walk(walk, path)
        line("walk", path, lambda: write_walk(walk, path), lambda: read_walk(path))
        path = Path(folder) / "recording.parquet"
        write_recording(recording, path)
        line("recording", path, lambda: write_recording(recording, path), lambda: read_recording(path))


if __name__ == "__main__":
    main()
