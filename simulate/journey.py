"""Walk a route from standing to standing: physics, steering and the truth that comes out.

The physics moves the 1.75 m body (models.subject); what comes out is stretched to the subject.
"""

from __future__ import annotations

import platform
from collections.abc import Callable
from dataclasses import dataclass, field, replace
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
from footfall.simulate.steer import Pursuit, Stop
from footfall.simulate.truth import at_rest, divisor, imu_truth, runs
from footfall.simulate.walk import TrueFootfalls, Walk
from footfall.simulate.walkers import N_ACTION, Walkers
from footfall.streams import stream

PHYSICS_STEP = 0.001  # s, of the subject's time
SUBSTEPS = 30  # physics steps of a control step
NOSLIP_ITERATIONS = 4
END_STAND_S = 2.0
_SLOWEST = 0.35  # m/s; a walk that takes longer than this has got stuck


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
    stops : where to stand on the way, and for how long
    variability : of the gait, 1 = that of people; action_noise : SD of the noise on the policy's action
    wander, wander_time : m and s, slow lateral wander of the aim
    calibration : s of standing before the first step
    rate_hz : of the truth; divides 1 kHz
    """

    name: str
    route: Route
    subject: Subject = field(default_factory=Subject)
    mount: Mount = field(default_factory=Mount)
    ground: Ground | None = None
    pace: float = 1.3
    stops: tuple[Stop, ...] = ()
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


def _shrunk(plan: Plan) -> Plan:
    """The plan in the units of the simulated body: lengths over s, times over sqrt(s)."""
    s, t = plan.subject.scale, plan.subject.time_scale
    route, ground = plan.route, plan.ground
    small = Route(route.s / s, route.x / s, route.y / s, route.z / s, route.heading, route.curvature * s)
    if ground is not None:
        ground = Ground(ground.x0 / s, ground.y0 / s, ground.cell / s, ground.heights / s)
    return replace(
        plan,
        route=small,
        ground=ground,
        pace=plan.pace / t,
        stops=tuple(Stop(stop.distance / s, stop.duration / t) for stop in plan.stops),
        wander=plan.wander / s,
        wander_time=plan.wander_time / t,
        calibration=plan.calibration / t,
    )


@dataclass(frozen=True)
class _Record:
    """The IMU site at every physics step, in the subject's units; contact in body weights."""

    position: np.ndarray
    quaternion: np.ndarray
    contact: np.ndarray


def _physics(plan: Plan, policy: Policy, on_progress: Callable[[float], None] | None) -> _Record:
    """Stand, walk the route and stand.

    Raises
    ------
    FallError, StrayError
        The walk did not reach its end.
    """
    subject, small = plan.subject, _shrunk(plan)
    route, step = small.route, PHYSICS_STEP / subject.time_scale
    model = build_body(subject.build, timestep=step, mount=plan.mount, ground=small.ground)
    # A standing foot would creep downhill by millimetres a second without it.
    model.opt.noslip_iterations = NOSLIP_ITERATIONS
    walkers = Walkers(
        [model],
        policy.feedback_gains,
        rng=stream(plan.seed, "gait variability"),
        ground=None if small.ground is None else ground_lookup(small.ground),
    )
    noise = stream(plan.seed, "action noise")
    pursuit = Pursuit(
        route,
        small.pace,
        (Stop(0.0, small.calibration), *small.stops, Stop(route.length, END_STAND_S)),
        wander=small.wander,
        wander_time=small.wander_time,
        dt=SUBSTEPS * step,
        rng=stream(plan.seed, "path wander"),
    )
    walkers.place(
        np.ones(1, dtype=bool),
        phase=np.zeros(1),
        speed=np.zeros(1),
        heading=route.heading[:1],
        position=np.array([[route.x[0], route.y[0], route.z[0]]]),
        standing=np.ones(1, dtype=bool),
        variability=np.array([plan.variability]),
        habits=[subject.habits],
    )
    weight = float(sum(model.body_mass)) * GRAVITY
    touch = np.arange(3) + body.SENSOR_TOUCH.start + (0 if plan.mount.foot == "right" else 3)
    columns = [*range(*body.SENSOR_IMU_POSITION.indices(99)), *range(*body.SENSOR_IMU_QUATERNION.indices(99))]
    chunks = []
    waiting = small.calibration + END_STAND_S + sum(stop.duration + 10 for stop in small.stops) + 20
    limit = int((route.length / _SLOWEST + waiting) / (SUBSTEPS * step))
    try:
        for count in range(limit):
            standing = bool(walkers.gate.value[0] <= 0)
            speed, turn = pursuit.command(
                walkers.qpos[0, 0], walkers.qpos[0, 1], walkers.heading[0], walkers.speed[0], standing
            )
            if pursuit.finished:
                break
            walkers.speed_goal[0], walkers.turn_goal[0] = speed, turn
            action = policy(walkers.observe())
            if plan.action_noise:
                action = action + plan.action_noise * noise.standard_normal((1, N_ACTION))
            sensor = walkers.step(action).sensor[0]
            chunks.append(
                np.concatenate([sensor[:, columns], sensor[:, touch].sum(axis=1, keepdims=True)], axis=1)
            )
            if walkers.fallen()[0]:
                at, when = pursuit.progress * subject.scale, count * SUBSTEPS * PHYSICS_STEP
                raise FallError(
                    f"{plan.name}: the walker fell at {at:.0f} m ({when:.0f} s, subject {subject.name}, "
                    f"seed {plan.seed}, pace {plan.pace:g} m/s)"
                )
            if on_progress is not None and count % 100 == 0:
                on_progress(pursuit.progress * subject.scale)
        else:
            at = pursuit.progress * subject.scale
            raise FallError(f"{plan.name}: the walker got stuck at {at:.0f} m (seed {plan.seed})")
    finally:
        walkers.close()
    record = np.concatenate(chunks)
    if not np.isfinite(record).all():
        raise FallError(f"{plan.name}: the physics is no longer finite (seed {plan.seed})")
    return _Record(record[:, :3] * subject.scale, record[:, 3:7], record[:, 7] / weight)


def walk(
    plan: Plan, policy: Policy | None = None, on_progress: Callable[[float], None] | None = None
) -> Walk:
    """The truth of one walk along the plan's route, from standing to standing.

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
    truth = imu_truth(record.position, record.quaternion, PHYSICS_STEP, factor)
    t = np.arange(len(truth.index)) * interval
    contact = record.contact[truth.index]
    rest = at_rest(truth, contact, interval)
    stances = runs(rest)
    if len(stances) < 3:
        raise FallError(f"{plan.name}: the walker made {len(stances)} footfalls, expected at least 3")
    rows = stances.mean(axis=1).astype(int)
    # The first stance is the stand before the walk: its footfall is the end of the calibration.
    rows[0] = min(int(plan.calibration / interval), stances[0, 1] - 1)
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
