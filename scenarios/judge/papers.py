"""What the papers measured, for printing beside ours.

HDR: Borenstein, Ojeda and Kwanmuang (2008), Heuristic Reduction of Gyro Drift in IMU-based Personnel Tracking
Systems, Table 2: final and average heading errors of five closed-loop walks of 1,800 m, five IMU units.
IHDE: Deng, Cao, Wang and Wang (2018), An Improved Heuristic Drift Elimination Method for Indoor Pedestrian
Positioning, Table 2: "the typical range of positioning errors for several tests".
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class PaperErrors:
    """Heading errors E_psi of one walk, or their improvement factors (deg or times)."""

    final: float
    average: float


@dataclass(frozen=True)
class PaperRow:
    """One column pair of Table 2: a walk, or the average of the five. Printed values, as rounded there."""

    name: str
    uncorrected: PaperErrors
    hdr: PaperErrors
    improvement: PaperErrors


HDR_TABLE_2 = (
    PaperRow("Walk 1", PaperErrors(165, 68), PaperErrors(25, 13), PaperErrors(6.6, 5.1)),
    PaperRow("Walk 2", PaperErrors(307, 145), PaperErrors(4, 10), PaperErrors(77, 14)),
    PaperRow("Walk 3", PaperErrors(124, 49), PaperErrors(25, 7.7), PaperErrors(5.0, 6.4)),
    PaperRow("Walk 4", PaperErrors(102, 34), PaperErrors(30, 15), PaperErrors(3.4, 2.3)),
    PaperRow("Walk 5", PaperErrors(288, 131), PaperErrors(20, 15), PaperErrors(14, 8.9)),
)
HDR_TABLE_2_MEAN = PaperRow(
    "Average of 5 walks", PaperErrors(197, 85), PaperErrors(21, 12), PaperErrors(9.4, 7.1)
)

# The uncorrected errors of the five walks span this range (deg).
UNCORRECTED_FINAL_RANGE = (102.0, 307.0)
UNCORRECTED_AVERAGE_RANGE = (34.0, 145.0)

# Scenario -> method -> range of P_err (% of the distance travelled); "> 20 %" has no upper end.
IHDE_TABLE_2: Mapping[str, Mapping[str, tuple[float, float]]] = {
    "ihde-test1": {"iez": (8.7, 9.6), "hde": (0.3, 0.6), "ihde": (0.2, 0.4)},
    "ihde-test2": {"iez": (2.3, 2.8), "hde": (1.3, 1.7), "ihde": (0.4, 0.7)},
    "ihde-test3": {"iez": (2.6, 3.2), "hde": (20.0, math.inf), "ihde": (0.3, 0.5)},
}


def range_text(values: tuple[float, float]) -> str:
    """A range of IHDE's Table 2 as it is printed there."""
    low, high = values
    return f"{low:g} to {high:g}" if math.isfinite(high) else f"> {low:g}"
