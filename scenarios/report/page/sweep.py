"""The page of a study: what each axis does to each method, case by case, failures, and a few tracks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from footfall.scenarios.report.page import html
from footfall.scenarios.report.page.cases import Cases, flat, middle
from footfall.scenarios.report.page.charts import (
    Axis,
    Chart,
    Hover,
    Looks,
    Trace,
    looks_of,
    scale,
)
from footfall.scenarios.report.page.document import Page, Section, again, sentence, versions
from footfall.scenarios.report.page.scores import (
    LABELS,
    NAMES,
    label_of,
    summary_columns,
    summary_row,
    unit_of,
)
from footfall.scenarios.report.page.study_tracks import read_tracks, track_charts, track_figure

_MOST_LEVELS = 12  # of an axis whose values stand side by side; more are drawn where they lie
_BINS = 8  # of such an axis, each with its own median
_MOST_POINTS = 4000  # in a panel; a browser takes its time over more
_MOST_SETTINGS = 2000  # rows of the table of settings
_MOST_FAILURES = 1000  # rows of the table of failures
_SLOT = 0.8  # of the room of a value, for all methods together
_GOLDEN = 0.618034


@dataclass(frozen=True)
class _Panel:
    """An axis and where it puts each row; `levels` are its values where there are few."""

    place: str
    label: str
    values: np.ndarray
    levels: tuple[Any, ...] | None

    @property
    def ordered(self) -> bool:
        """Whether a line from value to value means something."""
        return self.levels is None or all(isinstance(level, (int, float)) for level in self.levels)


def sweep_page(folder: Path, told: Mapping[str, Any]) -> Page:
    """The page of the study in `folder`, whose study.json says what is `told`.

    Raises
    ------
    InputError
        A file of the study is missing or broken.
    """
    cases = Cases.read(folder / "results.parquet")
    methods = [method["name"] for method in told["methods"]]
    looks = looks_of(methods)
    panels = _panels(cases, told)
    shown = read_tracks(folder)
    failed = f", of which {cases.lost:,} failed" if cases.lost else ""
    lead = f"{sentence(told['description'])}{len(cases):,} rows{failed}."
    sections = (
        Section("summary", "Summary", _summary(cases, methods)),
        Section("axes", "Axes", _figures(panels, looks, len(cases))),
        Section("tracks", "Tracks", track_figure(shown)),
        Section("settings", "Settings", _settings(cases, told)),
        Section("failures", "Failures", _failures(cases)),
        Section("parameters", "Parameters", _parameters(told)),
        Section("origin", "Versions", versions(told)),
        Section("again", "Make it again", again(told, "study.json")),
    )
    charts = [*_charts(cases, panels, looks), *track_charts(shown, looks)]
    return Page("sweep", told["name"], lead, sections, charts)


def _panels(cases: Cases, told: Mapping[str, Any]) -> list[_Panel]:
    """The study's axes, and what else of scenario and sheet differs."""
    axes = {address: _label(axis) for address, axis in told["axes"].items() if address in cases.columns}
    names = {"scenario": "scenario", **({} if "imu" in axes else {"imu": "IMU"}), **axes}
    found: list[_Panel] = []
    for name, label in names.items():
        values = cases.texts(name)
        there = [value for value in dict.fromkeys(values) if value != ""]
        if len(there) < 2:
            continue
        wanted = told["axes"].get(name, {}).get("values", told["scenarios"] if name == "scenario" else ())
        order = [value for value in wanted if value in there] if isinstance(wanted, list) else []
        if set(order) != set(there):
            order = sorted(there, key=lambda value: (isinstance(value, str), value))
        few = len(order) <= _MOST_LEVELS or not all(isinstance(value, (int, float)) for value in order)
        found.append(_Panel(f"axis-{len(found)}", label, values, tuple(order) if few else None))
    return found


def _label(axis: Mapping[str, Any]) -> str:
    return f"{axis['label']} ({axis['unit']})" if axis["unit"] else str(axis["label"])


def _figures(panels: Sequence[_Panel], looks: Looks, rows: int) -> str:
    if not panels:
        return ""
    few = f" Of {rows:,} cases some {_MOST_POINTS:,} are drawn." if rows > _MOST_POINTS else ""
    return (
        html.controls(
            html.radios("score", "Score", {name: LABELS[name] for name in NAMES}),
            html.boxes("method", "Methods", looks),
        )
        + html.paragraph(
            "Each panel has one axis and takes all values of the others together. Small marks: cases. "
            "Filled: the median. Open: the 90th percentile. A dotted line without marks: the median "
            f"of a method that has no such setting.{few}"
        )
        + '<div class="charts">'
        + "".join(html.figure(panel.place, panel.label) for panel in panels)
        + "</div>"
    )


def _charts(cases: Cases, panels: Sequence[_Panel], looks: Looks) -> Iterator[Chart]:
    names = cases.texts("method")
    scores = {name: cases.scores(name) for name in NAMES}
    step = max(1, -(-len(cases) // _MOST_POINTS))
    for panel in panels:
        made: dict[str, list[Trace]] = {name: [] for name in NAMES}
        for i, (method, (colour, mark)) in enumerate(looks.items()):
            own = np.flatnonzero(names == method)
            look: dict[str, Any] = {
                "colour": colour,
                "symbol": mark,
                "when": {"method": method},
            }
            has = np.array([value != "" for value in panel.values[own]], bool)
            if not has.any():
                for name in NAMES:
                    made[name] += _level(panel, method, middle(scores[name][own])["median"], look)
                continue
            own = own[has]
            x, centres, groups = _places(panel, panel.values[own], i, len(looks))
            some = cases.where(own[::step])
            for name in NAMES:
                y, unit = scores[name][own], unit_of(name)
                value = Hover(label_of(name), y[::step], 2, unit)
                points = Trace(
                    method,
                    x[::step],
                    y[::step],
                    mode="markers",
                    size=4,
                    opacity=0.35,
                    hover=(value, *some.hover()),
                    **look,
                )
                made[name] += [
                    points,
                    *_middles(panel, method, centres, [y[group] for group in groups], unit, look),
                ]
        for name in NAMES:
            y = scale(LABELS[name], np.concatenate([np.asarray(trace.y) for trace in made[name]]))
            yield Chart(panel.place, _axis(panel), y, made[name], when={"score": name})


def _axis(panel: _Panel) -> Axis:
    if panel.levels is None:
        return scale(panel.label, np.array([value for value in panel.values if value != ""], float))
    labels = [f"{level:.3g}" if isinstance(level, float) else html.told(level) for level in panel.levels]
    if len(set(labels)) < len(labels):
        labels = [html.told(level) for level in panel.levels]
    ticks = tuple((float(i), label) for i, label in enumerate(labels))
    return Axis(panel.label, ticks=ticks, bounds=(-0.6, len(panel.levels) - 0.4))


def _places(
    panel: _Panel, values: np.ndarray, method: int, methods: int
) -> tuple[np.ndarray, np.ndarray, list[np.ndarray]]:
    """Where the cases of a method stand along x, where their groups do, and which rows these are.

    Few values stand side by side, with the methods beside each other; cases of one are strewn a little.
    """
    if panel.levels is None:
        x = values.astype(float)
        groups = [group for group in np.array_split(np.argsort(x, kind="stable"), _BINS) if len(group)]
        return x, np.array([np.median(x[group]) for group in groups]), groups
    rank = {level: i for i, level in enumerate(panel.levels)}
    at = np.array([rank[value] for value in values])
    room = _SLOT / methods
    shift = (method - (methods - 1) / 2) * room
    strewn = (np.arange(len(at)) * _GOLDEN % 1 - 0.5) * 0.8 * room
    there = [i for i in range(len(panel.levels)) if (at == i).any()]
    return at + shift + strewn, np.array(there) + shift, [np.flatnonzero(at == i) for i in there]


def _middles(
    panel: _Panel,
    method: str,
    x: np.ndarray,
    values: Sequence[np.ndarray],
    unit: str,
    look: Mapping[str, Any],
) -> Iterator[Trace]:
    """Medians and 90th percentiles over the cases of each group."""
    found = [middle(group) for group in values]
    count = Hover("cases", [float(np.isfinite(group).sum()) for group in values], 0)
    mode = "lines+markers" if panel.ordered else "markers"
    for name, symbol, dash in (("median", look["symbol"], "solid"), ("p90", f"{look['symbol']}-open", "dot")):
        y = np.array([one[name] for one in found])
        hover = (Hover(name, y, 2, unit), count)
        more = {**look, "symbol": symbol}
        yield Trace(method, x, y, mode=mode, dash=dash, size=9, width=1.6, hover=hover, **more)


def _level(panel: _Panel, method: str, value: float, look: Mapping[str, Any]) -> list[Trace]:
    """A line across, of a method that the axis does not concern."""
    if panel.levels is None:
        numbers = np.array([v for v in panel.values if v != ""], float)
        ends = [float(numbers.min()), float(numbers.max())]
    else:
        ends = [-0.5, len(panel.levels) - 0.5]
    return [Trace(method, ends, [value, value], dash="dot", **look)]


def _summary(cases: Cases, methods: Sequence[str]) -> str:
    names = cases.texts("method")
    rows = []
    for method in methods:
        own = names == method
        rows.append([method, *summary_row(cases.where(own))])
    return html.table("All cases of each method", ("method", *summary_columns()), rows)


def _settings(cases: Cases, told: Mapping[str, Any]) -> str:
    names = [name for name in told["axes"] if name in cases.columns and name != "imu"]
    by = ["scenario", "imu", *names, "method"]
    groups = list(cases.groups(by))
    if len(groups) > _MOST_SETTINGS:
        return html.paragraph(f"{len(groups):,} settings are too many for a table: see results.parquet.")
    rows: list[list[html.Cell]] = []
    for key, own in groups:
        cells: list[html.Cell] = [
            html.Number(float(value), html.told(value)) if isinstance(value, (int, float)) else str(value)
            for value in key
        ]
        rows.append([*cells, *summary_row(cases.where(own))])
    heads = [told["axes"][name]["label"] for name in names]
    return html.table(
        "Every setting by every method", ("scenario", "IMU", *heads, "method", *summary_columns()), rows
    )


def _failures(cases: Cases) -> str:
    reasons = cases.failures()
    if not reasons:
        return html.paragraph("No case failed.")
    made = html.table(
        "Reasons",
        ("cases", "method", "stage", "reason"),
        [[html.integer(count), *rest] for count, *rest in reasons],
    )
    lost = cases.where(cases.texts("stage") != "")
    shown = lost.where(np.arange(min(len(lost), _MOST_FAILURES)))
    names = ("scenario", "walk_seed", "unit_seed", "imu", "method", "stage", "error")
    rows: list[list[html.Cell]] = [
        [html.integer(value) if isinstance(value, int) else str(value) for value in row]
        for row in zip(*(shown.texts(name) for name in names), strict=True)
    ]
    heads = ("scenario", "walk seed", "unit", "IMU", "method", "stage", "reason")
    made += html.table("Failed cases", heads, rows)
    if len(lost) > len(shown):
        made += html.paragraph(f"The first {_MOST_FAILURES:,} of {len(lost):,}; all are in results.parquet.")
    return made


def _parameters(told: Mapping[str, Any]) -> str:
    axes = {address: f"{_label(axis)}: {html.told(axis['values'])}" for address, axis in told["axes"].items()}
    made = html.pairs("Axes", axes) + html.pairs("The same for all", told.get("set") or {})
    if told.get("without"):
        made += html.paragraph(f"Sensor effects switched off: {html.told(told['without'])}.")
    made += '<div class="columns">'
    for method in told["methods"]:
        own = {"what": method["description"], **dict(flat(method["parameters"] or {}))}
        made += html.pairs(f"Method {method['name']}", own)
    return (
        made + html.pairs("Cases", told["cases"]) + html.pairs("Design", told.get("design") or {}) + "</div>"
    )
