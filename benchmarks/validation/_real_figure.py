"""Tracks of real feet over their measured footprints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from benchmarks.validation._real import Real
from footfall.pdr.track import Track
from footfall.scenarios.judge.reference import laid_on
from footfall.scenarios.report.style import head, label_edges, new_panels, save

SHOWN = {"pdr": "#c1440e", "iez": "#1f6fb4", "iez-paper": "#888888"}


def laid(real: Real, track: Track) -> np.ndarray:
    """(n, 2) the track laid on the footprints; without any, turned along its first strides."""
    prints = real.footprints
    if prints is not None:
        return laid_on(track, prints)(track.position[:, :2])
    place = track.position[:, :2] - track.position[0, :2]
    ahead = place[min(4, len(place) - 1)]
    c, s = ahead / np.hypot(*ahead)
    return np.asarray(place @ np.array([[c, -s], [s, c]]))


def draw(reals: Sequence[Real], tracks: Mapping[tuple[str, str], Track], path: Path) -> None:
    """A panel a recording: footprints, and the tracks of `SHOWN`."""
    figure, panels = new_panels(len(reals), 3.1, 2.8, columns=4)
    for axis, real in zip(panels, reals, strict=True):
        if real.footprints is not None:
            place = real.footprints.position
            axis.plot(*place.T, "o", ms=4.5, mfc="none", mec="#222222", mew=0.8, label="footprints")
        for name, colour in SHOWN.items():
            if (real.name, name) not in tracks:
                continue
            place = laid(real, tracks[real.name, name])
            axis.plot(*place.T, "-", color=colour, lw=1.1, marker=".", ms=3, label=name)
            axis.plot(*place[-1], "s", color=colour, ms=5)
        if real.footprints is None:
            axis.plot(0, 0, "^", color="#222222", ms=7, label="start and end")
        axis.set_title(real.name, fontsize=9)
        axis.set_aspect("equal", adjustable="datalim")
    label_edges(panels, "x (m)", "y (m)")
    head(figure, "Real feet, default settings; squares: where each track ends", panels)
    save(figure, path)
