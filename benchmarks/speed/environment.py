"""How many control steps a second the environments make, with the shipped policy driving.

python -m benchmarks.speed.environment
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Any

import gymnasium
import numpy as np
from rich.table import Table

import footfall  # noqa: F401 - registers the environment
from benchmarks._common import options, out, write_json
from footfall.models.policy import stock_policy

CASES: dict[str, dict[str, Any]] = {
    "one walker": {"num_envs": 1, "vectorization_mode": "sync"},
    "sync": {"num_envs": 8, "vectorization_mode": "sync"},
    "async": {"num_envs": 8, "vectorization_mode": "async"},
    "threads": {"num_envs": 64, "threads": 2},
}


def measure(steps: int, num_envs: int, **how: Any) -> float:
    """Control steps a second of all walkers together, after a second of warming up."""
    policy = stock_policy()
    envs = gymnasium.make_vec("footfall/Walk-v0", num_envs=num_envs, **how)
    observation, _ = envs.reset(seed=1)
    warm = 33
    for step in range(warm + steps):
        if step == warm:
            started = time.perf_counter()
        observation, *_ = envs.step(np.clip(policy(observation), -1, 1).astype(np.float32))
    rate = steps * num_envs / (time.perf_counter() - started)
    envs.close()
    return rate


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table."""
    parser = options(__doc__, processes=False)
    parser.add_argument("--steps", type=int, default=300, help="of each walker (default 300: 9 s)")
    chosen = parser.parse_args(arguments)
    rates = {name: measure(chosen.steps, **dict(how)) for name, how in CASES.items()}
    table = Table("environment", "walkers", "physics ms", "steps/s", "times real")
    for name, rate in rates.items():
        step = "3" if name == "threads" else "1"
        table.add_row(name, str(CASES[name]["num_envs"]), step, f"{rate:.0f}", f"{0.03 * rate:.0f}")
    out.print(table)
    write_json(chosen.json, {"steps_per_s": rates})


if __name__ == "__main__":
    main()
