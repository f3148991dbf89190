"""A plan in the units of the walker's body: the same walk to another scale of lengths and times."""

from dataclasses import replace

import numpy as np
import pytest

from footfall.models.body import Ground
from footfall.models.subject import Subject
from footfall.simulate.plan import Disturbance, Gait, Pace, Stop, shrunk


@pytest.mark.parametrize("height", [1.55, 1.90])
def test_lengths_and_times_shrink_and_what_is_drawn_or_recorded_does_not(short_plan, height):
    """Lengths over s, times and speeds over sqrt(s), curvature times s; angles and grades as they are."""
    subject = Subject("somebody", height_m=height)
    plan = replace(
        short_plan,
        subject=subject,
        ground=Ground(-4.0, -6.0, 0.5, np.full((3, 4), 0.2, dtype=np.float32)),
        gait=Gait(1.4, 0.9, 0.8, 0.7, 0.6, 0.1, 0.2, 5.0),
        paces=(Pace(10.0, 1.2),),
        stops=(Stop(20.0, 6.0),),
        disturbance=Disturbance(3.0, 7.0),
    )
    small, s = shrunk(plan), height / 1.75
    root = np.sqrt(s)
    for name, factor in (
        ("s", 1 / s),
        ("x", 1 / s),
        ("y", 1 / s),
        ("z", 1 / s),
        ("heading", 1),
        ("curvature", s),
    ):
        np.testing.assert_allclose(getattr(small.route, name), getattr(plan.route, name) * factor)
    assert (small.ground.x0, small.ground.y0, small.ground.cell) == pytest.approx((-4 / s, -6 / s, 0.5 / s))
    np.testing.assert_allclose(small.ground.heights, 0.2 / s, rtol=1e-6)
    assert small.gait == replace(plan.gait, pace_m_s=1.4 / root, wander_m=0.2 / s, wander_time_s=5.0 / root)
    assert (small.paces, small.stops) == ((Pace(10 / s, 1.2 / root),), (Stop(20 / s, 6 / root),))
    for name in ("subject", "mount", "disturbance", "calibration_s", "rate_hz", "seed"):
        assert getattr(small, name) == getattr(plan, name)
