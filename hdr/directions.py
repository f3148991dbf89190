"""Dominant directions: the few headings that a building's walls allow, given or learned from the walk."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

from footfall.settings import require, setting


@dataclass(frozen=True)
class DirectionParams:
    """Evenly spaced directions; `reference` is one of them.

    Attributes
    ----------
    count : how many on the circle: 4 for corridors that meet at right angles, 8 with diagonals
    reference : rad, one of them; None has them learned from the walk (`Directions`), which also takes in
        by how much the foot points beside the path
    learn_after : footfalls to learn from before learned directions are used
    learn_agreement : 0..1, length of the mean resultant vector below which nothing was learned: headings
        spread evenly have 0, headings along the directions 1
    """

    count: int = setting(4, ge=1)
    reference: float | None = setting(0.0, unit="rad")
    learn_after: float = setting(5.0, gt=0)
    learn_agreement: float = setting(0.7, ge=0, le=1)

    def __post_init__(self) -> None:
        require("directions", self)


def deviation(heading: float, reference: float, count: int) -> float:
    """By how much `heading` (rad) lies beside the nearest of the directions: from -pi/count to pi/count."""
    sector = 2 * math.pi / count
    return (heading - reference + sector / 2) % sector - sector / 2


def folded(heading: float, count: int) -> complex:
    """A heading (rad) as a unit vector that is the same for all `count` directions: exp(i count heading)."""
    return cmath.exp(1j * count * heading)


def learned_reference(resultant: complex, count: int) -> tuple[float, float]:
    """Where `count` evenly spaced directions fit the headings of a walk best, and how well.

    The first Fourier coefficient of the headings' distribution, folded onto one sector of 2 pi / count:
    R exp(i count reference) = sum w exp(i count heading) / sum w.

    Parameters
    ----------
    resultant : weighted mean of `folded` headings

    Returns
    -------
    reference : rad, -pi/count to pi/count
    agreement : R, from 0 (evenly spread) to 1 (all along the directions)
    """
    # not cmath.phase, which overflows at the least of angles
    return math.atan2(resultant.imag, resultant.real) / count, abs(resultant)


class Directions:
    """The dominant directions as they are known at this point of a walk.

    Parameters
    ----------
    params : which directions, or that they are learned
    """

    def __init__(self, params: DirectionParams) -> None:
        self.params = params
        self._sum, self._weight = 0j, 0.0

    @property
    def reference(self) -> float | None:
        """One of the directions (rad); None while too little was walked to know."""
        params = self.params
        if params.reference is not None:
            return params.reference
        if self._weight < params.learn_after:
            return None
        reference, agreement = learned_reference(self._sum / self._weight, params.count)
        return reference if agreement >= params.learn_agreement else None

    def learn(self, heading: float, weight: float = 1.0) -> None:
        """Learn from a heading (rad), weighted by how surely it was along a straight."""
        self._sum += weight * folded(heading, self.params.count)
        self._weight += weight

    def nearest(self, heading: float) -> float | None:
        """The direction nearest to `heading` (rad), in its turn of the circle; None while none is known."""
        reference = self.reference
        if reference is None:
            return None
        return heading - deviation(heading, reference, self.params.count)
