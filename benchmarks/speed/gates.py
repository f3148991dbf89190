"""What a gate costs: units of the closed loop recorded, navigated by pdr and hdr, scored and judged.

The walks are in the cache. First with no footfalls kept, then the same again. Real seconds need a machine
that has nothing else to do; beside them what all processes took of its processors.

python -m benchmarks.speed.gates --units 60
"""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from unittest.mock import patch

from benchmarks._common import options, out, write_json
from footfall.scenarios.report.tables import new_table, titled
from footfall.scenarios.studies.gate import gate, scored, walks_cached
from footfall.scenarios.studies.gate_file import read_gates

GATES = """
[cases]
scenario = "closed-loop"
[[gates]]
name = "half of the units"
method = "hdr"
at_most = 18
[[gates]]
name = "half of the error"
method = "hdr"
against = "pdr"
margin_percent = -50
"""


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table."""
    parser = options(__doc__)
    parser.add_argument("--units", type=int, default=60, help="how many (default 60)")
    chosen = parser.parse_args(arguments)
    taken: dict[str, dict[str, float]] = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "gates.toml").write_text(GATES, encoding="utf-8")
        made = read_gates(folder / "gates.toml").with_units(chosen.units)
        if walks_cached(made) < made.walks:
            scored(made, range(made.walks), workers=chosen.processes)
        with patch("footfall.scenarios.studies.gate.footfalls_folder", lambda: folder / "footfalls"):
            for what in ("recordings anew", "footfalls kept"):
                start, before = time.perf_counter(), sum(os.times()[:4])
                gate(made, workers=chosen.processes)
                taken[what] = {"s": time.perf_counter() - start, "cpu_s": sum(os.times()[:4]) - before}
    table = new_table("", "s", "CPU s")
    for what, one in taken.items():
        table.add_row(what, *(f"{value:.1f}" for value in one.values()))
    out.print(titled(f"A gate of {chosen.units} units, pdr and hdr, {chosen.processes} processes", table))
    write_json(chosen.json, {"units": chosen.units, "processes": chosen.processes, "taken": taken})


if __name__ == "__main__":
    main()
