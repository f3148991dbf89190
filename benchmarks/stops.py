"""Stop and go: drawn people who stop every few metres at three paces. How often do they fall?

python benchmarks/stops.py --people 10 --seconds 90
"""

from __future__ import annotations

from _common import options, out, write_json
from rich.table import Table

from footfall.models.policy import stock_policy
from footfall.simulate.trial import Course, attempt

_METRES = 200.0


def course(pace: float, every: float) -> Course:
    """A straight with a stop of 4 s every so many metres."""
    count = int(_METRES / every) - 1
    stops = tuple(every * (number + 1) for number in range(count))
    return Course(f"{pace:g} m/s, a stop every {every:g} m", ((_METRES, 0.0),), pace=pace, stops=stops)


def main() -> None:
    """Walk and print the table."""
    parser = options(__doc__, processes=False)
    parser.add_argument("--people", type=int, default=10, help="on each course (default 10)")
    parser.add_argument("--seconds", type=float, default=90.0, help="each (default 90)")
    parser.add_argument("--seed", type=int, default=5)
    chosen = parser.parse_args()
    courses = (course(1.0, 6.0), course(1.3, 7.0), course(1.5, 8.0))
    verdict = attempt(stock_policy(), courses, seed=chosen.seed, people=chosen.people, seconds=chosen.seconds)
    table = Table("", "falls", title=f"{verdict.minutes:.0f} minutes of stop-and-go")
    for name, falls in verdict.falls.items():
        table.add_row(name, str(falls))
    out.print(table)
    write_json(chosen.json, {"falls": verdict.falls, "minutes": verdict.minutes})


if __name__ == "__main__":
    main()
