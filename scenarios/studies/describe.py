"""What a study says of itself: its document for programs and reports, and its lines for people."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from footfall.identity import plain
from footfall.scenarios.studies.plan import Cost, Plan
from footfall.simulate.plan import versions
from footfall.sources import STAGES, stage_digest
from footfall.tables import replacing

FORMAT = "footfall study 1"


def document(plan: Plan, command: str = "") -> dict[str, Any]:
    """A study as it was understood, with the versions that do it: study.json."""
    study = plan.study
    return {
        "format": FORMAT,
        "name": study.name,
        "description": study.file.description,
        "command": command or f"footfall sweep {study.source or study.name}",
        "versions": versions(),
        "digests": {stage: stage_digest(stage) for stage in STAGES},
        "scenarios": list(study.documents()),
        "methods": [
            {"name": method.name, "description": method.description, "parameters": plain(method.params)}
            for method in study.methods
        ],
        "axes": {
            address: {"values": plain(axis.values), "unit": axis.unit, "label": axis.label}
            for address, axis in plan.axes.items()
        },
        "cases": study.file.cases.model_dump(),
        "design": plain(study.file.design.model_dump(exclude={"axes", "points"})),
        "set": plain(dict(study.file.fixed)),
        "without": list(study.file.without),
        "rows": plan.rows,
    }


def write_document(plan: Plan, folder: Path, command: str = "") -> None:
    """study.json in the study's folder."""
    with replacing(folder / "study.json") as temporary:
        temporary.write_text(json.dumps(document(plan, command), indent=2) + "\n", encoding="utf-8")


def headline(plan: Plan) -> str:
    """A study in a line: what is multiplied, and how many rows that makes."""
    study, table = plan.study, plan.study.file.cases
    parts = [_count(len(study.file.scenarios), "scenario")]
    shared = {address: axis for address, axis in plan.axes.items() if study.owner(address) is None}
    if study.file.design.kind == "grid":
        parts += [f"{len(axis.values)} {axis.label}" for axis in shared.values()]
    elif shared:
        parts.append(f"{study.file.design.kind} of {', '.join(axis.label for axis in shared.values())}")
    units = _count(table.units, "unit")
    crossed = f"{units} on every walk" if table.crossed else units
    parts.append(crossed + (f" x {table.noises} noises" if table.noises > 1 else ""))
    sets = {method.name: 0 for method in study.methods}
    seen = set()
    for task in plan.tasks[:1]:
        for setting in task.settings:
            for cell in setting.cells:
                if (told := (cell.method.name, repr(cell.method.params))) not in seen:
                    seen.add(told)
                    sets[cell.method.name] += 1
    methods = " + ".join(f"{name} {count}" if count > 1 else name for name, count in sets.items())
    return f"{study.name}: {' x '.join(parts)} x ({methods}): {plan.rows:,} rows"


def cost_line(cost: Cost, cores: int) -> str:
    """What is left to do, and about how long it takes."""
    if not cost.rows:
        return "nothing is left to do"
    walks = f"walks {cost.walks}" + (f", {cost.cached} of them in the cache" if cost.cached else "")
    told = f"{walks}; {cost.recordings:,} recordings; {cost.reckonings:,} reckonings; {cost.rows:,} rows"
    return f"{told}; about {duration(cost.seconds / cores)} on {_count(cores, 'core')}"


def duration(seconds: float) -> str:
    """In words, with as much precision as an estimate has."""
    if seconds < 90:
        return f"{max(round(seconds), 1)} s"
    if seconds < 5400:
        return f"{round(seconds / 60)} min"
    return f"{seconds / 3600:.1f} h"


def failures(rows: Any) -> list[tuple[int, str]]:
    """How many rows failed for what reason, the most frequent first.

    A reason is told with what all of its rows have in common: method, sheet, scenario, walk.
    """
    import pyarrow.compute as pc

    lost = rows.filter(pc.not_equal(rows["stage"], "")).select(
        ["error", "method", "imu", "scenario", "number"]
    )
    groups: dict[str, list[dict[str, Any]]] = {}
    for row in lost.to_pylist():
        groups.setdefault(row["error"], []).append(row)
    found = [(len(own), f"{_common(own)}: {error}") for error, own in groups.items()]
    return sorted(found, key=lambda one: (-one[0], one[1]))


def _common(rows: Sequence[dict[str, Any]]) -> str:
    told = []
    for name in ("method", "imu", "scenario", "number"):
        values = {row[name] for row in rows}
        if len(values) == 1:
            value = values.pop()
            told.append(f"walk {value + 1}" if name == "number" else str(value))
    return ", ".join(told) or "several"


def _count(number: int, name: str) -> str:
    return f"{number:,} {name}" + ("" if number == 1 else "s")
