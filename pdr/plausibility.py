"""Could a foot have made this track? What every track says of itself, and what is beyond the usual."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from footfall.late import late
from footfall.pdr.reckoning import Detected, PdrParams, level_attitude
from footfall.pdr.stance import compact
from footfall.recording import Recording

_kernels = late("footfall.pdr._kernels")

# Beyond these a track is warned of. Walks of the kinds that Footfall is measured on have, at most:
LEFT = 1.0  # m/s, RMS; 0.1 to 0.55
MOVEMENT_S = 3.0  # s; 1.3 (slow walkers 1.7)
STRIDE = 2.2  # m; 1.9
SPOILT = 0.05  # share of samples; 0.02
RISE = 0.15  # m a stride, RMS, up or down; stairs have 0.35, and are told of
# Beyond these it is none.
NO_STRIDE = 0.15  # m: a foot that never gets further has not walked
WALKED = 2.5  # m a stride, at a walker's pace
RUN = 5.0  # m a stride, at a runner's
RUNNING_S = 0.78  # s a stride and less: runners'


@dataclass(frozen=True)
class Plausibility:
    """What a track looks like beside a foot.

    Attributes
    ----------
    strides : how many
    velocity_left_m_s : RMS over strides of the velocity that is left at their ends; None for no stride
    longest_movement_s : between two moments of rest
    longest_stride_m : by the track
    stride_s : median
    spoilt_pct : share of samples that were filled in or clipped
    height_m : gained from the first footfall to the last
    rise_m : RMS over strides, up or down
    doubtful : strides that are not known, because samples are lost in their swings
    """

    strides: int
    velocity_left_m_s: float | None
    longest_movement_s: float
    longest_stride_m: float
    stride_s: float
    spoilt_pct: float
    height_m: float
    rise_m: float
    doubtful: int = 0

    def line(self) -> str:
        """In one line."""
        left = self.velocity_left_m_s
        parts = [] if left is None else [f"velocity left {left:.2f} m/s"]
        parts += [
            f"longest movement {self.longest_movement_s:.2g} s",
            f"longest stride {self.longest_stride_m:.2f} m",
            f"{self.spoilt_pct:.2g} % filled or clipped",
            f"height {self.height_m:+.2f} m",
        ]
        return "plausibility: " + ", ".join(parts)

    def as_dict(self) -> dict[str, Any]:
        """For metadata."""
        return asdict(self)

    def impossible(self) -> str:
        """What no legs can do; "" where there is nothing."""
        if self.strides < 1 or self.longest_stride_m < NO_STRIDE:
            far = f"{self.longest_stride_m:.2g} m"
            return f"no stride: from rest to rest the foot never gets further than {far}"
        most = RUN if self.stride_s <= RUNNING_S else WALKED
        # Where stances are missed the legs may be right.
        if self.longest_stride_m > most and self.longest_movement_s <= MOVEMENT_S:
            return (
                f"a stride of {self.longest_stride_m:.3g} m, legs make at most {most:g} m in "
                f"{self.stride_s:.2g} s: the rate, the units or the axes are probably wrong, or this is no "
                "foot"
            )
        return ""

    def warnings(self) -> list[str]:
        """What is beyond the usual, and its likely causes."""
        said, left = [], self.velocity_left_m_s
        if left is not None and left > LEFT:
            said.append(
                f"strides leave a velocity of {left:.2g} m/s, usual are 0.1 to {LEFT:g}: the rate or a unit "
                "is probably wrong, or the accelerometers lag or slip, or samples are spoilt"
            )
        if self.longest_movement_s > MOVEMENT_S:
            said.append(
                f"the foot moves for {self.longest_movement_s:.2g} s without a stance, usual are at most "
                f"{MOVEMENT_S:g}: running, another detector (--detector), or not a foot"
            )
        if self.longest_stride_m > STRIDE:
            said.append(
                f"a stride of {self.longest_stride_m:.2f} m, usual are at most {STRIDE:g}: running, a stance "
                "that was missed, or the rate or a unit is wrong"
            )
        if self.spoilt_pct > 100 * SPOILT:
            said.append(f"{self.spoilt_pct:.2g} % of the samples were filled in or clipped")
        if self.rise_m > RISE:
            said.append(
                f"strides rise or fall by {self.rise_m:.2g} m (RMS): stairs, or spoilt samples, or a unit is "
                "wrong"
            )
        return said


def judge_track(
    t: np.ndarray,
    position: np.ndarray,
    left: float | None,
    movement_s: float,
    spoilt: float,
    doubtful: int = 0,
) -> Plausibility:
    """A track's plausibility.

    Parameters
    ----------
    t, position : (n,) s and (n, 3) m, of its footfalls
    left : m/s, of `velocity_left`; None where it is not known
    movement_s : of `longest_movement`
    spoilt : share of samples that were filled in or clipped
    doubtful : strides
    """
    steps = np.diff(position, axis=0)
    length = np.linalg.norm(steps, axis=1)
    walked = length > NO_STRIDE
    times = np.diff(t)[walked]
    # A stride in which a stance was missed is several.
    usual = float(np.median(times)) if len(times) else 0.0
    parts = np.maximum(1, np.round(np.diff(t) / usual)) if usual else np.ones(len(steps))
    return Plausibility(
        strides=int(walked.sum()),
        velocity_left_m_s=left,
        longest_movement_s=movement_s,
        longest_stride_m=float((length / parts).max(initial=0.0)),
        stride_s=usual,
        spoilt_pct=100 * spoilt,
        height_m=float(position[-1, 2] - position[0, 2]),
        rise_m=float(np.sqrt(np.mean(steps[walked, 2] ** 2))) if walked.any() else 0.0,
        doubtful=doubtful,
    )


def velocity_left(recording: Recording, found: Detected, params: PdrParams) -> float | None:
    """RMS over strides of the velocity (m/s) that dead reckoning has left when the foot is at rest again."""
    resets = found.stances.resets
    if len(resets) < 2:
        return None
    t, gyro, accel = compact(recording.t), compact(recording.gyro), compact(recording.accel)
    level = level_attitude(found.rest.force)
    bias = found.rest.gyro_bias
    attitude = _kernels.reckon(t, gyro, accel, bias, level, resets, params.tilt_gain)[0]
    left = []
    zero = np.zeros(3)
    for i in np.flatnonzero(np.diff(t[resets]) > params.stance.min_stride_s):
        rows = slice(resets[i], resets[i + 1] + 1)
        rates = gyro[rows] - bias
        _, velocity, _ = _kernels.integrate(t[rows], rates, accel[rows], attitude[i], zero, zero)
        left.append(float(velocity[-1] @ velocity[-1]))
    return float(np.sqrt(np.mean(left))) if left else None


def longest_movement(t: np.ndarray, score: np.ndarray) -> float:
    """Longest time (s) between two moments of rest, by a detector's scores (n,)."""
    rest = np.flatnonzero(score < 1.0)
    if not len(rest):
        return float(t[-1] - t[0])
    ends = np.concatenate([[t[0]], t[rest], [t[-1]]])
    return float(np.diff(ends).max())


def doubtful_rows(t: np.ndarray, holes: Sequence[tuple[float, float]]) -> np.ndarray:
    """Which footfalls (n,) end a stride in which samples are lost: holes (s, s) on the footfalls' clock."""
    doubtful = np.zeros(len(t), dtype=bool)
    for first, last in holes:
        doubtful[1:] |= (t[:-1] < last) & (t[1:] > first)
    return doubtful


def spoilt_share(findings: Mapping[str, Any]) -> float:
    """Share of the samples that were filled in or clipped, by what reading found."""
    clipped = max(dict(findings.get("clipped", {})).values(), default=0)
    return float(findings.get("filled", 0) + clipped) / max(1, int(findings.get("rows", 1)))
