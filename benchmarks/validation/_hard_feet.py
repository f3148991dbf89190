"""Made-up footfalls that narrow priors get wrong: a gyro that drifts without any noise."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from footfall.pdr.footfalls import Footfalls
from footfall.pdr.strides import Strides

DEG = math.radians(1.0)
STRIDE_M, STRIDE_S = 1.5, 1.05


def steady_bias(seed: int) -> tuple[Footfalls, np.ndarray]:
    """A straight of 300 strides with a drift of 0.05 deg/s, which no rest has told."""
    return _feet(np.zeros(300), np.full(301, 0.05 * DEG), np.full(301, math.nan), seed)


def cooling_on_a_curve(seed: int) -> tuple[Footfalls, np.ndarray]:
    """A straight of 250 strides and a curve of 0.8 deg a stride; the drift grows with the told cold."""
    cold = -20 * (1 - np.exp(-np.arange(501) / 200))
    return _feet(np.repeat([0.0, 0.8 * DEG], 250), 0.006 * DEG * cold, 20 + cold, seed)


def _feet(turns: np.ndarray, rate: np.ndarray, warm: np.ndarray, seed: int) -> tuple[Footfalls, np.ndarray]:
    """Footfalls along a path that turns by `turns` (n,) rad, of a gyro that drifts by `rate` (n + 1,) rad/s.

    Returns
    -------
    the footfalls, which scatter beside the path, and the heading's drift at each (n + 1,) rad
    """
    n = len(rate)
    passed = np.concatenate([[0.0], np.full(n - 1, STRIDE_S)])
    drifted = np.cumsum(rate * passed)
    aside = np.random.default_rng(seed).normal(0, 0.0185, n)
    path = np.concatenate([[0.0], np.cumsum(turns)])
    seen = path + np.diff(aside, prepend=aside[0]) / STRIDE_M + drifted - rate * passed / 2
    steps = STRIDE_M * np.column_stack([np.cos(seen), np.sin(seen), np.zeros(n)])
    steps[0] = 0.0
    heading = np.append((path[1:] + path[:-1]) / 2, path[-1]) + drifted
    none = np.full(n, math.nan)
    strides = Strides(np.zeros((n, 27)), passed, warm, np.zeros(n), np.zeros(n), none)
    return replace(
        Footfalls.at(np.cumsum(passed), np.cumsum(steps, axis=0), heading), strides=strides
    ), drifted
