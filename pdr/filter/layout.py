"""Where each quantity stands in the filter's state and in its error: lengths are written here, and once.

The error delta = truth - estimate is what the covariance is of. The attitude is a quaternion in the state,
four numbers, and three in the error: small angles phi about the axes of the navigation frame.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

# What is estimated only where it is asked for comes last: without it both simply end before.
_ERROR = {"position": 3, "velocity": 3, "attitude": 3, "accel_bias": 3, "gyro_bias": 3, "g_sensitivity": 9}
_STATE = {"quaternion": 4, "velocity": 3, "position": 3, "accel_bias": 3, "gyro_bias": 3, "g_sensitivity": 9}


def slices(lengths: Mapping[str, int]) -> Mapping[str, slice]:
    """A slice for each name, one after the other."""
    stops = [sum(list(lengths.values())[: place + 1]) for place in range(len(lengths))]
    return MappingProxyType(
        {name: slice(stop - lengths[name], stop) for name, stop in zip(lengths, stops, strict=True)}
    )


def error_slices(g_sensitivity: bool) -> Mapping[str, slice]:
    """Where each error stands that a filter estimates, with g-sensitivity or without."""
    return slices({name: size for name, size in _ERROR.items() if g_sensitivity or name != "g_sensitivity"})


ERROR, STATE = slices(_ERROR), slices(_STATE)
POSITION, VELOCITY, ATTITUDE, ACCEL_BIAS, GYRO_BIAS, G_SENSITIVITY = ERROR.values()
HEADING = ATTITUDE.stop - 1  # the attitude error about the vertical
STATES = max(part.stop for part in STATE.values())


class Measurement(NamedTuple):
    """z = H dx + noise, of rows that are independent of one another.

    Attributes
    ----------
    z : (m,) innovation, truth - estimate
    h : (m, states)
    r : (m,) variances of the noise
    """

    z: np.ndarray
    h: np.ndarray
    r: np.ndarray
