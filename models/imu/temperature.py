"""The air around an IMU and the die inside it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from footfall.errors import InputError


@dataclass(frozen=True)
class TemperatureProfile:
    """Warmed up indoors, then carried through air whose temperature is known.

    Attributes
    ----------
    start : degC, the die at t = 0
    time : s, increasing; instants at which the air's temperature is given
    ambient : degC, the air at those instants; linear between them, constant before and after
    """

    start: float
    time: tuple[float, ...]
    ambient: tuple[float, ...]

    def __post_init__(self) -> None:
        if not self.time or len(self.time) != len(self.ambient):
            raise InputError(
                f"temperature: {len(self.time)} instants for {len(self.ambient)} ambient temperatures, "
                "expected as many, and at least one"
            )
        if not np.isfinite([self.start, *self.time, *self.ambient]).all():
            raise InputError("temperature: a value is not finite")
        if (np.diff(self.time) <= 0).any():
            raise InputError(f"temperature: time = {list(self.time)} does not increase")

    @classmethod
    def steady(cls, temperature: float) -> TemperatureProfile:
        """Die and air at one temperature (degC) for ever."""
        return cls(start=temperature, time=(0.0,), ambient=(temperature,))

    @classmethod
    def step(cls, indoors: float, outdoors: float) -> TemperatureProfile:
        """Out of a room at `indoors` degC into air at `outdoors` degC just before t = 0."""
        return cls(start=indoors, time=(0.0,), ambient=(outdoors,))

    def die(self, t: np.ndarray, time_constant: float) -> np.ndarray:
        """Temperature of a die that follows the air with a first-order lag, T' = (A - T) / tau.

        Parameters
        ----------
        t : (n,) s, evenly spaced; the die is at `start` at t[0]
        time_constant : s; 0 for a die that is always as warm as the air

        Returns
        -------
        (n,) degC. Exact where the air's temperature is linear between samples.
        """
        air = np.interp(t, self.time, self.ambient)
        if time_constant == 0:
            return air
        from footfall.models.imu._kernels import add_lag

        x = (t[-1] - t[0]) / (len(t) - 1) / time_constant
        decay, mean = math.exp(-x), -math.expm1(-x) / x
        # Lag e = T - A obeys e' = -e/tau - A': e+ = decay e - mean (A+ - A). Written in the lag so that a die
        # as warm as steady air stays there exactly.
        add_lag(air, self.start - air[0], decay, mean)
        return air


ROOM = TemperatureProfile.steady(20.0)
