"""What gates say: tables for people, and documents for programs."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any
from xml.etree import ElementTree as xml

import numpy as np
from rich.console import RenderableType
from rich.text import Text

from footfall.identity import plain
from footfall.scenarios.judge.verdict import Verdict, figure, is_change, told
from footfall.scenarios.report.tables import new_table, titled
from footfall.scenarios.run import OTHER_UNITS_FROM
from footfall.scenarios.studies.gate import Judged
from footfall.scenarios.studies.gate_file import Gates
from footfall.simulate.plan import versions

FORMAT = "footfall gate 1"

_STYLES = {"pass": "green", "fail": "red", "undecided": "yellow"}
_EMPTY = ("estimate", "low", "high", "limit")  # of a verdict, where there is no such figure


def gate_report(judged: Judged) -> list[RenderableType]:
    """What a file of gates prints for people."""
    confidence = f"{100 * (1 - judged.alpha):.4g} %"
    table = new_table("gate", "estimate", f"{confidence} bounds", "limit", "verdict")
    for verdict in judged:
        table.add_row(Text(verdict.name), *_cells(verdict), Text(verdict.verdict, _STYLES[verdict.verdict]))
    said = [Text(line) for line in remarks(judged)]
    return [Text.assemble((cases_line(judged.gates), "bold")), table, Text(), *said, cases_table(judged)]


def cases_line(gates: Gates) -> str:
    """Which cases they are."""
    setup, walks = gates.setup, min(gates.walks, gates.units)
    return (
        f"{setup.scenario.name}: {_count(gates.units, 'unit')} on {_count(walks, 'walk')}, {setup.imu}, "
        f"seeds {gates.seed}.. / {OTHER_UNITS_FROM}.."
    )


def remarks(judged: Judged) -> Iterator[str]:
    """What the table leaves open: reasons, scatter, failures."""
    for verdict in judged:
        if verdict.reason and verdict.reason != "identical":
            units = f" (--units {verdict.needed})" if verdict.needed else ""
            yield f"{verdict.verdict}: {verdict.name}: {verdict.reason}{units}"
    for verdict in judged:
        if verdict.scatter:
            yield (
                f"{verdict.method} against {verdict.against}: log ratios scatter by {verdict.scatter:.2g} "
                "from case to case"
            )
        if verdict.left_out:
            yield f"{verdict.name}: both failed in {_count(verdict.left_out, 'case')}, left out"
    for method in dict.fromkeys(row.method for row in judged.rows):
        failures = judged.rows.of(method).failures
        if failures:
            first = failures[0]
            yield f"{method}: {len(failures)} of {len(judged.rows.of(method))} cases failed: {first.error}"


def cases_table(judged: Judged) -> RenderableType:
    """Scores over the cases; a mean or a largest one is told, and gates nothing: one unit makes it."""
    table = new_table("method", "score", "median", "p90", "mean", "largest", "failed", left=2)
    for method, metric in _scored(judged):
        rows = judged.rows.of(method)
        values = np.abs(rows.values(metric))
        values = values[~np.isnan(values)]
        figures = []
        if len(values):
            figures = [np.median(values), np.percentile(values, 90), values.mean(), values.max()]
        cells = [figure(float(value)) for value in figures] or [""] * 4
        table.add_row(method, metric, *cells, str(len(rows.failures) or ""))
    return titled("The cases, by themselves", table)


def gate_document(judged: Judged, command: str = "") -> dict[str, Any]:
    """The document of `gate --json` (docs/gates.md). Figures that are not there are null."""
    gates = judged.gates
    return {
        "format": FORMAT,
        "name": gates.name,
        "description": gates.description,
        "command": command,
        "versions": versions(),
        "cases": {
            "scenario": gates.setup.scenario.name,
            "walks": min(gates.walks, gates.units),
            "units": gates.units,
            "seeds": {"walks": gates.seed, "units": OTHER_UNITS_FROM},
            "imu": gates.setup.imu,
        },
        "confidence": 1 - judged.alpha,
        "gates": [plain(verdict) for verdict in judged],
        "exit_code": judged.exit_code,
    }


def junit(judged: Judged) -> bytes:
    """JUnit's XML: a gate is a test case. Undecided is an error: what is skipped is shown as green."""
    count = {kind: sum(one.verdict == kind for one in judged) for kind in _STYLES}
    numbers = {"tests": len(judged), "failures": count["fail"], "errors": count["undecided"], "skipped": 0}
    attributes = {"name": judged.gates.name} | {key: str(value) for key, value in numbers.items()}
    suite = xml.Element("testsuite", attributes)
    for verdict in judged:
        case = xml.SubElement(suite, "testcase", name=verdict.name, classname=f"footfall.{judged.gates.name}")
        sentence = verdict_line(verdict)
        if verdict.verdict == "fail":
            xml.SubElement(case, "failure", message=sentence, type="fail").text = sentence
        elif verdict.verdict == "undecided":
            xml.SubElement(case, "error", message=sentence, type="undecided").text = sentence
        else:
            xml.SubElement(case, "system-out").text = sentence
    root = xml.Element("testsuites")
    root.append(suite)
    xml.indent(root)
    return bytes(xml.tostring(root, encoding="utf-8", xml_declaration=True)) + b"\n"


def markdown(judged: Judged) -> str:
    """A section for the summary of a pull request."""
    head = ("gate", "estimate", f"{100 * (1 - judged.alpha):.4g} % bounds", "limit", "verdict")
    marks = {"pass": "pass", "fail": "**fail**", "undecided": "**undecided**"}
    rows = [(verdict.name, *_cells(verdict), marks[verdict.verdict]) for verdict in judged]
    lines = [
        f"### Gates: {_escaped(judged.gates.name)}",
        "",
        _escaped(cases_line(judged.gates)),
        "",
        _row(head),
        _row(["---", *["---:"] * 3, "---"]),
        *(_row(map(_escaped, row[:-1]), row[-1]) for row in rows),
        "",
        *(f"- {_escaped(line)}" for line in remarks(judged)),
    ]
    return "\n".join(lines) + "\n\n"


def verdict_line(verdict: Verdict) -> str:
    """A verdict in one line, for logs."""
    estimate, bounds, limit = _cells(verdict)
    between = f" ({bounds})" if bounds else ""
    reason = f": {verdict.reason}" if verdict.reason else ""
    failed = (
        f"; {verdict.failed} of {verdict.cases + verdict.left_out} cases failed: {verdict.failure}"
        if verdict.failed
        else ""
    )
    return f"{verdict.verdict}: {verdict.name}: {estimate}{between}, limit {limit}{reason}{failed}"


def _cells(verdict: Verdict) -> tuple[str, str, str]:
    """Estimate, bounds and limit."""
    if verdict.statistic == "same":
        return f"{verdict.estimate:.0f} of {verdict.cases} moved", "", f"{verdict.limit:g} %"
    if verdict.reason == "identical":
        return "identical", "", f"<= {told(verdict.limit, verdict)}"
    signed = is_change(verdict)
    low, high = (
        figure(value, signed) if math.isfinite(value) else "" for value in (verdict.low, verdict.high)
    )
    bounds = f"{low} .. {high} {verdict.unit}" if low or high else "none"
    sign = ">=" if verdict.statistic == "share_below" else "<="
    return told(verdict.estimate, verdict), bounds, f"{sign} {_plainly(verdict)} {verdict.unit}"


def _plainly(verdict: Verdict) -> str:
    """The limit as it stands in the file."""
    return f"{verdict.limit:+g}" if is_change(verdict) else f"{verdict.limit:g}"


def _scored(judged: Judged) -> list[tuple[str, str]]:
    """Method and metric of whatever is gated."""
    pairs = []
    for gate in judged.gates.gates:
        metrics = gate.metrics if len(gate.metrics) == 1 else ("heading_error_mean_deg",)
        others = [] if gate.against is None or judged.gates.baseline(gate) else [gate.against]
        pairs += [(method, metric) for method in (gate.method, *others) for metric in metrics]
    return list(dict.fromkeys(pairs))


def _count(number: int, what: str) -> str:
    return f"{number} {what}" if number == 1 else f"{number} {what}s"


def _escaped(text: str) -> str:
    return text.replace("|", "\\|").replace("<", "&lt;").replace("\n", " ")


def _row(cells: Any, *more: str) -> str:
    return f"| {' | '.join((*cells, *more))} |"
