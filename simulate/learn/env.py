"""Walkers that follow commands of speed and turn rate without falling: many at once, on threads.

`gymnasium.make_vec("footfall/Walk-v0")` makes the threaded environment, which is what training uses;
`gymnasium.make` the one of `simulate.walk_env`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space

from footfall.conventions import GRAVITY
from footfall.errors import InputError
from footfall.models.body import build_body
from footfall.models.policy import stock_policy
from footfall.models.subject import Build, Habits
from footfall.simulate.learn.reward import reward_terms, total
from footfall.simulate.walker.feedback import GAIN_SHAPE
from footfall.simulate.walker.observation import LIMIT, N_OBSERVATION
from footfall.simulate.walker.walkers import N_ACTION, Trace, Walkers, grip

EPISODE_STEPS = 333  # 10 s


@dataclass(frozen=True)
class Difficulty:
    """What may be asked for. `level` 0 is straight, level walking at 1.1-1.3 m/s; 1 is everything below.

    Attributes
    ----------
    speed : (low, high) m/s; slow : share of commands from 0.25 m/s up to the low one
    turn : rad/s; grade : rise over run
    stop : share of commands that ask to stand
    stand, halt : shares of episodes that begin standing, and walking with the wish to stand
    kick : SD (m/s) of the velocity kicks at each change of command (training only)
    variability : of the gait, up to this many times that of people
    """

    level: float = 1.0
    speed: tuple[float, float] = (0.65, 1.95)
    slow: float = 0.18
    turn: float = 1.1
    grade: float = 0.10
    stop: float = 0.35
    stand: float = 0.2
    halt: float = 0.35
    kick: float = 0.08
    variability: float = 1.2


def draw_build(rng: np.random.Generator) -> Build:
    """A body of the range that the policy must master."""

    def around(share: float) -> float:
        return float(rng.uniform(1 - share, 1 + share))

    return Build(
        thigh=around(0.03),
        shank=around(0.03),
        hip_width=around(0.06),
        foot=around(0.05),
        trunk_mass=around(0.12),
        leg_mass=around(0.10),
        friction=float(rng.uniform(0.7, 1.2)),
        sole_time=float(rng.uniform(0.012, 0.026)),
    )


def draw_habits(rng: np.random.Generator) -> Habits:
    """Habits of the range that the policy must master."""
    return Habits(
        cadence=float(rng.uniform(0.93, 1.07)),
        step_width=float(rng.uniform(-0.02, 0.03)),
        toe_out=float(np.radians(rng.uniform(-3, 10))),
        asymmetry=float(rng.uniform(-0.03, 0.03)),
    )


def rewarded_step(walkers: Walkers, action: np.ndarray) -> tuple[dict[str, np.ndarray], Trace]:
    """Take a control step; the unweighted terms of its reward (n,) and its physics."""
    before = walkers.residual
    trace = walkers.step(action)
    return reward_terms(walkers, trace, action, walkers.residual - before), trace


class CommandedWalkers:
    """n walkers, random commands, rewards and falls. The environments are thin faces of it.

    Parameters
    ----------
    habits : of every walker; drawn anew at each reset when None
    """

    def __init__(
        self,
        builds: list[Build],
        difficulty: Difficulty,
        gains: np.ndarray,
        *,
        timesteps: np.ndarray,
        threads: int = 0,
        rng: np.random.Generator,
        habits: Habits | None = None,
    ) -> None:
        models = [build_body(build, timestep=step) for build, step in zip(builds, timesteps, strict=True)]
        self.rng, self.difficulty, self.habits = rng, difficulty, habits
        self.walkers = Walkers(models, gains, rng=rng, threads=threads)
        self.until_command = np.zeros(len(builds))
        self.terms: dict[str, np.ndarray] = {}

    def seed(self, rng: np.random.Generator) -> None:
        """Use this generator from now on."""
        self.rng = self.walkers.rng = rng

    def draw_commands(self, n: int, *, may_stop: bool = True) -> tuple[np.ndarray, np.ndarray]:
        """Speeds and turn rates: stops, straights, gentle bends and, slower, sharp turns."""
        d, rng = self.difficulty, self.rng
        low, high = 1.2 + d.level * (d.speed[0] - 1.2), 1.2 + d.level * (d.speed[1] - 1.2)
        speed, kind = rng.uniform(min(low, 1.1), max(high, 1.3), n), rng.random(n)
        speed = np.where(rng.random(n) < d.slow * d.level, rng.uniform(0.25, d.speed[0], n), speed)
        gentle, sharp = rng.uniform(-0.2, 0.2, n), rng.uniform(-d.turn, d.turn, n)
        turn = np.where(kind < 0.35, 0.0, np.where(kind < 0.6, gentle, sharp)) * d.level
        # The sharper the turn, the slower: 1.3 m/s at 0.3 rad/s, 0.8 m/s at 1.1 rad/s.
        slow = np.interp(np.abs(turn), [0.3, 1.1], [1.3, 0.8])
        speed = np.where(np.abs(turn) > 0.3, np.minimum(speed, slow), speed)
        if may_stop:
            stop = rng.random(n) < d.stop * d.level
            speed, turn = np.where(stop, 0.0, speed), np.where(stop, 0.0, turn)
        return speed, turn

    def reset(self, mask: np.ndarray) -> None:
        """Start the walkers in `mask` anew, in mid-gait or standing."""
        n = int(mask.sum())
        if n == 0:
            return
        d, rng, walkers = self.difficulty, self.rng, self.walkers
        self._tilt_gravity(mask)
        speed, turn = self.draw_commands(n, may_stop=False)
        kind = rng.random(n)
        standing = kind < d.stand * d.level
        halting = ~standing & (kind < (d.stand + d.halt) * d.level)
        # From a slow walk a stand is a step away; what is learnt there makes slowing down worth it.
        speed = np.where(halting, rng.uniform(0.0, 1.3, n), speed)
        calm = np.where(standing, 0.3, 1.0)[:, None]
        walkers.place(
            mask,
            phase=rng.random(n),
            speed=speed,
            heading=rng.uniform(-np.pi, np.pi, n),
            position=np.zeros((n, 3)),
            standing=standing,
            variability=rng.uniform(0.5, 1.0, n) * d.variability * d.level,
            habits=[self.habits or draw_habits(rng) for _ in range(n)],
            joint_noise=calm * rng.normal(0, 0.02, (n, walkers.qpos.shape[1] - 7)),
            velocity_noise=calm * rng.normal(0, 0.05, (n, 3)),
        )
        walkers.speed_goal[mask] = np.where(halting, 0.0, walkers.speed_goal[mask])
        turn = np.where(standing | halting, 0.0, turn)
        walkers.turn[mask], walkers.turn_goal[mask] = turn, turn
        self.until_command[mask] = rng.uniform(1, 4, n) + np.where(halting, 2.0, 0.0)

    def _tilt_gravity(self, mask: np.ndarray) -> None:
        """Sloping ground is level ground under tilted gravity."""
        d, rng, walkers, n = self.difficulty, self.rng, self.walkers, int(mask.sum())
        # Steep ones are the hardest to stop on, so they are drawn more often than slight ones.
        tangent = d.grade * d.level * np.sqrt(rng.random(n)) * (rng.random(n) < 0.7)
        azimuth = rng.uniform(-np.pi, np.pi, n)
        up = np.stack([tangent * np.cos(azimuth), tangent * np.sin(azimuth), np.ones(n)], 1)
        up /= np.linalg.norm(up, axis=1)[:, None]
        walkers.up[mask] = up
        for i, direction in zip(np.flatnonzero(mask), up, strict=True):
            walkers.models[i].opt.gravity[:] = -GRAVITY * direction

    def step(self, action: np.ndarray) -> tuple[np.ndarray, np.ndarray, Trace]:
        """Rewards (n,), falls (n,) and the physics of one control step."""
        grip(self.walkers)
        self.terms, trace = rewarded_step(self.walkers, action)
        self._change_commands()
        return total(self.terms), self.walkers.fallen(), trace

    def _change_commands(self) -> None:
        d, rng, walkers = self.difficulty, self.rng, self.walkers
        self.until_command -= walkers.dt
        due = np.flatnonzero(self.until_command <= 0)
        n = len(due)
        if n == 0:
            return
        speed, turn = self.draw_commands(n)
        # A walker that was told to stand is told to go.
        again, _ = self.draw_commands(n, may_stop=False)
        stood = walkers.speed_goal[due] < 0.2
        walkers.speed_goal[due] = np.where(stood, again, speed)
        walkers.turn_goal[due] = np.where(stood, 0.0, turn)
        self.until_command[due] = rng.uniform(1.5, 5, n) + np.where(walkers.speed_goal[due] < 0.2, 3.0, 0.0)
        kick = d.kick * d.level * np.where(walkers.gate.value[due] < 0.5, 0.3, 1.0)[:, None]
        walkers.qvel[due, :3] += kick * rng.standard_normal((n, 3)) * [1, 1, 0.3]


def balance_gains(asked: np.ndarray | None) -> np.ndarray:
    """(32,) gains of the balance feedback under the action: as asked, or the shipped policy's.

    Raises
    ------
    InputError
        Gains of another shape, or not finite.
    """
    if asked is None:
        return stock_policy().feedback_gains
    gains = np.asarray(asked, dtype=float)
    if gains.shape != GAIN_SHAPE or not np.isfinite(gains).all():
        raise InputError(f"feedback_gains {gains.shape}: expected {GAIN_SHAPE}, finite")
    return gains


OBSERVATION_SPACE = gym.spaces.Box(-LIMIT, LIMIT, (N_OBSERVATION,), np.float32)
ACTION_SPACE = gym.spaces.Box(-1.0, 1.0, (N_ACTION,), np.float32)


class WalkVectorEnv(gym.vector.VectorEnv):
    """Many walkers of drawn bodies, stepped together on threads; resets within the step (SAME_STEP).

    They follow random commands only. `infos["terms"]` holds the unweighted terms of the reward (n,) each,
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
        self.single_observation_space, self.single_action_space = OBSERVATION_SPACE, ACTION_SPACE
        self.observation_space = batch_space(OBSERVATION_SPACE, num_envs)
        self.action_space = batch_space(ACTION_SPACE, num_envs)
        bodies, commands = np.random.SeedSequence(seed).spawn(2)
        draw = np.random.default_rng(bodies)
        # People of other statures have other time scales (models.subject).
        timesteps = timestep * draw.uniform(0.94, 1.09, num_envs)
        self.commanded = CommandedWalkers(
            [draw_build(draw) for _ in range(num_envs)],
            difficulty or Difficulty(),
            balance_gains(feedback_gains),
            timesteps=timesteps,
            threads=threads,
            rng=np.random.default_rng(commands),
        )
        self._age = np.zeros(num_envs, dtype=int)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Start every walker anew, at staggered ages so that episodes do not end together.

        Raises
        ------
        InputError
            Options: these walkers have none.
        """
        if options:
            raise InputError(
                f"option {next(iter(options))!r}: the threaded environment follows random commands only, "
                "others can be had with vectorization_mode='sync' or 'async'"
            )
        if seed is not None:
            self.commanded.seed(np.random.default_rng(seed))
        self.commanded.reset(np.ones(self.num_envs, dtype=bool))
        self._age = self.commanded.rng.integers(0, int(0.8 * self._limit), self.num_envs)
        return self.commanded.walkers.observe(), {}

    def step(
        self, actions: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Walk for 30 ms; walkers that fell or ran out of time start anew."""
        reward, fallen, _ = self.commanded.step(np.asarray(actions, dtype=float))
        self._age += 1
        truncated = (self._age >= self._limit) & ~fallen
        ended = fallen | truncated
        info: dict[str, Any] = {"terms": self.commanded.terms}
        observation = self.commanded.walkers.observe()
        if ended.any():
            info["final_obs"], info["_final_obs"] = observation, ended
            self.commanded.reset(ended)
            self._age[ended] = 0
            observation = self.commanded.walkers.observe()
        return observation, reward, fallen, truncated, info

    def close_extras(self, **kwargs: Any) -> None:
        """Stop the physics threads."""
        self.commanded.walkers.close()
