"""Random streams, each spawned by name from one seed: a new source of randomness disturbs no other."""

from __future__ import annotations

import numpy as np

from footfall.errors import InputError


def stream(seed: int, name: str) -> np.random.Generator:
    """The generator that belongs to `name` under `seed`.

    Raises
    ------
    InputError
        The seed is negative or no integer.
    """
    if isinstance(seed, bool) or not isinstance(seed, int | np.integer) or seed < 0:
        raise InputError(f"seed = {seed!r}: expected an integer of 0 or more")
    # The name's own bytes are the spawn key: two names can never share a stream.
    return np.random.default_rng(np.random.SeedSequence(int(seed), spawn_key=tuple(name.encode())))
