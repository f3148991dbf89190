"""One walker that follows random commands or a scenario's path: `gymnasium.make("footfall/Walk-v0")`."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import gymnasium as gym
import numpy as np

from footfall.errors import InputError
from footfall.models.subject import SUBJECTS, Build, Subject, draw_subject
from footfall.simulate.draw import QUARTER_VIEW, Painter, Stage, Window
from footfall.simulate.episode import Episode
from footfall.simulate.learn.env import (
    ACTION_SPACE,
    OBSERVATION_SPACE,
    CommandedWalkers,
    Difficulty,
    balance_gains,
    rewarded_step,
)
from footfall.simulate.learn.reward import WEIGHTS, total
from footfall.simulate.plan import PHYSICS_STEP, Plan
from footfall.simulate.walker.steering import StrayError
from footfall.simulate.walker.walkers import CONTROL_INTERVAL, N_ACTION, Walkers

_STAND_S = 1.0  # before the first step along a route
_OPTIONS = ("scenario", "subject")


class WalkEnv(gym.Env[np.ndarray, np.ndarray]):
    """One walker that follows commands of speed and turn rate without falling.

    The commands are random (stops, starts and slopes included) or, with a scenario, those that steer it along
    that scenario's path over its terrain, after a stand of a second.

    Observation: Box(-6, 6, (88,), float32), mirrored so that the stance leg is always the right one: height,
    gravity in the pelvis, velocities, joint angles and rates, foot pressure, step phase, commands, residual,
    grade, gait variability, gate of standing (`simulate.walker.observation.LAYOUT`). Action: Box(-1, 1,
    (17,), float32), residual on the joint servos' targets, held for 30 ms. Reward: `simulate.learn.reward`. A
    fall terminates the episode, and so does leaving the path by 1.5 m; the end of the path truncates it, and
    so does gymnasium's time limit: 10 s unless `max_episode_steps` says otherwise (see docs/environment.md).

    Parameters
    ----------
    scenario : what an episode is about when `reset` is not told: None, random commands; a `Plan`; or a
        scenario's name or file
    subject : who walks when `reset` is not told: a stock name, "drawn" (another person in each episode), a
        `Subject`; None is the scenario's own or, with random commands, the reference body with habits drawn
    difficulty : of the random commands
    feedback_gains : (32,) balance feedback under the action; those of the shipped policy when None
    width, height : of pictures, pixels
    plan_of : makes a plan of a scenario's name or file

    Raises
    ------
    InputError
        An unknown render mode.
    """

    metadata = {  # noqa: RUF012 - gymnasium's declaration
        "render_modes": ["human", "rgb_array"],
        "render_fps": round(1 / CONTROL_INTERVAL),
    }

    def __init__(
        self,
        scenario: Any = None,
        subject: str | Subject | None = None,
        difficulty: Difficulty | None = None,
        feedback_gains: np.ndarray | None = None,
        render_mode: str | None = None,
        width: int = 480,
        height: int = 400,
        plan_of: Callable[[str], Plan] | None = None,
    ) -> None:
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            raise InputError(f"render_mode = {render_mode!r}: expected None, 'human' or 'rgb_array'")
        self.render_mode, self._size = render_mode, (width, height)
        self.observation_space, self.action_space = OBSERVATION_SPACE, ACTION_SPACE
        self._defaults = {"scenario": scenario, "subject": subject}
        self._difficulty = difficulty or Difficulty(kick=0.0)
        self._gains = balance_gains(feedback_gains)
        self._plan_of, self._plans = plan_of, dict[str, Plan]()
        self._course: _Commands | _Path | None = None
        self._stage: Stage | None = None
        self._canvas: Painter | Window | None = None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Start anew: with random commands in mid-gait or standing, on a scenario's path standing.

        Parameters
        ----------
        options : "scenario" and "subject", each as in the class; what is left out is as the class was told

        Raises
        ------
        InputError
            An unknown option, scenario or subject.
        """
        super().reset(seed=seed)
        options = options or {}
        for key in options:
            if key not in _OPTIONS:
                raise InputError(f"option {key!r} is unknown, expected {' or '.join(map(repr, _OPTIONS))}")
        asked = self._defaults | options
        subject, plan = self._subject(asked["subject"]), self._plan(asked["scenario"])
        if plan is None:
            self._begin_commands(subject)
        else:
            seed_of_walk = int(self.np_random.integers(2**31))
            self._begin_path(replace(plan, subject=subject or plan.subject, seed=seed_of_walk))
        assert self._course is not None
        self._show(restart=True)
        terms = dict.fromkeys(WEIGHTS, np.zeros(1))
        return self._course.walkers.observe()[0], self._info(terms)

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Walk for 30 ms.

        Raises
        ------
        InputError
            The action is not 17 finite numbers.
        """
        course = self._course
        if course is None:
            raise InputError("step: the environment wants a reset first")
        action = np.asarray(action, dtype=float)
        if action.shape != (N_ACTION,) or not np.isfinite(action).all():
            raise InputError(f"action: expected {N_ACTION} finite numbers")
        terms = course.step(action[None])
        self._show()
        ended = bool(course.walkers.fallen()[0]) or course.strayed
        reward = float(total(terms)[0])
        return course.walkers.observe()[0], reward, ended, course.arrived and not ended, self._info(terms)

    def render(self) -> np.ndarray | None:
        """A picture, (height, width, 3) uint8; None where a window shows it, or nothing was asked for.

        Raises
        ------
        InputError
            There is nothing to draw with.
        """
        if self.render_mode != "rgb_array" or self._stage is None:
            return None
        if self._canvas is None:
            self._canvas = Painter(self._stage, *self._size)
        assert isinstance(self._canvas, Painter)
        return self._canvas.paint(QUARTER_VIEW)

    def close(self) -> None:
        """Free the physics and whatever draws."""
        self._leave()

    def _subject(self, asked: Any) -> Subject | None:
        if asked is None or isinstance(asked, Subject):
            return asked
        if asked == "drawn":
            return draw_subject(self.np_random)
        if not isinstance(asked, str) or asked not in SUBJECTS:
            raise InputError(
                f"option subject = {asked!r}: expected {', '.join(map(repr, SUBJECTS))}, 'drawn' or a Subject"
            )
        return SUBJECTS[asked]

    def _plan(self, asked: Any) -> Plan | None:
        if asked is None or isinstance(asked, Plan):
            return asked
        if self._plan_of is None or not isinstance(asked, str | os.PathLike):
            names = "" if self._plan_of is None else ", or a scenario's name or file"
            raise InputError(f"option scenario = {asked!r}: expected None or a Plan{names}")
        name = os.fspath(asked)
        if name not in self._plans:
            self._plans[name] = self._plan_of(name)
        return self._plans[name]

    def _begin_commands(self, subject: Subject | None) -> None:
        if not isinstance(self._course, _Commands) or self._course.subject != subject:
            self._leave()
            self._course = _Commands(subject, self._difficulty, self._gains)
        self._course.begin(self.np_random)

    def _begin_path(self, plan: Plan) -> None:
        self._leave()
        self._course = _Path(plan, self._gains)

    def _leave(self) -> None:
        """Give up the present walker and its pictures."""
        if self._canvas is not None:
            self._canvas.close()
        if self._course is not None:
            self._course.walkers.close()
        self._course = self._stage = self._canvas = None

    def _show(self, restart: bool = False) -> None:
        """Keep the picture up to date."""
        course = self._course
        if self.render_mode is None or course is None:
            return
        if self._stage is None:
            self._stage = Stage(course.walkers, course.build, course.episode)
        elif restart:
            self._stage.restart()
        if self.render_mode == "rgb_array":
            self._stage.update()
            return
        if self._canvas is None:
            self._canvas = Window(self._stage)
        assert isinstance(self._canvas, Window)
        self._canvas.show()

    def _info(self, terms: dict[str, np.ndarray]) -> dict[str, Any]:
        """Where the walker is and what it is told, in the subject's units; terms of the reward."""
        course = self._course
        assert course is not None
        walkers, scale = course.walkers, course.scale
        return {
            "position": walkers.qpos[0, :3] * scale,
            "yaw": float(walkers.yaw[0]),
            "speed_command": float(walkers.speed[0] * np.sqrt(scale)),
            "turn_command": float(walkers.turn[0] / np.sqrt(scale)),
            "progress": course.progress,
            "arrived": course.arrived,
            "strayed": course.strayed,
            "terms": {name: float(value[0]) for name, value in terms.items()},
        }


class _Commands:
    """Random commands on ground that slopes at random (gravity is tilted)."""

    arrived, strayed, progress, episode = False, False, 0.0, None

    def __init__(self, subject: Subject | None, difficulty: Difficulty, gains: np.ndarray) -> None:
        self.subject = subject
        self.scale = 1.0 if subject is None else subject.scale
        self.build = Build() if subject is None else subject.build
        self._commanded = CommandedWalkers(
            [self.build],
            difficulty,
            gains,
            timesteps=np.array([PHYSICS_STEP / np.sqrt(self.scale)]),
            rng=np.random.default_rng(0),
            habits=None if subject is None else subject.habits,
        )
        self.walkers: Walkers = self._commanded.walkers

    def begin(self, rng: np.random.Generator) -> None:
        """Start an episode."""
        self._commanded.seed(rng)
        self._commanded.reset(np.ones(1, dtype=bool))

    def step(self, action: np.ndarray) -> dict[str, np.ndarray]:
        """One control step; terms of its reward."""
        self._commanded.step(action)
        return self._commanded.terms


class _Path:
    """A plan's route on its ground."""

    def __init__(self, plan: Plan, gains: np.ndarray) -> None:
        self.episode = Episode(plan, gains, stand=_STAND_S)
        self.walkers, self.scale = self.episode.walkers, plan.subject.scale
        self.build = plan.subject.build
        self.strayed = False

    @property
    def progress(self) -> float:
        """Along the route (m)."""
        return self.episode.progress

    @property
    def arrived(self) -> bool:
        """Has walked the route and stood at its end."""
        return self.episode.finished

    def step(self, action: np.ndarray) -> dict[str, np.ndarray]:
        """One control step; terms of its reward."""
        terms, _ = rewarded_step(self.walkers, action)
        try:
            self.episode.steer()
        except StrayError:
            self.strayed = True
        return terms
