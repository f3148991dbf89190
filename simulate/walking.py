"""From a plan to the truth of its walk: poses at every physics step, and what a perfect IMU measures of them.

The physics moves the 1.75 m body (models.subject); its poses are scaled to the subject.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from footfall.conventions import GRAVITY, heading_of
from footfall.models import body
from footfall.models.mount import Mount
from footfall.models.policy import Policy, stock_policy
from footfall.models.route import Ground, Route
from footfall.runs import runs
from footfall.simulate.episode import STAND_S, Episode, FallError, planned_pushes, stroll
from footfall.simulate.identity import walk_identity
from footfall.simulate.plan import PHYSICS_STEP, Plan, versions
from footfall.simulate.truth import ImuTruth, at_rest, divisor, imu_truth
from footfall.simulate.walk import TrueFootfalls, Walk
from footfall.simulate.walker.steering import StrayError


@dataclass(frozen=True)
class _Motion:
    """The walker at every physics step, in the subject's units.

    Attributes
    ----------
    poses : place of an IMU -> (n, 7) its position (m) and quaternion, body to world, scalar first
    load : foot -> (n,) body weights
    stands : the walk ends standing, as it should, and not in mid-gait
    """

    poses: Mapping[Mount, np.ndarray]
    load: Mapping[str, np.ndarray]
    stands: bool


def warm() -> None:
    """Compile what walks need, or find it in numba's cache: some steps of a walker on a slope."""
    policy, s = stock_policy(), np.arange(101) * 0.1
    nil = np.zeros_like(s)
    ground = Ground(-12.0, -12.0, 1.0, np.zeros((36, 36), dtype=np.float32))
    plan = Plan("warm", Route(s, s, nil, nil, nil, nil), ground=ground)
    episode = Episode(plan, policy.feedback_gains, stand=1.0)
    walkers = episode.walkers
    try:
        walkers.step(policy(walkers.observe()))
        walkers.variability.draw(np.zeros(1, dtype=np.intp), np.random.default_rng(0))
        episode.steer()
    finally:
        walkers.close()
    pose = np.zeros((100, 7))
    pose[:, 3] = 1.0
    imu_truth(pose[:, :3], pose[:, 3:], PHYSICS_STEP, 5)


def _physics(
    plan: Plan, policy: Policy, mounts: Sequence[Mount], on_progress: Callable[[float], None] | None
) -> _Motion:
    """Walk, and keep the poses of the IMUs and the load on the feet."""
    poses: list[list[np.ndarray]] = [[] for _ in mounts]
    touches, weight, walked = [], 1.0, None
    try:
        for count, moment in enumerate(stroll(plan, policy, mounts=mounts)):
            sensor = moment.trace.sensor[0]
            for k, kept in enumerate(poses):
                kept.append(sensor[:, body.sensor_imu(k)].copy())
            touches.append(sensor[:, body.SENSOR_TOUCH].copy())
            if count == 0:
                weight = float(sum(moment.walkers.models[0].body_mass)) * GRAVITY
            if moment.episode.ending and walked is None:
                walked = len(touches)
            if on_progress is not None and count % 100 == 0:
                on_progress(moment.progress)
        stands = True
    except (FallError, StrayError):
        if walked is None:
            raise
        # It failed to stop after the path was walked: the walk ends in mid-gait, before that.
        stands = False
    begin, end = round(STAND_S / PHYSICS_STEP), None if stands else walked
    found = {}
    for mount, kept in zip(mounts, poses, strict=True):
        found[mount] = np.concatenate(kept[:end])[begin:]
        found[mount][:, :3] *= plan.subject.scale
        kept.clear()
    touch = np.concatenate(touches[:end])[begin:]
    load = {"right": touch[:, :3].sum(axis=1) / weight, "left": touch[:, 3:].sum(axis=1) / weight}
    if not all(np.isfinite(part).all() for part in (*found.values(), *load.values())):
        raise FallError(f"{plan.name}: the physics is no longer finite (seed {plan.seed})")
    return _Motion(found, load, stands)


def _truth(
    motion: _Motion, mount: Mount, factor: int, end: int | None = None
) -> tuple[ImuTruth, np.ndarray, np.ndarray]:
    """A perfect IMU up to a physics step, the load on its foot, and the foot's stances (m, 2) as rows."""

    def at(place: Mount) -> ImuTruth:
        pose = motion.poses[place][:end]
        return imu_truth(pose[:, :3], pose[:, 3:], PHYSICS_STEP, factor)

    truth = at(mount)
    contact = motion.load[mount.foot][truth.index]
    still = truth if mount.on_foot == mount else at(mount.on_foot)
    return truth, contact, runs(at_rest(still, contact, factor * PHYSICS_STEP))


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
    return next(walks([plan], policy, on_progress))


def walks(
    plans: Sequence[Plan],
    policy: Policy | None = None,
    on_progress: Callable[[float], None] | None = None,
) -> Iterator[Walk]:
    """`walk` for plans that differ in mount and rate alone: they are walked once, each truth is read of that.

    Yields
    ------
    Each plan's truth, in their order: the same bits as that of `walk`.

    Raises
    ------
    ValueError
        Plans of different steps (`Plan.steps`).
    InputError, FallError, StrayError
        As `walk`.
    """
    if len({plan.steps for plan in plans}) != 1:
        raise ValueError("plans to be walked at once differ in mount and rate alone")
    for plan in plans:
        divisor(PHYSICS_STEP, plan.rate_hz)
    policy = policy or stock_policy()
    places = dict.fromkeys(place for plan in plans for place in (plan.mount, plan.mount.on_foot))
    motion = _physics(plans[0], policy, tuple(places), on_progress)
    for plan in plans:
        yield _told(plan, policy, motion)


def _told(plan: Plan, policy: Policy, motion: _Motion) -> Walk:
    """The truth at a plan's mount and rate."""
    factor = divisor(PHYSICS_STEP, plan.rate_hz)
    interval = factor * PHYSICS_STEP
    truth, contact, stances = _truth(motion, plan.mount, factor)
    if not motion.stands:  # a stance that the end of the record cuts short is no footfall
        whole = stances[stances[:, 1] < len(truth.index) - 1]
        end = truth.index[whole[-1, 1]] + 2 * factor if len(whole) else 0
        truth, contact, stances = _truth(motion, plan.mount, factor, end)
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
            "ends": "standing" if motion.stands else "in mid-gait",
            **({"paces_m_m_s": [[pace.at_m, pace.m_s] for pace in plan.paces]} if plan.paces else {}),
            **_told_pushes(plan, t[-1]),
            "versions": versions(),
        },
    )
