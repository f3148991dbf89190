"""Reading and checking a long CSV: one hour at 200 Hz, as Footfall writes it and as phones do.

Each file is read by a process of its own, whose memory is told with everything included. `read` mends the
samples and judges them by physics.

python -m benchmarks.speed.reading
python -m benchmarks.speed.reading --hours 0.1
"""

from __future__ import annotations

import multiprocessing
import tempfile
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv

from benchmarks._common import options, write_json
from benchmarks._page import Sheet
from benchmarks._usage import peak_bytes
from benchmarks.speed.long_recording import NAMES, RATE, parts
from footfall.formats import read

PERIOD_S = 1.1


def write(folder: Path, hours: float) -> dict[str, Path]:
    """The same recording in each form."""
    values = np.concatenate(list(parts(int(hours * 3600 / PERIOD_S))))
    t = np.arange(len(values)) / RATE
    plain, phone, stamped = (folder / f"{name}.csv" for name in ("plain", "phone", "stamped"))
    columns = dict(zip(NAMES, [t, *values.round(6).T], strict=True))
    pa_csv.write_csv(pa.table(columns), plain)
    text = plain.read_text(encoding="ascii").replace(",", ";").replace(".", ",")
    phone.write_text(text.replace('"t"', '"Time (s)"'), encoding="ascii")
    begin = np.datetime64("2024-05-01T12:00:00.000", "ms")
    stamps = (begin + (1000 * t).round().astype("timedelta64[ms]")).astype(str)
    pa_csv.write_csv(pa.table(columns | {"t": stamps}), stamped)
    return {
        "Footfall's own": plain,
        "semicolons and decimal commas": phone,
        "dates and times": stamped,
    }


def measure(path: Path) -> tuple[int, float, float]:
    """Rows, seconds of processor time, and MiB at most."""
    begin = time.process_time()
    recording, _ = read(path)
    spent = time.process_time() - begin
    return len(recording.t), spent, peak_bytes() / 2**20


def alone(work: Callable[..., Any], *arguments: Any) -> Any:
    """In a process of its own, which has never held more than this work needs."""
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        return pool.submit(work, *arguments).result()


def main(argv: Sequence[str] | None = None) -> None:
    parser = options(__doc__, processes=False)
    parser.add_argument("--hours", type=float, default=1.0)
    asked = parser.parse_args(argv)
    sheet = Sheet("reading", "Reading and checking", ["file", "rows", "MB", "CPU s", "MiB at most"])
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, path in alone(write, Path(folder), asked.hours).items():
            rows, spent, most = alone(measure, path)
            found[name] = {"rows": rows, "cpu_s": spent, "most_mib": most}
            size = path.stat().st_size / 1e6
            sheet.rows.append([name, f"{rows:,}", f"{size:.0f}", f"{spent:.1f}", f"{most:.0f}"])
    sheet.show()
    write_json(asked.json, found)


if __name__ == "__main__":
    main()
