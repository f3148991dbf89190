"""What keeps the gait from being a metronome: seeded scatter of timing, step length, width and toe-out.

Per step: cadence N(0, 2.6 %) plus a slow AR(1) part (1.3 %, rho 0.9), hip excursion N(0, 3 %), step width
AR(1) about 1 cm, toe-out of the landing foot N(0, 2 deg); each slews within 120 ms.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

CADENCE_SD, CADENCE_SLOW_SD, CADENCE_SLOW_RHO = 0.026, 0.013, 0.9
AMPLITUDE_SD = 0.03
WIDTH_SD, WIDTH_RHO = 0.010, 0.5
TOE_OUT_SD = np.radians(2.0)
_SLEW_S = 0.12


@dataclass
class Variability:
    """Current and target modulation of n walkers; `level` (n,) scales every standard deviation."""

    level: np.ndarray

    def __post_init__(self) -> None:
        n = len(self.level)
        self.slow = np.zeros(n)
        # columns: cadence (relative), hip amplitude (relative), step width (m), toe-out right, left (rad)
        self.value = np.zeros((n, 5))
        self.target = np.zeros((n, 5))

    def reset(self, mask: np.ndarray) -> None:
        """Forget the modulation of the walkers in `mask`."""
        self.slow[mask] = 0
        self.value[mask] = 0
        self.target[mask] = 0

    def advance(
        self, new_step: np.ndarray, half: np.ndarray, interval: float, rng: np.random.Generator
    ) -> None:
        """Draw for walkers that begin a step and slew the rest.

        Parameters
        ----------
        new_step : (n,) bool
        half : (n,) 0 while the right foot stands (the left one swings), 1 otherwise
        interval : s since the last call
        """
        k = np.flatnonzero(new_step)
        if len(k):
            level, normal = self.level[k], rng.standard_normal((len(k), 5))
            rho = CADENCE_SLOW_RHO
            self.slow[k] = rho * self.slow[k] + normal[:, 0] * CADENCE_SLOW_SD * np.sqrt(1 - rho**2) * level
            self.target[k, 0] = np.clip(self.slow[k] + normal[:, 1] * CADENCE_SD * level, -0.09, 0.09)
            self.target[k, 1] = np.clip(normal[:, 2] * AMPLITUDE_SD * level, -0.1, 0.1)
            width = WIDTH_RHO * self.target[k, 2] + normal[:, 3] * WIDTH_SD * level
            self.target[k, 2] = np.clip(width, -0.03, 0.03)
            # The leg about to swing gets a new toe-out and keeps it through its next stance.
            self.target[k, 4 - half[k]] = np.clip(normal[:, 4] * TOE_OUT_SD * level, -0.1, 0.1)
        self.value += (self.target - self.value) * (interval / _SLEW_S)
