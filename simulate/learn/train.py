"""Train the walker: `python -m footfall.simulate.learn.train --out DIR`; run it again to resume.

Stage 1 tunes the gains of the balance feedback by CMA-ES with no policy; stage 2 trains the policy on top by
PPO. The difficulty rises from straight walking to everything, and everything stays in every later batch: a
walker that is taught one thing at a time forgets the others. Stage 3 lets the last checkpoints walk fixed
courses, stop and set out again, keeps the best one as DIR/walker.npz, and judges it on other courses and with
other people. Needs `pip install footfall[train]`.
"""

from __future__ import annotations

import argparse
import json
import time
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import cma
import numpy as np
import torch

from footfall.models.policy import Policy, load_policy
from footfall.simulate.learn.courses import (
    CHOICE,
    CHOICE_SEED,
    JUDGEMENT,
    JUDGEMENT_SEED,
    Course,
    Verdict,
    attempt,
)
from footfall.simulate.learn.env import CommandedWalkers, Difficulty, WalkVectorEnv, draw_build
from footfall.simulate.learn.ppo import HORIZON, Learner, Schedule
from footfall.simulate.learn.stops import StopVerdict, attempt_stops
from footfall.simulate.walker.feedback import GAIN_SCALE, GAIN_START
from footfall.simulate.walker.observation import N_OBSERVATION
from footfall.simulate.walker.walkers import CONTROL_INTERVAL, N_ACTION
from footfall.tables import replacing

ENVS = 64
_CANDIDATES, _REPEATS, _TRIAL_S = 16, 4, 6.0
_EXCESS_WEIGHT = 0.5  # of a degree, beside one fall an hour or one in a hundred stops
_KEEP_FROM, _KEEP_EVERY = 0.6, 0.05  # of the planned samples: checkpoints among which the best is chosen


def tune_gains(seed: int, generations: int, threads: int) -> np.ndarray:
    """Feedback gains (32,) by CMA-ES: mean and worst reward of walking with no policy for up to 6 s."""
    n = _CANDIDATES * _REPEATS
    bodies = np.random.default_rng([seed, 1])
    commanded = CommandedWalkers(
        [draw_build(bodies) for _ in range(n)],
        Difficulty(level=0.0),
        np.tile(GAIN_START, (n, 1)),
        timesteps=np.full(n, 0.003),
        threads=threads,
        rng=np.random.default_rng(0),
    )
    start, scale = np.array(GAIN_START), np.array(GAIN_SCALE)
    search = cma.CMAEvolutionStrategy(
        np.zeros(len(start)),
        0.2,
        {"popsize": _CANDIDATES, "verbose": -9, "seed": seed + 1, "CMA_diagonal": 30},
    )
    idle = np.zeros((n, N_ACTION))
    for generation in range(generations):
        candidates = search.ask()
        commanded.walkers.gains = np.repeat(start + scale * np.array(candidates), _REPEATS, axis=0)
        commanded.seed(np.random.default_rng([seed, 2, generation]))
        commanded.reset(np.ones(n, dtype=bool))
        alive, reward, lived = np.ones(n, dtype=bool), np.zeros(n), np.zeros(n)
        for _ in range(int(_TRIAL_S / CONTROL_INTERVAL)):
            step_reward, fallen, _ = commanded.step(idle)
            reward += step_reward * alive
            lived += alive
            alive &= ~fallen
            if not alive.any():
                break
            if fallen.any():
                commanded.reset(fallen)  # keep the physics tame; `alive` no longer counts them
        score = reward.reshape(_CANDIDATES, _REPEATS)
        search.tell(candidates, list(-(0.7 * score.mean(1) + 0.3 * score.min(1))))
        if generation % 20 == 0:
            print(
                f"gains: generation {generation}, mean life {lived.mean() * CONTROL_INTERVAL:.2f} s",
                flush=True,
            )
    commanded.walkers.close()
    return start + scale * search.result.xfavorite


def schedule(samples: int, total: int) -> tuple[float, Schedule]:
    """Difficulty level, exploration and step-size bounds after so many samples."""
    level = float(np.clip((samples - 0.3e6) / 1.7e6, 0, 1))
    part = samples / total
    log_sd_max = float(np.interp(part, [0, 0.3, 0.8, 1], [-2.0, -2.5, -3.1, -3.4]))
    rate_max = float(np.interp(part, [0, 0.5, 1], [6e-4, 4e-4, 1e-4]))
    return level, Schedule(log_sd_max, rate_max)


def save_policy(learner: Learner, gains: np.ndarray, path: Path, meta: dict[str, Any]) -> None:
    """Write the policy as npz for `models.policy`."""
    arrays: dict[str, Any] = {"feedback_gains": gains, "meta": np.array(json.dumps(meta))}
    for i, layer in enumerate(module for module in learner.policy if isinstance(module, torch.nn.Linear)):
        arrays[f"weight_{i}"] = layer.weight.detach().numpy().T
        arrays[f"bias_{i}"] = layer.bias.detach().numpy()
    with replacing(path) as temporary, temporary.open("wb") as file:
        np.savez(file, **arrays)


def train(out: Path, seed: int, samples: int, generations: int, threads: int) -> None:
    """Train, or resume in `out`; writes checkpoint.pt, policy.npz (every ~0.5 M samples) and log.jsonl."""
    torch.set_num_threads(1)
    out.mkdir(parents=True, exist_ok=True)
    learner = Learner(N_OBSERVATION, N_ACTION, seed)
    checkpoint, gains_file = out / "checkpoint.pt", out / "gains.npy"
    done = 0
    if gains_file.exists():
        gains = np.load(gains_file)
    else:
        gains = tune_gains(seed, generations, threads)
        np.save(gains_file, gains)
    if checkpoint.exists():
        state = torch.load(checkpoint, weights_only=False)
        learner.restore(state["learner"])
        done = state["samples"]
        print(f"resumed at {done / 1e6:.2f} M samples", flush=True)
    env = WalkVectorEnv(ENVS, Difficulty(level=0.0), gains, threads=threads, seed=seed)
    observation, _ = env.reset(seed=seed + 1000 + done)
    started, first, iteration = time.time(), done, 0
    while done < samples:
        level, bounds = schedule(done, samples)
        env.commanded.difficulty = replace(env.commanded.difficulty, level=level)
        batch, observation = learner.collect(env, observation)
        divergence = learner.update(batch, bounds)
        done += batch["advantage"].size
        iteration += 1
        if iteration % 20 and done < samples:
            continue
        walked = HORIZON * ENVS * CONTROL_INTERVAL
        record = {
            "samples": done,
            "level": level,
            "falls_per_min": float(batch["falls"]) / walked * 60,
            "reward": float(batch["reward"].mean()),
            "sd": float(np.exp(learner.log_sd.detach().numpy()).mean()),
            "kl": divergence,
            "rate": learner.rate,
            "samples_per_s": (done - first) / (time.time() - started),
        }
        record |= {key: round(float(value), 3) for key, value in batch.items() if key.startswith("term_")}
        with (out / "log.jsonl").open("a") as file:
            file.write(json.dumps(record) + "\n")
        print(" ".join(f"{key} {value:.4g}" for key, value in record.items()), flush=True)
        with replacing(checkpoint) as temporary:
            torch.save({"learner": learner.state(), "samples": done}, temporary)
        meta: dict[str, Any] = {"seed": seed, "samples": done}
        meta |= {"samples_planned": samples, "generations": generations}
        save_policy(learner, gains, out / "policy.npz", meta)
        part = done / samples
        if part >= _KEEP_FROM:
            kept = out / f"policy_{round(part // _KEEP_EVERY * _KEEP_EVERY * 100):03d}.npz"
            if not kept.exists():
                save_policy(learner, gains, kept, meta)
    env.close()


def choose(out: Path, threads: int) -> None:
    """Keep the checkpoint that is best on the courses of choice as walker.npz, and judge it on others.

    A fall an hour on the courses counts as one in a hundred stops, and as 2 deg by which loaded feet twist or
    tip too far. Writes choice.json.
    """

    def tried(policy: Policy, courses: tuple[Course, ...], seed: int) -> tuple[Verdict, StopVerdict]:
        return (
            attempt(policy, courses, seed=seed, threads=threads),
            attempt_stops(policy, seed=seed, threads=threads),
        )

    def told(walked: Verdict, stopped: StopVerdict) -> dict[str, Any]:
        courses = {"falls_per_hour": walked.falls_per_hour, "minutes": walked.minutes, "falls": walked.falls}
        return {**courses, "stops": asdict(stopped)}

    def cost(name: str) -> float:
        walked, stopped = found[name]
        return walked.falls_per_hour + stopped.falls_percent + _EXCESS_WEIGHT * stopped.excess_deg

    found: dict[str, tuple[Verdict, StopVerdict]] = {}
    for path in sorted(out.glob("policy_*.npz")):
        found[path.name] = walked, stopped = tried(load_policy(path), CHOICE, CHOICE_SEED)
        print(f"{path.name}: {walked.falls_per_hour:.1f} falls an hour, {stopped}", flush=True)
    # Of equals the one that has learnt longest.
    best = min(reversed(found), key=cost)
    judged = tried(load_policy(out / best), JUDGEMENT, JUDGEMENT_SEED)
    report = {
        "chosen": best,
        "choice": {name: told(*both) for name, both in found.items()},
        "judgement": told(*judged),
    }
    with replacing(out / "choice.json") as temporary:
        temporary.write_text(json.dumps(report, indent=1) + "\n")
    with replacing(out / "walker.npz") as temporary:
        temporary.write_bytes((out / best).read_bytes())
    print(
        f"{best} chosen; on other courses {judged[0].falls_per_hour:.1f} falls an hour, {judged[1]}",
        flush=True,
    )


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--out", type=Path, required=True, help="folder of checkpoints and log; resumes from it"
    )
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--samples", type=float, default=14e6, help="control steps to learn from")
    parser.add_argument("--generations", type=int, default=160, help="of CMA-ES for the feedback gains")
    parser.add_argument("--threads", type=int, default=2, help="for the physics")
    arguments = parser.parse_args()
    train(
        arguments.out,
        arguments.seed,
        int(arguments.samples),
        arguments.generations,
        arguments.threads,
    )
    choose(arguments.out, arguments.threads)


if __name__ == "__main__":
    main()
