"""People in a stand, on level ground or a slope, and how they walk on."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from footfall.conventions import GRAVITY
from footfall.models.body import N_SERVOS, SENSOR_TOUCH, SERVO_JOINT, SERVOS, build_body
from footfall.models.policy import stock_policy
from footfall.models.subject import Subject
from footfall.simulate.walker._gait_kernels import REFERENCE
from footfall.simulate.walker.state import WALKER, Columns
from footfall.simulate.walker.walkers import Walkers

STEP = 0.0025  # s of physics
LEVEL = (0.0, 0.0)


@dataclass(frozen=True)
class Person:
    """Somebody on a slope (rise forwards and to the left) whose right foot steps first, or the left one."""

    subject: Subject = field(default_factory=Subject)
    grade: tuple[float, float] = LEVEL
    right_first: bool = False


def stand(people: list[Person], variability: float = 1.0) -> Walkers:
    """Everybody in a stand, on contact that never creeps (in a walk it may while the body is in mid-gait)."""
    n = len(people)
    models = [build_body(person.subject.build, timestep=STEP) for person in people]
    group = Walkers(models, stock_policy().feedback_gains, rng=np.random.default_rng(3))
    group.up[:] = [(forwards, left, 1.0) for forwards, left in (person.grade for person in people)]
    group.up[:] /= np.linalg.norm(group.up, axis=1)[:, None]
    for model, up in zip(models, group.up, strict=True):
        model.opt.gravity[:] = -GRAVITY * up
        model.opt.noslip_iterations = 4
    group.place(
        np.ones(n, dtype=bool),
        phase=np.array([0.5 * person.right_first for person in people]),
        speed=np.zeros(n),
        heading=np.zeros(n),
        position=np.zeros((n, 3)),
        standing=np.ones(n, dtype=bool),
        variability=np.full(n, variability),
        habits=[person.subject.habits for person in people],
    )
    return group


def walk_on(group: Walkers, seconds: float) -> tuple[np.ndarray, np.ndarray]:
    """Poses (n, k, 26) and loads of the right and the left foot (n, k, 2) in body weights."""
    policy, poses, touches = stock_policy(), [], []
    for _ in range(round(seconds / 0.03)):
        trace = group.step(policy(group.observe()))
        assert not group.fallen().any()
        poses.append(trace.qpos)
        touches.append(trace.sensor[:, :, SENSOR_TOUCH])
    touch = np.concatenate(touches, axis=1)
    weight = np.array([GRAVITY * model.body_mass.sum() for model in group.models])
    return np.concatenate(poses, axis=1), touch.reshape(*touch.shape[:2], 2, 3).sum(axis=3) / weight[
        :, None, None
    ]


def held_state(rng: np.random.Generator, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Walkers of 700 N in any pose and motion on any slope, and the loads of their feet (n, 2) N."""
    state = np.zeros(n, WALKER)
    state["weight"], state["phase"] = 700.0, rng.random(n)
    state["grade_forward"], state["grade_left"] = rng.normal(0, 0.05, (2, n))
    state["left_stance"] = rng.random(n) < 0.5
    state["qpos"], state["dt"] = rng.normal(0, 0.2, state["qpos"].shape), 0.03
    state["qvel"] = rng.normal(0, 2.0, state["qvel"].shape)
    touch = rng.uniform(0, 100, (n, 6))
    state["sensor"][:, SENSOR_TOUCH] = touch
    return state, touch.reshape(n, 2, 3).sum(axis=2)


def assert_held(
    hold: Callable[..., None], rng: np.random.Generator, state: np.ndarray, bounds: list[tuple[Any, ...]]
) -> None:
    """A law keeps torques within lever arms times the load, 140 N at least, and touches no other target.

    The torques are those at the ends of three physics steps of joints that keep their rates.

    `bounds`: of each a servo, whose (n,) it is held, and the arms (m) below and above.
    """
    wanted = rng.normal(0, 0.4, (len(state), 3, N_SERVOS))
    found = wanted.copy()
    hold(Columns(state), REFERENCE.view(np.recarray)[0], np.moveaxis(found, 0, -1))
    rate = state["qvel"][:, None, 6 + SERVO_JOINT]
    angle = state["qpos"][:, None, 7 + SERVO_JOINT] + rate * 0.03 * np.array([[1], [2], [3]]) / 3
    torque, asked = (REFERENCE["kp"] * (one - angle) - REFERENCE["kv"] * rate for one in (found, wanted))
    load = state["sensor"][:, SENSOR_TOUCH].reshape(-1, 2, 3).sum(axis=2)
    free = np.ones(found.shape, dtype=bool)
    for name, who, low, high in bounds:
        servo, foot = list(SERVOS).index(name), int(name.endswith("_l"))
        force = np.maximum(load[:, foot], 140)[who, None]
        least, most = (np.broadcast_to(arm, len(state))[who, None] * force for arm in (low, high))
        bounded = np.clip(asked[who][:, :, servo], least, most)
        np.testing.assert_allclose(torque[who][:, :, servo], bounded, rtol=0, atol=1e-9)
        free[who, :, servo] = False
    np.testing.assert_array_equal(found[free], wanted[free])
