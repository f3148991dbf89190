"""How far a foot's mean stride is from those of others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from footfall.pdr.gait.statistics import SIGNALS


def distance(mean: np.ndarray, others: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How far a mean stride is from others', signal by signal.

    Parameters
    ----------
    mean : (phases, signals)
    others : (recordings, phases, signals), their mean strides, two or more

    Returns
    -------
    far : (signals,) RMS difference from the mean of the others over the RMS of their standard deviation
    within : (signals,) share of the stride that lies within the others' mean +- 2 standard deviations
    """
    centre, spread = others.mean(axis=0), others.std(axis=0, ddof=1)
    off = mean - centre
    far = np.sqrt(np.mean(off**2, axis=0) / np.mean(spread**2, axis=0))
    return far, np.mean(np.abs(off) <= 2 * spread, axis=0)


def distances(means: Mapping[str, np.ndarray], real: Sequence[str]) -> dict[str, dict[str, float]]:
    """`distance` of every foot from the real ones, of a real one from the others: by foot and row."""
    found = {}
    for name, mean in means.items():
        far, within = distance(mean, np.array([means[other] for other in real if other != name]))
        found[name] = {f"distance {signal}": float(value) for signal, value in zip(SIGNALS, far, strict=True)}
        found[name] |= {
            f"within {signal}": 100 * float(value) for signal, value in zip(SIGNALS, within, strict=True)
        }
    return found
