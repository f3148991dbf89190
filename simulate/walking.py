"""Walk a route from standing to standing: physics, steering and the truth that comes out.

The physics moves the 1.75 m body (models.subject); what comes out is stretched to the subject.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from footfall.conventions import GRAVITY, heading_of
from footfall.errors import InputError
from footfall.models import body
from footfall.models.body import build_body
from footfall.models.ground import ground_lookup
from footfall.models.policy import Policy, stock_policy
from footfall.simulate.identity import walk_identity
from footfall.simulate.plan import PHYSICS_STEP, Plan, Stop, shrunk, versions
from footfall.simulate.truth import ImuTruth, at_rest, divisor, imu_truth, runs
from footfall.simulate.walk import TrueFootfalls, Walk
from footfall.simulate.walker.disturbance import Push, Pusher, pushes
from footfall.simulate.walker.steering import Pursuit, StrayError, pace_along
from footfall.simulate.walker.walkers import N_ACTION, Trace, Walkers
from footfall.streams import stream

SUBSTEPS = 30  # physics steps of a control step
STAND_S = 16.0  # s of standing, to come to rest, before the record begins
END_STAND_S = 5.0  # s of standing at the end
# A standing foot would creep by tenths of a millimetre a second, on a slope by millimetres, and under the
# torques of the first step it would turn by some degrees.
_NOSLIP_ITERATIONS = 4
_SLOWEST = 0.35  # m/s; a walk that takes longer than this, or to a stop longer than _SETTLING (s), is stuck
_SETTLING = 20.0


class FallError(InputError):
    """The walker fell."""


@dataclass(frozen=True)
class _Record:
    """The IMU site at every physics step, in the subject's units; contact in body weights.

    `stands`: the walk ends standing, as it should, and not in mid-gait.
    """

    position: np.ndarray
    quaternion: np.ndarray
    contact: np.ndarray
    stands: bool


@dataclass(frozen=True)
class Moment:
    """The walker after a control step, in its own units: the physics of that step.

    `progress` is where along the route it is, in the subject's metres.
    """

    walkers: Walkers
    trace: Trace
    progress: float
    outing: Outing


class Outing:
    """A plan on its way: one steered walker, which stands, walks the route and stands.

    Take a control step with `walkers.step`, then `steer`, until it has `finished`.

    Parameters
    ----------
    gains : (32,) of the balance feedback
    stand : s before the first step

    Attributes
    ----------
    plan : in the units of the walker; walkers : of one, in the same
    limit : control steps within which anything but a walker that is stuck has finished
    """

    def __init__(self, plan: Plan, gains: np.ndarray, *, stand: float) -> None:
        subject, gait, small = plan.subject, plan.gait, shrunk(plan)
        route, step = small.route, PHYSICS_STEP / subject.time_scale
        sloping = small.ground is not None
        model = build_body(subject.build, timestep=step, mount=plan.mount, sloping=sloping)
        self.plan, self._scale = small, subject.scale
        self.walkers = Walkers(
            [model],
            gains,
            rng=stream(plan.seed, "gait variability"),
            ground=None if small.ground is None else ground_lookup(small.ground),
            substeps=SUBSTEPS,
        )
        first = Stop(0.0, stand / subject.time_scale)
        last = Stop(route.length, END_STAND_S / subject.time_scale)
        self._pursuit = Pursuit(
            route,
            pace_along(route, small.gait.pace_m_s, small.paces),
            (first, *small.stops, last),
            wander=small.gait.wander_m,
            wander_time=small.gait.wander_time_s,
            dt=SUBSTEPS * step,
            rng=stream(plan.seed, "path wander"),
        )
        self.walkers.place(
            np.ones(1, dtype=bool),
            phase=np.array([0.5 * stream(plan.seed, "first step").integers(2)]),
            speed=np.zeros(1),
            heading=route.heading[:1],
            position=np.array([[route.x[0], route.y[0], route.z[0]]]),
            standing=np.ones(1, dtype=bool),
            variability=gait.variability
            * np.array([[gait.placement_variability, gait.cadence_variability, gait.toe_out_variability]]),
            habits=[subject.habits],
        )
        waiting = first.for_s + last.for_s + sum(stop.for_s + _SETTLING for stop in small.stops) + 20
        self.limit = int((route.length / _SLOWEST + waiting) / (SUBSTEPS * step))
        self.steer()

    @property
    def progress(self) -> float:
        """Distance along the route, in the subject's metres."""
        return self._pursuit.progress * self._scale

    @property
    def finished(self) -> bool:
        """The last stop has been stood through."""
        return self._pursuit.finished

    @property
    def ending(self) -> bool:
        """The path has been walked: only to stop is left."""
        return self._pursuit.ending

    def steer(self) -> None:
        """Command speed and turn for the next control step.

        Raises
        ------
        StrayError
            The walker has left its route.
        """
        walkers = self.walkers
        x, y = walkers.qpos[0, :2]
        standing = bool(walkers.gate.value[0] <= 0)
        steady = bool(walkers.steady[0])
        walkers.models[0].opt.noslip_iterations = _NOSLIP_ITERATIONS if steady else 0
        speed, turn = self._pursuit.command(x, y, walkers.heading[0], walkers.speed[0], standing)
        walkers.speed_goal[0], walkers.turn_goal[0] = speed, turn


def stroll(plan: Plan, policy: Policy, *, stand: float | None = None) -> Iterator[Moment]:
    """Stand, walk the route and stand, one control step at a time.

    Parameters
    ----------
    stand : s before the first step; what a record wants when None

    Raises
    ------
    FallError, StrayError
        The walk did not reach its end.
    """
    noise, at = stream(plan.seed, "action noise"), 0.0
    stand = STAND_S + plan.calibration_s if stand is None else stand
    outing = Outing(plan, policy.feedback_gains, stand=stand)
    walkers, interval = outing.walkers, SUBSTEPS * PHYSICS_STEP
    # The simulated body weighs something else, and its speeds are the subject's over `time_scale`.
    share = float(sum(walkers.models[0].body_mass)) / plan.subject.mass_kg
    pusher = Pusher(planned_pushes(plan, outing.limit * interval), start=STAND_S)
    try:
        for count in range(outing.limit):
            if outing.finished:
                return
            action, at = policy(walkers.observe()), outing.progress
            if plan.gait.action_noise:
                action = action + plan.gait.action_noise * noise.standard_normal((1, N_ACTION))
            trace = walkers.step(action, pusher.force(count * interval, share))
            if walkers.fallen()[0]:
                raise FallError(
                    f"{plan.name}: the walker fell at {at:.0f} m ({count * SUBSTEPS * PHYSICS_STEP:.0f} s, "
                    f"subject {plan.subject.name}, seed {plan.seed}, pace {plan.gait.pace_m_s:g} m/s)"
                )
            yield Moment(walkers, trace, at, outing)
            outing.steer()
        raise FallError(f"{plan.name}: the walker got stuck at {at:.0f} m (seed {plan.seed})")
    finally:
        walkers.close()


def _physics(plan: Plan, policy: Policy, on_progress: Callable[[float], None] | None) -> _Record:
    """Walk, and keep the IMU site and the load on its foot."""
    first = body.SENSOR_TOUCH.start + (0 if plan.mount.foot == "right" else 3)
    touch = slice(first, first + 3)
    pose = slice(body.SENSOR_IMU_POSITION.start, body.SENSOR_IMU_QUATERNION.stop)
    poses, touches, weight, walked = [], [], 1.0, None
    try:
        for count, moment in enumerate(stroll(plan, policy)):
            sensor = moment.trace.sensor[0]
            poses.append(sensor[:, pose].copy())
            touches.append(sensor[:, touch].copy())
            if count == 0:
                weight = float(sum(moment.walkers.models[0].body_mass)) * GRAVITY
            if moment.outing.ending and walked is None:
                walked = len(poses)
            if on_progress is not None and count % 100 == 0:
                on_progress(moment.progress)
        stands = True
    except (FallError, StrayError):
        if walked is None:
            raise
        # It failed to stop after the path was walked: the walk ends in mid-gait, before that.
        poses, touches, stands = poses[:walked], touches[:walked], False
    kept = slice(round(STAND_S / PHYSICS_STEP), None)
    found, load = np.concatenate(poses)[kept], np.concatenate(touches)[kept].sum(axis=1)
    if not (np.isfinite(found).all() and np.isfinite(load).all()):
        raise FallError(f"{plan.name}: the physics is no longer finite (seed {plan.seed})")
    return _Record(found[:, :3] * plan.subject.scale, found[:, 3:], load / weight, stands)


def _truth(record: _Record, factor: int) -> tuple[ImuTruth, np.ndarray, np.ndarray]:
    """What a perfect IMU says, the load on its foot, and its stances (m, 2) as rows."""
    truth = imu_truth(record.position, record.quaternion, PHYSICS_STEP, factor)
    contact = record.contact[truth.index]
    return truth, contact, runs(at_rest(truth, contact, factor * PHYSICS_STEP))


def planned_pushes(plan: Plan, until: float) -> tuple[Push, ...]:
    """The pushes of a plan in the first `until` seconds of its record, from the first step on."""
    if plan.disturbance is None:
        return ()
    return pushes(plan.disturbance, first=plan.calibration_s, until=until, rng=stream(plan.seed, "pushes"))


def _told_pushes(plan: Plan, until: float) -> dict[str, list[list[float]]]:
    """A disturbed walk says so: time (s) and impulse (N s along x, y) of each push."""
    given = [[push.t, *push.impulse] for push in planned_pushes(plan, until)]
    return {"pushes_s_Ns_Ns": given} if given else {}


def walk(
    plan: Plan, policy: Policy | None = None, on_progress: Callable[[float], None] | None = None
) -> Walk:
    """The truth of one walk along the plan's route, from standing to standing.

    A walker that walked the route and then failed to stop leaves a walk that ends with its last whole stance
    on the route: `meta["ends"]` says "standing" or "in mid-gait".

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
    if not record.stands:  # a stance that the end of the record cuts short is no footfall
        whole = stances[stances[:, 1] < len(truth.index) - 1]
        end = truth.index[whole[-1, 1]] + 2 * factor if len(whole) else 0
        record = _Record(record.position[:end], record.quaternion[:end], record.contact[:end], False)
        truth, contact, stances = _truth(record, factor)
    if len(stances) < 3:
        raise FallError(f"{plan.name}: the walker made {len(stances)} footfalls, expected at least 3")
    t = np.arange(len(truth.index)) * interval
    rest = np.zeros(len(t), dtype=bool)
    for first, last in stances:
        rest[first:last] = True
    rows = stances.mean(axis=1).astype(int)
    # The first stance is the stand before the walk: its footfall is the end of the calibration.
    rows[0] = min(int(plan.calibration_s / interval), stances[0, 1] - 1)
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
            **walk_identity(plan, policy).as_dict(),
            "pace_m_s": plan.gait.pace_m_s,
            "rate_hz": plan.rate_hz,
            "calibration_s": plan.calibration_s,
            "ends": "standing" if record.stands else "in mid-gait",
            **({"paces_m_m_s": [[pace.at_m, pace.m_s] for pace in plan.paces]} if plan.paces else {}),
            **_told_pushes(plan, t[-1]),
            "versions": versions(),
        },
    )
