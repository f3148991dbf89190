"""Where the IMU sits on a shoe."""

from __future__ import annotations

import math
from dataclasses import dataclass

from footfall.errors import InputError


@dataclass(frozen=True)
class Mount:
    """Where the IMU sits on a foot.

    Attributes
    ----------
    foot : "right" or "left"
    position : (3,) m from the ankle, x forward, y left, z up, of the 1.75 m body (scaled with stature)
    euler_deg : (3,) roll, pitch, yaw of the IMU in the foot (z-y-x); positive pitch is nose down
    """

    foot: str = "right"
    position: tuple[float, float, float] = (0.075, 0.0, -0.01)
    euler_deg: tuple[float, float, float] = (0.0, 20.0, 0.0)

    def __post_init__(self) -> None:
        if self.foot not in ("right", "left"):
            raise InputError(f"mount: foot = {self.foot!r}, expected 'right' or 'left'")
        if not all(map(math.isfinite, [*self.position, *self.euler_deg])):
            raise InputError("mount: position and euler_deg must be finite")


MOUNTS = {
    "instep": Mount(),
    # HDR paper, Figure 6: rigidly attached to the medial side of the right shoe.
    "medial": Mount(position=(0.02, 0.045, -0.04), euler_deg=(0.0, 0.0, 0.0)),
    "heel": Mount(position=(-0.06, 0.0, -0.03), euler_deg=(0.0, -10.0, 0.0)),
    "instep-left": Mount(foot="left"),
}
