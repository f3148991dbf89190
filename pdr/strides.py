"""What the samples of a stride say of that on which a gyro's errors depend: load, temperature, rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

VERTICAL, FORCE, RATE, SQUARE = slice(0, 3), slice(3, 12), slice(12, 21), slice(21, 30)  # of a row of sums
SUMS = 30
TURN = [12, 16, 20]  # C_z1 w_1, C_z2 w_2, C_z3 w_3: their sum is the rate about the vertical

LONG_S = 7.5  # s, a shorter rest tells no rate
SETTLING_S, LEAVING_S = 4.0, 1.5  # s of a rest, in which the body still moves the foot


@dataclass(frozen=True)
class Strides:
    """One row a footfall, of the stride that ends there; row 0 is the still start.

    With C_z the vertical in the body's axes, f the specific force and w the rate less the static bias, an
    error e_i = sum_j a_ij f_j of the gyro's axis i turns the heading by sum_ij a_ij mean(C_zi f_j). The
    static bias has taken off what it was at rest, of force f_s: this is what `loads` leaves out.

    Attributes
    ----------
    loads : (n, 27) means over the interval: nine of C_zi (f_j - f_sj) in m/s2, row by row, then nine of
        C_zi w_j in rad/s and nine of C_zi (f_j^2 - f_sj^2) in m2/s4
    moving : (n,) s, of the interval, until the foot comes to its rest
    temperature : (n,) degC, mean over the interval; NaN where the sensor reports none
    rest_s : (n,) s of quiet in the middle of a rest of 7.5 s or more that ends at this footfall; 0 where none
    rest_rate : (n,) rad/s, mean rate about the vertical in it; 0 where there is none
    rest_temperature : (n,) degC, its mean; NaN where there is none
    """

    loads: np.ndarray
    moving: np.ndarray
    temperature: np.ndarray
    rest_s: np.ndarray
    rest_rate: np.ndarray
    rest_temperature: np.ndarray


@dataclass(frozen=True)
class Sums:
    """Integrals over time from each instant of zero velocity to the next; row 0 is empty.

    Attributes
    ----------
    t : (m,) s, the instants
    sums : (m, 30) of C_zi; C_zi f_j; C_zi w_j; C_zi f_j^2
    temperature : (m,) of the temperature, degC s; NaN where the sensor reports none
    """

    t: np.ndarray
    sums: np.ndarray
    temperature: np.ndarray


def integrals(t: np.ndarray, values: np.ndarray | None, resets: np.ndarray) -> np.ndarray:
    """Integrals (m,) of values (n,) from each of `resets` to the next, row 0 empty; NaN for None.

    Each value is the mean over the interval that ends at its stamp.
    """
    if values is None:
        return np.full(len(resets), np.nan)
    first = int(resets[0])
    steps = np.diff(t[first : resets[-1] + 1]) * values[first + 1 : resets[-1] + 1]
    total = np.concatenate([[0.0], np.cumsum(steps)])
    return np.diff(total[resets - first], prepend=0.0)


def strides_of(made: Sums, footfalls: np.ndarray, force: np.ndarray, start: float) -> Strides:
    """The strides that end at footfalls.

    Parameters
    ----------
    footfalls : (n,) their places in `made`
    force : (3,) m/s2, mean specific force of the still start
    start : degC, mean temperature of the still start
    """
    n = len(footfalls)
    duration = np.diff(made.t[footfalls], prepend=made.t[footfalls[0]])
    duration[0] = 1.0  # row 0 is empty
    means = _between(made.sums, footfalls) / duration[:, None]
    standing = means[:, VERTICAL, None]
    loads = means[:, FORCE.start :].copy()
    loads[:, :9] -= (standing * force).reshape(n, 9)
    loads[:, 18:] -= (standing * force**2).reshape(n, 9)
    arrived = np.minimum(np.concatenate([[0], footfalls[:-1] + 1]), footfalls)
    moving = made.t[arrived] - made.t[np.maximum(arrived - 1, 0)]
    warm = _between(made.temperature, footfalls) / duration
    loads[0], moving[0], warm[0] = 0.0, 0.0, start
    rest_s, rest_rate, rest_temperature = np.zeros(n), np.zeros(n), np.full(n, np.nan)
    for k in np.flatnonzero(made.t[footfalls] - made.t[arrived] >= LONG_S):
        if k > 0:
            rest_s[k], rest_rate[k], rest_temperature[k] = _quiet(made, int(arrived[k]), int(footfalls[k]))
    return Strides(loads, moving, warm, rest_s, rest_rate, rest_temperature)


def _between(values: np.ndarray, footfalls: np.ndarray) -> np.ndarray:
    """Sums of rows (m, ...) from after each footfall up to the next; of the first, nothing."""
    rows = np.zeros((len(footfalls), *values.shape[1:]))
    if len(footfalls) > 1:
        rows[1:] = np.add.reduceat(values[: footfalls[-1] + 1], footfalls[:-1] + 1, axis=0)
    return rows


def _quiet(made: Sums, first: int, last: int) -> tuple[float, float, float]:
    """Seconds, mean vertical rate and mean temperature in the middle of a rest between two resets."""
    begin = int(np.searchsorted(made.t, made.t[first] + SETTLING_S))
    end = int(np.searchsorted(made.t, made.t[last] - LEAVING_S, side="right")) - 1
    if end <= begin:
        return 0.0, 0.0, np.nan
    seconds = float(made.t[end] - made.t[begin])
    rows = slice(begin + 1, end + 1)
    turned = float(made.sums[rows][:, TURN].sum())
    return seconds, turned / seconds, float(made.temperature[rows].sum()) / seconds
