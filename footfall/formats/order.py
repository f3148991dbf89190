"""Rows in the order of their stamps, and one sensor at a time."""

from __future__ import annotations

import numpy as np

from footfall.errors import InputError
from footfall.formats.samples import Samples

LATE_S = 1.0  # a row that is later than this by its stamp was not delayed: its stamp is wrong
MOST = 0.01  # share of rows that may be out of order
MOST_SENSORS = 4
ALIKE = 0.4  # by which the steps within a sensor are smaller than those from one to another


def in_order(samples: Samples) -> tuple[Samples, int]:
    """Rows that came late put back, rows with a wrong stamp left out, where they are few.

    Raises
    ------
    InputError
        There are many, or each row is another sensor's.
    """
    _require_one_sensor(samples)
    t = samples.t
    if len(t) < 2 or (np.diff(t) >= 0).all():
        return samples, 0
    back = int(np.argmax(np.diff(t) < 0)) + 1
    # Below what came before, or above what comes after: whichever explains it with fewer rows.
    low = t < np.maximum.accumulate(t)
    high = t > np.minimum.accumulate(t[::-1])[::-1]
    wrong = low if low.sum() <= high.sum() else high
    if wrong.sum() > max(1, MOST * len(t)) or len(t) < 20:
        again = "" if wrong.sum() < 0.2 * len(t) else ": two recordings in one file?"
        raise InputError(
            f"t does not increase at row {samples.row + back} (t = {t[back]:.6g} s){again}", "recording"
        )
    late = np.maximum.accumulate(t) - t
    if (late[wrong] <= LATE_S).all() and wrong is low:
        return samples.take(np.argsort(t, kind="stable")), int(wrong.sum())
    return samples.take(~wrong), int(wrong.sum())


def _require_one_sensor(samples: Samples) -> None:
    """Refuse rows that come from several sensors by turns: each is like the one before the last, or further.

    Raises
    ------
    InputError
        They do, and nothing in the file tells whose they are.
    """
    force = samples.accel[np.isfinite(samples.accel).all(axis=1)]
    if len(force) < 100:
        return
    steps = [
        float(np.median(np.linalg.norm(force[count:] - force[:-count], axis=1)))
        for count in range(1, MOST_SENSORS + 1)
    ]
    for count in range(2, MOST_SENSORS + 1):
        if steps[count - 1] < ALIKE * min(steps[: count - 1]) and steps[count - 1] > 0:
            raise InputError(
                f"its rows come from {count} sensors by turns: give each its own file, or a column that "
                "tells whose a row is",
                "recording",
            )
