"""Compile once, in one process, what trials need: the others find it in numba's cache."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from footfall.conventions import heading_of
from footfall.pdr.synthetic import walk as synthetic_walk
from footfall.scenarios.trial import Trial, perform
from footfall.simulate import walking
from footfall.simulate.walk import TrueFootfalls, Walk

_CORNER = (*[0.0] * 6, *[math.pi / 2] * 6)


def warm(trial: Trial, *, walks: bool) -> None:
    """Compile what a trial runs, or find it in numba's cache.

    A synthetic foot is recorded and navigated by the trial's methods, but for those of others: whatever they
    refuse is no matter.

    Parameters
    ----------
    walks : whether there is also to be walked
    """
    if walks:
        walking.warm()
    built_in = tuple(method for method in trial.setup.methods if not method.version)
    perform(
        replace(trial, setup=replace(trial.setup, methods=built_in)),
        synthetic(trial.setup.pdr.bias_s + 1.0, trial.setup.scenario.sensor.rate_hz),
        keep=True,
    )


def synthetic(still_s: float, rate_hz: float, headings: Sequence[float] = _CORNER) -> Walk:
    """The truth of a foot that rests for `still_s`, and walks with these headings (rad) at its footfalls.

    Some strides straight on and round a corner, if nothing is said.
    """
    made = synthetic_walk(headings, still_s=still_s, rate=rate_hz)
    rows = made.at(made.mid_stance)
    rows[0] = int(still_s * rate_hz)
    speed = np.linalg.norm(made.velocity, axis=1)
    return Walk(
        t=made.t,
        position=made.position,
        quaternion=made.quaternion,
        velocity=made.velocity,
        gyro=made.gyro,
        accel=made.accel,
        contact=(speed < 0.2).astype(float),
        stance=speed < 0.2,
        footfalls=TrueFootfalls(made.t[rows], made.position[rows], heading_of(made.quaternion[rows])),
        meta={"calibration_s": still_s, "scenario": "synthetic", "subject": "nobody"},
    )
