"""How the walker learnt: falls, reward and difficulty over the samples of a training, and how it was chosen.

python -m benchmarks.validation.learning_curve RUN --figure docs/images/learning_curve.png

RUN is the folder of `python -m footfall.simulate.learn.train --out RUN`.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from rich.table import Table

from benchmarks._common import options, out, write_json
from footfall.scenarios.report.style import COLOURS, entitle, head, new_figure, save

_SMOOTH = 8  # log lines


def smoothed(values: np.ndarray, width: int = _SMOOTH) -> np.ndarray:
    """Moving mean, shorter at the ends."""
    kernel = np.ones(width)
    return np.convolve(values, kernel, "same") / np.convolve(np.ones(len(values)), kernel, "same")


def read_log(run: Path) -> dict[str, np.ndarray]:
    """Columns of a training's log."""
    rows = [json.loads(line) for line in (run / "log.jsonl").read_text(encoding="utf-8").splitlines()]
    return {
        key: np.array([row[key] for row in rows]) for key in ("samples", "level", "falls_per_min", "reward")
    }


def draw(log: dict[str, np.ndarray], choice: dict, figure: Path) -> None:
    """Falls a minute with the reward, and the falls of the checkpoints on the courses of choice."""
    millions, falls = log["samples"] / 1e6, np.maximum(log["falls_per_min"], 0.3)
    fig, axes = new_figure(1, 3, 11.0, 3.4, width_ratios=[1, 1, 1])
    left, middle, right = axes[0]
    left.semilogy(millions, falls, ".", color="#bbbbbb", ms=3)
    left.semilogy(millions, smoothed(log["falls_per_min"]), color=COLOURS["pdr"])
    left.yaxis.set_major_formatter("{x:g}")
    left.set_ylabel("falls a minute")
    entitle(left, "falls while exploring")
    middle.plot(millions, log["reward"], ".", color="#bbbbbb", ms=3)
    middle.plot(millions, smoothed(log["reward"]), color=COLOURS["hdr"])
    middle.set_ylabel("reward a control step")
    entitle(middle, "reward")
    full = millions[np.argmax(log["level"] >= 1)]
    for axis in (left, middle):
        axis.axvspan(0, full, color="#eeeeee", zorder=0, label="courses still getting harder")
        axis.set_xlim(0, None)
        axis.set_xlabel("samples (million control steps)")
    names = sorted(choice["choice"])
    counts = [choice["choice"][name]["falls_per_hour"] for name in names]
    colours = [COLOURS["hde"] if name == choice["chosen"] else "#bbbbbb" for name in names]
    bars = right.bar([name[7:10].lstrip("0") for name in names], counts, color=colours)
    right.bar_label(bars, fmt="%.0f", fontsize=8)
    elsewhere = choice["judgement"]["falls_per_hour"]
    right.axhline(elsewhere, color=COLOURS["hde"], ls="--", label="the chosen one, on courses of judgement")
    right.grid(axis="x", visible=False)
    right.set_xlabel("checkpoint (% of the training)")
    right.set_ylabel("falls an hour")
    entitle(right, "courses of choice; green: the chosen one")
    head(fig, "How the walker learnt (dots: log lines; lines: their moving mean)", [left, right])
    figure.parent.mkdir(parents=True, exist_ok=True)
    save(fig, figure)


def main() -> None:
    """Command line."""
    parser = options(__doc__, processes=False)
    parser.add_argument("run", type=Path, help="folder of a finished training")
    parser.add_argument("--figure", type=Path, metavar="FILE")
    arguments = parser.parse_args()
    log = read_log(arguments.run)
    choice = json.loads((arguments.run / "choice.json").read_text(encoding="utf-8"))
    table = Table("M samples", "difficulty", "falls/min", "reward", title="Training, means of 8 log lines")
    falls, reward = smoothed(log["falls_per_min"]), smoothed(log["reward"])
    for i in range(0, len(falls), max(1, len(falls) // 12)):
        table.add_row(
            f"{log['samples'][i] / 1e6:.2f}", f"{log['level'][i]:.2f}", f"{falls[i]:.1f}", f"{reward[i]:.3f}"
        )
    out.print(table)
    courses = Table("course", "falls", title=f"{choice['chosen']} on the courses of choice and of judgement")
    for name, count in choice["choice"][choice["chosen"]]["falls"].items():
        courses.add_row(name, str(count))
    courses.add_section()
    for name, count in choice["judgement"]["falls"].items():
        courses.add_row(name, str(count))
    out.print(courses)
    if arguments.figure:
        draw(log, choice, arguments.figure)
    write_json(arguments.json, {"choice": choice, "samples": int(log["samples"][-1])})


if __name__ == "__main__":
    main()
