"""Footfalls along a path that is known, of a gyro whose drift is known, as dead reckoning would tell them."""

import math
from dataclasses import replace

import numpy as np

from footfall.pdr.footfalls import Footfalls
from footfall.pdr.strides import Strides

DEG = math.radians(1.0)


def feet(turns, drift=0.0, *, interval=1.05, stride=1.5, scatter=1.0 * DEG, seed=0, rests=None, beside=0.2):
    """Footfalls whose path turns by `turns` (n,) rad at each, and whose gyro drifts by `drift` rad/s.

    scatter : rad, of a stride's direction about the path, bounded aside: a foot that strays comes back
    rests : footfall -> s of standing there, of which 5.5 s tell no rate
    beside : rad, by which the foot points beside its way
    """
    turns = np.asarray(turns, dtype=float)
    n = len(turns) + 1
    rests = rests or {}
    moving = np.concatenate([[0.0], np.full(n - 1, interval)])
    standing = np.array([float(rests.get(i, 0.0)) for i in range(n)])
    intervals = moving + standing
    rate = np.broadcast_to(np.asarray(drift, dtype=float), n)
    drifted = np.cumsum(rate * intervals)
    aside = np.random.default_rng(seed).normal(0, scatter * stride / math.sqrt(2), n)
    path = np.cumsum(np.concatenate([[0.0], turns]))
    course = path + np.diff(aside, prepend=aside[0]) / stride
    seen = course + drifted - rate * (standing + moving / 2)
    steps = stride * np.column_stack([np.cos(seen), np.sin(seen), 0 * seen])
    steps[0] = 0.0
    heading = np.append((path[1:] + path[:-1]) / 2, path[-1]) + drifted + beside
    strides = Strides(
        loads=np.zeros((n, 27)),
        moving=moving,
        temperature=np.full(n, math.nan),
        rest_s=np.where(standing >= 7.5, standing - 5.5, 0.0),
        rest_rate=np.where(standing >= 7.5, rate, 0.0),
        rest_temperature=np.full(n, math.nan),
    )
    made = Footfalls.at(np.cumsum(intervals), np.cumsum(steps, axis=0), heading)
    return replace(made, strides=strides)


def drift_of(footfalls, drift):
    """By how much the heading of `feet` has drifted at each footfall (n,) rad."""
    return np.cumsum(np.broadcast_to(np.asarray(drift, dtype=float), len(footfalls)) * footfalls.interval)


def without(footfalls, rows):
    """The same with some footfalls missed."""
    kept = np.setdiff1d(np.arange(len(footfalls)), rows)
    made = Footfalls.at(footfalls.t[kept], footfalls.position[kept], footfalls.heading[kept])
    strides = {name: values[kept] for name, values in vars(footfalls.strides).items()}
    strides["moving"] = made.interval
    return replace(made, strides=Strides(**strides))


def turned(footfalls, angle, mirror=False):
    """Turned about the vertical by `angle` (rad), after left and right were changed where `mirror`."""
    sign = -1.0 if mirror else 1.0
    x, y, z = footfalls.position.T
    y = sign * y
    c, s = math.cos(angle), math.sin(angle)
    position = np.column_stack([c * x - s * y, s * x + c * y, z])
    strides = replace(footfalls.strides, rest_rate=sign * footfalls.strides.rest_rate)
    strides = replace(strides, loads=sign * footfalls.strides.loads)
    made = Footfalls.at(footfalls.t, position, sign * footfalls.heading + angle)
    return replace(made, strides=strides)
