"""Stop and go: drawn people who stop every few metres, at three paces or on slopes. How often do they fall?

python benchmarks/stops.py --people 10 --seconds 90
python benchmarks/stops.py --grade-percent 5
"""

from __future__ import annotations

from _common import options, out, write_json
from rich.table import Table

from footfall.models.policy import stock_policy
from footfall.simulate.trial import Course, attempt

_METRES = 200.0


def course(where: str, pace: float, every: float, grade: tuple[float, float] = (0.0, 0.0)) -> Course:
    """A straight with a stop of 4 s every so many metres."""
    count = int(_METRES / every) - 1
    stops = tuple(every * (number + 1) for number in range(count))
    name = f"{where}, {pace:g} m/s, a stop every {every:g} m"
    return Course(name, ((_METRES, 0.0),), pace=pace, grade=grade, stops=stops)


def main() -> None:
    """Walk and print the table."""
    parser = options(__doc__, processes=False)
    parser.add_argument("--people", type=int, default=10, help="on each course (default 10)")
    parser.add_argument("--seconds", type=float, default=90.0, help="each (default 90)")
    parser.add_argument("--seed", type=int, default=5)
    parser.add_argument("--grade-percent", type=float, default=0.0, help="slope of the ground (default 0)")
    chosen = parser.parse_args()
    slope = chosen.grade_percent / 100
    if slope:
        directions = {"uphill": (slope, 0.0), "downhill": (-slope, 0.0), "across": (0.0, slope)}
        courses = tuple(course(where, 1.2, 7.0, grade) for where, grade in directions.items())
    else:
        courses = (course("level", 1.0, 6.0), course("level", 1.3, 7.0), course("level", 1.5, 8.0))
    verdict = attempt(stock_policy(), courses, seed=chosen.seed, people=chosen.people, seconds=chosen.seconds)
    table = Table("", "falls", title=f"{verdict.minutes:.0f} minutes of stop-and-go")
    for name, falls in verdict.falls.items():
        table.add_row(name, str(falls))
    out.print(table)
    write_json(chosen.json, {"falls": verdict.falls, "minutes": verdict.minutes})


if __name__ == "__main__":
    main()
