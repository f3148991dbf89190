"""What keeps the gait from being a metronome: seeded scatter of timing, step length, width and toe-out.

Per step: cadence N(0, 2.6 %) plus a slow AR(1) part (1.3 %, rho 0.9), hip excursion N(0, 3 %), step width
AR(1) about 1 cm, toe-out of the landing foot N(0, 1.2 deg); each slews within 120 ms. A person's habits shift
the means.
"""

from __future__ import annotations

import numpy as np

from footfall.models.subject import Habits

CADENCE_SD, CADENCE_SLOW_SD, CADENCE_SLOW_RHO = 0.026, 0.013, 0.9
AMPLITUDE_SD = 0.03
WIDTH_SD, WIDTH_RHO = 0.010, 0.5
TOE_OUT_SD = np.radians(1.2)
_SLEW_S = 0.12
# columns of `value`
CADENCE, AMPLITUDE, WIDTH, TOE_OUT = 0, 1, 2, slice(3, 5)


class Variability:
    """Modulation of n walkers: cadence, hip excursion (relative), step width (m), toe-out right, left (rad).

    Attributes
    ----------
    level : (n,) factor on every standard deviation
    value : (n, 5) as applied
    """

    def __init__(self, n: int) -> None:
        self.level = np.zeros(n)
        self.slow = np.zeros(n)
        self.asymmetry = np.zeros(n)
        self.mean = np.zeros((n, 5))
        self.value = np.zeros((n, 5))
        self.target = np.zeros((n, 5))

    def place(self, mask: np.ndarray, level: np.ndarray, habits: list[Habits]) -> None:
        """Start the walkers in `mask` with these levels (m,) and habits (m)."""
        self.level[mask] = level
        self.slow[mask] = 0
        self.asymmetry[mask] = [habit.asymmetry for habit in habits]
        self.mean[mask] = [
            (habit.cadence - 1, 0.0, habit.step_width, habit.toe_out, habit.toe_out) for habit in habits
        ]
        self.value[mask] = self.target[mask] = self.mean[mask]

    def advance(
        self,
        new_step: np.ndarray,
        half: np.ndarray,
        dt: np.ndarray,
        rng: np.random.Generator,
        widen: np.ndarray | float = 0.0,
    ) -> None:
        """Draw for walkers that begin a step and slew the rest.

        Parameters
        ----------
        new_step : (n,) bool
        half : (n,) 0 while the right foot stands (the left one swings), 1 otherwise
        dt : (n,) s since the last call
        widen : (n,) m, step width to be added now
        """
        k = np.flatnonzero(new_step)
        if len(k):
            level, normal, mean = self.level[k], rng.standard_normal((len(k), 5)), self.mean[k]
            rho = CADENCE_SLOW_RHO
            self.slow[k] = rho * self.slow[k] + normal[:, 0] * CADENCE_SLOW_SD * np.sqrt(1 - rho**2) * level
            cadence = np.clip(self.slow[k] + normal[:, 1] * CADENCE_SD * level, -0.09, 0.09)
            # Asymmetry: the step on the right foot is quicker by as much as the one on the left is slower.
            limp = self.asymmetry[k] * np.where(half[k] == 0, 1.0, -1.0)
            self.target[k, CADENCE] = mean[:, CADENCE] + cadence + limp
            self.target[k, AMPLITUDE] = np.clip(normal[:, 2] * AMPLITUDE_SD * level, -0.1, 0.1)
            width = WIDTH_RHO * (self.target[k, WIDTH] - mean[:, WIDTH]) + normal[:, 3] * WIDTH_SD * level
            self.target[k, WIDTH] = mean[:, WIDTH] + np.clip(width, -0.03, 0.03)
            # The leg about to swing gets a new toe-out and keeps it through its next stance.
            toe_out = np.clip(normal[:, 4] * TOE_OUT_SD * level, -0.1, 0.1)
            self.target[k, 4 - half[k]] = mean[:, 3] + toe_out
        goal = self.target.copy()
        goal[:, WIDTH] += widen
        self.value += (goal - self.value) * (dt / _SLEW_S)[:, None]
