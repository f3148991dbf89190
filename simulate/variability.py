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
# columns of `value`
CADENCE, AMPLITUDE, WIDTH, TOE_OUT_RIGHT, TOE_OUT_LEFT = range(5)


class Variability:
    """Modulation of n walkers: cadence, hip excursion (relative), step width (m), toe-out right, left (rad).

    Parameters
    ----------
    state : (n,) of state.WALKER

    Attributes
    ----------
    level : (n,) factor on every standard deviation
    value : (n, 5) as applied; the control step slews it towards `target` (n, 5)
    """

    def __init__(self, state: np.ndarray) -> None:
        n = len(state)
        self.level = np.zeros(n)
        self.slow = np.zeros(n)
        self.asymmetry = np.zeros(n)
        self.mean = np.zeros((n, 5))
        self.value, self.target = state["varied"], state["varied_goal"]

    def place(self, mask: np.ndarray, level: np.ndarray, habits: list[Habits]) -> None:
        """Start the walkers in `mask` with these levels (m,) and habits (m)."""
        self.level[mask] = level
        self.slow[mask] = 0
        self.asymmetry[mask] = [habit.asymmetry for habit in habits]
        self.mean[mask] = [
            (habit.cadence - 1, 0.0, habit.step_width, habit.toe_out, habit.toe_out) for habit in habits
        ]
        self.value[mask] = self.target[mask] = self.mean[mask]

    def draw(self, k: np.ndarray, half: np.ndarray, rng: np.random.Generator) -> None:
        """New targets for the walkers k (m,) that begin a step.

        Parameters
        ----------
        half : (m,) int, 0 while the right foot stands (the left one swings), 1 otherwise
        """
        level, normal, mean = self.level[k], rng.standard_normal((len(k), 5)), self.mean[k]
        rho = CADENCE_SLOW_RHO
        self.slow[k] = rho * self.slow[k] + normal[:, 0] * CADENCE_SLOW_SD * np.sqrt(1 - rho**2) * level
        cadence = np.clip(self.slow[k] + normal[:, 1] * CADENCE_SD * level, -0.09, 0.09)
        # Asymmetry: the step on the right foot is quicker by as much as the one on the left is slower.
        limp = self.asymmetry[k] * np.where(half == 0, 1.0, -1.0)
        self.target[k, CADENCE] = mean[:, CADENCE] + cadence + limp
        self.target[k, AMPLITUDE] = np.clip(normal[:, 2] * AMPLITUDE_SD * level, -0.1, 0.1)
        width = WIDTH_RHO * (self.target[k, WIDTH] - mean[:, WIDTH]) + normal[:, 3] * WIDTH_SD * level
        self.target[k, WIDTH] = mean[:, WIDTH] + np.clip(width, -0.03, 0.03)
        # The leg about to swing gets a new toe-out and keeps it through its next stance.
        toe_out = np.clip(normal[:, 4] * TOE_OUT_SD * level, -0.1, 0.1)
        self.target[k, TOE_OUT_LEFT - half] = mean[:, TOE_OUT_RIGHT] + toe_out
