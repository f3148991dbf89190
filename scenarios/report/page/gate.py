"""The page of gates: the verdicts, and of each gate its cases with estimate, bounds and limit."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from footfall.scenarios.judge.bounds import log_ratios
from footfall.scenarios.judge.gate import QUANTILES, floor_of
from footfall.scenarios.judge.verdict import Verdict as Gate
from footfall.scenarios.judge.verdict import figure, is_change, told
from footfall.scenarios.report.page import html
from footfall.scenarios.report.page.cases import Cases
from footfall.scenarios.report.page.charts import INK, SOFT, Axis, Chart, Hover, Mark, Trace, scale, slots_of
from footfall.scenarios.report.page.document import Page, Section, again, sentence, versions
from footfall.scenarios.report.page.scores import (
    LABELS,
    NAMES,
    label_of,
    summary_columns,
    summary_row,
    unit_of,
)

_WORDS = {"pass": "✓ pass", "fail": "✗ fail", "undecided": "? undecided"}
_CASE = ("scenario", "walk_seed", "imu", "unit_seed", "noise_seed")


@dataclass(frozen=True)
class _Drawn:
    """A gate and its cases: (n,) scores, or ratios to another method; infinite where the method failed."""

    gate: Gate
    values: np.ndarray
    cases: Cases

    @property
    def share(self) -> float:
        """Of the cases, % that the estimate stands for; NaN of a share, which is the estimate itself."""
        return 100 * QUANTILES.get(self.gate.statistic, math.nan)


def gate_page(folder: Path, document: Mapping[str, Any]) -> Page:
    """The page of the gates in `folder`, whose gate.json says what `document` does.

    Raises
    ------
    InputError
        A file of the gates is missing or broken.
    """
    cases = Cases.read(folder / "cases.parquet")
    gates = [_gate(row) for row in document["gates"]]
    colours = slots_of(list(dict.fromkeys(cases.texts("method"))))
    drawn = {f"gate-{i}": _drawn(gate, cases) for i, gate in enumerate(gates)}
    about = document["cases"]
    counts = {
        word: sum(gate.verdict == kind for gate in gates)
        for kind, word in (("pass", "passed"), ("fail", "failed"), ("undecided", "undecided"))
    }
    said = ", ".join(f"{count} {word}" for word, count in counts.items() if count)
    where = f"{about['scenario']}: {about['units']} units on {about['walks']} walks, IMU {about['imu']}."
    seeds = {f"of the first of {name}": seed for name, seed in about["seeds"].items()}
    ended = f"{sentence(said)}Exit code {document['exit_code']}."
    lead = f"{sentence(document.get('description'))}{where} {ended}"
    sections = (
        Section("verdicts", "Verdicts", _verdicts(gates, document.get("confidence", 0.95))),
        Section("cases", "Cases", _figures(drawn, colours)),
        Section("scores", "Scores", _scores(cases)),
        Section("failures", "Failures", _failures(cases)),
        Section("origin", "Seeds and versions", html.pairs("Seeds", seeds) + versions(document)),
        Section("again", "Make it again", again(document, "gate.json")),
    )
    return Page("gate", document["name"], lead, sections, list(_charts(drawn, colours)))


def _gate(row: Mapping[str, Any]) -> Gate:
    """A verdict as it was before JSON, which knows no infinity, took its bounds."""
    empty = {"estimate": math.nan, "low": -math.inf, "high": math.inf, "limit": math.nan}
    values: dict[str, Any] = {
        name: empty.get(name) if value is None else value for name, value in row.items()
    }
    return Gate(**values)


def _verdicts(gates: Sequence[Gate], confidence: float) -> str:
    rows: list[list[html.Cell]] = []
    for gate in gates:
        shown = [gate.low, gate.high] if gate.statistic != "same" and gate.reason != "identical" else []
        ends = [figure(end, is_change(gate)) if math.isfinite(end) else "none" for end in shown]
        sign = ">=" if gate.statistic == "share_below" else "<="
        limit = f"within {gate.limit:g} %" if gate.statistic == "same" else f"{sign} {told(gate.limit, gate)}"
        against = f" against {gate.against}" if gate.against else ""
        rows.append(
            [
                gate.name,
                _WORDS[gate.verdict],
                html.Number(gate.estimate, told(gate.estimate, gate)),
                html.Number(gate.low if ends else None, f"{' to '.join(ends)} {gate.unit}" if ends else ""),
                html.Number(gate.limit, limit),
                html.integer(gate.cases),
                f"{gate.statistic}, {_metric(gate)} of {gate.method}{against}",
                gate.reason,
            ]
        )
    bounds = f"{100 * confidence:.4g} % bounds"
    return html.table(
        "The gates of this file",
        ("gate", "verdict", "estimate", bounds, "limit", "cases", "what", "why"),
        rows,
    )


def _metric(gate: Gate) -> str:
    return label_of(gate.metric) if gate.metric in LABELS else gate.metric


def _drawn(gate: Gate, cases: Cases) -> _Drawn | None:
    """A gate with its cases, where they are in the folder: those of a baseline are not."""
    names = cases.texts("method")
    own = cases.where(names == gate.method)
    if gate.statistic == "same" or gate.metric not in NAMES or not len(own):
        return None
    values = _magnitudes(own, gate.metric)
    if gate.against is not None:
        other = cases.where(names == gate.against)
        if not len(other):
            return None
        theirs = dict(zip(_keys(other), _magnitudes(other, gate.metric), strict=True))
        beside = np.array([theirs.get(key, np.nan) for key in _keys(own)])
        values = np.exp(log_ratios(values, beside, floor_of(gate.metric)))
    counted = ~np.isnan(values)
    order = np.flatnonzero(counted)[np.argsort(values[counted], kind="stable")]
    return _Drawn(gate, values[order], own.where(order))


def _magnitudes(cases: Cases, metric: str) -> np.ndarray:
    found = cases.scores(metric)
    return np.where(np.isnan(found), np.inf, found)


def _keys(cases: Cases) -> list[tuple[Any, ...]]:
    return list(zip(*(cases.texts(name) for name in _CASE), strict=True))


def _figures(drawn: Mapping[str, _Drawn | None], colours: Mapping[str, str]) -> str:
    made, missing = [], []
    for place, one in drawn.items():
        if one is None:
            missing.append(place)
            continue
        lost = int(np.isinf(one.values).sum())
        failed = f" {lost} failed cases count as infinitely bad and are not drawn." if lost else ""
        entries = {"a case": colours[one.gate.method], "estimate and its bounds": SOFT, "limit": INK}
        caption = f"{_WORDS[one.gate.verdict]}. Each point is a case, in order.{failed}"
        made.append(html.figure(place, one.gate.name, caption, legend=html.legend(entries)))
    told = "Not drawn: a gate of sameness, or one against a baseline, whose cases are in a file of their own."
    return (f'<div class="charts">{"".join(made)}</div>' if made else "") + (
        html.paragraph(told) if missing else ""
    )


def _charts(drawn: Mapping[str, _Drawn | None], colours: Mapping[str, str]) -> Iterator[Chart]:
    for place, one in drawn.items():
        if one is None:
            continue
        gate, there = one.gate, np.isfinite(one.values) & (one.values > -np.inf)
        x = one.values[there]
        y = 100 * (np.arange(len(one.values)) + 1)[there] / max(len(one.values), 1)
        ratio = is_change(gate)
        label = label_of(gate.metric)
        title = f"{label} over that of {gate.against}" if ratio else LABELS[gate.metric]
        unit = "" if ratio else unit_of(gate.metric)
        hover = (
            Hover("ratio" if ratio else label, x, 2, unit),
            Hover("share of the cases", y, 0, "%"),
            *one.cases.where(there).hover(),
        )
        points = Trace(gate.method, x, y, colours[gate.method], mode="markers", size=7, hover=hover)
        yield Chart(
            place,
            scale(title, x),
            Axis("share of the cases (%)", bounds=(-3, 103)),
            (points,),
            marks=_marks(one, x),
        )


def _marks(one: _Drawn, x: np.ndarray) -> tuple[Mark, ...]:
    """Estimate, bounds and limit: along the scores, or, of a share, along the shares."""
    gate = one.gate
    if not len(x) or math.isnan(gate.estimate):
        return ()
    side = "y" if gate.statistic == "share_below" else "x"
    ends = (0.0, 100.0) if side == "y" else (float(x[0]), float(x[-1]))
    values = [gate.estimate, gate.low, gate.high, gate.limit]
    if is_change(gate):
        values = [1 + value / 100 for value in values]
    low, high = (value if math.isfinite(value) else end for value, end in zip(values[1:3], ends, strict=True))
    estimate, limit = values[0], values[3]
    marks = [Mark(side, low, high, SOFT)]
    marks += [Mark(side, estimate, estimate, SOFT)] if math.isfinite(estimate) else []
    marks += [Mark(side, limit, limit, INK, "dash")]
    return (*marks, Mark("y", one.share, one.share, SOFT, "dot")) if side == "x" else tuple(marks)


def _scores(cases: Cases) -> str:
    rows = [[str(method), *summary_row(cases.where(own))] for (method,), own in cases.groups(("method",))]
    return html.table("The cases of each method", ("method", *summary_columns()), rows)


def _failures(cases: Cases) -> str:
    reasons = cases.failures()
    rows: list[list[html.Cell]] = [[html.integer(count), *rest] for count, *rest in reasons]
    if not rows:
        return html.paragraph("No case failed.")
    return html.table("Reasons", ("cases", "method", "stage", "reason"), rows)
