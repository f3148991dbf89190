"""Dead reckoning: detectors, ZUPT and the inertial filters."""

from pathlib import Path as _Path

from footfall.compiled import forget_stale as _forget_stale

_forget_stale(_Path(__file__).parent)
