"""Which tracks are judged: how far off the walk's time they may be, and how much of it they may leave out."""

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.pdr.track import Track
from footfall.scenarios.judge.score import score
from tests.helpers.synthetic import synthetic_walk

WALK = synthetic_walk()
FIRST, LAST = WALK.footfalls.t[[0, -1]]


def track_at(*extra: float, begin: float = FIRST, end: float = LAST) -> Track:
    """The truth at the footfalls from `begin` to `end`, and at these `extra` times (s)."""
    falls = WALK.footfalls
    within = (falls.t >= begin - 1e-9) & (falls.t <= end + 1e-9)
    t = np.unique([*falls.t[within], begin, end, *extra])
    position = np.column_stack([np.interp(t, falls.t, falls.position[:, axis]) for axis in range(3)])
    return Track(t, position, np.interp(t, falls.t, falls.heading))


@pytest.mark.parametrize(
    ("inside", "outside"),
    [
        (track_at(WALK.t[0] - 0.099), track_at(WALK.t[0] - 0.101)),
        (track_at(WALK.t[-1] + 0.099), track_at(WALK.t[-1] + 0.101)),
    ],
    ids=["start", "end"],
)
def test_a_clock_may_run_off_by_a_tenth_of_a_second(inside, outside):
    assert score(inside, WALK).position_rmse_m < 0.5
    with pytest.raises(InputError, match="lies outside the walk"):
        score(outside, WALK)


@pytest.mark.parametrize(
    ("enough", "less"),
    [
        (track_at(begin=FIRST + 4.99), track_at(begin=FIRST + 5.01)),
        (track_at(end=LAST - 4.99), track_at(end=LAST - 5.01)),
    ],
    ids=["start", "end"],
)
def test_five_seconds_of_the_footfalls_may_be_left_out(enough, less):
    assert score(enough, WALK).distance_error_pct == pytest.approx(0, abs=2)
    with pytest.raises(InputError, match="covers only a part of the walk"):
        score(less, WALK)
