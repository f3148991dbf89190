"""Proximal policy optimisation (Schulman et al. 2017) with a KL-adaptive step size, on the CPU.

Only training imports this module: it needs torch (`pip install footfall[train]`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import torch

from footfall.simulate.learn.env import WalkVectorEnv

GAMMA, LAMBDA, CLIP = 0.97, 0.95, 0.2
HORIZON, EPOCHS, MINIBATCHES = 48, 5, 4
KL_HIGH, KL_LOW = 0.025, 0.010
_HIDDEN = 128


def perceptron(n_in: int, n_out: int, last_gain: float) -> torch.nn.Sequential:
    """Two hidden ELU layers of 128, orthogonal initialisation."""
    layers = [
        torch.nn.Linear(n_in, _HIDDEN),
        torch.nn.Linear(_HIDDEN, _HIDDEN),
        torch.nn.Linear(_HIDDEN, n_out),
    ]
    for layer in layers:
        torch.nn.init.orthogonal_(layer.weight)
        torch.nn.init.zeros_(layer.bias)
    layers[-1].weight.data *= last_gain
    return torch.nn.Sequential(layers[0], torch.nn.ELU(), layers[1], torch.nn.ELU(), layers[2])


@dataclass
class Schedule:
    """Bounds of the exploration's log standard deviation and of the step size at a point of the training."""

    log_sd_max: float
    rate_max: float


class Learner:
    """Policy, value function and optimiser; `collect` then `update`, again and again."""

    def __init__(self, n_observation: int, n_action: int, seed: int) -> None:
        torch.manual_seed(seed)
        self.policy = perceptron(n_observation, n_action, 0.007)
        self.value = perceptron(n_observation, 1, 1.0)
        self.log_sd = torch.nn.Parameter(torch.full((n_action,), -2.3))
        self.parameters = [*self.policy.parameters(), *self.value.parameters(), self.log_sd]
        self.optimiser = torch.optim.Adam(self.parameters, lr=4e-4, eps=1e-5)
        self.rate = 4e-4
        self.rng = np.random.default_rng(np.random.SeedSequence(seed).spawn(1)[0])

    def state(self) -> dict[str, Any]:
        """Everything that a resumed training needs."""
        return {
            "policy": self.policy.state_dict(),
            "value": self.value.state_dict(),
            "log_sd": self.log_sd.data,
            "optimiser": self.optimiser.state_dict(),
            "rate": self.rate,
            "rng": self.rng.bit_generator.state,
            "torch_rng": torch.get_rng_state(),
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Continue from `state()`."""
        self.policy.load_state_dict(state["policy"])
        self.value.load_state_dict(state["value"])
        self.log_sd.data = state["log_sd"]
        self.optimiser.load_state_dict(state["optimiser"])
        self.rate = state["rate"]
        self.rng.bit_generator.state = state["rng"]
        torch.set_rng_state(state["torch_rng"])

    @torch.no_grad()
    def collect(
        self, env: WalkVectorEnv, observation: np.ndarray
    ) -> tuple[dict[str, np.ndarray], np.ndarray]:
        """Walk HORIZON control steps with exploration.

        Returns
        -------
        batch : (HORIZON, n, ...) observations, actions, log probabilities, advantages, returns; statistics
        observation : to continue from
        """
        n = env.num_envs
        sd = np.exp(self.log_sd.numpy())
        log: dict[str, list[np.ndarray]] = {
            key: [] for key in ("observation", "action", "log_probability", "value", "reward", "ended")
        }
        falls, terms = 0, []
        for _ in range(HORIZON):
            seen = torch.from_numpy(observation)
            mean, value = self.policy(seen).numpy(), self.value(seen).numpy()[:, 0]
            noise = self.rng.standard_normal(mean.shape).astype(np.float32)
            action = mean + sd * noise
            log["observation"].append(observation)
            log["action"].append(action)
            log["log_probability"].append(-0.5 * (noise**2).sum(1) - np.log(sd).sum())
            log["value"].append(value)
            observation, reward, fallen, truncated, info = env.step(action)
            if truncated.any():  # a time limit is not a failure: bootstrap its value
                last = self.value(torch.from_numpy(info["final_obs"])).numpy()[:, 0]
                reward = reward + GAMMA * last * truncated
            log["reward"].append(reward.astype(np.float32))
            log["ended"].append(fallen | truncated)
            falls += int(fallen.sum())
            terms.append({name: float(term.mean()) for name, term in info["terms"].items()})
        batch = {key: np.stack(values) for key, values in log.items()}
        value = np.concatenate([batch["value"], self.value(torch.from_numpy(observation)).numpy().T])
        advantage, running = np.zeros((HORIZON, n), np.float32), np.zeros(n, np.float32)
        for t in reversed(range(HORIZON)):
            alive = 1.0 - batch["ended"][t]
            delta = batch["reward"][t] + GAMMA * value[t + 1] * alive - value[t]
            running = delta + GAMMA * LAMBDA * alive * running
            advantage[t] = running
        batch["advantage"], batch["return"] = advantage, advantage + value[:-1]
        batch["falls"] = np.array(falls)
        for name in terms[0]:
            batch[f"term_{name}"] = np.array(np.mean([step[name] for step in terms]))
        return batch, observation

    def update(self, batch: dict[str, np.ndarray], schedule: Schedule) -> float:
        """Improve on `batch`; returns the mean KL divergence of the last epoch."""
        n = batch["advantage"].size
        flat = {
            key: torch.from_numpy(batch[key].reshape(n, *batch[key].shape[2:]))
            for key in ("observation", "action", "log_probability", "advantage", "return")
        }
        advantage = (flat["advantage"] - flat["advantage"].mean()) / (flat["advantage"].std() + 1e-6)
        divergence: list[float] = []
        for _ in range(EPOCHS):
            for rows in torch.randperm(n).split(n // MINIBATCHES):
                seen = flat["observation"][rows]
                mean = self.policy(seen)
                z = (flat["action"][rows] - mean) / self.log_sd.exp()
                log_probability = -0.5 * (z**2).sum(1) - self.log_sd.sum()
                ratio = (log_probability - flat["log_probability"][rows]).exp()
                gain = torch.min(
                    ratio * advantage[rows], ratio.clamp(1 - CLIP, 1 + CLIP) * advantage[rows]
                ).mean()
                value_error = ((self.value(seen)[:, 0] - flat["return"][rows]) ** 2).mean()
                loss = -gain + 0.5 * value_error + 0.0045 * (mean**2).sum(1).mean()
                self.optimiser.zero_grad()
                loss.backward()
                torch.nn.utils.clip_grad_norm_(self.parameters, 1.0)
                self.optimiser.step()
                with torch.no_grad():
                    divergence.append(float(((ratio - 1) - ratio.log()).mean()))
        last = float(np.mean(divergence[-MINIBATCHES:]))
        if last > KL_HIGH:
            self.rate = max(self.rate / 1.3, 5e-5)
        elif last < KL_LOW:
            self.rate = self.rate * 1.15
        self.rate = min(self.rate, schedule.rate_max)
        for group in self.optimiser.param_groups:
            group["lr"] = self.rate
        self.log_sd.data.clamp_(-4.2, schedule.log_sd_max)
        return last
