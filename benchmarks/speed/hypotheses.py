"""How fast the filter over hypotheses is, causal and smoothed, beside its plain twin and HDR. Processor time.

The footfalls are of a synthetic walk round blocks and along curves, with noise and drift.

python -m benchmarks.speed.hypotheses
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable

import numpy as np
from rich.table import Table

from benchmarks._common import options, out, write_json
from footfall.hdr.hdr import trace
from footfall.hdr.hypotheses._plain import PlainBeam
from footfall.hdr.hypotheses.filter import Given, Hypotheses, beliefs, given, rows_of
from footfall.hdr.hypotheses.params import HypothesesParams
from footfall.hdr.hypotheses.smoother import smoothed
from footfall.pdr.footfalls import Footfalls

CAUSAL_US, SMOOTHED_US = 60.0, 150.0
PLAIN = 40  # footfalls for the twin


def feet(n: int = 1200, interval: float = 1.05, stride: float = 1.5) -> Footfalls:
    """Straights of 80 strides, corners and bends in turn; placement scatters, and the gyro drifts."""
    rng = np.random.default_rng(1)
    turns = np.zeros(n)
    turns[80::160] = math.radians(90)
    for first in range(160, n, 320):
        turns[first : first + 60] = math.radians(0.6)
    path = np.cumsum(turns)
    course = path + np.diff(rng.normal(0, 0.02, n), prepend=0.0) / stride
    t = interval * np.arange(n)
    drift = math.radians(0.08) * t
    seen = course + drift
    steps = stride * np.column_stack([np.cos(seen), np.sin(seen), np.zeros(n)])
    return Footfalls.at(t, np.cumsum(steps, axis=0), path + drift)


def per_footfall(work: Callable[[], object], n: int, times: int = 5) -> float:
    """Least processor time (us) of several."""
    work()
    least = math.inf
    for _ in range(times):
        start = time.process_time()
        work()
        least = min(least, time.process_time() - start)
    return 1e6 * least / n


def main() -> None:
    """Measure and tell."""
    args = options(__doc__, processes=False).parse_args()
    walked, params = feet(), HypothesesParams()
    numbers, loads = given(walked)

    def streamed() -> None:
        one = Hypotheses(params)
        for row, load in zip(numbers, loads, strict=True):
            one.update(Given(*row, load))

    def twin() -> None:
        plain, c = PlainBeam(params.constants), params.constants
        for row in rows_of(walked, c)[1:PLAIN]:
            plain.step(row)

    n = len(walked)
    found = {
        "causal, a whole walk": (per_footfall(lambda: beliefs(walked, params), n), CAUSAL_US),
        "causal, footfall by footfall": (per_footfall(streamed, n), math.nan),
        "smoothed": (per_footfall(lambda: smoothed(walked, params), n), SMOOTHED_US),
        "plain twin": (per_footfall(twin, PLAIN, times=1), math.nan),
        "HDR, footfall by footfall": (per_footfall(lambda: trace(walked), n), math.nan),
    }
    table = Table(title=f"us a footfall, {params.hypotheses} hypotheses", title_justify="left")
    for heading in ("", "us", "aim"):
        table.add_column(heading, justify="left" if not heading else "right")
    for name, (took, aim) in found.items():
        table.add_row(name, f"{took:.0f}", "" if math.isnan(aim) else f"{aim:.0f}")
    out.print(table)
    write_json(args.json, {"figures": {name: took for name, (took, _) in found.items()}})


if __name__ == "__main__":
    main()
