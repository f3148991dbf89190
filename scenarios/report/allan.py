"""The Allan deviation of a gyro at rest, which says how long its static bias should be averaged."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from rich.console import Group

from footfall.conventions import GRAVITY
from footfall.models.imu import ImuUnit
from footfall.pdr.allan import allan_deviation, fit_allan, suggest_bias_time
from footfall.recording import Recording
from footfall.scenarios.report.tables import new_table, titled
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


def allan_report(recording: Recording, figure: Path | None = None) -> dict[str, float]:
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


def allan_table(report: Mapping[str, float]) -> Group:
    """`allan_report` for people."""
    table = new_table("", "")
    table.add_row("rested", f"{report['duration_s'] / 60:.0f} min")
    table.add_row("angle random walk", f"{report['angle_random_walk_deg_rt_h']:.3g} deg/sqrt(h)")
    table.add_row("bias instability: floor of the deviation", f"{report['allan_floor_deg_h']:.3g} deg/h")
    table.add_row("suggested time at rest, T_bias", f"{report['suggested_bias_time_s']:.1f} s", style="bold")
    return titled("Gyros at rest, mean of the three axes", table)


def _draw(recording: Recording, bias_time: float, white: float, path: Path) -> None:
    from footfall.scenarios.report.style import head, label_edges, new_panels, save
    from footfall.shown import AXES

    interval = recording.interval
    longest = (recording.t[-1] - recording.t[0]) / 5
    tau = np.geomspace(10 * interval, longest, 40)
    deviation = np.degrees(allan_deviation(recording.gyro, interval, tau)) * 3600
    figure, (axis,) = new_panels(1, 7.0, 3.8)
    for i, (name, colour) in enumerate(AXES.items()):
        axis.loglog(tau, deviation[:, i], color=colour, lw=1.4, label=f"gyro {name}")
    noise = np.degrees(white / np.sqrt(tau)) * 3600
    axis.loglog(tau, noise, "--", color="#888888", lw=1, label="white noise alone")
    axis.axvline(bias_time, color="#222222", lw=0.9, label=f"$T_{{bias}}$ = {bias_time:.0f} s")
    label_edges([axis], "averaging time (s)", "Allan deviation (deg/h)")
    head(figure, "Allan deviation of the gyros at rest, and how long they should rest (T_bias)", [axis])
    save(figure, path)
