"""The IMU's signals as a picture beside the drawn walker, uncovered as the walk goes on."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from footfall.shown import AXES, styled
from footfall.simulate.plan import PHYSICS_STEP
from footfall.simulate.truth import imu_truth
from footfall.simulate.walker.walkers import CONTROL_INTERVAL

RATE_STEPS = 5  # physics steps a sample: 200 Hz


def signal_panels(poses: list[np.ndarray], count: int, width: int, height: int) -> list[np.ndarray]:
    """Rates and specific force of a perfect IMU, one picture a control step.

    Parameters
    ----------
    poses : one (k, 7) array a control step, the IMU's position (m) and quaternion at each physics step; the
        last `count` are shown
    width, height : of a picture, in pixels

    Returns
    -------
    (height, width, 3) uint8, one for each of the last `count` control steps
    """
    pose = np.concatenate(poses)
    truth = imu_truth(pose[:, :3], pose[:, 3:], PHYSICS_STEP, RATE_STEPS)
    began = (len(poses) - count) * CONTROL_INTERVAL
    t = truth.index * PHYSICS_STEP - began
    empty, _ = _drawn(t, None, None, count, width, height)
    full, at = _drawn(t, truth.gyro, truth.accel, count, width, height)
    found = []
    for number in range(count):
        column = round(at(CONTROL_INTERVAL * (number + 1)))
        picture = empty.copy()
        picture[:, :column] = full[:, :column]
        picture[:, column : column + 2] = np.minimum(picture[:, column : column + 2], 150)
        found.append(picture)
    return found


def _drawn(
    t: np.ndarray,
    gyro: np.ndarray | None,
    accel: np.ndarray | None,
    count: int,
    width: int,
    height: int,
) -> tuple[np.ndarray, Callable[[float], float]]:
    """The picture, with or without lines, and from a time (s) to its column."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    with styled():
        figure = Figure(figsize=(width / 100, height / 100), dpi=100)
        canvas = FigureCanvasAgg(figure)
        axes = figure.subplots(2, sharex=True)
        texts = (("rate (deg/s)", 550), ("specific force (m/s²)", 60))
        signals = (None if gyro is None else np.degrees(gyro), accel)
        for axis, signal, (name, limit) in zip(axes, signals, texts, strict=True):
            for column, (part, colour) in enumerate(AXES.items()):
                values = np.full(len(t), np.nan) if signal is None else signal[:, column]
                axis.plot(t, values, color=colour, lw=1.2, label=part)
            axis.set_ylim(-limit, limit)
            axis.set_title(name)
        axes[0].legend(ncols=3, loc="upper right")
        axes[1].set_xlabel("time (s)")
        axes[1].set_xlim(0, count * CONTROL_INTERVAL)
        canvas.draw()
        shown = np.asarray(canvas.buffer_rgba())[:, :, :3].copy()
    left, right = (float(axes[0].transData.transform((x, 0))[0]) for x in axes[0].get_xlim())
    return shown, lambda time: left + (right - left) * time / (count * CONTROL_INTERVAL)
