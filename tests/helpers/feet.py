"""Walks of a synthetic foot in place of simulated ones: scored cases in milliseconds."""

import math

import pytest

from footfall.scenarios.warm import synthetic
from footfall.simulate.walk import Walk


def round_a_block(strides: int, legs: int = 4) -> Walk:
    """`strides` along each of the legs, with a quarter turn to the left between them."""
    return synthetic(26.0, 200.0, [math.radians(90 * leg) for leg in range(legs) for _ in range(strides)])


def walk_instead(patch: pytest.MonkeyPatch, walk: Walk) -> None:
    """Whatever is to be walked, `walk` is what comes of it; and all is done in this process."""
    patch.setattr("footfall.simulate.cache.cached_walk", lambda plan, **keys: walk)
    patch.setattr("footfall.scenarios.execute.cores", lambda: 1)
