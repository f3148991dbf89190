"""The rows of the gait tables, and which of them a simulated walk satisfies."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from footfall.pdr.gait.statistics import SIGNALS


@dataclass(frozen=True)
class Row:
    """A row of a table: the key of a figure, what it is called, and how many decimals it is worth.

    `people` are the lowest and the highest figure of people, with their source, where no foot IMU tells;
    `any_pace` says that they hold at every pace, not only near 1.3 m/s. A figure within `slack` of the
    bounds is not told from them.
    """

    key: str
    label: str
    decimals: int = 0
    people: tuple[float, float] | None = None
    source: str = ""
    any_pace: bool = False
    slack: float = 0.0


UNJUDGED = "What was walked"
RECTIFIED_SLACK = 0.03  # turns a unit of G = 0.1 deg/s/g by 4 deg in 20 minutes: too little to tell

FEET: dict[str, tuple[Row, ...]] = {
    UNJUDGED: (
        Row("strides", "steady strides"),
        Row("speed_m_s", "speed (m/s)", 2),
        Row("stride_s", "stride time (s)", 2),
        Row("stride_m", "stride length (m)", 2),
    ),
    "Timing": (
        Row("walk_ratio_mm_min", "step length / cadence (mm min)", 1),
        Row("stride_sd_ms", "stride time SD (ms)"),
        Row("stride_length_sd_cm", "stride length SD (cm)", 1),
        Row("still_pct", "stance fraction, below 0.6 rad/s (%)"),
        Row("swing_peak_pct", "swing peak after push-off's end (%)"),
        Row("landing_pct", "landing after push-off's end (%)"),
    ),
    "Swing and landing": (
        Row("push_off_deg_s", "push-off peak, pitch rate (deg/s)"),
        Row("swing_deg_s", "swing peak, pitch rate (deg/s)"),
        Row("roll_deg_s", "roll rate, RMS (deg/s)"),
        Row("yaw_deg_s", "yaw rate, RMS (deg/s)"),
        Row("toe_down_deg", "sole at push-off, toes down (deg)"),
        Row("toe_up_deg", "sole at landing, toes up (deg)"),
        Row("push_off_m_s2", "push-off peak, force (m/s2)"),
        Row("heel_strike_m_s2", "heel-strike peak, force (m/s2)"),
        Row("heel_strike_x_m_s2", "its forward part (m/s2)"),
        Row("heel_strike_z_m_s2", "its upward part (m/s2)"),
    ),
    "Mid-stance": (
        Row("mid_gyro_deg_s", "mean gyro norm (deg/s)", 1),
        Row("mid_gyro_sd_deg_s", "gyro SD (deg/s)", 1),
        Row("mid_accel_sd_m_s2", "accelerometer SD (m/s2)", 2),
    ),
    "Quietest 100 ms": (
        Row("quiet_gyro_deg_s", "mean gyro norm (deg/s)", 1),
        Row("quiet_gyro_sd_deg_s", "gyro SD (deg/s)", 1),
        Row("quiet_accel_sd_m_s2", "accelerometer SD (m/s2)", 2),
    ),
    "For heading methods": (
        Row("yaw_scatter_deg", "stance yaw about the path, SD (deg)", 1),
        *(
            Row(f"g_{gyro}{accel}", f"rectified force, {gyro}{accel}", 2, slack=RECTIFIED_SLACK)
            for gyro in "xyz"
            for accel in "xyz"
        ),
    ),
    "Mean stride: distance (SDs)": tuple(Row(f"distance {signal}", signal, 2) for signal in SIGNALS),
    "Mean stride: within +- 2 SD (%)": tuple(Row(f"within {signal}", signal) for signal in SIGNALS),
    "Scatter of strides, SD (deg/s, m/s2)": tuple(Row(f"band {signal}", signal, 1) for signal in SIGNALS),
}
_PERRY = "Perry & Burnfield 2010"
_AIM = "aim of the project"
WALKS: tuple[Row, ...] = (
    Row("asked_m_s", "speed asked for (m/s)", 2),
    Row("speed_m_s", "speed walked (m/s)", 2),
    Row("cadence_steps_min", "cadence (steps/min)"),
    Row("stride_length_m", "stride length (m)", 2),
    # 6.38 +- 0.66 mm per step/min, 30 healthy adults at 0.55-1.67 m/s, whatever their speed; +- 2 SD.
    Row(
        "walk_ratio_mm_min",
        "step length / cadence (mm min)",
        1,
        (5.1, 7.7),
        "Rota et al. 2011",
        True,
    ),
    Row("stance_pct", "stance (% of stride)", 0, (58, 64), _PERRY),
    Row("double_support_pct", "double support (% of stride)", 0, (16, 28), _PERRY),
    Row("first_hump_bw", "ground force, first hump (BW)", 2, (1.05, 1.3), _AIM),
    Row("valley_bw", "valley between the humps (BW)", 2, (0.6, 0.9), _PERRY),
    Row("second_hump_bw", "second hump (BW)", 2, (1.05, 1.3), _AIM),
    Row("spike_bw", "heel-strike spike, unfiltered (BW)", 2, (0.5, 1.25), "Whittle 1999"),
    Row("plantarflexion_deg", "push-off plantarflexion (deg)", 0, (12, 20), _AIM),
    Row("yaw_about_route_deg", "stance yaw about the route, SD (deg)", 1),
    Row("step_width_cm", "step width (cm)", 1, (8, 15), _AIM, True),
    # 2.4 +- 0.6 cm, young adults at their usual speed; +- 2 SD.
    Row("step_width_sd_cm", "step width SD (cm)", 1, (1.2, 3.6), "Almarwani et al. 2016"),
)


def judged() -> Iterable[Row]:
    """The rows of feet that are judged."""
    return (row for group, rows in FEET.items() if group != UNJUDGED for row in rows)


def spread(row: Row, real: Sequence[float]) -> tuple[float, float]:
    """Lowest and highest figure of the real feet; a distance may be 0, a share all of the stride."""
    values = np.asarray(real, dtype=float)
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    if row.key.startswith("distance"):
        low = 0.0
    if row.key.startswith("within"):
        high = 100.0
    return low, high


def inside(row: Row, value: float, low: float, high: float) -> bool:
    """Whether a figure lies within bounds, at the decimals it is worth. What is not a number does not."""
    low, high = low - row.slack, high + row.slack
    return round(low, row.decimals) <= round(value, row.decimals) <= round(high, row.decimals)


def verdict(row: Row, values: Sequence[float], low: float, high: float) -> str:
    """ "inside", "outside" or "k of n inside" over several simulated walks."""
    known = [value for value in values if np.isfinite(value)]
    count = sum(inside(row, value, low, high) for value in known)
    if not known:
        return ""
    if count in (0, len(known)):
        return "inside" if count else "outside"
    return f"{count} of {len(known)}"
