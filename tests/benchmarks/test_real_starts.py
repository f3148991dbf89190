"""How still real feet lie: spans and angles on a foot whose angles are known."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.validation.real_starts import last_stance, setting_out
from footfall.pdr.gait.strides import RATE_HZ

BIAS = np.radians([0.3, -0.5, 0.4])


def gyro(times, pitch, yaw):
    """Rates (n, 3) rad/s of a foot whose elevation and yaw (deg) go linearly through these at these times."""
    t = np.arange(times[0], times[-1], 1 / RATE_HZ)
    turned = np.radians([0 * t, -np.interp(t, times, pitch), np.interp(t, times, yaw)])
    return np.gradient(turned, 1 / RATE_HZ, axis=1).T + BIAS


def test_setting_out_counts_until_the_heel_rises():
    times = [0, 3, 3.2, 3.4, 3.6, 3.7, 4.0]
    # Toes up by 1.5, down by 0.8, half of it back, then the heel rises.
    turned = setting_out(gyro(times, [0, 0, 1.5, -0.8, -0.4, -1.4, -40], [0, 0, 0.5, -0.7, -0.7, -0.7, -0.7]))
    assert [turned.twist, turned.up, turned.down] == pytest.approx([0.7, 1.5, 0.8], abs=0.06)


def test_the_last_stance_counts_from_a_level_foot_and_from_its_pose_at_the_end():
    times = [0, 3, 3.2, 4.0, 4.2, 4.4, 4.6, 5.0, 9.0]
    # The heel rises, the foot lands 25 deg toes up, rocks to 4 deg toes down and back to 1 deg.
    found = last_stance(gyro(times, [0, 0, -40, 26, -3, 4, 1, 1, 1], [0, 0, 10, 9, 6, 3, 3, 3, 3]))
    assert [found.up, found.down] == pytest.approx([3.0, 4.0], abs=0.2)
    assert found.twist == pytest.approx(6.0 + 3.0 / 29 * 7 - 3.0, abs=0.2)


def test_a_foot_that_lies_still_has_turned_by_nothing():
    walk = gyro([0, 3, 3.2, 4.0, 4.2, 9.0], [0, 0, -40, 26, 0, 0], [0, 0, 10, 9, 0, 0])
    found = last_stance(walk)
    assert found.down == pytest.approx(0, abs=0.1)
    assert found.up <= 3.0
