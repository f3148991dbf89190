"""What gates promise: how often their bounds hold, what they find, and what they find where nothing is.

Coverage of the one-sided 95 % bounds over drawn samples of known laws. Power with the scatter that a small
change of HDR really makes: log ratios of two settings over units of the closed loop, centred, then moved by a
true change and drawn again. An unchanged method gated against its own baseline, again and again.

python -m benchmarks.validation.gate_statistics --units 200
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from benchmarks._common import err, options, out, write_json
from footfall.hdr.methods import METHODS
from footfall.scenarios.judge.bounds import ALPHA, quantile_bounds, ranks
from footfall.scenarios.report.tables import new_table, titled
from footfall.scenarios.studies.baseline import write_baseline
from footfall.scenarios.studies.gate import gate, scored
from footfall.scenarios.studies.gate_file import read_gates

Draw = Callable[[np.random.Generator, tuple[int, int]], np.ndarray]

# Law -> how it is drawn, its median and its 90th percentile.
LAWS: dict[str, tuple[Draw, float, float]] = {
    "lognormal": (lambda rng, n: np.exp(rng.normal(size=n)), 1.0, math.exp(1.2815515655446004)),
    "tied": (lambda rng, n: rng.integers(0, 4, size=n).astype(float), 1.0, 3.0),
    "infinite": (lambda rng, n: np.where(rng.random(n) < 0.3, math.inf, rng.random(n)), 0.5 / 0.7, math.inf),
    "heavy-tailed": (lambda rng, n: np.abs(rng.standard_cauchy(n)), 1.0, math.tan(0.45 * math.pi)),
}
SIZES = (5, 20, 60)
CHANGES = (0.0, 0.1, 0.2, 0.5)
MARGIN = 0.1
CASES = """
[cases]
scenario = "closed-loop"
units = {units}
[[gates]]
name = "no worse"
method = "hdr"
against = "{against}"
[[gates]]
name = "no worse, dead reckoning"
method = "pdr"
against = "{other}"
"""


def coverage(draws: int, seed: int) -> dict[str, dict[str, float]]:
    """Law, quantile and size -> share of lower and of upper bounds that hold."""
    rng, found = np.random.default_rng(seed), {}
    for law, (draw, median, p90) in LAWS.items():
        for n in SIZES:
            samples = draw(rng, (draws, n))
            for name, share, truth in (("median", 0.5, median), ("p90", 0.9, p90)):
                low, high = np.transpose([quantile_bounds(sample, share)[1:] for sample in samples])
                found[f"{law}, {name}, {n}"] = {
                    "lower": float((low <= truth).mean()),
                    "upper": float((high >= truth).mean()),
                }
    return found


def log_ratios(units: int) -> np.ndarray:
    """(units,) of the mean heading errors of HDR with theta_w 0.30 and 0.25 deg/s, centred."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "gates.toml"
        file.write_text(CASES.format(units=units, against="changed", other="hdr"), encoding="utf-8")
        changed = METHODS["hdr"].renamed("changed").with_params({"theta_w_deg_s": 0.3})
        made = read_gates(file, {"changed": changed})
        rows = scored(made, range(units))
    errors = {
        name: np.array([row.require().heading_error_mean_deg for row in rows if row.method == name])
        for name in ("hdr", "changed")
    }
    found = np.log(errors["changed"] / errors["hdr"])
    return np.asarray(found - np.median(found))


def power(scatter: np.ndarray, draws: int, seed: int) -> dict[str, dict[str, float]]:
    """True change and size -> shares of fail, undecided and pass."""
    rng, found = np.random.default_rng(seed), {}
    for change in CHANGES:
        for n in SIZES:
            ordered = np.sort(math.log1p(change) + rng.choice(scatter, (draws, n)), axis=1)
            low, high = ranks(n, 0.5, ALPHA)
            fail = ordered[:, low - 1] > math.log1p(MARGIN)
            passed = ordered[:, high - 1] <= math.log1p(MARGIN)
            found[f"{change:+.0%}, {n}"] = {
                "fail": float(fail.mean()),
                "undecided": float((~fail & ~passed).mean()),
                "pass": float(passed.mean()),
            }
    return found


def unchanged(runs: int, units: int) -> dict[str, int]:
    """Verdicts of `runs` runs of methods against their own baseline."""
    count = {"pass": 0, "undecided": 0, "fail": 0}
    with tempfile.TemporaryDirectory() as folder, err.status("unchanged") as status:
        file = Path(folder) / "gates.toml"
        file.write_text(CASES.format(units=units, against="b.parquet", other="b.parquet"), encoding="utf-8")
        write_baseline(scored(read_gates(file), range(units)), Path(folder) / "b.parquet")
        for number in range(runs):
            status.update(f"unchanged: run {number + 1} of {runs}")
            for verdict in gate(file, workers=1):
                count[verdict.verdict] += 1
    return count


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the tables."""
    parser = options(__doc__, processes=False)
    parser.add_argument("--draws", type=int, default=10_000, help="of each sample (default 10,000)")
    parser.add_argument("--units", type=int, default=200, help="whose log ratios are drawn (default 200)")
    parser.add_argument("--runs", type=int, default=100, help="of the unchanged methods (default 100)")
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args(arguments)

    covered = coverage(chosen.draws, chosen.seed)
    table = new_table("law, quantile, cases", "lower bound holds", "upper bound holds")
    for name, shares in covered.items():
        table.add_row(name, *(f"{share:.1%}" for share in shares.values()))
    out.print(titled("Coverage of the one-sided 95 % bounds", table))

    scatter = log_ratios(chosen.units)
    powered = power(scatter, chosen.draws, chosen.seed)
    table = new_table("true change", *(f"{n} cases" for n in SIZES))
    for change in CHANGES:
        cells = [powered[f"{change:+.0%}, {n}"] for n in SIZES]
        table.add_row(
            f"{change:+.0%}", *(" / ".join(f"{share:.0%}" for share in one.values()) for one in cells)
        )
    told = f"SD of the log ratios of {len(scatter)} units: {scatter.std():.2f}"
    out.print(titled(f"Fail / undecided / pass at a margin of {MARGIN:.0%}; {told}", table))

    verdicts = unchanged(chosen.runs, 20)
    out.print(f"{chosen.runs} runs of unchanged methods against their baseline: {verdicts}")
    write_json(
        chosen.json,
        {"coverage": covered, "power": powered, "scatter_sd": float(scatter.std()), "unchanged": verdicts},
    )


if __name__ == "__main__":
    main()
