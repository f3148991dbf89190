"""Who walks: stature, mass and habits, and what the simulated body makes of them.

The physics always moves a body of 1.75 m. A person of height H is dynamically similar to it: lengths scale
with s = H / 1.75 m, times with sqrt(s), forces with the mass, and specific force not at all, so the walk of
the 1.75 m body is stretched by s in space and by sqrt(s) in time (exact under gravity: equal Froude numbers).
What stature does not explain, the mass for it, changes the body's build.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from footfall.errors import InputError

REFERENCE_HEIGHT_M = 1.75
REFERENCE_MASS_KG = 75.0

# Soles by their softness: the contact's time constant (s). Lengths of the shoe do not differ.
SHOES = {"stiff": 0.013, "walking": 0.015, "running": 0.026}


@dataclass(frozen=True)
class Build:
    """Proportions of a body relative to the 1.75 m, 75 kg one (1 = the same), and its shoes.

    Attributes
    ----------
    thigh, shank, hip_width, foot : lengths
    trunk_mass, leg_mass : masses
    friction : sliding friction of the shoe on the ground
    sole_time : s of the simulated body, time constant of the sole's contact (MuJoCo solref[0]); smaller is
        harder
    """

    thigh: float = 1.0
    shank: float = 1.0
    hip_width: float = 1.0
    foot: float = 1.0
    trunk_mass: float = 1.0
    leg_mass: float = 1.0
    friction: float = 1.0
    sole_time: float = SHOES["walking"]


@dataclass(frozen=True)
class Habits:
    """How a person walks, beside their body.

    Attributes
    ----------
    cadence : relative to people of their height at that speed
    step_width : m added, of the 1.75 m body
    toe_out : rad, of each foot
    asymmetry : share by which right steps are quicker and left ones slower
    """

    cadence: float = 1.0
    step_width: float = 0.0
    toe_out: float = 0.0
    asymmetry: float = 0.0


LIMITS = {
    "height_m": (1.50, 1.95),
    "mass_kg": (50.0, 100.0),
    "cadence": (0.94, 1.06),
    "step_width_m": (-0.02, 0.03),
    "toe_out_deg": (-3.0, 10.0),
    "asymmetry": (-0.03, 0.03),
    "friction": (0.6, 1.2),
    "sole_time_s": (0.012, 0.026),
}
# A mass that stature does not explain sits mostly on the trunk.
_TRUNK_SHARE, _LEG_SHARE = 0.3, 0.15


@dataclass(frozen=True)
class Subject:
    """A person.

    Attributes
    ----------
    name : what reports call them
    height_m : 1.50 to 1.95; mass_kg : 50 to 100
    cadence, step_width_m, toe_out_deg, asymmetry : their habits (see `Habits`)
    friction, sole_time_s : of their shoes (see `Build`)

    Raises
    ------
    InputError
        A value outside the range that the walker was trained for.
    """

    name: str = "reference"
    height_m: float = REFERENCE_HEIGHT_M
    mass_kg: float = REFERENCE_MASS_KG
    cadence: float = 1.0
    step_width_m: float = 0.0
    toe_out_deg: float = 3.0
    asymmetry: float = 0.0
    friction: float = 1.0
    sole_time_s: float = SHOES["walking"]

    def __post_init__(self) -> None:
        for key, (low, high) in LIMITS.items():
            value = getattr(self, key)
            if not low - 1e-9 <= value <= high + 1e-9:
                raise InputError(
                    f"subject {self.name!r}: {key} = {value:g} is outside {low:g} to {high:g}, "
                    "the range that the walker was trained for"
                )

    @property
    def scale(self) -> float:
        """Lengths relative to the simulated body."""
        return self.height_m / REFERENCE_HEIGHT_M

    @property
    def time_scale(self) -> float:
        """Times relative to the simulated body."""
        return float(np.sqrt(self.scale))

    @property
    def build(self) -> Build:
        """The body that is simulated."""
        excess = self.mass_kg / (REFERENCE_MASS_KG * self.scale**2) - 1  # body-mass index
        trunk, legs = 1 + _TRUNK_SHARE * excess, 1 + _LEG_SHARE * excess
        sole_time = self.sole_time_s / self.time_scale
        return Build(trunk_mass=trunk, leg_mass=legs, friction=self.friction, sole_time=sole_time)

    @property
    def habits(self) -> Habits:
        """The habits of the simulated body."""
        return Habits(
            self.cadence, self.step_width_m / self.scale, float(np.radians(self.toe_out_deg)), self.asymmetry
        )


# The paper's walks "were performed by two different subjects" (Borenstein et al. 2008, section 5).
SUBJECTS = {
    "reference": Subject(),
    "taller": Subject("taller", height_m=1.86, mass_kg=84.0, cadence=0.98, toe_out_deg=6.0, asymmetry=0.01),
    "shorter": Subject(
        "shorter",
        height_m=1.64,
        mass_kg=62.0,
        cadence=1.01,
        step_width_m=0.001,
        toe_out_deg=2.0,
        asymmetry=-0.01,
    ),
}


def draw_subject(rng: np.random.Generator, name: str = "drawn") -> Subject:
    """A person of an adult population.

    Stature is normal about 1.70 m (SD 0.09 m, men and women together), body-mass index about 24 kg/m2 (SD 3);
    both, and the habits, are cut at the walker's limits.
    """

    def cut(key: str, value: float) -> float:
        return float(np.clip(value, *LIMITS[key]))

    height = cut("height_m", rng.normal(1.70, 0.09))
    return Subject(
        name,
        height_m=height,
        mass_kg=cut("mass_kg", rng.normal(24.0, 3.0) * height**2),
        cadence=cut("cadence", rng.normal(1.0, 0.03)),
        step_width_m=cut("step_width_m", rng.normal(0.0, 0.012)),
        toe_out_deg=cut("toe_out_deg", rng.normal(4.0, 3.0)),
        asymmetry=cut("asymmetry", rng.normal(0.0, 0.01)),
    )
