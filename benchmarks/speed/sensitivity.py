"""What a map and a Sobol study cost, once the units have been heard: on footfalls drawn at random.

A map: 100 walks x 1,000 pairs x 1,000 footfalls. Sobol: 8 parameters (five causes of drift and HDR's three),
20 units of 1,300 footfalls, N = 1,024, with the indices and their intervals. CPU seconds of one process.

python -m benchmarks.speed.sensitivity
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from benchmarks._common import options, out, write_json
from benchmarks._usage import peak_bytes
from footfall.hdr.methods import METHODS
from footfall.models.imu import load_spec
from footfall.scenarios.report.tables import new_table
from footfall.scenarios.studies.budget import CAUSE_OF, METRICS, Case, Surrogate
from footfall.scenarios.studies.indices import sobol_until

HDR = ("hdr.theta_w_deg_s", "hdr.i_c_deg_s", "hdr.tau_s")
RANGES = ((0.0625, 1.0), (0.00175, 0.028), (2.0, 32.0))
SCALED = (
    "temperature_sigma_deg_s_k",
    "g_sensitivity_sigma_deg_s_g",
    "flicker_deg_h",
    "angle_random_walk_deg_rt_h",
    "scale_sigma",
)
SHEET = dict(zip(SCALED, (0.011, 0.15, 80.0, 4.4, 0.003), strict=True))


def drawn(cases: int, footfalls: int, rng: np.random.Generator) -> list[Case]:
    """Units whose causes are constant drifts with noise on them."""
    made = []
    for _ in range(cases):
        interval = rng.uniform(1.0, 1.2, footfalls)
        causes = {
            CAUSE_OF[key]: np.radians(rng.normal(0, 0.1) + rng.normal(0, 0.02, footfalls)) for key in SCALED
        }
        rate = rng.normal(0, 0.01, footfalls) + sum(causes.values())
        made.append(Case(interval, rate, np.zeros(footfalls), 0.0, causes))
    return made


def timed(work: Callable[[], Any]) -> tuple[float, Any]:
    """CPU seconds, and what came of it."""
    start = time.process_time()
    found = work()
    return time.process_time() - start, found


def map_of(cases: Sequence[Case]) -> np.ndarray:
    """Median over the cases at 1,000 pairs."""
    pairs = np.array([(x, y) for x in np.geomspace(0.06, 1, 40) for y in np.geomspace(0.002, 0.03, 25)])
    return np.median(Surrogate(cases, load_spec("nimu"), METHODS["hdr"], HDR[:2], METRICS[0])(pairs), axis=1)


def sobol_of(cases: Sequence[Case]) -> Any:
    """Indices of all eight, N = 1,024."""
    addresses = (*(f"imu.gyro.{key}" for key in SCALED), *HDR)
    low = np.array([*(0.1 * now for now in SHEET.values()), *(pair[0] for pair in RANGES)])
    high = np.array([*(3 * now for now in SHEET.values()), *(pair[1] for pair in RANGES)])
    model = Surrogate(cases, load_spec("nimu"), METHODS["hdr"], addresses, METRICS[0])

    def function(shares: np.ndarray) -> np.ndarray:
        errors = model(low * (high / low) ** shares)
        return np.log(np.median(errors, axis=1))[:, None]

    *_, (found,) = sobol_until(function, 8, samples=1024, at_most=1024, widest=0.0, seed=1)
    return found


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table."""
    chosen = options(__doc__, processes=False).parse_args(arguments)
    rng = np.random.default_rng(1)
    map_of(drawn(1, 50, rng))  # compiled
    sobol_of(drawn(1, 50, rng))
    walks, units = drawn(100, 1000, rng), drawn(20, 1300, rng)
    before = peak_bytes() / 1e6
    map_s, _ = timed(lambda: map_of(walks))
    map_mb = peak_bytes() / 1e6
    sobol_s, _ = timed(lambda: sobol_of(units))
    table = new_table("what", "CPU s", "MB more", "MB in all")
    table.add_row("map: 100 walks, 1,000 pairs", f"{map_s:.2f}", f"{map_mb - before:.0f}", f"{map_mb:.0f}")
    table.add_row("Sobol: 8 parameters, N = 1,024, 20 units", f"{sobol_s:.2f}", "", "")
    out.print(table)
    write_json(chosen.json, {"map_s": map_s, "map_mb": map_mb - before, "sobol_s": sobol_s})


if __name__ == "__main__":
    main()
