"""The budget's surrogate beside the full chain, at some points of a study: whether it may be believed.

Points inside the ranges tell how far off it is in the mean. Where all that the budget scales is small, what
no cause says is left, and HDR's error of that follows chance: so the ends of all ranges are looked at, too,
each by itself.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np

from footfall.errors import InputError
from footfall.late import late

qmc = late("scipy.stats.qmc")

POINTS = 8
LIMIT = 0.15  # deviation, as a share, of the mean over them and of each end, beyond which it is refused
ENDS = ("all low", "all high")


@dataclass(frozen=True)
class Check:
    """Scores of a method at the same points.

    Attributes
    ----------
    shares : (p, factors) of each factor's range; the ends are all 0, and all 1
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
        """Mean size of it over the points that are no ends."""
        ends = list(self.ends.values())
        return float(np.abs(np.delete(self.off, ends)).mean())

    @property
    def ends(self) -> dict[str, int]:
        """ "all low" and "all high" -> which of the points that is."""
        found: dict[str, int] = {}
        for name, share in zip(ENDS, (0.0, 1.0), strict=True):
            rows = np.flatnonzero((self.shares == share).all(axis=1))
            if len(rows):
                found[name] = int(rows[0])
        return found

    def require(self) -> None:
        """Refuse the surrogate where it is too far off.

        Raises
        ------
        InputError
            By how much.
        """
        if not self.mean_off <= LIMIT:
            inside = len(self.full) - len(self.ends)
            off = f"{100 * self.mean_off:.0f} % in the mean over {inside} points"
            raise InputError(
                f"the budget is off the full chain of {self.method} by {off}, more than {100 * LIMIT:.0f} %: "
                'use fidelity = "full"'
            )
        for name, at in self.ends.items():
            if not abs(self.off[at]) <= LIMIT:
                off = f"{100 * self.off[at]:+.0f} % ({self.budget[at]:.3g} for {self.full[at]:.3g})"
                raise InputError(
                    f"the budget is off the full chain of {self.method} by {off} with {name} of the ranges, "
                    f'more than {100 * LIMIT:.0f} %: use narrower ranges, or fidelity = "full"'
                )


def check_points(factors: int, seed: int) -> np.ndarray:
    """Points (10, factors): eight that fill the cube evenly, others than the study's own, and both ends."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the keyword for the seed, which has changed in scipy
        inside = qmc.LatinHypercube(factors, seed=seed).random(POINTS)
    return np.vstack([inside, np.zeros(factors), np.ones(factors)])
