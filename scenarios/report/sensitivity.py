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
from footfall.scenarios.judge.score import unit_of
from footfall.scenarios.judge.verdict import figure
from footfall.scenarios.report.style import label_of
from footfall.scenarios.report.tables import new_table, titled
from footfall.scenarios.studies.check import LIMIT, Check
from footfall.scenarios.studies.factors import Factor
from footfall.scenarios.studies.indices import Index, Screened, Sobol, not_told_apart
from footfall.scenarios.studies.sensitivity import Answer, Found
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
    methods = " and ".join(label_of(method.name) for method in study.base.methods[:2])
    methods = methods if len(study.base.methods) <= 2 else f"{len(study.base.methods)} methods"
    what = ", by its logarithm" if file.of == "ratio" else ""
    return f"{WORDS[file.metric]} of {methods} on {file.scenario}, {over}{what}"


def check_report(study: Study, check: Check) -> RenderableType:
    """The budget beside the full chain."""
    unit = unit_of(study.file.metric)
    table = new_table("point", f"full ({unit})", f"budget ({unit})", "off")
    ends = {at: name for name, at in check.ends.items()}
    for i, (full, budget, off) in enumerate(zip(check.full, check.budget, check.off, strict=True)):
        table.add_row(ends.get(i, str(i + 1)), f"{full:.3g}", f"{budget:.3g}", f"{100 * off:+.0f} %")
    worst = max([check.mean_off, *(abs(check.off[at]) for at in ends)])
    verdict = "good for means and ranks" if worst <= LIMIT else "do not use"
    table.add_row("mean size, but for ends", "", "", f"{100 * check.mean_off:.0f} %: {verdict}", style="bold")
    return titled(f"{check.method}: the budget beside the full chain, at points of their own", table)


def sensitivity_report(found: Found) -> list[RenderableType]:
    """What `footfall sensitivity` prints for people."""
    study = found.study
    unit = unit_of(study.file.metric)
    parts: list[RenderableType] = [Text.assemble((study.name, "bold"), f": {asked(study)}\n")]
    for one in found.answers:
        head = f"{one.method}: at the documents' own values {one.nominal:.3g} {unit}"
        parts.append(Text(head, style="bold"))
        if one.morris is not None:
            title = f"Morris: mean size of an effect over a whole range{_in(study)}"
            parts.append(titled(title, _morris(study.factors, one.morris)))
        if one.sobol is not None:
            points = one.sobol.samples * (len(study.factors) + 2)
            title = f"Sobol: shares of the variance, N = {one.sobol.samples}, {points} points"
            parts.append(titled(title, _sobol(study.factors, one.sobol)))
            parts.append(_convergence(study.factors, one.convergence))
            parts.append(Text("\n".join(remarks(study, one.sobol)) + "\n"))
    if len(found.answers) > 1:
        parts.append(_side_by_side(found))
    return parts


def remarks(study: Study, sobol: Sobol) -> list[str]:
    """What is to be said of indices besides."""
    told = [f"interplay: {sobol.interplay:+.2f}, by which the total indices add up to more than 1"]
    for group in not_told_apart(sobol.total):
        told.append(f"not told apart: {', '.join(study.factors[i].name for i in group)}")
    wanted = study.file.sobol
    if wanted is not None and sobol.widest > wanted.widest:
        told.append(
            f"not converged: the widest interval is +-{sobol.widest:.2f}, asked for +-{wanted.widest:g}; "
            f"raise sobol.at_most"
        )
    return told


def _in(study: Study) -> str:
    return " (factor e^mu*)" if study.file.of == "ratio" else f" ({unit_of(study.file.metric)})"


def _morris(factors: Sequence[Factor], found: Sequence[Screened]) -> Table:
    table = new_table("parameter", "mu*", "+-", "sigma")
    for i in sorted(range(len(found)), key=lambda i: -found[i].mu_star):
        figures = (found[i].mu_star, found[i].half, found[i].sigma)
        table.add_row(factors[i].name, *(figure(value) for value in figures))
    return table


def order_of(indices: Sequence[Index]) -> list[int]:
    """The greatest first."""
    return sorted(range(len(indices)), key=lambda i: -indices[i].value)


def _sobol(factors: Sequence[Factor], found: Sobol) -> Table:
    table = new_table("parameter", "first", "+-", "total", "+-", "")
    table.columns[-1].justify = "left"
    for i in order_of(found.total):
        first, total = found.first[i], found.total[i]
        figures = (f"{v:.2f}" for v in (first.shown, first.half, total.shown, total.half))
        bar = "#" * max(0, round(_BAR * first.shown))
        bar += "-" * max(0, round(_BAR * total.shown) - len(bar))
        table.add_row(factors[i].name, *figures, bar)
    return table


def _convergence(factors: Sequence[Factor], steps: Sequence[Sobol]) -> RenderableType:
    best = order_of(steps[-1].total)[:3]
    table = new_table("N", "widest +-", *(factors[i].name for i in best))
    for step in steps:
        table.add_row(str(step.samples), f"{step.widest:.2f}", *(f"{step.total[i].shown:.2f}" for i in best))
    return titled("Total indices by the number of samples", table)


def _side_by_side(found: Found) -> RenderableType:
    """The methods beside each other: total indices, or mu* where there are none."""
    table = new_table("parameter", *(one.method for one in found.answers))
    few = len(found.answers) <= 3  # with whose intervals a line is not too long
    for i in ranked(found):
        cells = []
        for one in found.answers:
            if one.sobol is not None:
                value, half = one.sobol.total[i].shown, one.sobol.total[i].half
            else:
                assert one.morris is not None
                value, half = one.morris[i].mu_star, one.morris[i].half
            cells.append(f"{value:.2f} +-{half:.2f}" if few else f"{value:.2f}")
        table.add_row(found.study.factors[i].name, *cells)
    return titled("Total indices" if found.answers[0].sobol else f"mu*{_in(found.study)}", table)


def ranked(found: Found) -> list[int]:
    """Factors by their mean total index over the methods, or their mu* where there is none."""

    def weight(i: int) -> float:
        return sum(
            one.sobol.total[i].value if one.sobol else one.morris[i].mu_star if one.morris else 0.0
            for one in found.answers
        )

    return sorted(range(len(found.study.factors)), key=lambda i: -weight(i))


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
        "metric": file.metric,
        "over": file.over,
        "of": file.of,
        "fidelity": file.fidelity,
        "cases": [[one.walk_seed, one.unit_seed, one.noise_seed] for one in file.cases.deal(setup)],
        "units_as_factor": file.units_as_factor,
        "set": dict(file.set),
        "parameters": {factor.address: factor.as_dict() for factor in study.factors},
        "methods": {one.method: _answer(names, one) for one in found.answers},
    }
    return document


def _answer(names: Sequence[str], one: Answer) -> dict[str, Any]:
    told: dict[str, Any] = {"nominal": finite_or_none(one.nominal)}
    if one.check is not None:
        told["check"] = {
            "points": one.check.shares.tolist(),
            "full": one.check.full.tolist(),
            "budget": one.check.budget.tolist(),
            "mean_off": one.check.mean_off,
            "ends_off": {name: float(one.check.off[at]) for name, at in one.check.ends.items()},
        }
    if one.morris is not None:
        told["morris"] = {
            name: {"mu_star": row.mu_star, "half": row.half, "sigma": row.sigma}
            for name, row in zip(names, one.morris, strict=True)
        }
    if one.sobol is not None:
        told["sobol"] = {
            "steps": [
                {
                    "samples": step.samples,
                    "widest": step.widest,
                    "parameters": {
                        name: {"first": _index(first), "total": _index(total)}
                        for name, first, total in zip(names, step.first, step.total, strict=True)
                    },
                }
                for step in one.convergence
            ],
            "interplay": one.sobol.interplay,
            "not_told_apart": [[names[i] for i in group] for group in not_told_apart(one.sobol.total)],
        }
    return told


def _index(index: Index) -> dict[str, float]:
    return {"value": index.value, "half": index.half}


def finite_or_none(value: float) -> float | None:
    """JSON has no infinity."""
    return value if math.isfinite(value) else None


def write_sensitivity(found: Found, document: dict[str, Any], folder: Path) -> None:
    """sensitivity.json, points.parquet, the figures and the page, into the existing `folder`.

    Raises
    ------
    InputError
        The folder cannot be written.
    """
    from footfall.scenarios.report.page import write_page
    from footfall.scenarios.report.sensitivity_figures import draw_effects, draw_indices

    with replacing(folder / "sensitivity.json") as temporary:
        temporary.write_text(json.dumps(document, indent=2) + "\n", encoding="utf-8")
    rows = list(found.rows())
    columns = {name: _column([row[name] for row in rows]) for name in rows[0]}
    with replacing(folder / "points.parquet") as temporary:
        pq.write_table(pa.table(columns), temporary, compression="zstd")
    draw_indices(found, folder / "indices.png")
    if "sobol" in found.shares:  # Morris' points are few, and what is seen over one factor is the others
        draw_effects(found, folder / "effects.png")
    write_page(folder)


def _column(values: list[Any]) -> Any:
    """Numbers and texts as they are; lists, tables and mixtures as JSON."""
    kinds = {type(value) for value in values}
    if kinds <= {int, float} or kinds == {str} or kinds == {bool}:
        return np.array(values) if kinds != {str} else values
    return [json.dumps(value) for value in values]
