"""How strides close: real recordings as they are and spoilt on purpose, and what is told of them.

The first table gives the velocity that strides leave with the gyros' units and axes changed. The second gives
what is found of gyros that lag and of stamps that are off: "late 40 ms" (put right), "rate 1.10", "either"
where several causes are named, "-" where none is. Its last row is how far dead reckoning's track is from its
own where -f was recorded instead of f.

python -m benchmarks.validation.closing --page docs/real_recordings.md
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks._page import Sheet, by_name, fill
from benchmarks.validation._real import BESIDE, Real, find
from benchmarks.validation.real_recordings import DETECTOR, reckoning
from footfall.formats.closure import misclosure, rests_of, strides_of
from footfall.formats.diagnosis import CHANGES, diagnose
from footfall.recording import Recording

LAGS_MS = (-100, -40, -20, -10, 10, 20, 40, 100)
CLOCKS = (0.9, 0.95, 0.97, 1.03, 1.05, 1.1)


def mechanics(reals: Sequence[Real]) -> Sheet:
    """The velocity that a stride leaves, as it is and with the gyros' units or axes changed."""
    sheet = Sheet("mechanics", "Velocity left by a stride, g T", ["gyros", *(real.name for real in reals)])
    strides = [strides_of(real.recording, rests_of(real.recording)) for real in reals]
    for name, change in {"as they are": np.eye(3), **CHANGES}.items():
        row = [
            misclosure(real.recording, own, change) if own else None
            for real, own in zip(reals, strides, strict=True)
        ]
        sheet.rows.append([name, *("-" if left is None else f"{left:.3f}" for left in row)])
    return sheet


def heard(recording: Recording, lag_s: float) -> Recording:
    """With its gyros `lag_s` later."""
    gyro = [np.interp(recording.t - lag_s, recording.t, axis) for axis in recording.gyro.T]
    return replace(recording, gyro=np.column_stack(gyro))


def late(reals: Sequence[Real]) -> Sheet:
    """What is told of lags and clocks."""
    sheet = Sheet("late", "What is told of lags and clocks", ["spoilt", *(real.name for real in reals)])
    for lag in LAGS_MS:
        row = [told(heard(real.recording, lag / 1000)) for real in reals]
        sheet.rows.append([f"gyros {abs(lag)} ms {'later' if lag > 0 else 'earlier'}", *row])
    for clock in CLOCKS:
        row = [told(replace(real.recording, t=clock * real.recording.t)) for real in reals]
        sheet.rows.append([f"stamps {100 * (clock - 1):+.0f} %", *row])
    row = [told(replace(real.recording, accel=-real.recording.accel)) for real in reals]
    sheet.rows.append(["-f", *row])
    sheet.rows.append(["-f: m off at most, track's length", *map(mirrored, reals)])
    return sheet


def told(recording: Recording) -> str:
    """The cause that is named, in short."""
    found = diagnose(recording)
    if found is None or not found.cause:
        return "-"
    if found.lag_s:
        return f"late {1000 * found.lag_s:.0f} ms"
    if "later" in found.cause or "biased" in found.cause:
        return "either"
    times = found.cause.partition("the rates are ")[2].partition(" times")[0]
    return f"rate {times}" if times else found.cause


def mirrored(real: Real) -> str:
    """How far the track of -f is from that of f, both from the same start and heading."""
    recording = real.recording
    own, other = (
        reckoning(real, DETECTOR, one).footfalls.position[:, :2]
        for one in (recording, replace(recording, accel=-recording.accel))
    )
    rows = min(len(own), len(other))
    off = np.linalg.norm(own[:rows] - other[:rows], axis=1).max()
    return f"{off:.0f} of {np.linalg.norm(np.diff(own, axis=0), axis=1).sum():.0f}"


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--data", type=Path, default=BESIDE, help="folder of recordings")
    parser.add_argument("--page", type=Path, metavar="MD", help="put the tables into this page's marks")
    chosen = parser.parse_args(arguments)
    reals = find(chosen.data)
    if not reals:
        raise SystemExit(f"{chosen.data}: no recordings here")
    made = [mechanics(reals), late(reals)]
    for sheet in made:
        sheet.show()
    if chosen.page is not None:
        fill(chosen.page, by_name(made))


if __name__ == "__main__":
    main()
