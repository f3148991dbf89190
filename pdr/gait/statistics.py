"""Statistics of a foot's strides: timing, swing, landing, stance, and how regular they are."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from scipy.integrate import trapezoid

from footfall.conventions import GRAVITY
from footfall.pdr.gait.strides import QUIET_S, RATE_HZ, STILL_RATE, Foot, Stride

FEWEST = 8  # strides that a standard deviation is taken of
PUSH_OFF_S = 0.20  # before the peak of the pitch rate: the acceleration of push-off lies within
SIGNALS = ("gyro x", "gyro y", "gyro z", "gyro norm", "accel x", "accel y", "accel z", "accel norm")


def longest_still(rate: np.ndarray) -> slice:
    """The longest run of a rate (n,) rad/s below `STILL_RATE`; empty where there is none."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], rate < STILL_RATE, [False]]))).reshape(-1, 2)
    if len(edges) == 0:
        return slice(0, 0)
    start, stop = edges[np.argmax(edges[:, 1] - edges[:, 0])]
    return slice(int(start), int(stop))


def quietest(rate: np.ndarray, inside: slice) -> slice:
    """The `QUIET_S` with the lowest mean rate that begin in `inside` or half their length before it."""
    n = round(QUIET_S * RATE_HZ)
    first, last = max(inside.start - n // 2, 0), min(inside.stop + n // 2, len(rate))
    if last - first < n:
        return slice(0, 0)
    means = np.convolve(rate[first:last], np.ones(n) / n, mode="valid")
    start = first + int(np.argmin(means))
    return slice(start, start + n)


def per_axis_sd(values: np.ndarray) -> float:
    """Standard deviation of (n, 3) samples, root mean square over the axes; nan without samples."""
    return float(np.sqrt(np.mean(np.var(values, axis=0)))) if len(values) else float("nan")


def _mean(values: np.ndarray) -> float:
    return float(values.mean()) if len(values) else float("nan")


def stride_figures(foot: Foot, stride: Stride) -> dict[str, float]:
    """Figures of one stride, from crossing to crossing (see `Stride`); their names carry the unit.

    Returns
    -------
    dict
        `stride_s`, `stride_m`: duration and length. `still_pct`: of the stride below `STILL_RATE`.
        `push_off_deg_s`, `swing_deg_s`: largest pitch rates, toes down at push-off and toes up in swing.
        `swing_peak_pct`, `landing_pct`: of the stride, after the crossing between them; landing is where the
        pitch rate changes back. `roll_deg_s`, `yaw_deg_s`: RMS rates.
        `toe_down_deg`, `toe_up_deg`: largest pitch of the sole either way.
        `heel_strike_m_s2` with its forward and upward part (`_x_`, `_z_`), `push_off_m_s2`: largest forces.
        `mid_gyro_deg_s`: mean norm of the rate in the middle half of the still time, `mid_*_sd_*`: SD of its
        samples, RMS over the axes; `quiet_*`: the same over the quietest 0.1 s.
    """
    begin = round(stride.crossing - stride.duration * RATE_HZ)
    end = round(stride.crossing)
    gyro, accel = foot.signals.gyro[begin : stride.last + 1], foot.signals.accel[begin : stride.last + 1]
    rate, force = np.linalg.norm(gyro, axis=1), np.linalg.norm(accel, axis=1)
    cycle = slice(0, end - begin)
    still = longest_still(rate[cycle])
    quarter = (still.stop - still.start) // 4
    middle = slice(still.start + quarter, still.stop - quarter)
    quiet = quietest(rate[cycle], still)
    push_off, swing = stride.push_off - begin, stride.swing - begin
    landing = swing + int(np.argmax(gyro[swing:, 1] > 0))
    lean = np.degrees(np.arcsin(np.clip(stride.up[:, 0], -1, 1)))

    def percent(rows: float) -> float:
        return 100 * rows / (end - begin)

    return {
        "stride_s": stride.duration,
        "stride_m": float(np.hypot(*stride.step[:2])),
        "still_pct": percent(still.stop - still.start),
        "push_off_deg_s": float(np.degrees(gyro[push_off, 1])),
        "swing_deg_s": float(-np.degrees(gyro[swing, 1])),
        "swing_peak_pct": percent(stride.swing - stride.crossing),
        "landing_pct": percent(begin + landing - stride.crossing),
        "roll_deg_s": float(np.degrees(np.sqrt(np.mean(gyro[cycle, 0] ** 2)))),
        "yaw_deg_s": float(np.degrees(np.sqrt(np.mean(gyro[cycle, 2] ** 2)))),
        "toe_down_deg": float(-lean.min()),
        "toe_up_deg": float(lean.max()),
        "heel_strike_m_s2": float(force[swing:].max()),
        "heel_strike_x_m_s2": float(accel[swing:, 0].max()),
        "heel_strike_z_m_s2": float(accel[swing:, 2].max()),
        "push_off_m_s2": float(force[max(push_off - round(PUSH_OFF_S * RATE_HZ), 0) : swing].max()),
        "mid_gyro_sd_deg_s": float(np.degrees(per_axis_sd(gyro[middle]))),
        "mid_accel_sd_m_s2": per_axis_sd(accel[middle]),
        "mid_gyro_deg_s": float(np.degrees(_mean(rate[middle]))),
        "quiet_gyro_deg_s": float(np.degrees(_mean(rate[quiet]))),
        "quiet_gyro_sd_deg_s": float(np.degrees(per_axis_sd(gyro[quiet]))),
        "quiet_accel_sd_m_s2": per_axis_sd(accel[quiet]),
    }


def rectified(foot: Foot) -> np.ndarray:
    """(3, 3) heading rate per unit of g-sensitivity G_ij (deg/s per deg/s/g): gyro i, accelerometer j.

    mean(C_zi f_j) - mean(C_zi) f_j,standing over whole strides: f in g, C_z the vertical in the foot's axes.
    """
    product, vertical, samples = np.zeros((3, 3)), np.zeros(3), 0
    for stride in foot.strides:
        accel = foot.signals.accel[stride.first : stride.last + 1]
        product += trapezoid(stride.up[:, :, None] * accel[:, None, :], axis=0)
        vertical += trapezoid(stride.up, axis=0)
        samples += stride.last - stride.first
    # The foot's axes are level when it stands: then the force is g along z.
    standing = np.array([0.0, 0.0, GRAVITY])
    return (product / samples - np.outer(vertical / samples, standing)) / GRAVITY


def stance_yaw(strides: Sequence[Stride]) -> np.ndarray:
    """(m,) rad, a standing foot's heading about the direction of travel through it; toes out is negative.

    The direction at a footfall is that from the footfall before it to the one after it, where both strides
    are steady.
    """
    off = []
    for before, after in pairwise(strides):
        if before.last != after.first:
            continue
        cos, sin = np.cos(before.turn), np.sin(before.turn)
        x, y = before.step[:2]  # in the heading of its start: turned into that of its end
        both = np.array([cos * x + sin * y, -sin * x + cos * y]) + after.step[:2]
        off.append(-np.arctan2(both[1], both[0]))
    return np.array(off)


def _sd(values: np.ndarray) -> float:
    return float(np.std(values, ddof=1)) if len(values) >= FEWEST else float("nan")


def foot_figures(foot: Foot) -> dict[str, float]:
    """Figures of a foot: medians of `stride_figures` over its steady strides, and how regular they are.

    Returns
    -------
    dict
        Beside the medians: `strides`: how many. `speed_m_s`. `walk_ratio_mm_min`: step length over cadence.
        `stride_sd_ms`, `stride_length_sd_cm`, `yaw_scatter_deg` (`stance_yaw`): standard deviations, NaN of
        fewer than `FEWEST`. `g_ij`: `rectified`, gyro axis i, accelerometer axis j.
    """
    each = [stride_figures(foot, stride) for stride in foot.strides]
    times, lengths = (np.array([row[name] for row in each]) for name in ("stride_s", "stride_m"))
    matrix = rectified(foot)
    return {
        "strides": len(each),
        "speed_m_s": float(lengths.sum() / times.sum()),
        "walk_ratio_mm_min": float(1e3 * np.median(lengths / 2 / (120 / times))),
        **{name: float(np.nanmedian([row[name] for row in each])) for name in each[0]},
        "stride_sd_ms": 1e3 * _sd(times),
        "stride_length_sd_cm": 1e2 * _sd(lengths),
        "yaw_scatter_deg": float(np.degrees(_sd(stance_yaw(foot.strides)))),
        **{f"g_{a}{b}": float(matrix[i, j]) for i, a in enumerate("xyz") for j, b in enumerate("xyz")},
    }


def bands(strides: np.ndarray) -> dict[str, float]:
    """How far a foot's strides scatter about their mean.

    Parameters
    ----------
    strides : (strides, phases, 8), as of `normalised`

    Returns
    -------
    dict
        `band SIGNAL`: standard deviation, RMS over the stride (deg/s, m/s2); NaN of fewer than `FEWEST`.
    """
    if len(strides) < FEWEST:
        return {f"band {signal}": float("nan") for signal in SIGNALS}
    wide = np.sqrt(np.mean(np.var(strides, axis=0, ddof=1), axis=0))
    return {
        f"band {signal}": float(np.degrees(sd) if signal.startswith("gyro") else sd)
        for signal, sd in zip(SIGNALS, wide, strict=True)
    }
