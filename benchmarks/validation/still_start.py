"""Which units are called moving though they rest, and which movements are found, by the sensors' noise.

Units of the stock IMU `nimu` with other white noises stand still for 27 s, and T_bias is 25 s of that. Then
the same recordings with a movement in them, at a time drawn by the seed: the foot turns by 5 deg/s, or takes
a step. The limit of the rest test was chosen on the first seeds and is judged on the second.

python -m benchmarks.validation.still_start
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks._common import options, write_json
from benchmarks._page import Sheet, by_name, fill
from footfall.conventions import BIAS_TIME, GRAVITY
from footfall.errors import InputError
from footfall.models.imu import ImuSpec, draw_unit, load_spec
from footfall.pdr.rest import static_bias
from footfall.recording import Recording
from footfall.simulate.record import record
from footfall.simulate.walk import TrueFootfalls, Walk

PAGE = Path(__file__).parents[2] / "docs" / "navigation.md"
RATE = 200
# White noise of gyros (deg/rt-h) and accelerometers (ug/rt-Hz); the first are those of `nimu`.
LEVELS = ((4.4, 80.0), (8.8, 1600.0), (17.6, 3200.0), (26.0, 6400.0), (52.0, 12_800.0))
TURN = math.radians(5.0) * np.array([math.sin(0.35), 0.0, math.cos(0.35)])  # about the vertical, aslant
SEEDS = {"chosen on": 1000, "judged on": 2000}


def standing() -> Walk:
    """An IMU that stands still for 27 s."""
    t = np.arange(27 * RATE + 1) / RATE
    zero = np.zeros((len(t), 3))
    return Walk(
        t=t,
        position=zero,
        quaternion=np.tile([1.0, 0.0, 0.0, 0.0], (len(t), 1)),
        velocity=zero,
        gyro=zero,
        accel=np.tile([0.0, 0.0, GRAVITY], (len(t), 1)),
        contact=np.ones(len(t)),
        stance=np.ones(len(t), dtype=bool),
        footfalls=TrueFootfalls(t[-1:], zero[:1], np.zeros(1)),
        meta={"calibration_s": 26.0},
    )


def sheet_with(arw_deg_rt_h: float, density_ug_rt_hz: float) -> ImuSpec:
    """`nimu` with other white noises."""
    spec = load_spec("nimu")
    return replace(
        spec,
        gyro=replace(spec.gyro, white=math.radians(arw_deg_rt_h) / 60),
        accel=replace(spec.accel, white=1e-6 * GRAVITY * density_ug_rt_hz),
    )


def moving(still: Recording, seconds: float, step: bool, seed: int) -> Recording:
    """The same recording with a movement of so many seconds."""
    begin = np.random.default_rng(seed).uniform(1.0, BIAS_TIME - seconds)
    phase = (still.t - begin) / seconds
    inside = ((phase > 0) & (phase < 1))[:, None]
    wave = inside * np.sin(2 * np.pi * phase)[:, None]
    gyro = wave * np.array([0.0, 6.0, 0.0]) if step else inside * TURN
    accel = wave * np.array([10.0, 0.0, 6.0]) if step else 0.0
    return replace(still, gyro=still.gyro + gyro, accel=still.accel + accel)


def refused(recording: Recording) -> bool:
    """Whether the recording is said to move."""
    try:
        static_bias(recording, BIAS_TIME)
    except InputError:
        return True
    return False


def outcomes(spec: ImuSpec, seeds: Sequence[int]) -> Iterator[list[bool]]:
    """For each unit: refused at rest, turning for 1 s and for 3 s, and stepping."""
    walk = standing()
    for seed in seeds:
        still = record(walk, draw_unit(spec, seed), seed=seed)
        kinds = ((1.0, False), (3.0, False), (0.6, True))
        yield [refused(still), *(refused(moving(still, seconds, step, seed)) for seconds, step in kinds)]


def main(arguments: Sequence[str] | None = None) -> None:
    """Count, print the table, fill the page."""
    parser = options(__doc__, processes=False)
    parser.add_argument("--units", type=int, default=200, help="of each noise (default 200)")
    parser.add_argument("--page", action="store_true", help="put the table into docs/navigation.md")
    chosen = parser.parse_args(arguments)
    headings = ["deg/rt-h", "ug/rt-Hz", "seeds", "at rest", "turns 1 s", "turns 3 s", "steps"]
    sheet = Sheet("rest", f"Called moving, of {chosen.units} units", headings, left=3)
    for level in LEVELS:
        for name, first in SEEDS.items():
            seeds = range(first, first + chosen.units)
            counts = np.sum(list(outcomes(sheet_with(*level), seeds)), axis=0)
            sheet.rows.append([*(f"{value:g}" for value in level), name, *map(str, counts)])
    sheet.show()
    if chosen.page:
        fill(PAGE, by_name([sheet]))
    write_json(chosen.json, {"units": chosen.units, "called_moving": [headings, *sheet.rows]})


if __name__ == "__main__":
    main()
