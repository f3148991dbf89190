"""A package that brings a method: once it is installed, `smoothed` is a name like `hdr`."""

import numpy as np

from footfall import Track
from footfall.hdr.correct import turned_positions


def smoothed(footfalls, start):
    """The heading's mean over five footfalls, from where it starts."""
    mean = np.convolve(np.pad(footfalls.heading, 2, mode="edge"), np.full(5, 0.2), mode="valid")
    heading = mean - mean[0] + start.heading
    return Track(t=footfalls.t, position=turned_positions(footfalls, heading), heading=heading)


smoothed.needs = "footfalls"
