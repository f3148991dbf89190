"""The heading of a step: where the foot points, where the step goes, or both.

Methods of dominant directions judge "the heading angle of step s". Deng et al. (2018, section 2.4) say only
that their navigation computes it. Two angles fit these words: the yaw of the IMU at the
stance, and the course, the direction of the stride that ends there. A corridor guides the course. The foot
points beside it by the toe-out, which differs between people, between feet, and between standing and walking.
"""

from __future__ import annotations

import cmath
import math
from collections import deque
from typing import Literal

from footfall.conventions import wrap
from footfall.errors import InputError
from footfall.pdr.filter.run import Step

HeadingSource = Literal["yaw", "course", "both"]

SHORTEST = 0.3  # m, of a stride that has a direction
TELLING = 0.7  # m, of a stride that tells the toe-out
TOLD_BY = 3  # strides before the toe-out counts as known


def require_source(method: str, source: str) -> None:
    """Raise InputError unless there is such a heading of a step."""
    if source not in ("yaw", "course", "both"):
        raise InputError(f'{method}: heading = {source!r}, expected "yaw", "course" or "both"')


class StepHeadings:
    """The heading of each step of a walk, asked in order and told of every correction (`applied`).

    With psi the yaw at the stances and c the course, the direction of the stride from s - 1 to s:

        yaw     psi_s
        course  c_s
        both    f + wrap(c_s - f) / 2 with f = psi_s - toe-out; the course while no toe-out is known
        toe-out = circular mean of (psi_{s-1} + psi_s) / 2 - c_s over strides longer than 0.7 m

    A drift of the heading turns psi and c alike, and the mean of the two yaws is that of the middle of the
    stride, so that neither drift nor curves get into the toe-out.

    Parameters
    ----------
    source : which of them
    memory : steps that are remembered

    Attributes
    ----------
    recent : headings of the last steps (rad, continuous), turned as the filter's heading was turned since
    """

    def __init__(self, source: HeadingSource, memory: int = 1) -> None:
        self.source = source
        self.recent: deque[float] = deque(maxlen=memory)
        self._yaw: float | None = None  # at the footfall before
        self._last = 0.0  # what was said last
        self._sum, self._count = 0j, 0

    @property
    def toe_out(self) -> float | None:
        """By how much the foot points to the left of the course (rad); None while too few strides tell."""
        # not cmath.phase, which overflows at the least of angles
        return math.atan2(self._sum.imag, self._sum.real) if self._count >= TOLD_BY else None

    def __call__(self, step: Step) -> float | None:
        """Heading of this step (rad, continuous), which is remembered; None where the step has none."""
        heading = step.heading if self.source == "yaw" else self._course(step)
        if heading is None:
            return None
        toe_out = self.toe_out
        if self.source == "both" and toe_out is not None:
            foot = step.heading - toe_out
            heading = foot + float(wrap(heading - foot)) / 2
        self._last += float(wrap(heading - self._last))
        self.recent.append(self._last)
        return self._last

    def applied(self, turned: float) -> None:
        """The filter's heading was turned by `turned` (rad)."""
        for i in range(len(self.recent)):
            self.recent[i] += turned
        if self._yaw is not None:
            self._yaw += turned

    def _course(self, step: Step) -> float | None:
        """Direction of the stride (rad), from which the toe-out is learned; None of one that is too short."""
        before, self._yaw = self._yaw, step.heading
        length = math.hypot(step.stride[0], step.stride[1])
        if length < SHORTEST:
            return None
        course = math.atan2(step.stride[1], step.stride[0])
        if before is not None and length > TELLING:
            self._sum += cmath.exp(1j * ((before + step.heading) / 2 - course))
            self._count += 1
        return course
