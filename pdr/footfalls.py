"""What dead reckoning hands to a heading method: one row a footfall."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from footfall.pdr.strides import Strides


@dataclass(frozen=True)
class Footfalls:
    """Stances of the instrumented foot, two steps apart.

    Row 0 is where the walk starts: its interval, distance and rate are 0. The strides are the rows after it.

    Attributes
    ----------
    t : (n,) s, the instant of each footfall
    interval : (n,) s, T_i of HDR Eq. 3
    distance : (n,) m, horizontal D_i of HDR Eq. 12
    rate : (n,) rad/s, raw_i of HDR Eq. 2: heading increment from stance to stance over T_i
    position : (n, 3) m, dead-reckoned
    heading : (n,) rad, unwrapped, of the IMU's x axis
    strides : what the samples say of loads, temperature and rests; None where no samples were reckoned
    """

    t: np.ndarray
    interval: np.ndarray
    distance: np.ndarray
    rate: np.ndarray
    position: np.ndarray
    heading: np.ndarray
    strides: Strides | None = None

    def __len__(self) -> int:
        return len(self.t)

    @classmethod
    def at(cls, t: np.ndarray, position: np.ndarray, heading: np.ndarray) -> Footfalls:
        """Footfalls at these times and places: the strides are what lies between them."""
        interval = np.diff(t, prepend=t[0])
        steps = np.diff(position, axis=0, prepend=position[:1])
        rate = np.zeros_like(t)
        rate[1:] = np.diff(heading) / interval[1:]
        return cls(
            t=t,
            interval=interval,
            distance=np.hypot(*steps[:, :2].T),
            rate=rate,
            position=position,
            heading=heading,
        )
