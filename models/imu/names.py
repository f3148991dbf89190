"""Names of the error effects of an IMU."""

from __future__ import annotations

from collections.abc import Collection

from footfall.errors import InputError
from footfall.settings import did_you_mean

# In the order in which they act on the true signal.
EFFECTS = (
    "scale",
    "misalignment",
    "non_linearity",
    "g_sensitivity",
    "g2",
    "temperature",
    "turn_on",
    "flicker",
    "rate_random_walk",
    "bandwidth",
    "white",
    "saturation",
    "quantisation",
)


def require_effects(names: Collection[str]) -> None:
    """Raise InputError when a name is not one of `EFFECTS`."""
    for name in names:
        if name not in EFFECTS:
            raise InputError(f"effect {name!r} does not exist{did_you_mean(name, EFFECTS)}")
