"""Walk a route: physics, steering and the truth that comes out."""

from __future__ import annotations

import platform
from collections.abc import Callable
from dataclasses import dataclass, field
from importlib.metadata import version

import mujoco
import numpy as np

import footfall
from footfall.conventions import GRAVITY, heading_of
from footfall.errors import InputError
from footfall.models import body
from footfall.models.body import Ground, Mount, build_body
from footfall.models.policy import Policy, stock_policy
from footfall.models.subject import Subject
from footfall.simulate.ground import ground_lookup
from footfall.simulate.route import Route
from footfall.simulate.steer import Pursuit
from footfall.simulate.truth import at_rest, divisor, imu_truth, runs
from footfall.simulate.walk import TrueFootfalls, Walk
from footfall.simulate.walkers import CONTROL_INTERVAL, N_ACTION, Walkers
from footfall.streams import stream

PHYSICS_STEP = 0.001  # s
RUN_UP = 5.0  # m of straight ground before the route, to fall into step, and after it
_START_PHASE = 0.25
_SLOWEST = 0.5  # m/s; a walk that takes longer than this has got stuck


class FallError(InputError):
    """The walker fell."""


@dataclass(frozen=True)
class Plan:
    """Everything that determines a walk.

    Attributes
    ----------
    name : of the scenario, for messages and provenance
    route : where to walk; ground : level when None
    pace : m/s commanded on straights
    variability : of the gait, 1 = that of people; action_noise : SD of the noise on the policy's action
    wander, wander_time : m and s, slow lateral wander of the aim
    calibration : s of motionless recording before the first footfall
    rate_hz : of the truth; divides 1 kHz
    """

    name: str
    route: Route
    subject: Subject = field(default_factory=Subject)
    mount: Mount = field(default_factory=Mount)
    ground: Ground | None = None
    pace: float = 1.3
    variability: float = 1.0
    action_noise: float = 0.0
    wander: float = 0.0
    wander_time: float = 4.0
    calibration: float = 30.0
    rate_hz: float = 200.0
    seed: int = 1


def versions() -> dict[str, str]:
    """What a walk depends on besides its plan."""
    return {
        "footfall": footfall.__version__,
        "mujoco": mujoco.__version__,
        "numpy": np.__version__,
        "scipy": version("scipy"),
        "python": platform.python_version(),
    }


def _extended(route: Route) -> Route:
    """The route with straight, level run-up and run-out."""
    step = float(route.s[1] - route.s[0])
    away = np.arange(1, round(RUN_UP / step) + 1) * step

    def ends(before: np.ndarray, values: np.ndarray, after: np.ndarray) -> np.ndarray:
        return np.concatenate([before[::-1], values, after])

    first, last = route.heading[0], route.heading[-1]
    flat = np.zeros_like(away)
    return Route(
        s=ends(route.s[0] - away, route.s, route.s[-1] + away),
        x=ends(route.x[0] - away * np.cos(first), route.x, route.x[-1] + away * np.cos(last)),
        y=ends(route.y[0] - away * np.sin(first), route.y, route.y[-1] + away * np.sin(last)),
        z=ends(flat + route.z[0], route.z, flat + route.z[-1]),
        heading=ends(flat + first, route.heading, flat + last),
        curvature=ends(flat, route.curvature, flat),
    )


@dataclass(frozen=True)
class _Record:
    """The IMU site at every physics step, before that step."""

    position: np.ndarray
    quaternion: np.ndarray
    contact: np.ndarray


def _physics(plan: Plan, policy: Policy, on_progress: Callable[[float], None] | None) -> _Record:
    """Walk from the run-up to the end of the run-out.

    Raises
    ------
    FallError, StrayError
        The walk did not reach its end.
    """
    route = _extended(plan.route)
    model = build_body(plan.subject, timestep=PHYSICS_STEP, mount=plan.mount, ground=plan.ground)
    lookup = None if plan.ground is None else ground_lookup(plan.ground)
    walkers = Walkers(
        [model],
        [plan.subject],
        policy.feedback_gains,
        variability=np.array([plan.variability]),
        rng=stream(plan.seed, "gait variability"),
        ground=lookup,
    )
    noise = stream(plan.seed, "action noise")
    pursuit = Pursuit(route, plan.pace, plan.wander, plan.wander_time, stream(plan.seed, "path wander"))
    start = np.array([[route.x[0], route.y[0], route.z[0]]])
    walkers.place(
        np.ones(1, dtype=bool),
        phase=np.array([_START_PHASE]),
        speed=np.array([min(plan.pace, 1.25)]),
        heading=np.array([route.heading[0]]),
        position=start,
    )
    weight = float(sum(model.body_mass)) * GRAVITY
    touch = np.arange(3) + body.SENSOR_TOUCH.start + (0 if plan.mount.foot == "right" else 3)
    chunks = []
    limit = int((route.length - route.s[0]) / _SLOWEST / CONTROL_INTERVAL)
    try:
        for step in range(limit):
            speed, turn = pursuit.command(walkers.qpos[0, 0], walkers.qpos[0, 1], walkers.heading[0])
            if pursuit.finished:
                break
            walkers.speed_goal[0], walkers.turn_goal[0] = speed, turn
            action = policy(walkers.observe())
            if plan.action_noise:
                action = action + plan.action_noise * noise.standard_normal((1, N_ACTION))
            trace = walkers.step(action)
            sensor = trace.sensor[0]
            chunks.append(
                np.concatenate(
                    [
                        sensor[:, body.SENSOR_IMU_POSITION],
                        sensor[:, body.SENSOR_IMU_QUATERNION],
                        sensor[:, touch].sum(axis=1, keepdims=True) / weight,
                    ],
                    axis=1,
                )
            )
            if walkers.fallen()[0]:
                raise FallError(
                    f"{plan.name}: the walker fell at {pursuit.progress:.0f} m "
                    f"({step * CONTROL_INTERVAL:.0f} s, seed {plan.seed}, pace {plan.pace:g} m/s)"
                )
            if on_progress is not None and step % 100 == 0:
                on_progress(max(0.0, pursuit.progress))
        else:
            raise FallError(
                f"{plan.name}: the walker got stuck at {pursuit.progress:.0f} m (seed {plan.seed})"
            )
    finally:
        walkers.close()
    record = np.concatenate(chunks)
    if not np.isfinite(record).all():
        raise FallError(f"{plan.name}: the physics is no longer finite (seed {plan.seed})")
    return _Record(record[:, :3], record[:, 3:7], record[:, 7])


def _hold(record: _Record, first: int, last: int, duration: float) -> _Record:
    """The record from row `first` to `last`, after `duration` seconds motionless in its first pose."""
    still = round(duration / PHYSICS_STEP)

    def held(values: np.ndarray) -> np.ndarray:
        return np.concatenate([np.repeat(values[first : first + 1], still, axis=0), values[first : last + 1]])

    return _Record(held(record.position), held(record.quaternion), held(record.contact))


def walk(
    plan: Plan, policy: Policy | None = None, on_progress: Callable[[float], None] | None = None
) -> Walk:
    """The truth of one walk along the plan's route.

    The walk begins at the first footfall on the route (after a run-up that is not part of it), preceded by
    `plan.calibration` seconds motionless in that pose, and ends with the last footfall on the route.

    Parameters
    ----------
    on_progress : called now and then with the distance walked (m)

    Raises
    ------
    InputError
        `rate_hz` does not divide the physics rate.
    FallError, StrayError
        The walker did not reach the end: there is no walk.
    """
    factor = divisor(PHYSICS_STEP, plan.rate_hz)
    policy = policy or stock_policy()
    interval = factor * PHYSICS_STEP
    record = _physics(plan, policy, on_progress)

    # Stances at the physics rate say where the walk begins and ends.
    fine = imu_truth(record.position, record.quaternion, PHYSICS_STEP, 1)
    stances = runs(at_rest(fine, record.contact[fine.index], PHYSICS_STEP))
    middle = fine.index[stances.mean(axis=1).astype(int)]
    on_route = _on_route(record.position[middle], plan.route)
    if on_route.sum() < 3:
        raise FallError(f"{plan.name}: the walker made {on_route.sum()} footfalls, expected at least 3")
    first, final = np.flatnonzero(on_route)[[0, -1]]
    end = min(fine.index[stances[final, 1] - 1] + 2 * factor, len(record.position) - 1)
    record = _hold(record, int(middle[first]), int(end), plan.calibration)

    truth = imu_truth(record.position, record.quaternion, PHYSICS_STEP, factor)
    t = np.arange(len(truth.index)) * interval
    contact = record.contact[truth.index]
    rest = at_rest(truth, contact, interval)
    stances = runs(rest)
    # The first stance is the motionless start; its footfall is the instant at which walking begins.
    rows = stances.mean(axis=1).astype(int)
    rows[0] = int(plan.calibration / interval)
    # The record ends at the last stance: a shred of a later one is no footfall.
    return Walk(
        t=t,
        position=truth.position,
        quaternion=truth.quaternion,
        velocity=truth.velocity,
        gyro=truth.gyro,
        accel=truth.accel,
        contact=contact,
        stance=rest,
        footfalls=TrueFootfalls(t[rows], truth.position[rows], heading_of(truth.quaternion[rows])),
        meta={
            "scenario": plan.name,
            "subject": plan.subject.name,
            "seed": plan.seed,
            "pace": plan.pace,
            "rate_hz": plan.rate_hz,
            "calibration_s": plan.calibration,
            "policy": policy.digest,
            "versions": versions(),
        },
    )


def _on_route(position: np.ndarray, route: Route) -> np.ndarray:
    """(m,) bool: rows of (m, 3) beyond the start line and before the end line of the route.

    The lines are judged only near the two ends: elsewhere the route may well cross them.
    """
    out = np.ones(len(position), dtype=bool)
    half = len(position) // 2
    for rows, at, sign in ((slice(0, half), 0, 1.0), (slice(half, None), -1, -1.0)):
        direction = np.array([np.cos(route.heading[at]), np.sin(route.heading[at])])
        offset = position[rows, :2] - [route.x[at], route.y[at]]
        near = np.linalg.norm(offset, axis=1) < RUN_UP + 2
        out[rows] = ~near | (sign * offset @ direction >= 0)
    return out
