"""Are sensitivity studies to be believed? Known indices, and the budget beside the full chain.

First Ishigami's function and Sobol's g, whose indices are known: how many of them lie inside their intervals,
over seeds. Then four sheets far from the nIMU's, units by the drift budget and recorded in full, uncorrected
and with HDR: means over the units, how far single units are off, and whether a study that reaches to that
sheet would refuse the budget.

python -m benchmarks.validation.sensitivity
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from benchmarks._common import options, out, write_json
from footfall.errors import InputError
from footfall.scenarios.parameters import documents
from footfall.scenarios.report.tables import new_table
from footfall.scenarios.studies.budget import METRICS
from footfall.scenarios.studies.check import Check
from footfall.scenarios.studies.indices import sobol_until
from footfall.scenarios.studies.listening import Heard, listened
from footfall.scenarios.studies.points import Worn, evaluate_points

WEIGHTS = np.array([0.0, 1.0, 4.5, 9.0])  # of Sobol's g
GYRO = "imu.gyro."
WHITE, FLICKER = f"{GYRO}angle_random_walk_deg_rt_h", f"{GYRO}flicker_deg_h"
HEAT, FORCE = f"{GYRO}temperature_sigma_deg_s_k", f"{GYRO}g_sensitivity_sigma_deg_s_g"
SHEETS = {
    "a tenth of temperature and g-sensitivity": {HEAT: 0.0011, FORCE: 0.015},
    "twice white noise and temperature, half g-sensitivity": {WHITE: 8.8, HEAT: 0.022, FORCE: 0.075},
    "eightfold flicker, 1.5 times the others": {WHITE: 6.6, HEAT: 0.0165, FORCE: 0.225, FLICKER: 640.0},
    "three times temperature and g-sensitivity": {HEAT: 0.033, FORCE: 0.45},
}


def ishigami(x: np.ndarray) -> np.ndarray:
    """Ishigami and Homma (1990), a = 7, b = 0.1, on the unit cube."""
    one, two, three = (np.pi * (2 * x - 1)).T
    return np.asarray(np.sin(one) + 7 * np.sin(two) ** 2 + 0.1 * three**4 * np.sin(one))


def ishigami_known() -> tuple[np.ndarray, np.ndarray]:
    """First-order and total indices."""
    a, b = 7.0, 0.1
    first = 0.5 * (1 + b * np.pi**4 / 5) ** 2
    second, both = a**2 / 8, b**2 * np.pi**8 * (1 / 18 - 1 / 50)
    whole = first + second + both
    return np.array([first, second, 0.0]) / whole, np.array([first + both, second, both]) / whole


def g(x: np.ndarray) -> np.ndarray:
    """Sobol's g (Saltelli and Sobol 1995)."""
    return np.asarray(np.prod((np.abs(4 * x - 2) + WEIGHTS) / (1 + WEIGHTS), axis=1))


def g_known() -> tuple[np.ndarray, np.ndarray]:
    """First-order and total indices."""
    own = 1 / (3 * (1 + WEIGHTS) ** 2)
    whole = np.prod(1 + own) - 1
    total = [value * np.prod(1 + np.delete(own, i)) for i, value in enumerate(own)]
    return own / whole, np.array(total) / whole


def inside(
    function: Callable[[np.ndarray], np.ndarray], known: tuple[np.ndarray, np.ndarray], seeds: int
) -> dict[str, float]:
    """How many of the known indices lie inside their intervals, and how wide those are, N = 1,024."""
    hits, count, widest, furthest = 0, 0, 0.0, 0.0
    for seed in range(seeds):
        steps = sobol_until(
            lambda x: function(x)[:, None],
            len(known[0]),
            samples=1024,
            at_most=1024,
            widest=0.0,
            seed=seed,
        )
        *_, (found,) = steps
        widest = max(widest, found.widest)
        for indices, true in zip((found.first, found.total), known, strict=True):
            for index, value in zip(indices, true, strict=True):
                hits += int(index.low <= value <= index.high)
                furthest = max(furthest, float(abs(index.value - value) / max(index.half, 1e-12)))
                count += 1
    return {"indices": count, "inside": hits, "widest": widest, "furthest": furthest}


END = np.array([[0.5], [0.0]])  # shares of a range: inside, where nothing is off, and its end


def refused(check: Check) -> bool:
    """Whether a study with this check would end."""
    try:
        check.require()
    except InputError:
        return True
    return False


def main(arguments: Sequence[str] | None = None) -> None:
    """Print both tables."""
    parser = options(__doc__)
    parser.add_argument("--units", type=int, default=10, help="on the first walk (default 10)")
    parser.add_argument("--seeds", type=int, default=20, help="of the known functions (default 20)")
    chosen = parser.parse_args(arguments)
    figures: dict[str, Any] = {}
    table = new_table("function", "indices", "inside", "widest +-", "furthest, of +-")
    for name, function, known in (("Ishigami", ishigami, ishigami_known()), ("Sobol's g", g, g_known())):
        made = figures[name] = inside(function, known, chosen.seeds)
        cells = (f"{made['widest']:.3f}", f"{made['furthest']:.2f}")
        table.add_row(name, str(made["indices"]), str(made["inside"]), *cells)
    out.print(table)

    base = documents("closed-loop", imu="nimu", methods=["pdr", "hdr"])
    setup, worn = base.setup(), Worn(walks=1, units=chosen.units)
    heard = listened(worn.deal(setup), workers=chosen.processes)
    full = evaluate_points(
        base, list(SHEETS.values()), worn.deal, METRICS[0], workers=chosen.processes
    ).errors
    table = new_table("sheet", "method", "full", "budget", "off", "units off", "a study", left=2)
    for i, method in enumerate(setup.methods):
        for k, (name, values) in enumerate(SHEETS.items()):
            model = Heard(heard, setup.spec, method, list(values), METRICS[0])
            made = model(np.array([list(values.values())]))[0]
            own = full[i, k]
            off = 100 * (made.mean() / own.mean() - 1)
            each = float(np.median(np.abs(made - own)))
            ends = Check(method.name, END, np.array([1.0, own.mean()]), np.array([1.0, made.mean()]))
            told = "refused" if refused(ends) else "within"
            figures[f"{method.name}, {name}"] = {"full": own.tolist(), "budget": made.tolist()}
            table.add_row(
                name,
                method.name,
                f"{own.mean():.1f}",
                f"{made.mean():.1f}",
                f"{off:+.0f} %",
                f"{each:.1f}",
                told,
            )
    out.print(table)
    write_json(chosen.json, figures)


if __name__ == "__main__":
    main()
