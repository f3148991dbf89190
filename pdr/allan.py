"""Allan deviation of a sensor at rest, and the averaging time for a static bias that follows from it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from footfall.errors import InputError
from footfall.late import late

optimize = late("scipy.optimize")


def allan_deviation(x: np.ndarray, interval: float, tau: ArrayLike) -> np.ndarray:
    """Overlapping Allan deviation (IEEE Std 952, annex C).

    Parameters
    ----------
    x : (n,) or (n, k) rate, or any signal that is averaged
    interval : s between samples
    tau : (m,) s, averaging times; each is rounded to a whole number of samples

    Returns
    -------
    (m,) or (m, k), in the unit of x

    Raises
    ------
    InputError
        An averaging time is shorter than a sample or longer than half the record.
    """
    theta = np.concatenate([np.zeros((1, *x.shape[1:])), np.cumsum(x - x.mean(axis=0), axis=0)]) * interval
    rows = []
    for seconds in np.atleast_1d(np.asarray(tau, dtype=float)):
        m = round(seconds / interval)
        if not 1 <= m <= len(x) // 2:
            raise InputError(
                f"tau = {seconds:g} s: expected {interval:g} s to half the record's {len(x) * interval:g} s"
            )
        second = theta[2 * m :] - 2 * theta[m:-m] + theta[: -2 * m]
        rows.append(np.sqrt(np.mean(second**2, axis=0) / 2) / (m * interval))
    return np.array(rows)


@dataclass(frozen=True)
class AllanFit:
    """Allan variance N^2 / tau + F^2 + K^2 tau / 3, as a sensor at rest shows it.

    Attributes
    ----------
    white : N, unit of x times sqrt(s): angle random walk of a gyro
    floor : F, unit of x: bias instability, .664 of the flicker coefficient B
    random_walk : K, unit of x per sqrt(s): rate random walk
    longest : s, the longest averaging time that the record could show
    """

    white: float
    floor: float
    random_walk: float
    longest: float

    @property
    def knee(self) -> float:
        """Averaging time (s) at which white noise is half of the variance; at most `longest`."""
        # N^2 / T = F^2 + K^2 T / 3, solved in the form that stands K = 0
        b, n, k = self.floor**2, self.white**2, self.random_walk**2 / 3
        denominator = b + math.sqrt(b * b + 4 * k * n)
        return min(2 * n / denominator, self.longest) if denominator else self.longest


def fit_allan(x: np.ndarray, interval: float) -> AllanFit:
    """Read white noise, floor and random walk off the Allan variance, averaged over the axes.

    Parameters
    ----------
    x : (n,) or (n, k) a sensor's output at rest; ten minutes or more for a trustworthy floor
    interval : s between samples

    Raises
    ------
    InputError
        The record is shorter than 10 s or 90 samples, or holds nothing but one constant.
    """
    duration = len(x) * interval
    least = max(10.0, 90 * interval)
    if duration < least:
        raise InputError(f"Allan deviation: {duration:g} s at rest, expected at least {least:g} s")
    # From 10 samples on: less is coloured by filters and quantisation. Up to a ninth of the record: averages
    # over more are too few to tell anything.
    tau = interval * np.unique(np.round(np.geomspace(10, duration / 9 / interval, 60)))
    variance = np.mean(allan_deviation(x.reshape(len(x), -1), interval, tau) ** 2, axis=1)
    if not variance.all():
        raise InputError("Allan deviation: the record holds one constant, not a sensor's noise")
    # An estimate over tau scatters by a share of sqrt(tau / duration) of itself: equal scatter in every row.
    weight = 1 / (variance * np.sqrt(tau))
    terms = np.column_stack([1 / tau, np.ones_like(tau), tau / 3])
    size = np.linalg.norm(terms * weight[:, None], axis=0)  # columns of one length condition the fit
    squares, _ = optimize.nnls(terms * weight[:, None] / size, variance * weight)
    white, floor, walk = np.sqrt(squares / size)
    return AllanFit(white=float(white), floor=float(floor), random_walk=float(walk), longest=float(tau[-1]))


def suggest_bias_time(gyro: np.ndarray, interval: float) -> float:
    """T_bias of the HDR paper (section 2): how long to average a gyro at rest for its static bias.

    It is the knee of the Allan deviation, where the white noise has come down to the floor. Up to there
    averaging removes noise; beyond it, what is left is the bias's own wandering. The minimum of the curve
    itself is flat, hence badly determined, and lies much later without being much lower.

    Parameters
    ----------
    gyro : (n, 3) or (n,) rad/s, at rest; ten minutes or more for a trustworthy answer
    interval : s between samples

    Returns
    -------
    s, at most a ninth of the record

    Raises
    ------
    InputError
        The record is shorter than 10 s or 90 samples, or holds nothing but one constant.
    """
    return fit_allan(gyro, interval).knee
