"""Points on the plane laid on others by a turn and a shift."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class RigidMotion:
    """A turn about the vertical and a shift on the plane: of `here` to `there`, by `turn` rad about it."""

    here: np.ndarray
    there: np.ndarray
    turn: float

    def __call__(self, points: np.ndarray) -> np.ndarray:
        """(n, 2) points, moved."""
        c, s = math.cos(self.turn), math.sin(self.turn)
        return np.asarray(self.there + (points - self.here) @ np.array([[c, s], [-s, c]]))


def turn_between(a: np.ndarray, b: np.ndarray) -> float:
    """The turn (rad) of (n, 2) vectors that brings them nearest to others, in the sum of squares.

    On the plane it is the angle of the sum of conj(a) b (Umeyama 1991, without scale).
    """
    across = np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    return math.atan2(across, np.sum(a * b))


def rigid_fit(ours: np.ndarray, theirs: np.ndarray) -> RigidMotion:
    """The motion of (n, 2) points by which they lie best on (n, 2) others: no scaling, no mirror."""
    here, there = ours.mean(axis=0), theirs.mean(axis=0)
    return RigidMotion(here, there, turn_between(ours - here, theirs - there))
