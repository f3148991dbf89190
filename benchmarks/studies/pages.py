"""The stock studies and their pages: sweep, tables, figures.

    python -m benchmarks.studies.pages                     # all of them: prints the tables
    python -m benchmarks.studies.pages grades --docs docs  # one; fills its page and draws its figure

What is finished already is not done again (`footfall sweep`); results lie in OUT/NAME/results.parquet.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from benchmarks._common import options, out
from benchmarks._page import by_name, fill
from benchmarks.studies import _arc_radius, _grades, _mounts, _paces, _shapes
from benchmarks.studies._results import read_results

STUDIES = {
    "shapes": _shapes,
    "arc-radius": _arc_radius,
    "grades": _grades,
    "mounts": _mounts,
    "paces": _paces,
}


def main(arguments: Sequence[str] | None = None) -> None:
    """Sweep, print, fill, draw."""
    parser = options(__doc__, processes=False)
    parser.add_argument(
        "studies", nargs="*", choices=[*STUDIES, []], metavar="STUDY", help=", ".join(STUDIES)
    )
    parser.add_argument(
        "--out", type=Path, default=Path("out"), help="folder of the studies' folders (default out)"
    )
    parser.add_argument("--docs", type=Path, metavar="DIR", help="fill the pages and draw the figures there")
    parser.add_argument("--made", action="store_true", help="take the results as they are, sweep nothing")
    chosen = parser.parse_args(arguments)
    for name in chosen.studies or STUDIES:
        folder, study = chosen.out / name, STUDIES[name]
        if not chosen.made:
            command = [sys.executable, "-m", "footfall", "sweep", name, "--out", str(folder)]
            subprocess.run(command, check=True)
        results = read_results(folder / "results.parquet")
        sheets = study.sheets(results)
        for sheet in sheets:
            sheet.show()
        out.print(f"{name}: {len(results)} rows, {results.failed} of them failed")
        if chosen.docs is not None:
            fill(chosen.docs / "studies" / f"{name}.md", by_name(sheets))
            study.draw(results, chosen.docs / "images" / f"study_{name.replace('-', '_')}.png")


if __name__ == "__main__":
    main()
