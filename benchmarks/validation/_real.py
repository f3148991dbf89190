"""Real recordings that lie beside the checkout, read by Footfall's own readers, and their truths."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from footfall.formats import Findings, read
from footfall.recording import Recording
from footfall.scenarios.judge.reference import Footprints
from footfall.tables import read_table

BESIDE = Path(__file__).resolve().parents[3] / "shared" / "data"


@dataclass(frozen=True)
class Real:
    """One recording.

    Attributes
    ----------
    name : of the recording
    group : of those made alike
    path : its file
    prints : CSV with the columns timestamp, gcpX, gcpY of measured footprints; None where there are none
    """

    name: str
    group: str
    path: Path
    prints: Path | None = None

    @cached_property
    def _read(self) -> tuple[Recording, Findings]:
        return read(self.path)

    @property
    def recording(self) -> Recording:
        """In SI, mended."""
        return self._read[0]

    @property
    def findings(self) -> Findings:
        """What was wrong with it."""
        return self._read[1]

    @cached_property
    def footprints(self) -> Footprints | None:
        """One a footfall, the first that of the start."""
        if self.prints is None:
            return None
        columns, _ = read_table(self.prints)
        # Theirs is a frame with z down.
        return Footprints(columns["timestamp"], np.column_stack([columns["gcpX"], -columns["gcpY"]]))


def find(folder: Path) -> list[Real]:
    """The recordings in a folder laid out like the one beside the checkout."""
    found = [
        Real(f"openshoe {path.stem[-2:]}", "openshoe", path)
        for path in sorted((folder / "openshoe").glob("data_inert_*.txt"))
    ]
    for path in sorted((folder / "gdin").glob("SensorConnectData_[0-9][0-9].csv")):
        prints = path.with_name(f"{path.stem}_strideIndex_timestamp_gcpX_gcpY.csv")
        found.append(Real(f"gdin {path.stem[-2:]}", "gdin", path, prints if prints.is_file() else None))
    found += [
        Real(f"xio {path.stem.removesuffix('_walk')}", "xio", path)
        for path in sorted((folder / "xio").glob("*_walk.csv"))
    ]
    return found
