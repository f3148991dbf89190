"""The page of a sensitivity study: indices with their intervals, how they converged, the check."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from footfall.scenarios.report.page import html
from footfall.scenarios.report.page.charts import INK, SLOTS, SOFT, Axis, Chart, Hover, Trace, looks_of
from footfall.scenarios.report.page.document import Page, Section, again, sentence, versions
from footfall.scenarios.report.page.scores import LABELS, unit_of

_FIRST = looks_of(["total"])["total"][0]
_SHOWN = len(SLOTS)  # factors whose convergence is drawn: those with the greatest indices


def sensitivity_page(folder: Path, document: Mapping[str, Any]) -> Page:
    """The page of the study in `folder`, whose sensitivity.json says what `document` does."""
    methods = document["methods"]
    places = {method: f"method-{i}" for i, method in enumerate(methods)}
    count = len(document["cases"])
    metric = LABELS[document["metric"]]
    judged = f"{metric} of {', '.join(methods)} on {document['scenario']}, IMU {document['imu']}"
    asked = (
        f"{document['description']} "
        if document["description"].endswith("?")
        else sentence(document["description"])
    )
    lead = f"{asked}{judged[0].upper()}{judged[1:]}: {document['over']} over {count} cases."
    parts = [
        Section(
            f"about-{places[method]}", f"{method}: {one['nominal']:.3g} {unit_of(document['metric'])}", body
        )
        for method, one in methods.items()
        if (body := _method(document, places[method], one))
    ]
    checks = "".join(_check(method, one["check"]) for method, one in methods.items() if "check" in one)
    ranges = {name: _range(one) for name, one in document["parameters"].items()}
    sections = (
        *parts,
        Section("check", "The budget beside the full chain", checks),
        Section("ranges", "Ranges", html.pairs("Varied", ranges) + html.pairs("Set", document["set"])),
        Section("origin", "Versions", versions(document)),
        Section("again", "Make it again", again(document, "sensitivity.json")),
    )
    charts = [chart for method, one in methods.items() for chart in _charts(document, places[method], one)]
    return Page("sensitivity", document["name"], lead, sections, charts)


def _range(told: Mapping[str, Any]) -> str:
    if "values" in told:
        return html.told(told["values"])
    unit = f" {told['unit']}" if told.get("unit") else ""
    return f"{told['from']:g} to {told['to']:g}{unit}, {told.get('scale') or 'linear'}"


def _name(document: Mapping[str, Any], address: str) -> str:
    return str(document["parameters"][address].get("label") or address)


def _ranked(steps: Sequence[Mapping[str, Any]]) -> list[str]:
    """Addresses, the greatest total index first."""
    last = steps[-1]["parameters"]
    return sorted(last, key=lambda name: -last[name]["total"]["value"])


def _method(document: Mapping[str, Any], place: str, one: Mapping[str, Any]) -> str:
    body = ""
    if "sobol" in one:
        steps = one["sobol"]["steps"]
        last = steps[-1]
        entries = {"total, with its 95 % interval": _FIRST, "first order": SOFT}
        told = f"N = {last['samples']}; the widest interval is ± {last['widest']:.2f}."
        body += html.figure(place, "Shares of the variance", told, legend=html.legend(entries))
        names = _ranked(steps)[:_SHOWN]
        looks = looks_of(names)
        colours = {_name(document, name): looks[name][0] for name in names}
        told = "Total indices by the number of samples."
        body += html.figure(f"{place}-steps", "Convergence", told, legend=html.legend(colours))
        body = f'<div class="charts">{body}</div>'
        rows: list[list[html.Cell]] = []
        for name in _ranked(steps):
            found = last["parameters"][name]
            values = [found[kind][part] for kind in ("first", "total") for part in ("value", "half")]
            rows.append([_name(document, name), *(html.number(max(value, 0.0), 2) for value in values)])
        body += html.table("Sobol's indices", ("parameter", "first order", "±", "total", "±"), rows)
        apart = [
            "; ".join(_name(document, name) for name in group) for group in one["sobol"]["not_told_apart"]
        ]
        body += html.paragraph(f"Interplay: {one['sobol']['interplay']:+.2f}.")
        body += "".join(html.paragraph(f"Not told apart: {group}.") for group in apart)
    if "morris" in one:
        found = one["morris"]
        rows = [
            [
                _name(document, name),
                *(html.number(found[name][key], 2) for key in ("mu_star", "half", "sigma")),
            ]
            for name in sorted(found, key=lambda name: -found[name]["mu_star"])
        ]
        body += html.table("Morris: mean size of an effect", ("parameter", "mu*", "±", "sigma"), rows)
    return body


def _charts(document: Mapping[str, Any], place: str, one: Mapping[str, Any]) -> Iterator[Chart]:
    if "sobol" not in one:
        return
    steps = one["sobol"]["steps"]
    names = _ranked(steps)
    last = steps[-1]["parameters"]
    rows = np.arange(len(names)).astype(float)
    ticks = tuple((row, _name(document, name)) for row, name in zip(rows, names, strict=True))
    traces = []
    for row, name in zip(rows, names, strict=True):
        total = last[name]["total"]
        ends = (total["value"] - total["half"], total["value"] + total["half"])
        traces.append(Trace("interval", (row, row), ends, INK))
    for kind, colour, mark in (("total", _FIRST, "circle"), ("first", SOFT, "diamond")):
        values = np.array([last[name][kind]["value"] for name in names])
        hover = (Hover(f"{kind} index", values, 2),)
        traces.append(Trace(kind, rows, values, colour, mode="markers", size=9, symbol=mark, hover=hover))
    yield Chart(place, Axis("", ticks=ticks), Axis("index"), traces)
    samples = np.array([step["samples"] for step in steps], dtype=float)
    ticks = tuple((float(count), f"{count:.0f}") for count in samples)
    lines, looks = [], looks_of(names[:_SHOWN])
    for name in looks:
        values = np.array([step["parameters"][name]["total"]["value"] for step in steps])
        hover = (Hover(_name(document, name), values, 2),)
        lines.append(
            Trace(_name(document, name), samples, values, looks[name][0], mode="lines+markers", hover=hover)
        )
    yield Chart(f"{place}-steps", Axis("samples N", log=True, ticks=ticks), Axis("total index"), lines)


def _check(method: str, told: Mapping[str, Any]) -> str:
    rows: list[list[html.Cell]] = []
    for i, (full, budget) in enumerate(zip(told["full"], told["budget"], strict=True)):
        off = html.number(100 * (budget / full - 1), 0, sign=True)
        rows.append([html.integer(i + 1), html.number(full, 2), html.number(budget, 2), off])
    table = html.table(method, ("point", "full", "budget", "off (%)"), rows)
    ends = ", ".join(f"{name} {100 * off:+.0f} %" for name, off in told.get("ends_off", {}).items())
    return table + html.paragraph(f"Mean size {100 * told['mean_off']:.0f} %, but for the ends: {ends}.")
