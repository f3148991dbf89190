"""Two methods: a function, and a dataclass whose fields are its parameters."""

from dataclasses import dataclass

import numpy as np

from footfall import Track
from footfall.hdr.correct import turned_positions
from footfall.pdr.reckoning import dead_reckon
from footfall.settings import setting


def straightened(footfalls, start):
    """The walk ends as it began: whatever the heading gained on the way is taken for drift."""
    gained = footfalls.heading[-1] - footfalls.heading[0]
    share = (footfalls.t - footfalls.t[0]) / (footfalls.t[-1] - footfalls.t[0])
    heading = footfalls.heading - gained * share
    return Track(t=footfalls.t, position=turned_positions(footfalls, heading), heading=heading)


straightened.needs = "footfalls"


@dataclass(frozen=True)
class SteadyPace:
    """The gyro's heading, and strides that are all of one length."""

    stride_m: float = setting(1.4, unit="m", gt=0, le=3)
    yaw: float = setting(0.0, unit="rad")

    def __call__(self, recording, start):
        feet = dead_reckon(recording, start=start)
        course = (feet.heading[1:] + feet.heading[:-1]) / 2 + self.yaw
        steps = self.stride_m * np.column_stack([np.cos(course), np.sin(course), np.zeros_like(course)])
        position = np.vstack([feet.position[:1], feet.position[0] + np.cumsum(steps, axis=0)])
        return Track(t=feet.t, position=position, heading=feet.heading)
