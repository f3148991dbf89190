"""What a tuning says: four figures and a verdict, a document, tuned.toml, and a figure."""

from __future__ import annotations

import json
import textwrap
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import RenderableType
from rich.text import Text

from footfall.scenarios.judge.score import unit_of
from footfall.scenarios.judge.statistics import spread
from footfall.scenarios.judge.verdict import figure
from footfall.scenarios.report.sensitivity import WORDS, finite_or_none
from footfall.scenarios.report.style import entitle, label_of, new_panels, plain_log, save
from footfall.scenarios.report.tables import new_table, titled
from footfall.scenarios.studies.tuning import Tuned
from footfall.simulate.plan import versions
from footfall.tables import replacing

FORMAT = "footfall tuning 1"


def _sides(tuned: Tuned) -> dict[str, np.ndarray]:
    return {"train": tuned.train, "test": tuned.test}


def tuning_report(tuned: Tuned) -> list[RenderableType]:
    """What `footfall tune` prints for people."""
    file = tuned.tuning.file
    title = f"{WORDS[file.metric]} ({unit_of(file.metric)}) of {label_of(_method(tuned))} on {file.scenario}"
    table = new_table("", "parameters", "cases", "mean", "median", "p90", left=2)
    for side, errors in _sides(tuned).items():
        for name, row in zip(("default", "tuned"), errors, strict=True):
            values = row[np.isfinite(row)]
            failed = len(row) - len(values)
            count = f"{len(row)}, {failed} failed" if failed else str(len(row))
            table.add_row(side, name, count, *(f"{value:.3g}" for value in spread(values).values()))
    values_ = new_table("parameter", "default", "tuned")
    for address, now in tuned.tuning.defaults().items():
        values_.add_row(address, _told(now), _told(tuned.chosen.get(address, now)))
    verdict = tuned.verdict
    bounds = f"{figure(verdict.low, True)} .. {figure(verdict.high, True)} %"
    return [
        titled(title[0].upper() + title[1:], table),
        titled(f"Best of {tuned.tried} on train, by the {file.over}", values_),
        Text(f"tuned against default on test, case by case: {figure(verdict.estimate, True)} % ({bounds})"),
        Text(tuned.advice, style="bold"),
    ]


def _method(tuned: Tuned) -> str:
    return tuned.tuning.base.methods[0].name


def _told(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def tuning_document(tuned: Tuned, command: str) -> dict[str, Any]:
    """The document of `tune --json` (docs/tuning.md)."""
    tuning, verdict = tuned.tuning, tuned.verdict
    return {
        "format": FORMAT,
        "name": tuning.name,
        "description": tuning.file.description,
        "command": command,
        "versions": versions(),
        "scenario": tuning.file.scenario,
        "imu": tuning.base.sheet.name,
        "method": _method(tuned),
        "metric": tuning.file.metric,
        "over": tuning.file.over,
        "tried": tuned.tried,
        "parameters": {factor.address: factor.as_dict() for factor in tuning.factors},
        "default": tuning.defaults(),
        "tuned": dict(tuned.chosen),
        "cases": {
            side: [[one.walk_seed, one.unit_seed, one.noise_seed] for one in cases]
            for side, cases in (("train", tuning.train), ("test", tuning.test))
        },
        "errors": {
            side: {
                name: [finite_or_none(value) for value in row.tolist()]
                for name, row in zip(("default", "tuned"), errors, strict=True)
            }
            for side, errors in _sides(tuned).items()
        },
        "verdict": {
            "verdict": verdict.verdict,
            "change_percent": finite_or_none(verdict.estimate),
            "low_percent": finite_or_none(verdict.low),
            "high_percent": finite_or_none(verdict.high),
            "better": tuned.better,
            "advice": tuned.advice,
        },
    }


def write_tuning(tuned: Tuned, document: dict[str, Any], folder: Path) -> None:
    """tuning.json, tuned.toml and tuning.png, into the existing `folder`."""
    with replacing(folder / "tuning.json") as temporary:
        temporary.write_text(json.dumps(document, indent=2) + "\n", encoding="utf-8")
    with replacing(folder / "tuned.toml") as temporary:
        temporary.write_text(tuned_toml(tuned, document["command"]), encoding="utf-8")
    draw_tuning(tuned, folder / "tuning.png")


def tuned_toml(tuned: Tuned, command: str) -> str:
    """The chosen values as a table [set]: `--set @tuned.toml` takes it, and a study has one like it."""
    lines = [f"# {command}", f"# {tuned.advice}", "[set]"]
    lines += [f'"{address}" = {json.dumps(value)}' for address, value in tuned.chosen.items()]
    return "\n".join(lines) + "\n"


def draw_tuning(tuned: Tuned, path: Path) -> None:
    """Each case under the default and under the tuned values, on train and on test."""
    unit = unit_of(tuned.tuning.file.metric)
    drawn, axes = new_panels(2, 3.4, 3.2, sharex=True, sharey=True)
    both = np.concatenate([errors.ravel() for errors in _sides(tuned).values()])
    finite = np.maximum(both[np.isfinite(both)], 0.01)
    ends = [finite.min() / 1.3, finite.max() * 1.3]
    for axis, (side, errors), colour in zip(axes, _sides(tuned).items(), ("#9a9a9a", "#1f6fb4"), strict=True):
        axis.set(xscale="log", yscale="log")
        axis.plot(ends, ends, color="#222222", lw=0.8)
        axis.plot(*np.maximum(errors, 0.01), "o", ms=4, alpha=0.7, mew=0, color=colour)
        middle = [np.median(row[np.isfinite(row)]) for row in errors]
        axis.plot(*middle, "X", ms=10, mfc="#c1440e", mec="white")
        what = "chosen on these" if side == "train" else "never seen"
        medians = f"median {figure(middle[0])} -> {figure(middle[1])} {unit}"
        entitle(axis, f"{side}: {errors.shape[1]} cases, {what}\n{medians}")
        axis.set_xlabel(f"default ({unit})")
    axes[0].set_ylabel(f"tuned ({unit})")
    plain_log(axes[0].xaxis)
    plain_log(axes[0].yaxis)
    drawn.suptitle(textwrap.fill(f"{tuned.tuning.name}: {tuned.advice}", 76), x=0.01, ha="left", fontsize=10)
    save(drawn, path)
