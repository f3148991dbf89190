"""What keeps the gait from being a metronome: seeded scatter of timing, step length, width and toe-out.

Per step: cadence N(0, 2.47 %) plus a slow AR(1) part (1.26 %, rho 0.9); placement, which is hip excursion
N(0, 2.15 %), excursion of knee and ankle N(0, 5.4 %) and step width AR(1) about 4.5 mm; toe-out of the
landing foot N(0, 1.0 deg), and how far that foot turns out on its way N(0, 11.5 deg). Each slews within
120 ms. Slow strides scatter more (Beauchet et al. 2009), those before a stop less. A person's habits shift
the means.
"""

from __future__ import annotations

import numpy as np

from footfall.models.subject import Habits
from footfall.simulate.walker._variability_kernels import draw_all
from footfall.simulate.walker.state import N_VARIED
from footfall.simulate.walker.state import WIDTH as WIDTH


class Variability:
    """Modulation of n walkers, in the order of state.CADENCE to state.BEND.

    Cadence, hip excursion (both relative), step width (m), toe-out right and left, turn of the swinging foot
    (rad), excursion of knee and ankle (relative).

    Parameters
    ----------
    state : (n,) of state.WALKER

    Attributes
    ----------
    level : (n, 3) factors on the standard deviations of foot placement, cadence and toe-out
    value : (n, 7) as applied; the control step slews it towards `target` (n, 7)
    """

    def __init__(self, state: np.ndarray) -> None:
        self._state = state
        self.level, self.slow, self.asymmetry = state["level"], state["slow"], state["asymmetry"]
        self.mean, self.value, self.target = state["varied_mean"], state["varied"], state["varied_goal"]

    def place(self, mask: np.ndarray, level: np.ndarray, habits: list[Habits]) -> None:
        """Start the walkers in `mask` with these levels, (m, 3) or one for all (m,), and habits (m)."""
        self.level[mask] = level if level.ndim == 2 else level[:, None]
        self.slow[mask] = 0
        self.asymmetry[mask] = [habit.asymmetry for habit in habits]
        self.mean[mask] = [
            (habit.cadence - 1, 0.0, habit.step_width, habit.toe_out, habit.toe_out, 0.0, 0.0)
            for habit in habits
        ]
        self.value[mask] = self.target[mask] = self.mean[mask]

    def draw(self, rows: np.ndarray, rng: np.random.Generator) -> None:
        """New targets for the walkers `rows` (m,), which begin a step."""
        draw_all(self._state, rows, rng.standard_normal((len(rows), N_VARIED)))
