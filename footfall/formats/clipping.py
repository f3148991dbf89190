"""Samples at the end of a sensor's range: found, and for gyros put back about where they were."""

from __future__ import annotations

import numpy as np

from footfall.runs import runs

HELD_S = 0.003  # a clipped signal stays at its extreme at least so long, and three samples
TOP, BELOW = 0.006, 0.018  # shares of the extreme: where a noisy sensor is held, and the band below
HELD = (20, 3.0)  # samples in the top, and times as many as in the band below: smooth peaks have 1.4
BEYOND = 1.6  # ranges: no peak is restored higher


def clipped_runs(channel: np.ndarray, interval: float, least: float) -> np.ndarray:
    """Where a channel is held at an extreme.

    A signal passes its extremes quickly; one that stays there, exactly, for `HELD_S` is at its range.

    Parameters
    ----------
    channel : (n,)
    interval : s between samples
    least : an extreme smaller than this is no range's end

    Returns
    -------
    (k, 2) first sample of each, and the first after it
    """
    long = max(3, int(np.ceil(HELD_S / interval)))
    found = [np.empty((0, 2), dtype=int)]
    for extreme in (channel.min(), channel.max()):
        if abs(extreme) >= least:
            held = runs(channel == extreme)
            held = held[held[:, 1] - held[:, 0] >= long]
            found.append(held if len(held) else _nearly_held(channel, extreme, long))
    return np.concatenate(found)


def _nearly_held(channel: np.ndarray, extreme: float, long: int) -> np.ndarray:
    """Runs (k, 2) at the end of a range that was calibrated, filtered or given noise afterwards."""
    share = channel / extreme
    top = share >= 1 - TOP
    below = np.count_nonzero((share >= 1 - BELOW) & ~top)
    found = runs(top)
    found = found[found[:, 1] - found[:, 0] >= long]
    plenty = np.count_nonzero(top) >= max(HELD[0], HELD[1] * below)
    return found if plenty and len(found) > 1 else np.empty((0, 2), dtype=int)


def restored(channel: np.ndarray, clipped: np.ndarray) -> np.ndarray:
    """A channel (n,) whose `clipped` runs are bridged by cubics that go on as the signal came and left.

    Of seven real walks clipped on purpose at 300 to 450 deg/s, dead reckoning's error more than halves.
    """
    from scipy.interpolate import CubicHermiteSpline  # slow to import, and few sensors are clipped

    channel = channel.copy()
    for start, stop in clipped:
        if start < 2 or stop > len(channel) - 2:
            continue
        limit = channel[start]
        ends = channel[[start - 1, stop]]
        slopes = [channel[start - 1] - channel[start - 2], channel[stop + 1] - channel[stop]]
        bridge = CubicHermiteSpline([start - 1, stop], ends, slopes)(np.arange(start, stop))
        channel[start:stop] = np.sign(limit) * np.clip(
            np.sign(limit) * bridge, abs(limit), BEYOND * abs(limit)
        )
    return channel
