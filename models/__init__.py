"""The walker's body, the people, the ground, and the IMU: what a simulation is made of."""

from pathlib import Path as _Path

from footfall.compiled import forget_stale as _forget_stale

_forget_stale(_Path(__file__).parent)
