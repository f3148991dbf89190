"""Is this a straight walk at a walking rhythm? The evidence of IHDE (Deng et al. 2018, section 2.4)."""

from __future__ import annotations

import math
from collections.abc import Sequence

from footfall.conventions import wrap


def circular_mean(angles: Sequence[float]) -> float:
    """Mean direction of angles (rad), in the turn of the last one; psibar of Eq. 20.

    The paper averages numbers, which fails where headings cross 0 and 360 deg.
    """
    last = angles[-1]
    c = sum(math.cos(angle - last) for angle in angles)
    s = sum(math.sin(angle - last) for angle in angles)
    return last + math.atan2(s, c)


def circular_std(angles: Sequence[float]) -> float:
    """Standard deviation of angles (rad) about their circular mean, Eq. 20 with differences wrapped.

    sqrt(sum wrap(psi_l - psibar)^2 / (W - 1)); 0 for a single angle.
    """
    if len(angles) < 2:
        return 0.0
    mean = circular_mean(angles)
    return math.sqrt(sum(float(wrap(angle - mean)) ** 2 for angle in angles) / (len(angles) - 1))


def z_membership(std: float, k1: float, a: float) -> float:
    """Membership in "straight", Eq. 21: 1 / (1 + exp(k1 std - a)); 1/2 where std = a / k1.

    Parameters
    ----------
    std : rad; k1 : 1/rad, positive; a : positive
    """
    return 0.5 * (1.0 - math.tanh(0.5 * (k1 * std - a)))  # the same, and no overflow


def bell_membership(stride_time: float, b: float, c: float, gamma_t: float) -> float:
    """Membership in "walking at an ordinary rhythm", Eq. 22: 1 / (1 + b |ST - gamma_T|^(2 c)).

    Parameters
    ----------
    stride_time : s, from footfall to footfall of the same foot; gamma_t : s, the usual one
    b : s^-(2c), positive; c : positive
    """
    return 1.0 / (1.0 + b * abs(stride_time - gamma_t) ** (2 * c))
