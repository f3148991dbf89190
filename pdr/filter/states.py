"""What the filter knows at some instants."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from footfall.late import late
from footfall.pdr.filter.layout import STATE

kernels = late("footfall.pdr.filter._kernels")


@dataclass(frozen=True)
class States:
    """The state at some instants.

    Attributes
    ----------
    t : (k,) s
    state : (k, n) in the order of `footfall.pdr.filter.layout.STATE`
    covariance : (k, states, states) of delta = truth - estimate, in the order of `FilterSettings.layout`
    """

    t: np.ndarray
    state: np.ndarray
    covariance: np.ndarray

    @classmethod
    def joined(cls, parts: Sequence[States]) -> States:
        """The instants of all parts."""
        return cls(
            t=np.concatenate([one.t for one in parts]),
            state=np.concatenate([one.state for one in parts]),
            covariance=np.concatenate([one.covariance for one in parts]),
        )

    @property
    def position(self) -> np.ndarray:
        """(k, 3) m, world."""
        return self.state[:, STATE["position"]]

    @property
    def accel_bias(self) -> np.ndarray:
        """(k, 3) m/s2, body."""
        return self.state[:, STATE["accel_bias"]]

    @property
    def gyro_bias(self) -> np.ndarray:
        """(k, 3) rad/s, body."""
        return self.state[:, STATE["gyro_bias"]]

    @property
    def heading(self) -> np.ndarray:
        """(k,) rad from -pi to pi, of the IMU's x axis."""
        return heading(*self.state[:, STATE["quaternion"]].T)

    @property
    def heading_sd(self) -> np.ndarray:
        """(k,) rad, standard deviation of the heading."""
        variances = [kernels.heading_variance(*one) for one in zip(self.state, self.covariance, strict=True)]
        return np.sqrt(np.array(variances))


def heading(w: Any, x: Any, y: Any, z: Any) -> Any:
    """Heading of the body's x axis (rad from -pi to pi); `conventions.heading_of`, but not unwrapped."""
    return np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
