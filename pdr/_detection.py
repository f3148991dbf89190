"""Compiled detection. The faces that explain and check are stance.py and detectors.py, the twin _plain.py.

Sums run on from the record's first sample, as `numpy.cumsum` does: a window's sum is the difference of two of
them, and the scores are those of the twin to the last bit. Stamps increase.
"""

from __future__ import annotations

import math

import numpy as np

from footfall.compiled import kernel
from footfall.conventions import GRAVITY

SLACK = 1e-6  # s; stamps are decimal numbers: a sample on the window's edge counts
BARELY = math.nextafter(1.0, 0.0)  # at rest, but no candidate for the quietest instant
_PART = 256  # samples: divisions and roots of so many are taken side by side


@kernel(nogil=True)
def less(values, bias):  # type: ignore[no-untyped-def]
    """(n, 3) values less (3,) bias."""
    out = np.empty(values.shape)
    for k in range(len(values)):
        for i in range(3):
            out[k, i] = values[k, i] - bias[i]
    return out


@kernel(nogil=True, error_model="numpy")
def _size(x, y, z, count):  # type: ignore[no-untyped-def]
    """Length of the mean of `count` vectors, from their sum."""
    x, y, z = x / count, y / count, z / count
    return math.sqrt(x * x + y * y + z * z)


@kernel(nogil=True, error_model="numpy")
def threshold(t, gyro, accel, window_s, gyro_max, accel_max):  # type: ignore[no-untyped-def]
    """Score (n,) of `ThresholdDetector`, and whether all sums were finite: else it means nothing."""
    n, half = len(t), window_s / 2
    score = np.empty(n)
    sums, count = np.empty((6, _PART)), np.empty(_PART)
    low = high = 0
    # Sums up to the window's end, and up to its beginning: rate, then force.
    ax = ay = az = bx = by = bz = 0.0
    cx = cy = cz = dx = dy = dz = 0.0
    for first in range(0, n, _PART):
        part = min(_PART, n - first)
        for j in range(part):
            begin, end = t[first + j] - half - SLACK, t[first + j] + half + SLACK
            while high < n and t[high] < end:
                ax, ay, az = ax + gyro[high, 0], ay + gyro[high, 1], az + gyro[high, 2]
                bx, by, bz = bx + accel[high, 0], by + accel[high, 1], bz + accel[high, 2]
                high += 1
            while t[low] < begin:
                cx, cy, cz = cx + gyro[low, 0], cy + gyro[low, 1], cz + gyro[low, 2]
                dx, dy, dz = dx + accel[low, 0], dy + accel[low, 1], dz + accel[low, 2]
                low += 1
            sums[0, j], sums[1, j], sums[2, j] = ax - cx, ay - cy, az - cz
            sums[3, j], sums[4, j], sums[5, j] = bx - dx, by - dy, bz - dz
            count[j] = high - low
        for j in range(part):
            rate = _size(sums[0, j], sums[1, j], sums[2, j], count[j]) / gyro_max
            force = abs(_size(sums[3, j], sums[4, j], sums[5, j], count[j]) - GRAVITY) / accel_max
            score[first + j] = rate if rate > force else force
    return score, math.isfinite(ax + ay + az + bx + by + bz)


@kernel(nogil=True, error_model="numpy")
def means(t, gyro, accel, window_s):  # type: ignore[no-untyped-def]
    """Over the window that begins at each sample, and whether all sums were finite: else they mean nothing.

    Rows of the means (6, n): force along x, y, z, its square, the square of the rate, and that of the
    deviation of the force's length from g.
    """
    n = len(t)
    out = np.empty((6, n))
    total = np.zeros((n + 1, 6))
    for k in range(n):
        x, y, z = accel[k, 0], accel[k, 1], accel[k, 2]
        force = x * x + y * y + z * z
        off = math.sqrt(force) - GRAVITY
        rate = gyro[k, 0] * gyro[k, 0] + gyro[k, 1] * gyro[k, 1] + gyro[k, 2] * gyro[k, 2]
        for i, value in enumerate((x, y, z, force, rate, off * off)):
            total[k + 1, i] = total[k, i] + value
    stop = 0
    for k in range(n):
        end = t[k] + window_s + SLACK
        while stop < n and t[stop] < end:
            stop += 1
        for i in range(6):
            out[i, k] = (total[stop, i] - total[k, i]) / (stop - k)
    return out, math.isfinite(total[n].sum())


@kernel(nogil=True)
def held(t, value, window_s):  # type: ignore[no-untyped-def]
    """Score (n,) from the value of the window that begins at each sample.

    It is that of the window about the sample; at rest is the sample if any window that holds it is.
    """
    score = np.empty(len(t))
    first = about = 0
    still = -1  # the last window at rest
    for k in range(len(t)):
        while t[first] < t[k] - window_s - SLACK:
            first += 1
        while t[about] < t[k] - window_s / 2 - SLACK:
            about += 1
        if value[k] < 1.0:
            still = k
        score[k] = BARELY if value[about] >= 1.0 and still >= first else value[about]
    return score


@kernel(nogil=True)
def stances(t, score, min_stance_s, min_stride_s, reset_s):  # type: ignore[no-untyped-def]
    """Samples of the instants of zero velocity, and which of them are footfalls (`stance.Stances`)."""
    n = len(t)
    resets, last = np.empty(n, np.int64), np.empty(n, np.int64)
    m = count = stop = 0  # resets, stances
    quietest = math.inf  # of the latest stance
    while True:
        start = stop
        while start < n and not score[start] < 1.0:
            start += 1
        stop = start
        while stop < n and score[stop] < 1.0:
            stop += 1
        if start == n:
            return resets[:m].copy(), last[:count].copy()
        duration = t[stop - 1] - t[start]
        if duration < min_stance_s:
            continue
        # The quietest instant of a stance, or of each part of a still period.
        parts = int(duration / reset_s) if duration > 2 * reset_s else 1
        begin, end, quiet = m, start, math.inf
        for part in range(1, parts + 1):
            origin = place = end
            bound = t[start] + part * (duration / parts)
            while end < stop and (part == parts or t[end] < bound):
                if score[end] < score[place]:
                    place = end
                end += 1
            if end > origin:  # a gap in the samples may leave a part empty
                resets[m] = place
                quiet = min(quiet, score[place])
                m += 1
        if count and t[resets[begin]] - t[resets[begin - 1]] < min_stride_s:
            # Two stances too close are one: the quieter.
            before = last[count - 2] + 1 if count > 1 else 0
            if quiet >= quietest:
                m = begin
                continue
            for i in range(m - begin):
                resets[before + i] = resets[begin + i]
            m, count = before + m - begin, count - 1
        quietest = quiet
        last[count] = m - 1
        count += 1
