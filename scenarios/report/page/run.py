"""The page of a run: tracks on a map, their errors and where these come from, scores, how to repeat it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from footfall.columns import BUDGET, PLACE, POSITION, QUATERNION
from footfall.hdr.filtered import FILTER_UNITS
from footfall.pdr.track import Track, read_track
from footfall.scenarios.judge.score import Comparison, compare
from footfall.scenarios.judge.statistics import running_mean
from footfall.scenarios.report.page import html
from footfall.scenarios.report.page.cases import flat
from footfall.scenarios.report.page.charts import (
    INK,
    SOFT,
    Axis,
    Chart,
    Hover,
    Looks,
    Trace,
    frame,
    looks_of,
    thinned,
)
from footfall.scenarios.report.page.document import Page, Section, again, sentence, versions
from footfall.scenarios.report.page.scores import score_columns, scores_row
from footfall.simulate.walk import TrueFootfalls, footfalls_path
from footfall.tables import read_table, read_units, require_columns

MOST_WALKS = 12  # whose tracks are drawn; the tables tell of all
_MOST_EVIDENCE = 5  # of a method's columns; more would fill a small screen
_SHOWN_SHARE = 0.03  # of the largest cause of drift; smaller ones are pooled
_TIME = Axis("time (s)")
_MOST_CAUSES = 7  # as many colours as can be told apart
_ERRORS = ("heading_error_mean_deg", "heading_error_final_deg")
_DEGREES = {"rad": "deg", "rad/s": "deg/s", "rad/step": "deg/step"}


@dataclass(frozen=True)
class _Poses:
    """Of a walk's file what a track is judged by: a tenth of its columns."""

    t: np.ndarray
    position: np.ndarray
    quaternion: np.ndarray
    footfalls: TrueFootfalls
    meta: Mapping[str, Any]


@dataclass(frozen=True)
class _Walked:
    """A walk of the run as its files tell it. `units` of each method's evidence."""

    number: str
    poses: _Poses
    tracks: Mapping[str, Track]
    units: Mapping[str, Mapping[str, str]]
    beside: Mapping[str, Comparison]
    drift_t: np.ndarray
    interval: np.ndarray
    causes: Mapping[str, np.ndarray]
    total: np.ndarray

    @property
    def when(self) -> dict[str, str]:
        return {"walk": self.number}


def run_page(folder: Path, told: Mapping[str, Any]) -> Page:
    """The page of the run in `folder`, whose scores.json says what is `told`.

    Raises
    ------
    InputError
        A file of the run is missing or broken.
    """
    rows = told["walks"]
    methods = list(rows[0]["methods"])
    walks = [_read(folder, number, methods) for number in range(1, min(len(rows), MOST_WALKS) + 1)]
    looks = looks_of(methods)
    count = "1 walk" if len(rows) == 1 else f"{len(rows)} walks"
    walked = f"{count} of {told['distance_m']:,.0f} m, IMU {rows[0]['imu']}, methods {', '.join(methods)}."
    lead = sentence(told.get("description")) + walked
    causes = _shown_causes(walks)
    sections = (
        Section("summary", "Summary", _tiles(told["mean"], looks)),
        Section("tracks", "Tracks", _figures(rows, looks, causes)),
        Section("scores", "Scores", _scores(told, rows, methods)),
        Section("parameters", "Parameters", _parameters(told, walks[0])),
        Section("origin", "Seeds and versions", _origin(told, rows, walks[0])),
        Section("again", "Make it again", again(told, "scores.json")),
    )
    return Page("run", str(told["scenario"]), lead, sections, list(_charts(walks, looks, causes)))


def _read(folder: Path, number: int, methods: Sequence[str]) -> _Walked:
    file = folder / f"walk-{number}.parquet"
    names = ("t", *POSITION, *QUATERNION)
    columns, meta = read_table(file, names)
    beside = footfalls_path(file)
    falls, _ = read_table(beside)
    require_columns(str(beside), falls, ("t", *PLACE, "heading"))
    truth = TrueFootfalls(falls["t"], np.column_stack([falls[axis] for axis in PLACE]), falls["heading"])
    place, attitude = (np.column_stack([columns[name] for name in part]) for part in (POSITION, QUATERNION))
    poses = _Poses(columns["t"], place, attitude, truth, meta)
    files = {name: folder / f"walk-{number}.{name}.parquet" for name in methods}
    tracks = {name: read_track(source) for name, source in files.items()}
    drift_file = folder / f"walk-{number}.drift.parquet"
    drift, _ = read_table(drift_file)
    require_columns(str(drift_file), drift, tuple(BUDGET))
    return _Walked(
        number=str(number),
        poses=poses,
        tracks=tracks,
        units={name: read_units(source) for name, source in files.items()},
        beside={name: compare(track, poses) for name, track in tracks.items()},
        drift_t=drift["t"],
        interval=drift["interval"],
        causes={name: np.degrees(rate) for name, rate in drift.items() if name not in BUDGET},
        total=np.degrees(drift["total"]),
    )


def _figures(
    rows: Sequence[Mapping[str, Any]],
    looks: Looks,
    causes: Mapping[str, str],
) -> str:
    shown = {str(i + 1): f"{i + 1}, unit {row['unit']}" for i, row in enumerate(rows[:MOST_WALKS])}
    few = (
        f"The first {MOST_WALKS} walks are drawn; the tables have all walks."
        if len(rows) > MOST_WALKS
        else ""
    )
    return (
        html.controls(
            html.radios("walk", "Walk", shown),
            html.boxes("method", "Methods", looks),
        )
        + (html.paragraph(few) if few else "")
        + '<div class="charts">'
        + html.figure(
            "map",
            "Map",
            "Seen from above, both axes at one scale. Wide and grey: the true walk, from the triangle on. "
            "Each point is a footfall, the large one the last.",
            kind="wide",
        )
        + html.figure(
            "error", "Heading error", "Estimate - truth at each footfall, counted in full beyond 180 deg."
        )
        + html.figure(
            "drift",
            "Drift and correction",
            "Grey: the true drift of the gyro about the vertical, mean of 25 strides. Coloured: what each "
            "method takes for drift: -I for HDR, for others the rate at which they turn PDR's heading back. "
            "Jumps leave the frame.",
        )
        + html.figure(
            "budget",
            "Drift budget",
            "The causes of the uncorrected heading error: the drift of each, summed over the strides. "
            "Small causes are taken together.",
            kind="wide",
            legend=html.legend(
                {cause.replace("_", " "): colour for cause, colour in [*causes.items(), ("sum", INK)]}
            ),
        )
        + "</div>"
    )


def _charts(walks: Sequence[_Walked], looks: Looks, causes: Mapping[str, str]) -> Iterator[Chart]:
    for walk in walks:
        x, y = walk.poses.footfalls.position[:, :2].T
        start = Trace("start", x[:1], y[:1], INK, mode="markers", size=12, symbol="triangle-up")
        tracks = [Trace("truth", x, y, SOFT, width=6, opacity=0.45), start]
        errors, corrections = [], [_true_drift(walk)]
        for name, (colour, mark) in looks.items():
            row, mine, hover = walk.beside[name], {"method": name}, _hover(walk, name)
            x, y = row.estimate.T
            end = Trace(name, x[-1:], y[-1:], colour, mode="markers", size=11, symbol=mark, when=mine)
            both = "lines+markers"
            tracks += [Trace(name, x, y, colour, mode=both, symbol=mark, when=mine, hover=hover), end]
            errors.append(
                Trace(name, row.t, np.degrees(row.heading_error), colour, when=mine, hover=hover[:3])
            )
            correction = _correction(walk, name)
            if correction is not None:
                corrections.append(_line(name, row.t, correction, colour, "deg/s", when=mine))
        yield Chart("map", Axis("x (m)"), Axis("y (m)"), tracks, equal=True, when=walk.when)
        yield Chart("error", _TIME, Axis("heading error (deg)"), errors, when=walk.when)
        rate = Axis("drift (deg/s)", bounds=frame(corrections))
        yield Chart("drift", _TIME, rate, corrections, when=walk.when)
        yield Chart("budget", _TIME, Axis("heading error (deg)"), _budget(walk, causes), when=walk.when)


def _line(name: str, t: np.ndarray, values: np.ndarray, colour: str, unit: str, **more: Any) -> Trace:
    """A smooth line over time."""
    t, values = thinned(t, values)
    digits = 3 if unit == "deg/s" else 1
    hover = (Hover("time", t, 1, "s"), Hover(name, values, digits, unit))
    return Trace(name, t, values, colour, width=2, hover=hover, **more)


def _hover(walk: _Walked, name: str) -> tuple[Hover, ...]:
    """Time, heading, error and drift at each footfall, and the method's own evidence."""
    row, track, units = walk.beside[name], walk.tracks[name], walk.units[name]
    error = np.degrees(row.heading_error)
    middles = (walk.drift_t[:-1] + walk.drift_t[1:]) / 2
    drift = walk.total[np.searchsorted(middles, row.t)]
    told = [
        Hover("time", row.t, 1, "s"),
        # The true heading is the same for all methods of the same footfalls.
        Hover("heading", error, 1, "deg", plus=np.degrees(row.heading)),
        Hover("error", error, 1, "deg"),
        Hover("drift", drift, 3, "deg/s"),
    ]
    evidence = [key for key in track.evidence if key not in FILTER_UNITS][:_MOST_EVIDENCE]
    for key in evidence:
        unit, values = units.get(key, ""), np.asarray(track.evidence[key], dtype=float)
        if unit in _DEGREES:
            unit, values = _DEGREES[unit], np.degrees(values)
        told.append(Hover(key.replace("_", " "), values, 3, unit))
    return tuple(told)


def _true_drift(walk: _Walked) -> Trace:
    return _line("true drift", walk.drift_t, running_mean(walk.total), SOFT, "deg/s")


def _correction(walk: _Walked, name: str) -> np.ndarray | None:
    """(n,) deg/s that a method takes for drift at each footfall; None where nothing tells.

    HDR says it: -I (Borenstein et al. 2008, Eq. 5). Of others it is the rate at which their heading leaves
    PDR's behind, which comes to the same.
    """
    track = walk.tracks[name]
    if "integrator" in track.evidence:
        return -np.degrees(track.evidence["integrator"])
    pdr = walk.tracks.get("pdr")
    if pdr is None or name == "pdr":
        return None
    turned = np.degrees(np.interp(track.t, pdr.t, pdr.heading) - track.heading)
    return running_mean(np.gradient(turned, track.t))


def _summed(walk: _Walked, rates: np.ndarray) -> np.ndarray:
    return np.cumsum(rates * walk.interval)


def _shown_causes(walks: Sequence[_Walked]) -> dict[str, str]:
    """Cause -> colour of those that are drawn by themselves, the largest first."""
    peak = {
        cause: max(float(np.abs(_summed(walk, walk.causes[cause])).max()) for walk in walks)
        for cause in walks[0].causes
    }
    ranked = sorted(peak, key=lambda cause: -peak[cause])[:_MOST_CAUSES]
    shown = [cause for cause in ranked if peak[cause] > _SHOWN_SHARE * peak[ranked[0]]]
    found = {cause: f"s{i}" for i, cause in enumerate(shown)}
    return found | ({"all others": SOFT} if len(shown) < len(peak) else {})


def _budget(walk: _Walked, causes: Mapping[str, str]) -> list[Trace]:
    others = sum(
        (rates for cause, rates in walk.causes.items() if cause not in causes), np.zeros(len(walk.total))
    )
    rates = {**walk.causes, "all others": others, "sum": walk.total}
    made = [
        _line(cause.replace("_", " "), walk.drift_t, _summed(walk, rates[cause]), colour, "deg")
        for cause, colour in {**causes, "sum": INK}.items()
    ]
    return made


def _tiles(mean: Mapping[str, Mapping[str, float]], looks: Looks) -> str:
    made = []
    for name, score in mean.items():
        more = f"mean heading error, {score['heading_error_final_deg']:.1f} deg at the end"
        ours, theirs = score["heading_error_mean_deg"], mean.get("pdr", score)["heading_error_mean_deg"]
        if name != "pdr" and "pdr" in mean and min(ours, theirs) > 0:
            times, word = (theirs / ours, "smaller") if ours <= theirs else (ours / theirs, "larger")
            more += f"; {times:.1f} times {word} than uncorrected"
        made.append((name, looks[name][0], f"{score['heading_error_mean_deg']:.1f} deg", more))
    return html.tiles(made)


def _scores(told: Mapping[str, Any], rows: Sequence[Mapping[str, Any]], methods: Sequence[str]) -> str:
    lines: list[list[html.Cell]] = [
        [html.integer(i + 1), html.integer(row["unit"]), name, *scores_row(row["methods"][name])]
        for i, row in enumerate(rows)
        for name in methods
    ]
    foot: list[list[html.Cell]] = [["mean", "", name, *scores_row(told["mean"][name])] for name in methods]
    made = html.table(
        "Each walk by each method",
        ("walk", "unit", "method", *score_columns()),
        lines,
        foot if len(rows) > 1 else [],
    )
    for key, caption, columns in (
        ("other_units", "{} other units of the same sheet on the same walks", ("mean", "median", "p90")),
        (
            "other_noises",
            "Mean over the walks, with {} other noise seeds",
            ("median", "smallest", "largest"),
        ),
    ):
        if key not in told:
            continue
        heads = [f"{error}, {column} (deg)" for error in ("average", "final") for column in columns]
        body = [
            [name, *(html.number(found[error][column]) for error in _ERRORS for column in columns)]
            for name, found in told[key]["methods"].items()
        ]
        made += html.table(f"Heading error: {caption.format(told[key]['count'])}", ("method", *heads), body)
    return made


def _parameters(told: Mapping[str, Any], walk: _Walked) -> str:
    made = html.pairs("Set for this run", told.get("settings") or {})
    if told.get("without"):
        made += html.paragraph(f"Sensor effects switched off: {html.told(told['without'])}.")
    made += html.paragraph("Values are in SI units and radians, as the tracks hold them.")
    common: dict[str, Any] = {}
    made += '<div class="columns">'
    for name, track in walk.tracks.items():
        meta = track.meta
        own = dict(flat(meta.get("params") or {})) | dict(flat(meta.get("filter") or {}, "filter."))
        own |= {key: meta[key] for key in ("use", "version") if key in meta}
        made += html.pairs(f"Method {name}", own)
        common |= dict(flat(meta.get("pdr") or {}))
    return made + html.pairs("Dead reckoning", common) + "</div>"


def _origin(told: Mapping[str, Any], rows: Sequence[Mapping[str, Any]], walk: _Walked) -> str:
    seeds = [
        [
            html.integer(i + 1),
            html.integer(row["seed"]),
            html.integer(row["unit"]),
            html.integer(row["noise"]),
            row["subject"],
            html.integer(row["footfalls"]),
        ]
        for i, row in enumerate(rows)
    ]
    heads = ("walk", "seed of the walk", "of the unit", "of the noise", "subject", "footfalls")
    digests = {
        key: walk.poses.meta[key] for key in ("scenario_digest", "policy", "code") if key in walk.poses.meta
    }
    return html.table("Seeds", heads, seeds) + versions(told) + html.pairs("Digests of what walked", digests)
