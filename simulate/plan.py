"""Everything that determines a walk."""

from __future__ import annotations

import platform
from dataclasses import dataclass, field, replace
from functools import cached_property
from importlib.metadata import version

import footfall
from footfall.identity import digest_of
from footfall.models.mount import Mount
from footfall.models.route import Ground, Route
from footfall.models.subject import Subject

PHYSICS_STEP = 0.001  # s, of the subject's time


@dataclass(frozen=True)
class Gait:
    """How a path is walked. The names are those of a scenario's `[gait]`.

    Attributes
    ----------
    pace_m_s : commanded on straights
    variability : of the gait, 1 = that of people; placement_variability, cadence_variability and
        toe_out_variability : of where and when the feet land and how far they turn out, each times the former
    action_noise : SD of the noise on the policy's action
    wander_m, wander_time_s : SD and time constant of the slow lateral wander of the steering's aim
    """

    pace_m_s: float = 1.3
    variability: float = 1.0
    placement_variability: float = 1.0
    cadence_variability: float = 1.0
    toe_out_variability: float = 1.0
    action_noise: float = 0.0
    wander_m: float = 0.0
    wander_time_s: float = 4.0


@dataclass(frozen=True)
class Stop:
    """Stand at `at_m` along the route for `for_s`."""

    at_m: float
    for_s: float


@dataclass(frozen=True)
class Pace:
    """From `at_m` along the route on, walk at `m_s`."""

    at_m: float
    m_s: float


@dataclass(frozen=True)
class Disturbance:
    """Pushes of `push_Ns` (N s) at the trunk in random horizontal directions, one each `every_s` (s)."""

    push_Ns: float
    every_s: float = 10.0


@dataclass(frozen=True)
class Plan:
    """Everything that determines a walk.

    Attributes
    ----------
    name : of the scenario, for messages and provenance
    route : where to walk; ground : level when None
    paces : changes of the gait's pace on the way, in walking order
    stops : pauses on the way, in walking order
    disturbance : pushes from the first step on, the only possible external force; none when None
    calibration_s : of standing before the first step
    rate_hz : of the truth; divides 1 kHz
    """

    name: str
    route: Route
    subject: Subject = field(default_factory=Subject)
    mount: Mount = field(default_factory=Mount)
    ground: Ground | None = None
    gait: Gait = Gait()
    paces: tuple[Pace, ...] = ()
    stops: tuple[Stop, ...] = ()
    disturbance: Disturbance | None = None
    calibration_s: float = 30.0
    rate_hz: float = 200.0
    seed: int = 1

    @cached_property
    def steps(self) -> str:
        """SHA-256 of what decides the steps: all but name, mount and rate, which the body does not feel."""
        return digest_of(replace(self, name="", mount=Mount(), rate_hz=0.0))

    @cached_property
    def digest(self) -> str:
        """SHA-256 of all of it but the name: a copy of a scenario is the same walk."""
        return digest_of(self.steps, self.mount, self.rate_hz)


def shrunk(plan: Plan) -> Plan:
    """The plan in the units of the simulated body (models.subject): lengths over s, times over sqrt(s).

    What concerns the record alone (`calibration_s`, `rate_hz`, pushes) stays as it is.
    """
    s, t = plan.subject.scale, plan.subject.time_scale
    route, ground, gait = plan.route, plan.ground, plan.gait
    small = Route(route.s / s, route.x / s, route.y / s, route.z / s, route.heading, route.curvature * s)
    if ground is not None:
        ground = Ground(ground.x0 / s, ground.y0 / s, ground.cell / s, ground.heights / s)
    return replace(
        plan,
        route=small,
        ground=ground,
        gait=replace(
            gait,
            pace_m_s=gait.pace_m_s / t,
            wander_m=gait.wander_m / s,
            wander_time_s=gait.wander_time_s / t,
        ),
        paces=tuple(Pace(pace.at_m / s, pace.m_s / t) for pace in plan.paces),
        stops=tuple(Stop(stop.at_m / s, stop.for_s / t) for stop in plan.stops),
    )


def versions() -> dict[str, str]:
    """What a walk depends on besides its plan."""
    return {
        "footfall": footfall.__version__,
        **{package: version(package) for package in ("mujoco", "numpy", "scipy")},
        "python": platform.python_version(),
    }
