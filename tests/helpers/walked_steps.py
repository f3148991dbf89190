"""Steps as the filter would tell them, walked along given courses by a foot that points beside them."""

import math

import numpy as np

from footfall.pdr.filter.run import Step

DEG = math.pi / 180
T = 1.1  # s, of a stride


def walked(course, toe_out=0.0, *, length=1.4, drift=0.0, yaw_off=0.0, stride_time=T):
    """A step for each course (rad).

    At a stance the foot points midway between the strides before and after it, and `toe_out` and `yaw_off`
    (rad) further to the left. `drift` (rad a step) is how far the navigation's heading runs away.
    """
    course = np.asarray(course, dtype=float)
    wrong = drift * np.arange(1, len(course) + 1)
    # the foot at the ends of each stride: their mean is that of the stride, as in a steady curve
    after = np.append(course[1:], 2 * course[-1] - course[-2] if len(course) > 1 else course)
    yaw = (course + after) / 2 + toe_out + yaw_off + wrong
    told = course + wrong - drift / 2
    stride = length * np.column_stack([np.cos(told), np.sin(told), np.zeros_like(told)])
    position = np.cumsum(stride, axis=0)
    return [told_step(i + 1, float(yaw[i]), stride_time, position[i], stride[i]) for i in range(len(course))]


def told_step(index, heading, stride_time, position, stride):
    """A step by a filter that is sure of its heading to a degree."""
    return Step(
        index=index,
        t=T * index,
        heading=heading,
        stride_time=stride_time,
        still_time=0.4,
        position=position,
        stride=stride,
        heading_sd=DEG,
        covariance=DEG**2 * np.eye(15),
    )
