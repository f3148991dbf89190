"""The shipped weights, with the laws as they are, on the courses on which training chooses and judges.

python -m benchmarks.validation.courses
"""

from __future__ import annotations

from rich.table import Table

from benchmarks._common import options, out, write_json
from footfall.models.policy import stock_policy
from footfall.simulate.learn.courses import CHOICE, CHOICE_SEED, JUDGEMENT, JUDGEMENT_SEED, attempt


def main() -> None:
    """Walk and print the tables."""
    parser = options(__doc__, processes=False)
    parser.add_argument("--people", type=int, default=6, help="on each course (default 6, as in training)")
    chosen = parser.parse_args()
    figures = {}
    for name, courses, seed in (("choice", CHOICE, CHOICE_SEED), ("judgement", JUDGEMENT, JUDGEMENT_SEED)):
        verdict = attempt(stock_policy(), courses, seed=seed, people=chosen.people)
        table = Table(
            "", "falls", title=f"{name}: {sum(verdict.falls.values())} falls in {verdict.minutes:.0f} min"
        )
        for course, falls in verdict.falls.items():
            table.add_row(course, str(falls))
        out.print(table)
        figures[name] = {"falls": verdict.falls, "minutes": verdict.minutes}
    write_json(chosen.json, figures)


if __name__ == "__main__":
    main()
