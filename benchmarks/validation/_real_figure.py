"""Tracks of real feet over their measured footprints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from benchmarks.validation._real import Real
from footfall.pdr.track import Track
from footfall.scenarios.judge.reference import laid_on
from footfall.scenarios.report.style import entitle, head, label_edges, label_of, new_panels, save, widths_of

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
            axis.plot(*place[0], "^", color="#222222", ms=6, ls="", label="start")
        widths = widths_of(list(SHOWN))
        for name, colour in SHOWN.items():
            if (real.name, name) not in tracks:
                continue
            place = laid(real, tracks[real.name, name])
            axis.plot(*place.T, "-", color=colour, lw=widths[name], label=label_of(name))
            axis.plot(*place[-1], "s", color=colour, ms=5)
        if real.footprints is None:
            axis.plot(0, 0, "^", color="#222222", ms=6, ls="", label="start")
        entitle(axis, real.name)
        axis.set_aspect("equal", adjustable="datalim")
    label_edges(panels, "x (m)", "y (m)")
    told = "Squares: where each track ends. Without footprints, the walk ended at its start."
    head(figure, f"Real feet, default settings. {told}", panels)
    save(figure, path)
