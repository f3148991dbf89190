"""What only a simulated walker tells: ground force, support, step width, ankles, speed and cadence."""

from __future__ import annotations

import numpy as np
from scipy.signal import butter, sosfiltfilt

from benchmarks.validation._gait_walks import Motion
from footfall.conventions import heading_of
from footfall.simulate.plan import PHYSICS_STEP

LOADED = 0.03  # body weights: less is no support
SHORTEST_S = 0.25  # of a stance; shorter contacts are scuffs
BRIDGED_S = 0.05
HUMPS_HZ = 20.0  # above lies the heel-strike spike, not the double hump
SPIKE_S = 0.05  # after contact
SKIPPED = 3  # strides at either end: starting and stopping


def stances(load: np.ndarray) -> np.ndarray:
    """(m, 2) first and one-past-last row of each stance of a foot that carries `load` (n,) body weights."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], load > LOADED, [False]]))).reshape(-1, 2)
    if len(edges) == 0:
        return edges
    apart = (edges[1:, 0] - edges[:-1, 1]) * PHYSICS_STEP > BRIDGED_S
    edges = np.column_stack([edges[np.r_[True, apart], 0], edges[np.r_[apart, True], 1]])
    return edges[(edges[:, 1] - edges[:, 0]) * PHYSICS_STEP > SHORTEST_S]


def ground_force(load: np.ndarray) -> dict[str, float]:
    """Humps, valley and spike of one stance's vertical force (n,), in body weights."""
    margin = 200
    low_pass = butter(2, HUMPS_HZ, fs=1 / PHYSICS_STEP, output="sos")
    smooth = sosfiltfilt(low_pass, np.pad(load, margin))[margin:-margin]
    half = len(load) // 2
    first, second = int(np.argmax(smooth[:half])), half + int(np.argmax(smooth[half:]))
    return {
        "first_hump_bw": float(smooth[first]),
        "valley_bw": float(smooth[first : second + 1].min()),
        "second_hump_bw": float(smooth[second]),
        "spike_bw": float(load[: round(SPIKE_S / PHYSICS_STEP)].max()),
    }


def step_widths(times: np.ndarray, y: np.ndarray, left: np.ndarray) -> np.ndarray:
    """(m - 2,) m: each stance's distance from the line through the stances of the other foot beside it.

    Parameters
    ----------
    times, y, left : (m,) of alternating stances along the x axis: when, where across, and which foot
    """
    share = (times[1:-1] - times[:-2]) / (times[2:] - times[:-2])
    line = y[:-2] + share * (y[2:] - y[:-2])
    return (y[1:-1] - line) * np.where(left[1:-1], 1.0, -1.0)


def walk_figures(motion: Motion) -> dict[str, float]:
    """Figures of the walk's middle; medians over the stances of both feet."""
    feet = [stances(motion.load[:, side]) for side in (0, 1)]
    begin, end = feet[0][SKIPPED, 0], feet[0][-SKIPPED, 0]
    strides = int(np.sum((feet[0][:, 0] >= begin) & (feet[0][:, 0] < end)))
    seconds, distance = (end - begin) * PHYSICS_STEP, float(motion.foot[end, 0] - motion.foot[begin, 0])
    loaded = motion.load[begin:end] > LOADED

    forces, extended, placed = [], [], []
    heading = heading_of(motion.foot[:, 3:])
    for side in (0, 1):
        for first, last in feet[side]:
            if not begin <= first < last <= end:
                continue
            forces.append(ground_force(motion.load[first:last, side]))
            # The ankle is most extended shortly about toe-off.
            extended.append(motion.ankle[last - 150 : last + 100, side].min())
            middle = (first + last) // 2
            placed.append((middle, motion.feet[middle, side, 1], side))
    times, y, left = np.array(sorted(placed)).T
    flat = times[left == 0].astype(int)
    widths = step_widths(times, y, left == 1)
    cadence, stride = 120 * strides / seconds, distance / strides
    return {
        "asked_m_s": motion.case.pace,
        "speed_m_s": distance / seconds,
        "cadence_steps_min": cadence,
        "stride_length_m": stride,
        "walk_ratio_mm_min": 1e3 * stride / 2 / cadence,
        "stance_pct": 100 * float(loaded.mean()),
        "double_support_pct": 100 * float(loaded.all(axis=1).mean()),
        **{name: float(np.median([force[name] for force in forces])) for name in forces[0]},
        "plantarflexion_deg": -float(np.degrees(np.median(extended))),
        "yaw_about_route_deg": float(np.degrees(np.std(heading[flat], ddof=1))),
        "step_width_cm": 100 * float(np.median(widths)),
        "step_width_sd_cm": 100 * float(widths.std(ddof=1)),
    }
