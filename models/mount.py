"""Where the IMU sits on a leg: places on a shoe, and on the shank above it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from footfall.errors import InputError


@dataclass(frozen=True)
class Mount:
    """Where the IMU sits on a foot or on the shank above it.

    Attributes
    ----------
    foot : "right" or "left"
    position : (3,) m from the ankle in the segment's axes (x forward, y left, z up), of the 1.75 m body
        (scaled with stature)
    euler_deg : (3,) roll, pitch, yaw of the IMU in the segment (z-y-x); positive pitch is nose down
    segment : "foot" or "shank", which it is fixed to

    Raises
    ------
    InputError
        Another foot or segment; a position or an angle that is not finite.
    """

    foot: str = "right"
    position: tuple[float, float, float] = (0.075, 0.0, -0.01)
    euler_deg: tuple[float, float, float] = (0.0, 20.0, 0.0)
    segment: str = "foot"

    def __post_init__(self) -> None:
        for name, known in (("foot", ("right", "left")), ("segment", ("foot", "shank"))):
            if getattr(self, name) not in known:
                raise InputError(
                    f"mount: {name} = {getattr(self, name)!r}, expected {' or '.join(map(repr, known))}"
                )
        if not all(map(math.isfinite, [*self.position, *self.euler_deg])):
            raise InputError("mount: position and euler_deg must be finite")

    @property
    def on_foot(self) -> Mount:
        """The place that says when the foot is at rest: this one, or the instep below a shank."""
        return self if self.segment == "foot" else Mount(self.foot)


MOUNTS = {
    "instep": Mount(),
    # HDR paper, Figure 6: rigidly attached to the medial side of the right shoe.
    "medial": Mount(position=(0.02, 0.045, -0.04), euler_deg=(0.0, 0.0, 0.0)),
    "heel": Mount(position=(-0.06, 0.0, -0.03), euler_deg=(0.0, -10.0, 0.0)),
    "instep-left": Mount(foot="left"),
    # On the outer side, 10 cm above the ankle, x forward. A shank never lies still: in stance it turns about
    # the ankle as an inverted pendulum (Li et al., J. Biomech. 43 (2010) 1640-1643).
    "shank": Mount(position=(0.0, -0.045, 0.10), euler_deg=(90.0, 0.0, 0.0), segment="shank"),
    "shank-left": Mount("left", (0.0, 0.045, 0.10), (-90.0, 0.0, 0.0), "shank"),
}
