"""The budget's surrogate beside the full chain, at some points of a study: whether it may be believed."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np

from footfall.errors import InputError
from footfall.late import late

qmc = late("scipy.stats.qmc")

POINTS = 8
LIMIT = 0.15  # mean deviation over the points, as a share, beyond which the surrogate is refused


@dataclass(frozen=True)
class Check:
    """Scores of a method at the same points.

    Attributes
    ----------
    shares : (p, factors) of each factor's range
    full, budget : (p,) scores over the cases, by the full chain and by the surrogate
    """

    method: str
    shares: np.ndarray
    full: np.ndarray
    budget: np.ndarray

    @property
    def off(self) -> np.ndarray:
        """(p,) by how much the surrogate is off, as a share of the full chain's score."""
        return np.asarray(self.budget / self.full - 1)

    @property
    def mean_off(self) -> float:
        """Mean size of it over the points."""
        return float(np.abs(self.off).mean())

    def require(self) -> None:
        """Refuse the surrogate where it is too far off.

        Raises
        ------
        InputError
            By how much.
        """
        if not self.mean_off <= LIMIT:
            off = f"{100 * self.mean_off:.0f} % in the mean over {len(self.full)} points"
            raise InputError(
                f"the budget is off the full chain of {self.method} by {off}, more than {100 * LIMIT:.0f} %: "
                'use fidelity = "full"'
            )


def check_points(factors: int, seed: int) -> np.ndarray:
    """Points (8, factors) that fill the cube evenly, others than the study's own."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the keyword for the seed, which has changed in scipy
        return np.asarray(qmc.LatinHypercube(factors, seed=seed).random(POINTS))
