"""The tables of ihde_table2.py, as Markdown, and where they go in a page."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from footfall.hdr.ihde import IhdeParams
from footfall.scenarios.paper import IHDE_TABLE_2, range_text

if TYPE_CHECKING:
    from ihde_table2 import Scattered


def _markdown(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def _number(value: float) -> str:
    return f"{value:.1f}" if value >= 10 else f"{value:.2f}"


def table_2(errors: Mapping[str, Mapping[str, np.ndarray]]) -> str:
    """Test -> method -> (seeds, 3) as a table: return and heading errors, the paper's range beside them."""
    tests = list(errors)
    head = ["P_err (%), median (10th to 90th percentile); mean heading error (deg)"]
    for test in tests:
        head += [test, "heading", "paper"]
    rows = []
    for method in errors[tests[0]]:
        row = [f"`{method}`" if " " not in method else method]
        for test in tests:
            low, middle, high = np.percentile(errors[test][method][:, 0], [10, 50, 90])
            paper = IHDE_TABLE_2[test].get(method)
            row += [
                f"{_number(middle)} ({_number(low)} to {_number(high)})",
                f"{errors[test][method][:, 1].mean():.1f}",
                range_text(paper) if paper else "",
            ]
        rows.append(row)
    return _markdown(head, rows)


def setting_table(settings: Mapping[str, tuple[str, str]]) -> str:
    """What the tuning walks chose, beside the defaults."""
    rows = [[name, *words] for name, words in settings.items()]
    return _markdown(["", "chosen on the tuning walks", "default"], rows)


def threshold_table(grid: Sequence[IhdeParams], errors: Mapping[str, np.ndarray]) -> str:
    """IHDE by its threshold at sigma = 4 deg, on the tuning walks; errors: test -> (seeds, grid, 3)."""
    head = ["a / k1 (deg)", "mean heading"]
    for test in errors:
        head += [f"{test}: P_err (%), median", "heading error (deg)"]
    rows = []
    for i, params in enumerate(grid):
        if round(degrees(params.sigma), 6) != 4:
            continue
        row = [f"{degrees(params.a / params.k1):.3g}", "fed back" if params.fallback else "left out"]
        for found in errors.values():
            row += [_number(float(np.median(found[:, i, 0]))), f"{found[:, i, 1].mean():.1f}"]
        rows.append(row)
    return _markdown(head, rows)


def scatter_table(
    found: Sequence[Scattered], gaits: Sequence[str], tests: Sequence[str], thresholds: Sequence[float]
) -> str:
    """Return errors against how much the stance yaw scatters, each gait with its best threshold (deg)."""
    head = ["gait", "stance yaw SD (deg)", "foot beside the path, standing / walking (deg)"]
    head += ["a / k1 (deg)"]
    for test in tests:
        head += [f"{test}: IEZ", "IHDE", "foot known", "and no mean heading"]
    rows = []
    for gait in gaits:
        mine = [one for one in found if one.gait == gait]
        if not mine:
            continue
        yaw, standing, walking = np.mean(
            [(one.yaw_sd_deg, one.standing_deg, one.walking_deg) for one in mine], axis=0
        )
        heading = np.mean([np.array(one.errors)[:, 1] for one in mine], axis=0)
        half = len(thresholds)
        best = [int(np.argmin(heading[1 + i * half : 1 + (i + 1) * half])) for i in range(3)]
        places = [0, *(1 + i * half + best[i] for i in range(3))]
        row = [gait, f"{yaw:.1f}", f"{standing:.1f} / {walking:.1f}"]
        row.append(" / ".join(f"{thresholds[i]:g}" for i in best))
        for test in tests:
            errors = np.array([one.errors for one in mine if one.test == test])
            row += [_number(np.median(errors[:, i, 0])) for i in places] if len(errors) else [""] * 4
        rows.append(row)
    paper = ["the paper's", "", "", ""]
    for test in tests:
        paper += [range_text(IHDE_TABLE_2[test]["iez"]), range_text(IHDE_TABLE_2[test]["ihde"]), "", ""]
    return _markdown(head, [*rows, paper])


def fill(page: Path, tables: Mapping[str, str]) -> None:
    """Put each table between its two marks in the page: <!-- table NAME --> and <!-- end -->.

    Raises
    ------
    SystemExit
        The page lacks a mark.
    """
    text = page.read_text(encoding="utf-8")
    for name, table in tables.items():
        text, count = re.subn(
            rf"(<!-- table {re.escape(name)} -->\n).*?(<!-- end -->)",
            lambda found, table=table: f"{found[1]}\n{table}\n\n{found[2]}",
            text,
            flags=re.DOTALL,
        )
        if count != 1:
            raise SystemExit(f"{page}: expected one mark <!-- table {name} -->, found {count}")
    page.write_text(text, encoding="utf-8")
