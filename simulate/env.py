"""The gymnasium environment: follow commands of speed and turn rate without falling.

`gymnasium.make("footfall/Walk-v0")` after `import footfall`; `gymnasium.make_vec` gives many walkers whose
physics runs on threads, which is what training uses.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space

from footfall.conventions import GRAVITY
from footfall.models.body import Mount, build_body
from footfall.models.subject import REFERENCE_HEIGHT_M, REFERENCE_MASS_KG, Subject
from footfall.simulate.feedback import GAIN_START
from footfall.simulate.reward import reward_terms, total
from footfall.simulate.walkers import (
    CONTROL_INTERVAL,
    N_ACTION,
    N_OBSERVATION,
    OBSERVATION_LIMIT,
    Trace,
    Walkers,
)

EPISODE_STEPS = 333  # 10 s


@dataclass(frozen=True)
class Difficulty:
    """What the task may ask for. `level` 0 is straight, level walking at 1.1-1.3 m/s; 1 is everything below.

    Attributes
    ----------
    speed : (low, high) m/s; turn : rad/s; grade : rise over run
    kick : SD (m/s) of the velocity kicks at each change of command (training only)
    variability : of the gait, 1 = that of people
    """

    level: float = 1.0
    speed: tuple[float, float] = (0.85, 1.55)
    turn: float = 0.8
    grade: float = 0.06
    kick: float = 0.06
    variability: float = 1.0


def draw_subject(rng: np.random.Generator) -> Subject:
    """A body of the range that the policy must master."""
    return Subject(
        "drawn",
        height_m=REFERENCE_HEIGHT_M * rng.uniform(0.96, 1.04),
        mass_kg=REFERENCE_MASS_KG * rng.uniform(0.88, 1.12),
        friction=rng.uniform(0.7, 1.1),
        sole_time_s=rng.uniform(0.006, 0.012),
    )


class Task:
    """n walkers, random commands, rewards and falls. The environments are thin faces of it."""

    def __init__(
        self,
        n: int,
        difficulty: Difficulty,
        gains: np.ndarray,
        subjects: list[Subject],
        *,
        timestep: float,
        threads: int = 0,
        rng: np.random.Generator,
        mount: Mount | None = None,
    ) -> None:
        models = [build_body(subject, timestep=timestep, mount=mount) for subject in subjects]
        self.rng, self.difficulty = rng, difficulty
        self.walkers = Walkers(models, subjects, gains, variability=np.zeros(n), rng=rng, threads=threads)
        self.until_command = np.zeros(n)
        self.terms: dict[str, np.ndarray] = {}

    def seed(self, rng: np.random.Generator) -> None:
        """Use this generator from now on."""
        self.rng = self.walkers.rng = rng

    def draw_commands(self, n: int) -> tuple[np.ndarray, np.ndarray]:
        """Speeds and turn rates: a third straight, a third gentle, a third sharp and then slower."""
        d, rng = self.difficulty, self.rng
        low, high = 1.2 + d.level * (d.speed[0] - 1.2), 1.2 + d.level * (d.speed[1] - 1.2)
        low, high = min(low, 1.1), max(high, 1.3)
        speed, kind = rng.uniform(low, high, n), rng.random(n)
        gentle, sharp = rng.uniform(-0.2, 0.2, n), rng.uniform(-d.turn, d.turn, n)
        turn = np.where(kind < 0.35, 0.0, np.where(kind < 0.6, gentle, sharp)) * d.level
        return np.where(np.abs(turn) > 0.3, np.minimum(speed, 1.2), speed), turn

    def reset(self, mask: np.ndarray, *, random: bool = True) -> None:
        """Start the walkers in `mask` anew in mid-gait."""
        n = int(mask.sum())
        if n == 0:
            return
        d, rng, walkers = self.difficulty, self.rng, self.walkers
        self._tilt_gravity(mask, d.grade * d.level if random else 0.0)
        speed, turn = self.draw_commands(n)
        walkers.variability.level[mask] = d.variability * d.level
        walkers.place(
            mask,
            phase=rng.random(n),
            speed=speed,
            heading=rng.uniform(-np.pi, np.pi, n),
            position=np.zeros((n, 3)),
            joint_noise=rng.normal(0, 0.02, (n, walkers.qpos.shape[1] - 7)),
            velocity_noise=rng.normal(0, 0.05, (n, 3)),
        )
        walkers.turn[mask] = walkers.turn_goal[mask] = turn
        self.until_command[mask] = rng.uniform(1, 4, n)

    def _tilt_gravity(self, mask: np.ndarray, grade: float) -> None:
        """Sloping ground is level ground under tilted gravity."""
        n, rng, walkers = int(mask.sum()), self.rng, self.walkers
        tangent = rng.uniform(0, grade, n) * (rng.random(n) < 0.6)
        azimuth = rng.uniform(-np.pi, np.pi, n)
        up = np.stack([tangent * np.cos(azimuth), tangent * np.sin(azimuth), np.ones(n)], 1)
        up /= np.linalg.norm(up, axis=1)[:, None]
        walkers.up[mask] = up
        for i, direction in zip(np.flatnonzero(mask), up, strict=True):
            walkers.models[i].opt.gravity[:] = -GRAVITY * direction

    def step(self, action: np.ndarray) -> tuple[np.ndarray, np.ndarray, Trace]:
        """Rewards (n,), falls (n,) and the physics of one control step."""
        walkers = self.walkers
        before = walkers.residual
        trace = walkers.step(action)
        self.terms = reward_terms(walkers, trace, action, walkers.residual - before)
        self._change_commands()
        return total(self.terms), walkers.fallen(), trace

    def _change_commands(self) -> None:
        d, rng, walkers = self.difficulty, self.rng, self.walkers
        self.until_command -= CONTROL_INTERVAL
        due = np.flatnonzero(self.until_command <= 0)
        if len(due) == 0:
            return
        walkers.speed_goal[due], walkers.turn_goal[due] = self.draw_commands(len(due))
        self.until_command[due] = rng.uniform(1, 4, len(due))
        walkers.qvel[due, :3] += rng.normal(0, d.kick * d.level, (len(due), 3)) * [1, 1, 0.3]


_OBSERVATION_SPACE = gym.spaces.Box(-OBSERVATION_LIMIT, OBSERVATION_LIMIT, (N_OBSERVATION,), np.float32)
_ACTION_SPACE = gym.spaces.Box(-1.0, 1.0, (N_ACTION,), np.float32)


class WalkEnv(gym.Env[np.ndarray, np.ndarray]):
    """One walker that follows random commands of speed and turn rate.

    Observation: Box(-6, 6, (80,), float32), mirrored so that the stance leg is always the right one: height,
    gravity in the pelvis, velocities, joint angles and rates, foot pressure, step phase, commands, residual,
    grade, gait variability. Action: Box(-1, 1, (15,), float32), residual on the joint servos' targets, held for
    30 ms. Reward: `simulate.reward`. A fall terminates; the time limit (10 s) truncates.

    Parameters
    ----------
    subject : who walks
    difficulty : what is asked
    feedback_gains : (32,) balance feedback under the action; the hand-set start when None
    """

    metadata = {"render_modes": []}  # noqa: RUF012 - gymnasium's declaration

    def __init__(
        self,
        subject: Subject | None = None,
        difficulty: Difficulty | None = None,
        feedback_gains: np.ndarray | None = None,
        render_mode: str | None = None,
    ) -> None:
        self.render_mode = render_mode
        self.observation_space, self.action_space = _OBSERVATION_SPACE, _ACTION_SPACE
        gains = np.array(GAIN_START) if feedback_gains is None else np.asarray(feedback_gains)
        self._task = Task(
            1,
            difficulty or Difficulty(kick=0.0),
            gains,
            [subject or Subject()],
            timestep=0.001,
            rng=np.random.default_rng(0),
        )

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Start in mid-gait at a random phase, heading and command."""
        super().reset(seed=seed)
        self._task.seed(self.np_random)
        self._task.reset(np.ones(1, dtype=bool))
        return self._task.walkers.observe()[0], self._info()

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Walk for 30 ms."""
        reward, fallen, _ = self._task.step(np.asarray(action, dtype=float)[None])
        return self._task.walkers.observe()[0], float(reward[0]), bool(fallen[0]), False, self._info()

    def close(self) -> None:
        """Free the physics."""
        self._task.walkers.close()

    def _info(self) -> dict[str, Any]:
        walkers = self._task.walkers
        return {
            "position": walkers.qpos[0, :3].copy(),
            "yaw": float(walkers.yaw[0]),
            "speed_command": float(walkers.speed[0]),
            "turn_command": float(walkers.turn[0]),
        }


class WalkVectorEnv(gym.vector.VectorEnv):
    """Many walkers of drawn bodies, stepped together on threads; resets within the step (SAME_STEP).

    `infos["final_obs"]` holds the last observation of the walkers whose episode ended.
    """

    metadata = {"autoreset_mode": AutoresetMode.SAME_STEP, "render_modes": []}  # noqa: RUF012

    def __init__(
        self,
        num_envs: int = 64,
        difficulty: Difficulty | None = None,
        feedback_gains: np.ndarray | None = None,
        timestep: float = 0.003,
        threads: int = 0,
        seed: int = 0,
        max_episode_steps: int = EPISODE_STEPS,
    ) -> None:
        self.num_envs, self._limit = num_envs, max_episode_steps
        self.single_observation_space, self.single_action_space = _OBSERVATION_SPACE, _ACTION_SPACE
        self.observation_space = batch_space(_OBSERVATION_SPACE, num_envs)
        self.action_space = batch_space(_ACTION_SPACE, num_envs)
        bodies, commands = np.random.SeedSequence(seed).spawn(2)
        draw = np.random.default_rng(bodies)
        gains = np.array(GAIN_START) if feedback_gains is None else np.asarray(feedback_gains)
        self.task = Task(
            num_envs,
            difficulty or Difficulty(),
            gains,
            [draw_subject(draw) for _ in range(num_envs)],
            timestep=timestep,
            threads=threads,
            rng=np.random.default_rng(commands),
        )
        self._age = np.zeros(num_envs, dtype=int)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Start every walker anew, at staggered ages so that episodes do not end together."""
        if seed is not None:
            self.task.seed(np.random.default_rng(seed))
        self.task.reset(np.ones(self.num_envs, dtype=bool))
        self._age = self.task.rng.integers(0, int(0.8 * self._limit), self.num_envs)
        return self.task.walkers.observe(), {}

    def step(
        self, actions: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Walk for 30 ms; walkers that fell or ran out of time start anew."""
        reward, fallen, _ = self.task.step(np.asarray(actions, dtype=float))
        self._age += 1
        truncated = (self._age >= self._limit) & ~fallen
        ended = fallen | truncated
        info: dict[str, Any] = {"terms": self.task.terms}
        observation = self.task.walkers.observe()
        if ended.any():
            info["final_obs"], info["_final_obs"] = observation, ended
            self.task.reset(ended)
            self._age[ended] = 0
            observation = self.task.walkers.observe()
        return observation, reward, fallen, truncated, info

    def close_extras(self, **kwargs: Any) -> None:
        """Stop the physics threads."""
        self.task.walkers.close()
