"""Walk a route, beginning with a stand: physics, steering and the truth that comes out.

The physics moves the 1.75 m body (models.subject); what comes out is stretched to the subject.
"""

from __future__ import annotations

import platform
from collections.abc import Callable, Iterator
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
from footfall.simulate.truth import ImuTruth, at_rest, divisor, imu_truth, runs
from footfall.simulate.walk import TrueFootfalls, Walk
from footfall.simulate.walkers import N_ACTION, Trace, Walkers
from footfall.streams import stream

PHYSICS_STEP = 0.001  # s, of the subject's time
SUBSTEPS = 30  # physics steps of a control step
STAND_S = 4.0  # of standing, to come to rest, before the record begins
_RUN_OUT = 8.0  # m
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
    variability : of the gait, 1 = that of people; action_noise : SD of the noise on the policy's action
    wander, wander_time : m and s, slow lateral wander of the aim
    calibration : s motionless before the first step
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
        wander=plan.wander / s,
        wander_time=plan.wander_time / t,
    )


def _with_run_out(route: Route) -> Route:
    """The route and some straight, level ground beyond its end: people do not stop on a line."""
    step = float(route.s[1] - route.s[0])
    away = np.arange(1, round(_RUN_OUT / step) + 1) * step
    last, flat = route.heading[-1], np.zeros_like(away)
    return Route(
        s=np.concatenate([route.s, route.s[-1] + away]),
        x=np.concatenate([route.x, route.x[-1] + away * np.cos(last)]),
        y=np.concatenate([route.y, route.y[-1] + away * np.sin(last)]),
        z=np.concatenate([route.z, flat + route.z[-1]]),
        heading=np.concatenate([route.heading, flat + last]),
        curvature=np.concatenate([route.curvature, flat]),
    )


@dataclass(frozen=True)
class _Record:
    """The IMU site at every physics step, in the subject's units; contact in body weights."""

    position: np.ndarray
    quaternion: np.ndarray
    contact: np.ndarray


@dataclass(frozen=True)
class Moment:
    """The walker after a control step, in its own units: the physics of that step.

    `progress` is where along the route it is, in the subject's metres.
    """

    walkers: Walkers
    trace: Trace
    progress: float


def stroll(plan: Plan, policy: Policy) -> Iterator[Moment]:
    """Stand and walk the route, one control step at a time.

    Raises
    ------
    FallError, StrayError
        The walk did not reach its end.
    """
    subject, small = plan.subject, _shrunk(replace(plan, route=_with_run_out(plan.route)))
    route, step = small.route, PHYSICS_STEP / subject.time_scale
    model = build_body(subject.build, timestep=step, mount=plan.mount, ground=small.ground)
    walkers = Walkers(
        [model],
        policy.feedback_gains,
        rng=stream(plan.seed, "gait variability"),
        ground=None if small.ground is None else ground_lookup(small.ground),
    )
    noise, end = stream(plan.seed, "action noise"), plan.route.length / subject.scale
    pursuit = Pursuit(
        route,
        small.pace,
        (Stop(0.0, STAND_S / subject.time_scale),),
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
    waiting = STAND_S + 20
    limit = int((route.length / _SLOWEST + waiting) / (SUBSTEPS * step))
    try:
        for count in range(limit):
            standing = bool(walkers.gate.value[0] <= 0)
            speed, turn = pursuit.command(
                walkers.qpos[0, 0], walkers.qpos[0, 1], walkers.heading[0], walkers.speed[0], standing
            )
            if pursuit.progress >= end:
                return
            walkers.speed_goal[0], walkers.turn_goal[0] = speed, turn
            action = policy(walkers.observe())
            if plan.action_noise:
                action = action + plan.action_noise * noise.standard_normal((1, N_ACTION))
            trace = walkers.step(action)
            at = pursuit.progress * subject.scale
            if walkers.fallen()[0]:
                raise FallError(
                    f"{plan.name}: the walker fell at {at:.0f} m ({count * SUBSTEPS * PHYSICS_STEP:.0f} s, "
                    f"subject {subject.name}, seed {plan.seed}, pace {plan.pace:g} m/s)"
                )
            yield Moment(walkers, trace, at)
        raise FallError(f"{plan.name}: the walker got stuck at {at:.0f} m (seed {plan.seed})")
    finally:
        walkers.close()


def _physics(plan: Plan, policy: Policy, on_progress: Callable[[float], None] | None) -> _Record:
    """Walk, and keep the IMU site and the load on its foot."""
    touch = np.arange(3) + body.SENSOR_TOUCH.start + (0 if plan.mount.foot == "right" else 3)
    columns = np.r_[body.SENSOR_IMU_POSITION, body.SENSOR_IMU_QUATERNION]
    chunks, weight = [], 1.0
    for count, moment in enumerate(stroll(plan, policy)):
        sensor = moment.trace.sensor[0]
        load = sensor[:, touch].sum(axis=1, keepdims=True)
        chunks.append(np.concatenate([sensor[:, columns], load], axis=1))
        weight = float(sum(moment.walkers.models[0].body_mass)) * GRAVITY
        if on_progress is not None and count % 100 == 0:
            on_progress(moment.progress)
    record = np.concatenate(chunks)[round(STAND_S / PHYSICS_STEP) :]
    # The static bias is taken from the same unit held motionless in this pose (HDR paper, section 2): the
    # simulated stand turns by a few thousandths of a degree a second, degrees over a walk.
    still = np.repeat(record[:1], round(plan.calibration / PHYSICS_STEP), axis=0)
    record = np.concatenate([still, record])
    if not np.isfinite(record).all():
        raise FallError(f"{plan.name}: the physics is no longer finite (seed {plan.seed})")
    return _Record(record[:, :3] * plan.subject.scale, record[:, 3:7], record[:, 7] / weight)


def _truth(record: _Record, factor: int) -> tuple[ImuTruth, np.ndarray, np.ndarray]:
    """What a perfect IMU says, the load on its foot, and its stances (m, 2) as rows."""
    truth = imu_truth(record.position, record.quaternion, PHYSICS_STEP, factor)
    contact = record.contact[truth.index]
    return truth, contact, runs(at_rest(truth, contact, factor * PHYSICS_STEP))


def walk(
    plan: Plan, policy: Policy | None = None, on_progress: Callable[[float], None] | None = None
) -> Walk:
    """The truth of one walk along the plan's route: it begins with a stand and ends with a footfall.

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
    truth, contact, stances = _truth(record, factor)
    if len(stances) < 3:
        raise FallError(f"{plan.name}: the walker made {len(stances)} footfalls, expected at least 3")
    # A stance that the end of the walk cuts short is no footfall: end with the last whole one.
    whole = stances[stances[:, 1] < len(truth.index) - 1]
    end = truth.index[whole[-1, 1]] + 2 * factor
    record = _Record(record.position[:end], record.quaternion[:end], record.contact[:end])
    truth, contact, stances = _truth(record, factor)
    t = np.arange(len(truth.index)) * interval
    rest = np.zeros(len(t), dtype=bool)
    for first, last in stances:
        rest[first:last] = True
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
