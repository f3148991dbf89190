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
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot as plt

    millions = log["samples"] / 1e6
    fig, (left, right) = plt.subplots(1, 2, figsize=(9.5, 3.4), layout="constrained", width_ratios=[1.7, 1])
    left.semilogy(millions, np.maximum(log["falls_per_min"], 0.3), ".", color="0.75", ms=3)
    left.semilogy(millions, smoothed(log["falls_per_min"]), color="C3", label="falls a minute, exploring")
    left.set(xlabel="samples (million control steps)", ylabel="falls a minute of walking", xlim=(0, None))
    full = millions[np.argmax(log["level"] >= 1)]
    left.axvspan(0, full, color="0.95", zorder=0)
    left.text(full, left.get_ylim()[1], " full difficulty", va="top", fontsize=8, color="0.35")
    other = left.twinx()
    other.plot(millions, smoothed(log["reward"]), color="C0")
    other.set_ylabel("reward a control step", color="C0")
    left.spines["top"].set_visible(False)
    names = sorted(choice["choice"])
    falls = [choice["choice"][name]["falls_per_hour"] for name in names]
    colours = ["C2" if name == choice["chosen"] else "0.7" for name in names]
    bars = right.bar([name[7:10].lstrip("0") for name in names], falls, color=colours)
    right.bar_label(bars, fmt="%.0f", fontsize=8)
    right.axhline(choice["judgement"]["falls_per_hour"], color="C2", ls="--", lw=1)
    right.set(xlabel="checkpoint (% of the training)", ylabel="falls an hour, courses of choice")
    right.set_title("green: chosen; dashed: it, on other courses", fontsize=9)
    for side in ("top", "right"):
        right.spines[side].set_visible(False)
    figure.parent.mkdir(parents=True, exist_ok=True)
    fig.savefig(figure, dpi=150)


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
