"""Teach the shipped walker to spare its torque: a toy residual, learnt by an evolution strategy in minutes.

The residual is added to the shipped policy's action: an offset and one wave a step for each, 51 numbers.
It learns on straight, level walking at 1.1-1.3 m/s and is judged on other seeds and on a path that turns.

python docs/examples/spare_torque.py --seed 1 --out residual.npz
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

import footfall  # noqa: F401 - registers the environment
from footfall.models.policy import Policy, stock_policy
from footfall.simulate.learn.env import Difficulty
from footfall.simulate.walker.observation import LAYOUT
from footfall.simulate.walker.walkers import N_ACTION

ID = "footfall/Walk-v0"
PRICE = 10.0  # of torque, beside the 0.25 that the reward has already
STEPS, LONG = 150, 333  # of 30 ms, an episode to learn on and one to be judged on
LOOK, GO = 0.03, 0.03  # how far the strategy looks around and how far it goes, in units of action
COURSES: dict[str, dict[str, Any]] = {
    "straight, level, as learnt": {"difficulty": Difficulty(level=0.0)},
    "random commands": {},
    "scenario turning, drawn subjects": {"scenario": "turning", "subject": "drawn"},
}


def act(policy: Policy, residual: np.ndarray, observation: np.ndarray) -> np.ndarray:
    """Actions (n, 17) for observations (n, 88) and residuals (n, 17, 3) or (17, 3)."""
    wave = observation[:, LAYOUT["step_phase"]]
    features = np.concatenate([np.ones((len(wave), 1)), wave], axis=1)
    action = policy(observation) + np.einsum("...ij,...j->...i", residual, features)
    return np.clip(action, -1, 1).astype(np.float32)


def walk(
    envs: gymnasium.vector.VectorEnv, policy: Policy, residual: np.ndarray, seed: int, steps: int
) -> np.ndarray:
    """Walk one episode of so many steps in each environment.

    Returns
    -------
    (n, 3) reward a step (nothing after a fall), torque a step, and 1 where it fell.
    """
    observation, _ = envs.reset(seed=seed)
    n = envs.num_envs
    alive, lived, fell = np.ones(n, dtype=bool), np.zeros(n), np.zeros(n)
    reward, torque = np.zeros(n), np.zeros(n)
    for _ in range(steps):
        observation, gained, terminated, truncated, info = envs.step(act(policy, residual, observation))
        used = info["terms"]["torque"]
        reward += alive * (gained - PRICE * used)
        torque += alive * used
        lived += alive
        fell += alive & terminated
        alive &= ~(terminated | truncated)
    return np.stack([reward / steps, torque / lived, fell], axis=1)


def learn(policy: Policy, seed: int, generations: int, walkers: int) -> np.ndarray:
    """A residual (17, 3): climb along random directions, each of them tried both ways on the same episode."""
    rng = np.random.default_rng(seed)
    envs = gymnasium.make_vec(
        ID,
        num_envs=walkers,
        difficulty=Difficulty(level=0.0),
        threads=2,
        seed=seed,
        max_episode_steps=100 * STEPS,
    )
    residual, momentum = np.zeros((N_ACTION, 3)), np.zeros((N_ACTION, 3))
    for generation in range(generations):
        directions = rng.standard_normal((walkers, N_ACTION, 3))
        episode = int(rng.integers(2**31))
        one, other = (walk(envs, policy, residual + s * LOOK * directions, episode, STEPS) for s in (1, -1))
        better = one[:, 0] - other[:, 0]
        climb = (
            np.einsum("n,nij->ij", np.clip(better / np.median(np.abs(better)), -2, 2), directions) / walkers
        )
        momentum = 0.7 * momentum + 0.3 * climb
        residual = residual + GO * momentum
        reward, torque, fell = (one + other).mean(axis=0) / 2
        print(
            f"generation {generation}: reward {reward:.4f}, torque {torque:.5f}, falls {fell:.3f}", flush=True
        )
    envs.close()
    return residual


def judge(policy: Policy, residual: np.ndarray, seed: int, **how: Any) -> np.ndarray:
    """(3,) mean reward and torque and number of falls in 16 episodes of 10 s that it has not learnt on."""
    envs = gymnasium.make_vec(ID, num_envs=16, vectorization_mode="async", **how)
    found = walk(envs, policy, residual, seed, LONG)
    envs.close()
    return found.mean(axis=0) * [1, 1, len(found)]


def report(policy: Policy, residual: np.ndarray, seed: int) -> str:
    """The table of the tutorial: the shipped policy and the sparing one on every course."""
    lines = ["| | reward a step | torque | falls |", "|---|---|---|---|"]
    for name, how in COURSES.items():
        for label, one in (("shipped", np.zeros_like(residual)), ("sparing", residual)):
            reward, torque, fell = judge(policy, one, seed, **how)
            lines.append(f"| {name}: {label} | {reward:.3f} | {torque:.4f} | {fell:.0f} of 16 |")
    return "\n".join(lines)


def main() -> None:
    """Learn, judge and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--generations", type=int, default=15)
    parser.add_argument("--walkers", type=int, default=48, help="directions tried in each generation")
    parser.add_argument("--out", type=Path, help="npz file for the residual")
    parser.add_argument("--page", type=Path, help="the tutorial, whose table is replaced")
    chosen = parser.parse_args()

    policy, started = stock_policy(), time.monotonic()
    residual = learn(policy, chosen.seed, chosen.generations, chosen.walkers)
    minutes = (time.monotonic() - started) / 60
    table = report(policy, residual, 10_000 + chosen.seed)
    table += f"\n\nWeights `{policy.digest}`, seed {chosen.seed}; {minutes:.1f} minutes on two cores."
    print(table)
    if chosen.out is not None:
        np.savez(chosen.out, residual=residual, policy=policy.digest, seed=chosen.seed)
    if chosen.page is not None:
        text = chosen.page.read_text(encoding="utf-8")
        before, rest = text.split("<!-- table -->", 1)
        after = rest.split("<!-- end -->", 1)[1]
        chosen.page.write_text(f"{before}<!-- table -->\n{table}\n<!-- end -->{after}", encoding="utf-8")


if __name__ == "__main__":
    main()
