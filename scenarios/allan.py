"""The Allan deviation of a gyro at rest, which says how long its static bias should be averaged."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from footfall.conventions import GRAVITY
from footfall.models.imu import ImuUnit
from footfall.pdr.allan import allan_deviation, fit_allan, suggest_bias_time
from footfall.recording import Recording
from footfall.simulate.record import record
from footfall.simulate.walk import TrueFootfalls, Walk


def resting_recording(unit: ImuUnit, seconds: float, seed: int, rate_hz: float = 200.0) -> Recording:
    """What a unit says while it lies level and still at room temperature."""
    n = round(seconds * rate_hz) + 1
    still, t = np.zeros((n, 3)), np.arange(n) / rate_hz
    walk = Walk(
        t=t,
        position=still,
        quaternion=np.tile([1.0, 0.0, 0.0, 0.0], (n, 1)),
        velocity=still,
        gyro=still,
        accel=np.tile([0.0, 0.0, GRAVITY], (n, 1)),
        contact=np.ones(n),
        stance=np.ones(n, dtype=bool),
        footfalls=TrueFootfalls(t[:1], still[:1], np.zeros(1)),
        meta={"scenario": "rest"},
    )
    return record(walk, unit, seed=seed)


def allan_report(recording: Recording, figure: Path | None = None) -> dict[str, Any]:
    """Angle random walk, bias floor and the suggested T_bias of the gyros of a resting recording.

    Raises
    ------
    InputError
        The recording is too short.
    """
    interval = recording.interval
    fit = fit_allan(recording.gyro, interval)
    bias_time = suggest_bias_time(recording.gyro, interval)
    result = {
        "duration_s": float(recording.t[-1] - recording.t[0]),
        "angle_random_walk_deg_rt_h": float(np.degrees(fit.white) * 60),
        "allan_floor_deg_h": float(np.degrees(fit.floor) * 3600),
        "suggested_bias_time_s": float(bias_time),
    }
    if figure is not None:
        _draw(recording, bias_time, fit.white, figure)
    return result


def _draw(recording: Recording, bias_time: float, white: float, path: Path) -> None:
    from footfall.scenarios.figures import new_figure, save

    interval = recording.interval
    longest = (recording.t[-1] - recording.t[0]) / 5
    tau = np.geomspace(10 * interval, longest, 40)
    deviation = np.degrees(allan_deviation(recording.gyro, interval, tau)) * 3600
    figure, axes = new_figure(1, 1, 6.0, 3.8)
    axis = axes[0, 0]
    for i, (name, colour) in enumerate(zip("xyz", ("#c1440e", "#6a9f3a", "#1f6fb4"), strict=True)):
        axis.loglog(tau, deviation[:, i], color=colour, lw=1.4, label=f"gyro {name}")
    axis.loglog(
        tau, np.degrees(white / np.sqrt(tau)) * 3600, "--", color="#888888", lw=1, label="white noise alone"
    )
    axis.axvline(bias_time, color="#222222", lw=0.9)
    axis.annotate(
        f"suggested $T_{{bias}}$ = {bias_time:.0f} s",
        (bias_time, deviation.max()),
        xytext=(4, -6),
        textcoords="offset points",
        va="top",
        fontsize=8,
    )
    axis.set_xlabel("averaging time (s)")
    axis.set_ylabel("Allan deviation (deg/h)")
    axis.legend(fontsize=8)
    save(figure, path)
