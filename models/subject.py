"""Who walks: stature and mass, and the segment table that follows from them."""

from __future__ import annotations

from dataclasses import dataclass

from footfall.errors import InputError

REFERENCE_HEIGHT_M = 1.75
REFERENCE_MASS_KG = 75.0


@dataclass(frozen=True)
class Subject:
    """A person, by what sets the body's proportions.

    Attributes
    ----------
    name : what reports call them
    height_m : stature; the shipped policy walks bodies within 4 % of 1.75 m
    mass_kg : shipped policy: within 12 % of 75 kg
    friction : sliding friction of the shoe on the ground
    sole_time_s : time constant of the sole's contact (MuJoCo solref[0]); smaller is harder
    """

    name: str = "reference"
    height_m: float = REFERENCE_HEIGHT_M
    mass_kg: float = REFERENCE_MASS_KG
    friction: float = 1.0
    sole_time_s: float = 0.010

    def __post_init__(self) -> None:
        limits = {
            "height_m": (0.96 * REFERENCE_HEIGHT_M, 1.04 * REFERENCE_HEIGHT_M),
            "mass_kg": (0.88 * REFERENCE_MASS_KG, 1.12 * REFERENCE_MASS_KG),
            "friction": (0.6, 1.2),
            "sole_time_s": (0.005, 0.02),
        }
        for key, (low, high) in limits.items():
            value = getattr(self, key)
            if not low - 1e-9 <= value <= high + 1e-9:
                raise InputError(
                    f"subject {self.name!r}: {key} = {value:g} is outside {low:g} to {high:g}, "
                    "the range that the walker was trained for"
                )

    @property
    def scale(self) -> float:
        """Lengths relative to the reference body."""
        return self.height_m / REFERENCE_HEIGHT_M

    @property
    def mass_ratio(self) -> float:
        """Masses relative to the reference body."""
        return self.mass_kg / REFERENCE_MASS_KG


# The paper's walks "were performed by two different subjects" (Borenstein et al. 2008, section 5).
SUBJECTS = {
    "reference": Subject(),
    "taller": Subject("taller", height_m=1.81, mass_kg=82.0, sole_time_s=0.011),
    "shorter": Subject("shorter", height_m=1.69, mass_kg=68.0, sole_time_s=0.009),
}
