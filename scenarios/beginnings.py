"""The first minutes of walks, as recordings that a method is tried on (`footfall.hdr.check`)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

import numpy as np

from footfall.hdr.check import Case
from footfall.recording import Recording
from footfall.scenarios.run import OTHER_UNITS_FROM
from footfall.scenarios.scenario import load_scenario
from footfall.scenarios.trial import Trial, recording_of, setup, start_pose, walk_of

MINUTES = 5.0


def beginnings(
    scenarios: Iterable[str], minutes: float = MINUTES, on_walk: Callable[[str], None] | None = None
) -> Iterator[Case]:
    """The first minutes of each scenario's first walk, recorded by one unit of its IMU.

    Parameters
    ----------
    on_walk : called with the name of each scenario before it is walked

    Raises
    ------
    InputError
        A scenario that cannot be read or walked.
    """
    for name in scenarios:
        made = setup(load_scenario(name), methods=())
        seed = made.scenario.seeds.base
        trial = Trial(made, 0, walk_seed=seed, unit_seed=OTHER_UNITS_FROM, noise_seed=OTHER_UNITS_FROM)
        if on_walk is not None:
            on_walk(made.scenario.name)
        walk = walk_of(trial)
        recording = recording_of(trial, walk)
        last = int(np.searchsorted(recording.t, 60 * minutes, side="right"))
        temperature = recording.temperature
        begun = Recording(
            t=recording.t[:last],
            gyro=recording.gyro[:last],
            accel=recording.accel[:last],
            temperature=None if temperature is None else temperature[:last],
            meta=recording.meta,
        )
        yield Case(made.scenario.name, begun, start_pose(walk, made.pdr.bias_s), made.pdr.bias_s)
