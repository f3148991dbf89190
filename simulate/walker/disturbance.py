"""Pushes at the trunk: a test of robustness, and the only possible external force. Off by default."""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass

import numpy as np

from footfall.simulate.plan import Disturbance

PUSH_S = 0.09  # s that a push lasts


@dataclass(frozen=True)
class Push:
    """Beginning (s of the record) and impulse (N s along x and y of the world) of a push."""

    t: float
    impulse: tuple[float, float]


def pushes(
    disturbance: Disturbance, *, first: float, until: float, rng: np.random.Generator
) -> tuple[Push, ...]:
    """The pushes between `first` and `until` (s of the record), the first of them `every_s` after `first`."""
    impulse, every = disturbance.push_Ns, disturbance.every_s
    times = first + every * np.arange(1, max(int((until - first) / every), 0) + 1)
    angles = rng.uniform(-np.pi, np.pi, len(times))
    return tuple(
        Push(float(t), (float(impulse * np.cos(a)), float(impulse * np.sin(a))))
        for t, a in zip(times, angles, strict=True)
    )


class Pusher:
    """Gives the pushes, control step by control step.

    Parameters
    ----------
    pushes : in order of time
    start : s from the first control step to the record's beginning
    """

    def __init__(self, pushes: tuple[Push, ...], *, start: float) -> None:
        self._pushes, self._start = pushes, start
        self._begins = [push.t for push in pushes]

    def force(self, now: float, share: float) -> np.ndarray | None:
        """(1, 3) N times `share` on the trunk `now` (s from the first control step); None between pushes."""
        t = now - self._start + 1e-9
        i = bisect_left(self._begins, t) - 1
        if i < 0 or t - self._begins[i] >= PUSH_S:
            return None
        x, y = self._pushes[i].impulse
        return np.array([[x, y, 0.0]]) * (share / PUSH_S)
