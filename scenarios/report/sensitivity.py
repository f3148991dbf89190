"""What a sensitivity study says: tables for people, a document for programs, points, figures."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from rich.console import RenderableType
from rich.text import Text

from footfall.late import late
from footfall.scenarios.judge.gate import unit_of
from footfall.scenarios.report.style import label_of
from footfall.scenarios.report.tables import new_table, titled
from footfall.scenarios.studies.check import LIMIT, Check
from footfall.scenarios.studies.indices import Index, not_told_apart
from footfall.scenarios.studies.sensitivity import Found
from footfall.scenarios.studies.sensitivity_file import Study
from footfall.simulate.plan import versions
from footfall.tables import replacing

if TYPE_CHECKING:
    from rich.table import Table

pa, pq = late("pyarrow"), late("pyarrow.parquet")

FORMAT = "footfall sensitivity 1"
WORDS = {
    "heading_error_mean_deg": "mean heading error",
    "heading_error_final_deg": "final heading error",
    "return_error_pct": "return error",
    "distance_error_pct": "distance error",
    "position_rmse_m": "rms position error",
    "position_error_final_m": "final position error",
}
_BAR = 20  # characters of an index of 1


def asked(study: Study) -> str:
    """One line: what is judged, over what."""
    file = study.file
    cases = len(file.cases.deal(study.base.setup()))
    over = "each unit by itself" if file.units_as_factor else f"{file.over} over {cases} units"
    (method,) = study.base.methods
    what = ", as a ratio" if file.of == "ratio" else ""
    return f"{WORDS[file.metric]} of {label_of(method.name)} on {file.scenario}, {over}{what}"


def check_report(study: Study, check: Check) -> RenderableType:
    """The budget beside the full chain."""
    unit = unit_of(study.file.metric)
    table = new_table("point", f"full ({unit})", f"budget ({unit})", "off")
    for i, (full, budget, off) in enumerate(zip(check.full, check.budget, check.off, strict=True)):
        table.add_row(str(i + 1), f"{full:.3g}", f"{budget:.3g}", f"{100 * off:+.0f} %")
    verdict = "good for means and ranks" if check.mean_off <= LIMIT else "do not use"
    table.add_row("mean size", "", "", f"{100 * check.mean_off:.0f} %: {verdict}", style="bold")
    return titled("The budget beside the full chain, at points of their own", table)


def sensitivity_report(found: Found) -> list[RenderableType]:
    """What `footfall sensitivity` prints for people."""
    study, unit = found.study, unit_of(found.study.file.metric)
    parts: list[RenderableType] = [
        Text.assemble((study.name, "bold"), f": {asked(study)}"),
        Text(f"At the documents' own values: {found.nominal:.3g} {unit}\n", style="dim"),
    ]
    if found.morris is not None:
        parts.append(titled(f"Morris: mean size of an effect over a whole range{_in(study)}", _morris(found)))
    if found.sobol is not None:
        samples = found.sobol.samples
        points = samples * (len(study.factors) + 2)
        parts.append(titled(f"Sobol: shares of the variance, N = {samples}, {points} points", _sobol(found)))
        parts.append(_convergence(found))
        parts.append(Text("\n".join(remarks(found))))
    return parts


def remarks(found: Found) -> list[str]:
    """What is to be said of the indices besides."""
    sobol = found.sobol
    assert sobol is not None
    told = [
        f"interplay: the total indices add up to {1 + sobol.interplay:.2f}, {sobol.interplay:+.2f} from 1"
    ]
    for group in not_told_apart(sobol.total):
        told.append(f"not told apart: {', '.join(found.study.factors[i].name for i in group)}")
    asked_for = found.study.file.sobol
    if asked_for is not None and sobol.widest > asked_for.widest:
        told.append(
            f"not converged: the widest interval is +-{sobol.widest:.2f}, asked for +-{asked_for.widest:g}; "
            f"raise sobol.at_most"
        )
    return told


def _in(study: Study) -> str:
    return " (factor e^mu*)" if study.file.of == "ratio" else f" ({unit_of(study.file.metric)})"


def _morris(found: Found) -> Table:
    assert found.morris is not None
    table = new_table("parameter", "mu*", "+-", "sigma")
    for i in sorted(range(len(found.morris)), key=lambda i: -found.morris[i].mu_star):  # type: ignore[index]
        one = found.morris[i]
        table.add_row(found.study.factors[i].name, *(f"{v:.3g}" for v in (one.mu_star, one.half, one.sigma)))
    return table


def order_of(indices: Sequence[Index]) -> list[int]:
    """The greatest first."""
    return sorted(range(len(indices)), key=lambda i: -indices[i].value)


def _sobol(found: Found) -> Table:
    assert found.sobol is not None
    table = new_table("parameter", "first", "+-", "total", "+-", "")
    table.columns[-1].justify = "left"
    for i in order_of(found.sobol.total):
        first, total = found.sobol.first[i], found.sobol.total[i]
        figures = (f"{v:.2f}" for v in (first.shown, first.half, total.shown, total.half))
        bar = "#" * max(0, round(_BAR * first.shown))
        bar += "-" * max(0, round(_BAR * total.shown) - len(bar))
        table.add_row(found.study.factors[i].name, *figures, bar)
    return table


def _convergence(found: Found) -> RenderableType:
    names = [found.study.factors[i].name for i in order_of(found.convergence[-1].total)[:3]]
    table = new_table("N", "widest +-", *names)
    for step in found.convergence:
        best = order_of(found.convergence[-1].total)[:3]
        table.add_row(str(step.samples), f"{step.widest:.2f}", *(f"{step.total[i].shown:.2f}" for i in best))
    return titled("Total indices by the number of samples", table)


def sensitivity_document(found: Found, command: str) -> dict[str, Any]:
    """The document of `sensitivity --json` (docs/sensitivity.md)."""
    study, file = found.study, found.study.file
    setup = study.base.setup()
    names = [factor.address for factor in study.factors]
    document: dict[str, Any] = {
        "format": FORMAT,
        "name": study.name,
        "description": file.description,
        "command": command,
        "versions": versions(),
        "scenario": setup.scenario.name,
        "imu": setup.imu,
        "method": setup.methods[0].name,
        "metric": file.metric,
        "over": file.over,
        "of": file.of,
        "fidelity": file.fidelity,
        "cases": [[one.walk_seed, one.unit_seed] for one in file.cases.deal(setup)],
        "units_as_factor": file.units_as_factor,
        "set": dict(file.set),
        "parameters": {factor.address: factor.as_dict() for factor in study.factors},
        "nominal": finite_or_none(found.nominal),
    }
    if found.check is not None:
        check = found.check
        document["check"] = {
            "points": check.shares.tolist(),
            "full": check.full.tolist(),
            "budget": check.budget.tolist(),
            "mean_off": check.mean_off,
        }
    if found.morris is not None:
        document["morris"] = {
            name: {"mu_star": one.mu_star, "half": one.half, "sigma": one.sigma}
            for name, one in zip(names, found.morris, strict=True)
        }
    if found.sobol is not None:
        document["sobol"] = {
            "steps": [
                {
                    "samples": step.samples,
                    "widest": step.widest,
                    "parameters": {
                        name: {"first": _index(first), "total": _index(total)}
                        for name, first, total in zip(names, step.first, step.total, strict=True)
                    },
                }
                for step in found.convergence
            ],
            "interplay": found.sobol.interplay,
            "not_told_apart": [[names[i] for i in group] for group in not_told_apart(found.sobol.total)],
        }
    return document


def _index(index: Index) -> dict[str, float]:
    return {"value": index.value, "half": index.half}


def finite_or_none(value: float) -> float | None:
    """JSON has no infinity."""
    return value if math.isfinite(value) else None


def write_sensitivity(found: Found, document: dict[str, Any], folder: Path) -> None:
    """sensitivity.json, points.parquet and the figures, into the existing `folder`.

    Raises
    ------
    InputError
        The folder cannot be written.
    """
    from footfall.scenarios.report.sensitivity_figures import draw_effects, draw_indices

    with replacing(folder / "sensitivity.json") as temporary:
        temporary.write_text(json.dumps(document, indent=2) + "\n", encoding="utf-8")
    rows = list(found.rows())
    columns = {name: _column([row[name] for row in rows]) for name in rows[0]}
    with replacing(folder / "points.parquet") as temporary:
        pq.write_table(pa.table(columns), temporary, compression="zstd")
    draw_indices(found, folder / "indices.png")
    draw_effects(found, folder / "effects.png")


def _column(values: list[Any]) -> Any:
    """Numbers and texts as they are; lists, tables and mixtures as JSON."""
    kinds = {type(value) for value in values}
    if kinds <= {int, float} or kinds == {str} or kinds == {bool}:
        return np.array(values) if kinds != {str} else values
    return [json.dumps(value) for value in values]
