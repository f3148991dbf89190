"""Who falls when stopping, and how soon is the foot at rest? Drawn people stop on level ground and on slopes.

Each walks 10 m at a pace of 0.8 to 1.6 m/s, stands for 5 s, walks on for 5 m and stands again, with the
physics of the walks. The rate of the foot (deg/s, as large as it gets within half a second) is counted from
the moment at which the foot has come down for good: median of the stands, and what nine of ten stay below.

python -m benchmarks.validation.stops --people 20
python -m benchmarks.validation.stops --extremes
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from itertools import product

import numpy as np
from rich.table import Table

from benchmarks._common import options, out, run_all, write_json
from footfall.models.route import Ground
from footfall.models.subject import LIMITS, Subject, draw_subject
from footfall.runs import runs
from footfall.scenarios.path import PathSpec, build_path
from footfall.simulate.episode import FallError
from footfall.simulate.plan import Gait, Plan, Stop
from footfall.simulate.walk import Walk
from footfall.simulate.walker.steering import StrayError
from footfall.simulate.walking import walk
from footfall.streams import stream

METRES, AT, PAUSE_S = 15.0, 10.0, 5.0
GRADES_PERCENT = (2.0, 5.0, 8.0)
# Gradient of the ground along and to the left of the way, in shares of the grade.
WAYS = {"uphill": (1.0, 0.0), "downhill": (-1.0, 0.0), "across": (0.0, 1.0), "uphill, aslant": (0.7, 0.7)}
AFTER_S, WITHIN_S = (1.0, 2.0, 4.0), 0.5
_LONG_S = 3.0  # a stance that lasts so long is a stand


@dataclass(frozen=True)
class Place:
    """Where to stop: a way on a slope."""

    grade_percent: float
    way: str

    def __str__(self) -> str:
        return f"{self.grade_percent:g} %, {self.way}" if self.grade_percent else "level"

    def ground(self) -> Ground | None:
        """The slope; None where it is level."""
        if not self.grade_percent:
            return None
        along, across = np.array(WAYS[self.way]) * self.grade_percent / 100
        x, y = np.arange(-12.0, METRES + 12), np.arange(-12.0, 12.0)
        return Ground(x[0], y[0], 1.0, (along * x + across * y[:, None]).astype(np.float32))


@dataclass(frozen=True)
class Stopped:
    """One walk: its stops, 2 unless it fell, and the foot's rates in them (stops, len(AFTER_S)) deg/s."""

    place: Place
    fell: bool
    rates: tuple[tuple[float, ...], ...]


def extreme_subject(rng: np.random.Generator) -> Subject:
    """A person each of whose measures and habits is the least or the greatest that a subject may have."""
    return Subject(**{key: float(rng.choice(limits)) for key, limits in LIMITS.items()})


def plan(place: Place, seed: int, extreme: bool = False) -> Plan:
    """The walk of a drawn person, or of an extreme one."""
    rng = stream(seed, "who stops")
    spec = PathSpec.model_validate({"elements": [{"kind": "straight", "length_m": METRES}]})
    return Plan(
        name=str(place),
        route=build_path(spec).route,
        ground=place.ground(),
        subject=extreme_subject(rng) if extreme else draw_subject(rng),
        gait=Gait(pace_m_s=float(rng.uniform(0.8, 1.6))),
        stops=(Stop(AT, PAUSE_S),),
        calibration_s=1.0,
        seed=seed,
    )


def rates_in_stands(truth: Walk) -> tuple[tuple[float, ...], ...]:
    """Largest rate of the foot (deg/s) so long after each stand began, but for the one before the walk."""
    rate = np.degrees(np.linalg.norm(truth.gyro, axis=1))
    found = []
    for first, last in runs(truth.stance):
        since = truth.t - truth.t[first]
        if first == 0 or since[last - 1] < _LONG_S:
            continue
        spans = [(since >= after) & (since < after + WITHIN_S) & truth.stance for after in AFTER_S]
        spans = [span & (since <= since[last - 1]) for span in spans]
        found.append(tuple(float(rate[span].max()) if span.any() else np.nan for span in spans))
    return tuple(found)


def stop(job: tuple[Place, int, bool]) -> Stopped:
    """Walk once."""
    place, seed, extreme = job
    try:
        truth = walk(plan(place, seed, extreme))
    except (FallError, StrayError):
        return Stopped(place, True, ())
    return Stopped(place, truth.meta["ends"] != "standing", rates_in_stands(truth))


def report(found: Sequence[Stopped], people: str) -> None:
    """One row a place."""
    table = Table(title=f"Stops of {people} people", title_justify="left")
    table.add_column("")
    for heading in ("walks", "falls", *(f"after {after:g} s" for after in AFTER_S)):
        table.add_column(heading, justify="right")
    for place in dict.fromkeys(one.place for one in found):
        here = [one for one in found if one.place == place]
        rates = np.array([row for one in here for row in one.rates]).reshape(-1, len(AFTER_S))
        columns = [column[np.isfinite(column)] for column in rates.T]
        cells = [f"{np.median(c):.2f} / {np.percentile(c, 90):.2f}" if len(c) else "-" for c in columns]
        table.add_row(str(place), str(len(here)), str(sum(one.fell for one in here)), *cells)
    out.print(table)


def main(arguments: Sequence[str] | None = None) -> None:
    """Walk and print the table."""
    parser = options(__doc__)
    parser.add_argument("--people", type=int, default=20, help="at each place (default 20)")
    parser.add_argument("--first-seed", type=int, default=501)
    parser.add_argument(
        "--extremes", action="store_true", help="people at the limits of a subject, not drawn ones"
    )
    chosen = parser.parse_args(arguments)
    places = [Place(0.0, ""), *(Place(grade, way) for grade, way in product(GRADES_PERCENT, WAYS))]
    jobs = [
        (place, chosen.first_seed + chosen.people * number + person, chosen.extremes)
        for number, place in enumerate(places)
        for person in range(chosen.people)
    ]
    found = run_all(stop, jobs, chosen.processes, "stops")
    report(found, "extreme" if chosen.extremes else "drawn")
    write_json(chosen.json, {"stops": [asdict(one) for one in found]})


if __name__ == "__main__":
    main()
