"""Stops and restarts on which trained walkers are chosen: by falls, and by how still loaded feet lie.

Drawn people set out, stop, stand, set out again and stop again, on level ground and on slopes (`still_feet`
says what twist and pitch are).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from footfall.conventions import GRAVITY
from footfall.models.body import SENSOR_TOUCH, build_body
from footfall.models.policy import Policy
from footfall.models.subject import draw_subject
from footfall.simulate.learn.still_feet import Moved, feet, last_step, set_out
from footfall.simulate.walker.walkers import Walkers, grip

# Rise over run along and to the left of the way.
SLOPES = (
    *((0.0, 0.0), (0.05, 0.0), (-0.05, 0.0), (0.0, 0.05), (0.0, -0.05)),
    *((0.08, 0.0), (-0.08, 0.0), (0.0, 0.08), (0.0, -0.08), (0.057, 0.057), (0.057, -0.057)),
)
_STEP, _SUBSTEPS, _EVERY = 0.0025, 12, 2  # s of the subject's time; physics steps a control step, a sample
_SAMPLE = _STEP * _EVERY
_STAND, _WALK, _STOP = 1.0, 4.0, 9.0  # s
_BEFORE = 6.5  # s before the end of a stop, in which the last step is
_TWIST, _PITCH = 2.0, 3.0  # deg, which people's feet keep within


@dataclass(frozen=True)
class StopVerdict:
    """Falls among so many stops, and the feet's twist and pitch (deg) that nine of ten stay below."""

    stops: int
    falls: int
    twist: float
    pitch: float

    @property
    def falls_percent(self) -> float:
        """Of stops."""
        return 100 * self.falls / self.stops

    @property
    def excess_deg(self) -> float:
        """By how much twist and pitch exceed what people's feet do."""
        return max(0.0, self.twist - _TWIST) + max(0.0, self.pitch - _PITCH)


def verdict(stops: int, falls: int, moved: Iterable[Moved]) -> StopVerdict:
    """The worse of stops and restarts, and of the two feet, counts."""
    groups: dict[tuple[str, bool], list[tuple[float, float]]] = {}
    for one in moved:
        groups.setdefault((one.kind, one.first), []).append((one.twist, max(one.up, one.down)))
    tenths = [np.percentile(rows, 90, axis=0) for rows in groups.values()]
    twist, pitch = np.max(tenths, axis=0) if tenths else (np.inf, np.inf)
    return StopVerdict(stops, falls, float(twist), float(pitch))


def attempt_stops(
    policy: Policy,
    *,
    seed: int,
    people: int = 8,
    threads: int = 2,
    slopes: tuple[tuple[float, float], ...] = SLOPES,
) -> StopVerdict:
    """Let `people` drawn subjects stop twice on each slope; one that falls or does not stop is out.

    Parameters
    ----------
    seed : of the subjects, their paces and their gait's variability
    """
    rng = np.random.default_rng([seed, 2])
    up = np.repeat([[*slope, 1.0] for slope in slopes], people, axis=0)
    up /= np.linalg.norm(up, axis=1)[:, None]
    n = len(up)
    subjects = [draw_subject(rng) for _ in range(n)]
    models = [build_body(one.build, timestep=_STEP / one.time_scale) for one in subjects]
    walkers = Walkers(
        models,
        policy.feedback_gains,
        rng=np.random.default_rng([seed, 3]),
        threads=threads,
        substeps=_SUBSTEPS,
    )
    # Sloping ground is level ground under tilted gravity.
    walkers.up[:] = up
    for model, direction in zip(models, up, strict=True):
        model.opt.gravity[:] = -GRAVITY * direction

    def place(mask: np.ndarray) -> None:
        m = int(mask.sum())
        walkers.place(
            mask,
            phase=0.5 * rng.integers(2, size=m),
            speed=np.zeros(m),
            heading=np.zeros(m),
            position=np.zeros((m, 3)),
            standing=np.ones(m, dtype=bool),
            variability=np.ones(m),
            habits=[subjects[i].habits for i in np.flatnonzero(mask)],
        )

    place(np.ones(n, dtype=bool))
    pace = rng.uniform(0.8, 1.6, n) / [one.time_scale for one in subjects]
    # Control steps at which it is told to stand and to walk, in turn.
    interval = _STEP * _SUBSTEPS
    told = np.round(np.cumsum([0, _STAND, _WALK, _STOP, _WALK, _STOP]) / interval).astype(int)
    stands = np.searchsorted(told, np.arange(told[-1]), side="right") % 2 == 1
    weight = np.array([model.body_mass.sum() * GRAVITY for model in models])
    out, falls, poses, loads = np.zeros(n, dtype=bool), 0, [], []
    for count, stand in enumerate(stands):
        walkers.speed_goal[:] = 0.0 if stand else pace
        grip(walkers)
        trace = walkers.step(policy(walkers.observe()))
        poses.append(trace.qpos[:, _EVERY - 1 :: _EVERY])
        touch = trace.sensor[:, _EVERY - 1 :: _EVERY, SENSOR_TOUCH]
        loads.append(touch.reshape(n, -1, 2, 3).sum(axis=3) / weight[:, None, None])
        fallen = walkers.fallen()
        # A stop that has not come to rest is as bad as a fall.
        late = (count + 1 in told[3::2]) & (walkers.gate.value > 0)
        falls += int(((fallen | late) & ~out).sum())
        out |= fallen | late
        if fallen.any():  # keep the physics tame
            place(fallen)
    walkers.close()
    qpos, load = np.concatenate(poses, axis=1), np.concatenate(loads, axis=1)
    moved: list[Moved] = []
    per = _SUBSTEPS // _EVERY
    for i in np.flatnonzero(~out):
        for end in told[3::2].tolist():
            last = slice(end * per - round(_BEFORE / _SAMPLE), end * per)
            angles = feet(models[i], qpos[i, last])
            yaw, pitch = (angles - angles[:, :, -1:]).swapaxes(0, 1)
            moved += last_step(yaw, pitch, load[i, last].T)
            if end < told[-1]:
                first = slice(end * per - 1, end * per + round(2.0 / _SAMPLE))
                angles = feet(models[i], qpos[i, first])
                yaw, pitch = (angles - angles[:, :, :1])[:, :, 1:].swapaxes(0, 1)
                moved += set_out("restart", yaw, pitch, load[i, first][1:].T, _SAMPLE)
    return verdict(2 * n, falls, moved)
