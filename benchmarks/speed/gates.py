"""What a gate costs: units of the closed loop recorded, navigated by pdr and hdr, scored and judged.

The walks are in the cache. First with no footfalls kept, then the same again. Real seconds: the machine must
have nothing else to do.

python -m benchmarks.speed.gates --units 60
"""

from __future__ import annotations

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
    seconds = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "gates.toml").write_text(GATES, encoding="utf-8")
        made = read_gates(folder / "gates.toml").with_units(chosen.units)
        if walks_cached(made) < made.walks:
            scored(made, range(made.walks), workers=chosen.processes)
        with patch("footfall.scenarios.studies.gate.footfalls_folder", lambda: folder / "footfalls"):
            for what in ("recordings anew", "footfalls kept"):
                start = time.perf_counter()
                gate(made, workers=chosen.processes)
                seconds[what] = time.perf_counter() - start
    table = new_table("", "s")
    for what, taken in seconds.items():
        table.add_row(what, f"{taken:.1f}")
    out.print(titled(f"A gate of {chosen.units} units, pdr and hdr, {chosen.processes} processes", table))
    write_json(chosen.json, {"units": chosen.units, "processes": chosen.processes, "seconds": seconds})


if __name__ == "__main__":
    main()
