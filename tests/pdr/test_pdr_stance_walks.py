"""Stances found by the detector against the strides that the simulator counted, slow to fast."""

import math

import numpy as np
import pytest

from footfall.models.imu import draw_unit, load_spec
from footfall.pdr.stance import StanceParams, ThresholdDetector, find_stances
from footfall.scenarios.path import PathSpec, build_path
from footfall.simulate.cache import cached_walk
from footfall.simulate.plan import Gait, Plan
from footfall.simulate.record import record

PACES = (0.7, 1.0, 1.35, 1.7)
STILL = 2.0  # s


@pytest.fixture(scope="module")
def walks():
    """25 m straight ahead at each pace, as people walk."""
    elements = [{"kind": "straight", "length_m": 25.0}]
    route = build_path(PathSpec.model_validate({"elements": elements})).route
    return {
        pace: cached_walk(Plan("paces", route, gait=Gait(pace_m_s=pace), calibration_s=STILL, seed=5))
        for pace in PACES
    }


def stances_per_stride(walk, imu="nimu", detector=None, params=None):
    """How many stances the detector finds around each true footfall but the first two and the last four.

    Where the walk sets out and stops the foot is put down and shifted more than once.
    """
    recording = record(walk, draw_unit(load_spec(imu), 1), seed=1)
    t, gyro = recording.t[1:], recording.gyro[1:]
    gyro = gyro - gyro[t < STILL].mean(axis=0)
    found = find_stances(t, (detector or ThresholdDetector())(t, gyro, recording.accel[1:]), params)
    true = walk.footfalls.t[1:-3]
    between = (true[1:] + true[:-1]) / 2
    return np.histogram(t[found.resets[found.footfalls]], between)[0]


@pytest.mark.parametrize("imu", ["perfect", "nimu"])
@pytest.mark.parametrize("pace", PACES)
def test_every_stride_has_one_stance(walks, pace, imu):
    found = stances_per_stride(walks[pace], imu)
    assert len(found) >= 12
    assert (found == 1).all()


def test_the_rate_threshold_has_room_on_both_sides(walks):
    """A third of it misses the brisk walker's stances, three times it takes the slow one's swing for rest."""
    low, high = (ThresholdDetector(gyro_max=factor * math.radians(60.0)) for factor in (1 / 3, 3.0))
    assert (stances_per_stride(walks[1.7], detector=low) == 0).sum() >= 3
    assert (stances_per_stride(walks[0.7], detector=high) > 1).sum() >= 3
    for factor in (0.8, 1.2):
        some = ThresholdDetector(gyro_max=factor * math.radians(60.0))
        assert (stances_per_stride(walks[1.35], detector=some) == 1).all()


def test_the_shortest_stance_has_room_on_both_sides(walks):
    """A fifth of it lets the slow walker's swing in, four times it outlasts the brisk walker's stances."""
    assert (stances_per_stride(walks[0.7], params=StanceParams(min_stance_s=0.02)) > 1).sum() >= 3
    assert (stances_per_stride(walks[1.7], params=StanceParams(min_stance_s=0.4)) == 0).sum() >= 3


def test_the_shortest_stride_is_shorter_than_any(walks):
    """Three times it skips strides at every pace but the slowest."""
    for pace in PACES[1:]:
        assert (stances_per_stride(walks[pace], params=StanceParams(min_stride_s=1.2)) == 0).sum() >= 3
