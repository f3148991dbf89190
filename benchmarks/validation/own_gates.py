"""Footfall's own gates in full, and defects that they must find in 20 cases.

Every file of gates that comes with Footfall is judged over all of its cases. Then gates are judged over 20
units with a mistake in the methods (`_defects.py`), one after the other. Last, HDR with a stride time that is
2 % too long against HDR itself: what its own scatter hides.

python -m benchmarks.validation.own_gates
"""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path

from benchmarks._common import options, out, write_json
from benchmarks.validation._defects import DEFECTS
from footfall.hdr.methods import METHODS
from footfall.identity import plain
from footfall.scenarios.report.gates import gate_report, verdict_line
from footfall.scenarios.report.progress import showing
from footfall.scenarios.report.tables import new_table, titled
from footfall.scenarios.studies.gate import Judged, gate
from footfall.scenarios.studies.gate_file import stock_gates

FEW = 20
HIDDEN = f"""
[cases]
scenario = "closed-loop"
units = {FEW}

[[gates]]
name = "HDR with long strides is no worse than HDR"
method = "long-strides"
against = "sound"
"""


def judged(name: str, processes: int, **keys: object) -> Judged:
    """A file of gates, with progress."""
    with showing() as progress:
        return gate(name, workers=processes, on_progress=progress, **keys)  # type: ignore[arg-type]


def hidden(processes: int) -> Judged:
    """The first defect against sound HDR."""
    methods = {"long-strides": DEFECTS[0].methods["hdr"], "sound": METHODS["hdr"]}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "hidden.toml"
        file.write_text(HIDDEN, encoding="utf-8")
        return judged(str(file), processes, methods=methods)


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the tables."""
    parser = options(__doc__)
    parser.add_argument("--quick", action="store_true", help="20 cases of each file")
    parser.add_argument("--only", nargs="*", default=stock_gates(), help="names of files of gates")
    chosen = parser.parse_args(arguments)

    own = {name: judged(name, chosen.processes, quick=chosen.quick) for name in chosen.only}
    for found in own.values():
        for part in gate_report(found):
            out.print(part)

    defects = {
        one.name: judged(one.gates, chosen.processes, units=FEW, methods=one.methods) for one in DEFECTS
    }
    table = new_table("defect", f"what fails in {FEW} cases", left=2)
    for name, found in defects.items():
        lines = [verdict_line(verdict) for verdict in found if verdict.verdict == "fail"]
        table.add_row(name, "\n".join(lines) or "nothing")
    out.print(titled("Defects, and the gates that find them", table))
    unseen = hidden(chosen.processes)
    for part in gate_report(unseen):
        out.print(part)
    write_json(
        chosen.json,
        {
            "own": {name: [plain(verdict) for verdict in found] for name, found in own.items()},
            "defects": {name: [plain(verdict) for verdict in found] for name, found in defects.items()},
            "hidden": [plain(verdict) for verdict in unseen],
        },
    )


if __name__ == "__main__":
    main()
