"""Which cause turned the heading: the drift of a simulated recording, stride by stride and cause by cause."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from footfall.columns import BUDGET, CAUSE
from footfall.errors import InputError
from footfall.late import late
from footfall.simulate.walk import Walk
from footfall.tables import write_table

_kernels, transform = late("footfall.simulate._budget_kernels"), late("scipy.spatial.transform")


@dataclass(frozen=True)
class DriftBudget:
    """Drift of each stride: vertical rate error (estimate - truth) of the gyro less its static bias.

    Attributes
    ----------
    t : (m,) s, the footfall that ends each stride
    interval : (m,) s, duration of each stride
    causes : effect -> (m,) rad/s, in the order of the effects
    total : (m,) rad/s, the sum of the causes
    """

    t: np.ndarray
    interval: np.ndarray
    causes: Mapping[str, np.ndarray]
    total: np.ndarray


def drift_budget(walk: Walk, signals: Iterable[tuple[str, np.ndarray]], bias_time: float) -> DriftBudget:
    """Drift of each stride between true footfalls.

    Every stride starts from the true attitude, as if the accelerometers had just corrected the tilt. The gyro
    signal after each effect, less its static bias, is integrated over the stride; the vertical component of
    the rotation by which it ends off the truth, over the stride's duration, is its drift. A cause's share is
    the difference that its effect makes. (A plain mean of rate errors turned into the world by the true
    attitude would be the same to first order, but counts the pure delay of the sensor's low-pass as drift.)

    Parameters
    ----------
    signals : each effect and (n, 3) rad/s, the gyro after it and all before it, in their order
    bias_time : s of motionless start over which the static bias is averaged

    Raises
    ------
    InputError
        The walk's motionless start is shorter than `bias_time`.
    """
    if not 0 < bias_time <= walk.calibration_s:
        raise InputError(
            f"bias_time = {bias_time:g} s: expected more than 0 and at most the "
            f"{walk.calibration_s:g} s that the walk stands still at its start"
        )
    still = slice(0, max(1, round(bias_time / walk.interval)))
    edges = np.rint((walk.footfalls.t - walk.t[0]) / walk.interval).astype(np.int64)
    interval = np.diff(walk.t[edges])
    start = transform.Rotation.from_quat(walk.quaternion[edges[:-1]], scalar_first=True)

    def turned(rate: np.ndarray) -> Any:
        return transform.Rotation.from_quat(_kernels.compose(rate, walk.interval, edges), scalar_first=True)

    back = (start * turned(walk.gyro)).inv()
    previous, total = walk.gyro, np.zeros(len(interval))
    causes = {}
    for name, signal in signals:
        if signal is previous:  # switched off, or not an error of this unit
            causes[name] = np.zeros(len(interval))
            continue
        # The static bias is a body vector, removed from every sample (HDR Eq. 2).
        bias = (signal[still] - walk.gyro[still]).mean(axis=0)
        drift = (start * turned(signal - bias) * back).as_rotvec()[:, 2] / interval
        causes[name] = drift - total
        previous, total = signal, drift
    return DriftBudget(t=walk.t[edges[1:]] - walk.t[0], interval=interval, causes=causes, total=total)


def write_budget(budget: DriftBudget, path: str | os.PathLike[str], meta: Mapping[str, Any]) -> None:
    """Write the budget to Parquet: t, interval, one column a cause, total."""
    columns = {"t": budget.t, "interval": budget.interval, **budget.causes, "total": budget.total}
    write_table(path, columns, {**dict.fromkeys(budget.causes, CAUSE), **BUDGET}, meta)
