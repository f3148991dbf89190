"""A unit on a synthetic walk, for studies that need no walker."""

from dataclasses import replace

import pytest

from footfall.scenarios.parameters import documents, with_values
from footfall.scenarios.trial import Trial
from tests.helpers.synthetic import synthetic_walk


@pytest.fixture(scope="session")
def walked():
    """Some two minutes of a foot that turns slowly."""
    walk = synthetic_walk(strides=100, turn=0.004)
    return replace(walk, meta={**walk.meta, "subject": "nobody"})


@pytest.fixture(scope="session")
def wearing():
    """Trials of units that are worn on it: `wearing([7, 8], {"imu.gyro.flicker_deg_h": 9})`."""
    base = documents("straight", methods=["pdr", "hdr"])

    def made(units, values=None):
        setup = with_values(base, values or {}).setup()
        return [Trial(setup, 0, walk_seed=1, unit_seed=unit, noise_seed=unit) for unit in units]

    return made
