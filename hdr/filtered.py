"""From the error-state filter's footfalls to a track."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from footfall import __version__
from footfall.identity import plain
from footfall.pdr.filter.ins import FilterSettings
from footfall.pdr.filter.run import Filtered
from footfall.pdr.track import Track

FILTER_UNITS: Mapping[str, str] = {
    "gyro_bias_x": "rad/s",
    "gyro_bias_y": "rad/s",
    "gyro_bias_z": "rad/s",
    "heading_sd": "rad",
}


def filter_track(
    filtered: Filtered,
    settings: FilterSettings,
    *,
    name: str,
    evidence: Mapping[str, np.ndarray] | None = None,
    units: Mapping[str, str] | None = None,
) -> Track:
    """The filter's footfalls as a track.

    Parameters
    ----------
    name : of the method, for the track's provenance
    evidence, units : the heading method's own columns, (n,) each, and their units

    Returns
    -------
    Track
        Evidence: gyro bias in the body, the heading's standard deviation, and what is given.
    """
    columns = (*filtered.gyro_bias.T, filtered.heading_sd)
    return Track(
        t=filtered.footfalls.t,
        position=filtered.footfalls.position,
        heading=filtered.footfalls.heading,
        evidence=dict(zip(FILTER_UNITS, columns, strict=True)) | dict(evidence or {}),
        units=dict(FILTER_UNITS) | dict(units or {}),
        meta={"method": name, "version": __version__, "filter": plain(settings)},
    )
