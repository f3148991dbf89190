"""What the page's script draws: charts of traces whose numbers are kept once each, as float32 in base64."""

from __future__ import annotations

import base64
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from footfall.scenarios.report.style import COLOURS, MORE, colours_of

SOFT, INK = "soft", "ink"  # colours of truth and of sums
SLOTS = tuple(
    dict.fromkeys((*COLOURS.values(), *MORE))
)  # of the figures; page.css has a page's shade of each

_WIDE = 30.0  # of the largest value over the smallest: from here on an axis is logarithmic

Numbers = Sequence[float] | np.ndarray


@dataclass(frozen=True)
class Axis:
    """`ticks`: position -> label, where they are not left to the script; `bounds`: first and last value."""

    title: str
    log: bool = False
    ticks: tuple[tuple[float, str], ...] = ()
    bounds: tuple[float, float] | None = None


@dataclass(frozen=True)
class Hover:
    """A line of what is told at a point: values + `plus`, which several traces may share."""

    label: str
    values: Numbers
    digits: int = 1
    unit: str = ""
    plus: Numbers | None = None


@dataclass(frozen=True)
class Trace:
    """A line or points.

    Attributes
    ----------
    colour : name of a colour of page.css
    mode : "lines", "markers" or "lines+markers"
    when : name of a choice -> the value that must be chosen for this to be shown
    hover : what is told at a point; nothing where empty
    """

    name: str
    x: Numbers
    y: Numbers
    colour: str
    mode: str = "lines"
    width: float = 1.6
    dash: str = "solid"
    size: float = 4
    symbol: str = "circle"
    opacity: float = 1.0
    when: Mapping[str, str] = field(default_factory=dict)
    hover: tuple[Hover, ...] = ()


@dataclass(frozen=True)
class Mark:
    """What is marked along an `axis` ("x" or "y"): a line where both ends are the same, else a band."""

    axis: str
    low: float
    high: float
    colour: str
    dash: str = "solid"


@dataclass(frozen=True)
class Chart:
    """Traces in the `figure` of id `place`.

    Attributes
    ----------
    equal : whether a metre is as long along y as along x
    when : as of a trace, for several charts of one place
    """

    place: str
    x: Axis
    y: Axis
    traces: Sequence[Trace]
    equal: bool = False
    marks: tuple[Mark, ...] = ()
    when: Mapping[str, str] = field(default_factory=dict)


class _Arrays:
    """Numbers by content: what several traces share, as times, is written once."""

    def __init__(self) -> None:
        self.kept: dict[str, int] = {}

    def add(self, values: Numbers) -> int:
        coded = base64.b64encode(np.asarray(values, dtype="<f4").tobytes()).decode("ascii")
        return self.kept.setdefault(coded, len(self.kept))


def chart_data(charts: Sequence[Chart]) -> dict[str, Any]:
    """The charts as JSON can hold them, and their numbers apart."""
    arrays = _Arrays()

    def trace_data(trace: Trace) -> dict[str, Any]:
        plain = {name: value for name, value in vars(trace).items() if name not in ("x", "y", "hover")}
        hover = [
            vars(item)
            | {
                "values": arrays.add(item.values),
                "plus": None if item.plus is None else arrays.add(item.plus),
            }
            for item in trace.hover
        ]
        return plain | {"x": arrays.add(trace.x), "y": arrays.add(trace.y), "hover": hover}

    made = []
    for chart in charts:
        axes = {"x": asdict(chart.x), "y": asdict(chart.y)}
        parts = {
            "traces": [trace_data(trace) for trace in chart.traces],
            "marks": [vars(mark) for mark in chart.marks],
        }
        made.append(vars(chart) | axes | parts)
    return {"charts": made, "arrays": list(arrays.kept)}


def scale(title: str, values: np.ndarray) -> Axis:
    """An axis for these values: logarithmic where they are positive and far apart, with ticks of 1, 2, 5."""
    values = values[np.isfinite(values)]
    if not len(values) or values.min() <= 0 or values.max() < _WIDE * values.min():
        return Axis(title)
    decades = range(math.floor(math.log10(values.min())), math.ceil(math.log10(values.max())) + 1)
    steps = (1, 2, 5) if len(decades) <= 4 else (1,)
    ticks = tuple((step * 10.0**decade, f"{step * 10.0**decade:g}") for decade in decades for step in steps)
    return Axis(title, log=True, ticks=ticks)


def thinned(*columns: np.ndarray, most: int = 300) -> list[np.ndarray]:
    """At most so many rows of columns, evenly taken, first and last among them: enough for a smooth line."""
    count = len(columns[0])
    kept = np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))
    return [column[kept] for column in columns]


def slots_of(methods: Sequence[str]) -> dict[str, str]:
    """A colour of page.css for each method: the shade of the one that it has in the figures."""
    return {name: f"s{SLOTS.index(colour)}" for name, colour in colours_of(methods).items()}


def symbols_of(methods: Sequence[str]) -> dict[str, str]:
    """A marker for each method, for those to whom colours say little."""
    marks = ("circle", "square", "diamond", "triangle-up", "cross", "star", "hexagon", "triangle-down")
    return {name: marks[i % len(marks)] for i, name in enumerate(methods)}
