"""A plan walked control step by control step: stand, walk the route and stand."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from footfall.errors import InputError
from footfall.models.body import build_body
from footfall.models.ground import ground_lookup
from footfall.models.mount import Mount
from footfall.models.policy import Policy
from footfall.simulate.plan import PHYSICS_STEP, Plan, Stop, shrunk
from footfall.simulate.walker.disturbance import Push, Pusher, pushes
from footfall.simulate.walker.steering import Pursuit, pace_along
from footfall.simulate.walker.walkers import N_ACTION, Trace, Walkers, grip
from footfall.streams import stream

SUBSTEPS = 30  # physics steps of a control step
STAND_S = 16.0  # s of standing, to come to rest, before the record begins
END_STAND_S = 5.0  # s of standing at the end
_SLOWEST = 0.35  # m/s; a walk that takes longer than this, or to a stop longer than _SETTLING (s), is stuck
_SETTLING = 20.0


class FallError(InputError):
    """The walker fell."""


class Episode:
    """A plan being walked: one steered walker, which stands, walks the route and stands.

    Take a control step with `walkers.step`, then `steer`, until it has `finished`.

    Parameters
    ----------
    gains : (32,) of the balance feedback
    stand : s before the first step
    mounts : of the IMUs; the plan's when None

    Attributes
    ----------
    plan : in the units of the walker; walkers : of one, in the same
    limit : control steps after which a walker that has not finished is stuck
    """

    def __init__(
        self, plan: Plan, gains: np.ndarray, *, stand: float, mounts: Sequence[Mount] | None = None
    ) -> None:
        subject, gait, small = plan.subject, plan.gait, shrunk(plan)
        route, step = small.route, PHYSICS_STEP / subject.time_scale
        sloping = small.ground is not None
        worn = (plan.mount,) if mounts is None else mounts
        model = build_body(subject.build, timestep=step, mounts=worn, sloping=sloping)
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
        """The path has been walked; only the stop is left."""
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
        grip(walkers)
        speed, turn = self._pursuit.command(x, y, walkers.heading[0], walkers.speed[0], standing)
        walkers.speed_goal[0], walkers.turn_goal[0] = speed, turn


@dataclass(frozen=True)
class Moment:
    """The walker after a control step, in its own units: the physics of that step.

    `progress` is where along the route it is, in the subject's metres.
    """

    walkers: Walkers
    trace: Trace
    progress: float
    episode: Episode


def stroll(
    plan: Plan, policy: Policy, *, stand: float | None = None, mounts: Sequence[Mount] | None = None
) -> Iterator[Moment]:
    """Stand, walk the route and stand, one control step at a time.

    Parameters
    ----------
    stand : s before the first step; that of a record when None
    mounts : of the IMUs; the plan's when None

    Raises
    ------
    FallError, StrayError
        The walk did not reach its end.
    """
    noise, at = stream(plan.seed, "action noise"), 0.0
    stand = STAND_S + plan.calibration_s if stand is None else stand
    episode = Episode(plan, policy.feedback_gains, stand=stand, mounts=mounts)
    walkers, interval = episode.walkers, SUBSTEPS * PHYSICS_STEP
    # The simulated body has another mass, and its speeds are the subject's over `time_scale`.
    share = float(sum(walkers.models[0].body_mass)) / plan.subject.mass_kg
    pusher = Pusher(planned_pushes(plan, episode.limit * interval), start=STAND_S)
    try:
        for count in range(episode.limit):
            if episode.finished:
                return
            action, at = policy(walkers.observe()), episode.progress
            if plan.gait.action_noise:
                action = action + plan.gait.action_noise * noise.standard_normal((1, N_ACTION))
            trace = walkers.step(action, pusher.force(count * interval, share))
            if walkers.fallen()[0]:
                raise FallError(
                    f"{plan.name}: the walker fell at {at:.0f} m ({count * SUBSTEPS * PHYSICS_STEP:.0f} s, "
                    f"subject {plan.subject.name}, seed {plan.seed}, pace {plan.gait.pace_m_s:g} m/s)"
                )
            yield Moment(walkers, trace, at, episode)
            episode.steer()
        raise FallError(f"{plan.name}: the walker got stuck at {at:.0f} m (seed {plan.seed})")
    finally:
        walkers.close()


def planned_pushes(plan: Plan, until: float) -> tuple[Push, ...]:
    """The pushes of a plan in the first `until` seconds of its record, from the first step on."""
    if plan.disturbance is None:
        return ()
    return pushes(plan.disturbance, first=plan.calibration_s, until=until, rng=stream(plan.seed, "pushes"))
