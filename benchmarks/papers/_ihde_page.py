"""The tables of ihde_table2.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from benchmarks._page import Sheet
from footfall.scenarios.judge.papers import IHDE_TABLE_2, range_text


def _number(value: float) -> str:
    return f"{value:.1f}" if value >= 10 else f"{value:.2f}"


def _spread(errors: np.ndarray) -> str:
    """Median (10th to 90th percentile) of return errors in % (walks,)."""
    low, middle, high = np.percentile(errors, [10, 50, 90])
    return f"{_number(middle)} ({_number(low)} to {_number(high)})"


def table_2(gait: str, errors: Mapping[str, Mapping[str, np.ndarray]]) -> Sheet:
    """Test -> method -> (walks, 3) as a table: return and heading errors, the paper's ranges first."""
    tests = list(errors)
    head = ["P_err (%), median (10th to 90th percentile); mean heading error (deg)"]
    for test in tests:
        head += [test, "heading"]
    sheet = Sheet(gait, f"Table 2, {gait}", head)
    for method in ("iez", "hde", "ihde"):
        row = [f"**the paper: {method.upper()}**"]
        for test in tests:
            row += [range_text(IHDE_TABLE_2[test][method]), ""]
        sheet.rows.append(row)
    for method in errors[tests[0]]:
        row = [f"`{method}`" if " " not in method else method]
        for test in tests:
            found = errors[test][method]
            row += [_spread(found[:, 0]), f"{found[:, 1].mean():.1f}"]
        sheet.rows.append(row)
    return sheet


def setting_table(settings: Mapping[str, tuple[str, str]]) -> Sheet:
    """What the tuning walks chose, beside the defaults."""
    rows = [[f"`{name}`", *words] for name, words in settings.items()]
    return Sheet("settings", "Settings", ["", "chosen on the tuning walks", "default"], rows, left=3)


def variant_table(*gaits: Mapping[str, Mapping[str, np.ndarray]]) -> Sheet:
    """Test -> variant -> (walks, 3) of people, then of somebody on a line, as one table."""
    tests = list(gaits[0])
    head = ["P_err (%), median (10th to 90th percentile)"]
    head += [f"{test}{gait}" for gait in ("", ", on a line") for test in tests]
    rows = [
        [name, *(_spread(gait[test][name][:, 0]) for gait in gaits for test in tests)]
        for name in gaits[0][tests[0]]
    ]
    return Sheet("decides", "What decides", head, rows)


LOST_DEG = 30.0


def loop_table(methods: Sequence[str], errors: np.ndarray) -> Sheet:
    """Heading errors on the closed loop, (walks x units, methods, 3)."""
    head = ["", "mean heading error (deg), median", "90th percentile", "final, median", "90th percentile"]
    head.append(f"lost (mean above {LOST_DEG:g} deg)")
    sheet = Sheet("loop", "The closed loop", head)
    for i, method in enumerate(methods):
        mean, final = errors[:, i, 1], errors[:, i, 2]
        row = [f"`{method}`" if " " not in method else method]
        row += [f"{np.percentile(values, q):.1f}" for values in (mean, final) for q in (50, 90)]
        sheet.rows.append([*row, f"{(mean > LOST_DEG).sum()} of {len(mean)}"])
    return sheet
