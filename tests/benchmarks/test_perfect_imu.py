"""The benchmark of what a perfect IMU leaves."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchmarks.validation import perfect_imu
from footfall.scenarios.judge.score import compare
from footfall.scenarios.scenario import load_scenario
from footfall.scenarios.trial import Trial, perform, setup, walk_of
from tests.benchmarks.test_benchmarks import own_cache, short

__all__ = ["own_cache", "short"]


def test_a_perfect_imu_has_no_bias_that_a_scenario_gives() -> None:
    assert load_scenario("ihde-test1").sensor.bias_shift_deg_s > 0
    assert perfect_imu.without_bias("ihde-test1").sensor.bias_shift_deg_s == 0


def test_a_perfect_imu_leaves_what_is_the_methods_own(short: str, tmp_path: Path) -> None:
    """On a short walk next to nothing, and a track that is turned by 5 deg is told as it is."""
    trial = Trial(setup(load_scenario(short), imu="perfect", methods=["pdr"]), 0, 1, 1, 1)
    walk = walk_of(trial)
    assert [one.method for one in perfect_imu.measure(trial)] == ["pdr"]
    track = perform(trial, walk, keep=True).kept.tracks["pdr"]
    own = perfect_imu.own("short", 1, "pdr", track, walk)
    assert own.first_heading_deg < 0.01
    assert abs(own.distance_error_pct) < 0.5
    turned = replace(track, heading=track.heading + np.radians(5))
    off = perfect_imu.own("short", 1, "pdr", turned, walk)
    assert off.first_heading_deg == pytest.approx(5, abs=0.01)
    moved = replace(track, position=track.position + np.array([0.0, 10.0, 0.0]))
    walked = np.hypot(*np.diff(compare(track, walk).truth, axis=0).T).sum()
    far = perfect_imu.own("short", 1, "pdr", moved, walk).largest_position_pct
    assert far == pytest.approx(1000 / walked, rel=0.05)
