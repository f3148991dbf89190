"""The tracks that a study keeps, on a map: one is chosen at a time."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from footfall.conventions import wrap
from footfall.errors import InputError
from footfall.pdr.track import Track, read_track
from footfall.scenarios.report.page import html
from footfall.scenarios.report.page.charts import INK, SOFT, Axis, Chart, Hover, Trace
from footfall.tables import read_table, require_columns


@dataclass(frozen=True)
class ShownTrack:
    """A track of the study beside the true footfalls."""

    entry: Mapping[str, Any]
    truth: Mapping[str, np.ndarray]
    track: Track

    @property
    def label(self) -> str:
        entry = self.entry
        axes = [f"{axis} {html.told(value)}" for axis, value in entry["axes"].items() if value is not None]
        where = [
            entry["scenario"],
            entry["imu"],
            f"walk seed {entry['walk_seed']}",
            f"unit {entry['unit_seed']}",
        ]
        return f"{entry['method']}, {entry['which']}: {', '.join([*where, *axes])}"

    @property
    def heading_error(self) -> np.ndarray:
        """(n,) deg, against the true footfall that is nearest in time."""
        t = self.truth["t"]
        near = np.searchsorted((t[:-1] + t[1:]) / 2, self.track.t)
        off = np.unwrap(self.track.heading - self.truth["heading"][near])
        return np.degrees(off - off[0] + wrap(off[0]))


def read_tracks(folder: Path) -> list[ShownTrack]:
    index = folder / "tracks" / "index.json"
    if not index.is_file():
        return []
    try:
        entries = json.loads(index.read_text(encoding="utf-8"))
    except ValueError as error:
        raise InputError(f"not a readable JSON file ({error})", index) from None
    truths: dict[str, dict[str, np.ndarray]] = {}
    for name in dict.fromkeys(entry["truth"] for entry in entries):
        truths[name], _ = read_table(folder / "tracks" / name)
        require_columns(name, truths[name], ("t", "x", "y", "heading"))
    return [
        ShownTrack(entry, truths[entry["truth"]], read_track(folder / "tracks" / entry["file"]))
        for entry in entries
    ]


def track_figure(shown: Sequence[ShownTrack]) -> str:
    if not shown:
        return ""
    return html.controls(
        html.radios("track", "Track", {str(i): one.label for i, one in enumerate(shown)}), kept=False
    ) + html.figure(
        "track",
        "Map",
        "The best, the median and the worst track of each method by its mean heading error. Wide and grey: "
        "the true walk from the triangle on. Each point is a footfall, the large one the last.",
        kind="wide",
    )


def track_charts(shown: Sequence[ShownTrack], colours: Mapping[str, str]) -> Iterator[Chart]:
    for i, one in enumerate(shown):
        name, truth, track = one.entry["method"], one.truth, one.track
        (x, y), colour = track.position[:, :2].T, colours.get(name, INK)
        hover = (
            Hover("time", track.t, 1, "s"),
            Hover("heading", np.degrees(track.heading), 1, "deg"),
            Hover("error", one.heading_error, 1, "deg"),
        )
        start = truth["x"][:1], truth["y"][:1]
        traces = (
            Trace("truth", truth["x"], truth["y"], SOFT, width=6, opacity=0.45),
            Trace("start", *start, INK, mode="markers", size=12, symbol="triangle-up"),
            Trace(name, x, y, colour, mode="lines+markers", hover=hover),
            Trace(name, x[-1:], y[-1:], colour, mode="markers", size=11),
        )
        yield Chart("track", Axis("x (m)"), Axis("y (m)"), traces, equal=True, when={"track": str(i)})
