"""Courses on which trained walkers are chosen, and others on which the chosen one is judged, by falls."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from footfall.conventions import GRAVITY
from footfall.models.body import build_body
from footfall.models.policy import Policy
from footfall.models.route import Route
from footfall.models.subject import Subject, draw_subject
from footfall.simulate.plan import Stop
from footfall.simulate.walker.steering import Pursuit, StrayError
from footfall.simulate.walker.walkers import CONTROL_INTERVAL, Walkers, grip

_SPACING = 0.05  # m, of the routes' samples
_PHYSICS_STEP = 0.0025  # s
CHOICE_SEED, JUDGEMENT_SEED = 11, 12  # of the people on the courses


@dataclass(frozen=True)
class Course:
    """A route walked over and over.

    Attributes
    ----------
    name : what it tries
    parts : (length in m, turn in degrees) one after the other; a length of 0 turns on the spot
    pace : m/s
    grade : rise over run, uphill and to the left of the first heading
    stops : m along the route where the walker stands for 4 s
    """

    name: str
    parts: tuple[tuple[float, float], ...]
    pace: float = 1.3
    grade: tuple[float, float] = (0.0, 0.0)
    stops: tuple[float, ...] = ()


CHOICE = (
    Course("straight, slow", ((80, 0),), pace=0.8),
    Course("straight, brisk", ((120, 0),), pace=1.65),
    Course("block, radius 2.5 m", ((15, 0), (3.93, 90)) * 5),
    Course("block, corners on the spot", ((12, 0), (0, 90)) * 6, pace=1.2),
    Course("there and back, radius 1.5 m", ((12, 0), (4.71, 180), (12, 0), (4.71, -180)) * 2),
    Course("stop and go", ((100, 0),), stops=(10, 22, 35, 45, 60)),
    Course("stop and go, slow", ((60, 0),), pace=0.9, stops=(8, 16, 26, 36, 46)),
    Course("uphill", ((100, 0),), grade=(0.08, 0.0), stops=(30,)),
    Course("downhill", ((100, 0),), grade=(-0.08, 0.0), stops=(30,)),
    Course("across a slope", ((40, 0), (31.4, 90), (20, 0)), grade=(0.0, 0.08)),
)
JUDGEMENT = (
    Course("straight", ((100, 0),)),
    Course("bends", ((10, 60), (10, -90), (15, 45)) * 3, pace=1.45),
    Course("block, radius 1.5 m", ((11, 0), (2.36, -90)) * 6),
    Course("zigzag on the spot", ((9, 0), (0, 60), (9, 0), (0, -60)) * 3, pace=1.1),
    Course("stop and go, brisk", ((100, 0),), pace=1.5, stops=(12, 27, 40, 55)),
    Course("stops at corners", ((14, 0), (2.36, 90)) * 5, stops=(13, 29, 45)),
    Course("uphill, aslant", ((100, 0),), pace=1.1, grade=(0.06, 0.05), stops=(20,)),
    Course("downhill, aslant", ((100, 0),), pace=1.4, grade=(-0.06, -0.05), stops=(40,)),
)


def course_route(course: Course) -> Route:
    """The course's centre line."""
    heading, curvature, now = [0.0], [0.0], 0.0
    for length, turn_deg in course.parts:
        turn, count = np.radians(turn_deg), max(1, round(length / _SPACING))
        heading += list(now + turn * np.arange(1, count + 1) / count)
        curvature += [turn / length if length else 0.0] * count
        now += turn
    psi = np.array(heading)
    step = _SPACING * np.stack([np.cos(psi), np.sin(psi)])
    x, y = np.concatenate([np.zeros((2, 1)), np.cumsum(step, axis=1)[:, :-1]], axis=1)
    return Route(np.arange(len(psi)) * _SPACING, x, y, np.zeros(len(psi)), psi, np.array(curvature))


@dataclass(frozen=True)
class Verdict:
    """Falls (and strayings) of each course's walkers, and the minutes that they walked."""

    falls: dict[str, int]
    minutes: float

    @property
    def falls_per_hour(self) -> float:
        """Over all courses."""
        return 60 * sum(self.falls.values()) / self.minutes


def attempt(
    policy: Policy,
    courses: tuple[Course, ...],
    *,
    seed: int,
    people: int = 6,
    seconds: float = 60.0,
    threads: int = 2,
) -> Verdict:
    """Let `people` drawn subjects walk each course for so long; after a fall they begin it again.

    Parameters
    ----------
    seed : of the subjects and of their gait's variability
    """
    rng = np.random.default_rng([seed, 0])
    todo = [course for course in courses for _ in range(people)]
    n = len(todo)
    subjects: list[Subject] = [draw_subject(rng) for _ in todo]
    models = [build_body(subject.build, timestep=_PHYSICS_STEP) for subject in subjects]
    walkers = Walkers(models, policy.feedback_gains, rng=np.random.default_rng([seed, 1]), threads=threads)
    grade = np.array([[*course.grade] for course in todo])
    # Sloping ground is level ground under tilted gravity.
    up = np.concatenate([grade, np.ones((n, 1))], axis=1)
    up /= np.linalg.norm(up, axis=1)[:, None]
    walkers.up[:] = up
    for model, direction in zip(models, up, strict=True):
        model.opt.gravity[:] = -GRAVITY * direction
    routes = [course_route(course) for course in todo]
    pursuits: list[Pursuit] = [None] * n  # type: ignore[list-item]
    falls = {course.name: 0 for course in courses}

    def begin(mask: np.ndarray) -> None:
        m = int(mask.sum())
        walkers.place(
            mask,
            phase=np.zeros(m),
            speed=np.zeros(m),
            heading=np.zeros(m),
            position=np.zeros((m, 3)),
            standing=np.ones(m, dtype=bool),
            variability=np.ones(m),
            habits=[subjects[i].habits for i in np.flatnonzero(mask)],
        )
        for i in np.flatnonzero(mask):
            stops = (Stop(0.0, 1.0), *(Stop(at, 4.0) for at in todo[i].stops))
            pursuits[i] = Pursuit(
                routes[i], todo[i].pace, stops, wander=0.0, wander_time=4.0, dt=CONTROL_INTERVAL, rng=rng
            )

    begin(np.ones(n, dtype=bool))
    steps = round(seconds / CONTROL_INTERVAL)
    for _ in range(steps):
        over = np.zeros(n, dtype=bool)
        for i, pursuit in enumerate(pursuits):
            x, y = walkers.qpos[i, :2]
            standing = bool(walkers.gate.value[i] <= 0)
            try:
                speed, turn = pursuit.command(x, y, walkers.heading[i], walkers.speed[i], standing)
            except StrayError:
                over[i] = True
                continue
            walkers.speed_goal[i], walkers.turn_goal[i] = speed, turn
        grip(walkers)
        walkers.step(policy(walkers.observe()))
        over |= walkers.fallen()
        for i in np.flatnonzero(over).tolist():
            falls[todo[i].name] += 1
        arrived = np.array([pursuit.progress >= routes[i].length - 0.5 for i, pursuit in enumerate(pursuits)])
        if (over | arrived).any():
            begin(over | arrived)
    walkers.close()
    return Verdict(falls, n * steps * CONTROL_INTERVAL / 60)
