"""Standing still, and when to stop and go.

A standing controller (ankles and hips about the pose in which the feet stopped) is blended with the gait by
a gate: 0 stands, 1 walks. Stopping waits for a step from which the body can be captured (its extrapolated
centre of mass stays over the feet); until then it steps on the spot. A stand that loses its balance steps.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from footfall.models.body import HIP_HEIGHT, N_SERVOS
from footfall.models.gait import INDEX, mask

GO_SPEED = 0.2  # m/s; a commanded speed above it is a wish to walk
_STOP_SPEED = 0.12
_GATE_DOWN_S, _GATE_UP_S = 0.23, 0.35
_PENDULUM_S = 0.31  # sqrt(height of the centre of mass / g)
_TRUNK_ARM = 0.18  # m by which the centre of mass moves per rad of trunk lean
_STANDING_POINT = 0.005  # m, centre of mass before the middle of the ankles
_FORWARD_MARGIN = (-0.06, 0.10)  # m about the standing point within which the capture point may lie
_SIDE_MARGIN = 0.03  # m inside the feet's half distance
_STAGGER_SHARE = 0.4  # of the stagger by which the feet's support reaches further, forward and back
_LARGEST_STAGGER = 0.32  # m
_LOADED = 100.0  # N

# Gains of the standing controller, rad per m, per m/s, per rad.
_ANKLE, _ANKLE_RATE = 3.3, 0.28
_HIP, _HIP_RATE = 1.2, 0.085
_SIDE, _SIDE_RATE = 4.2, 2.0
_TRUNK_ROLL = 0.4
_UPHILL_KNEE = 2.5

_ANKLES, _HIPS = mask("ankle"), mask("hip_flexion")
_SIDEWAYS = np.zeros(N_SERVOS)
_SIDEWAYS[INDEX["hip_adduction_r"]], _SIDEWAYS[INDEX["hip_adduction_l"]] = 1.0, -1.0
_LUMBAR = mask("lumbar_roll")
_BEND = {
    side: mask(f"knee_{side}") + 0.5 * mask(f"hip_flexion_{side}") + 0.5 * mask(f"ankle_{side}")
    for side in "rl"
}


@dataclass(frozen=True)
class Stand:
    """The body over its feet, all (n,), in the heading frame, against gravity.

    Attributes
    ----------
    forward, left : m, centre of mass from the standing point
    forward_velocity, left_velocity : m/s
    pitch, pitch_rate, trunk_roll : rad, rad/s, rad
    grade_left : rise of the ground to the left
    stagger, width : m, distances of the feet along and across
    loaded : bool, both feet carry
    """

    forward: np.ndarray
    left: np.ndarray
    forward_velocity: np.ndarray
    left_velocity: np.ndarray
    pitch: np.ndarray
    pitch_rate: np.ndarray
    trunk_roll: np.ndarray
    grade_left: np.ndarray
    stagger: np.ndarray
    width: np.ndarray
    loaded: np.ndarray

    @property
    def capture_forward(self) -> np.ndarray:
        """Extrapolated centre of mass, along (m)."""
        return self.forward + _PENDULUM_S * self.forward_velocity

    @property
    def capture_left(self) -> np.ndarray:
        """Extrapolated centre of mass, across (m)."""
        return self.left + _PENDULUM_S * self.left_velocity


def stand_of(
    *,
    pelvis: np.ndarray,
    feet: np.ndarray,
    velocity: np.ndarray,
    up: np.ndarray,
    pitch: np.ndarray,
    roll: np.ndarray,
    pitch_rate: np.ndarray,
    lumbar: np.ndarray,
    lumbar_pitch_rate: np.ndarray,
    grade_left: np.ndarray,
    force: np.ndarray,
) -> Stand:
    """Judge a stand.

    Parameters
    ----------
    pelvis : (n, 2) m, velocity : (n, 2) m/s, forward and left
    feet : (n, 2, 2) m, right and left foot, forward and left
    up : (n, 2) gravity's opposite, forward and left components
    pitch, roll : (n,) rad relative to gravity; lumbar : (n, 2) rad, roll and pitch of the trunk on the pelvis
    force : (n, 2) N on each foot
    """
    middle = feet.mean(axis=1)
    lean, trunk_roll = pitch + lumbar[:, 1], roll + lumbar[:, 0]
    over = pelvis - middle - HIP_HEIGHT * up
    apart = np.abs(feet[:, 0] - feet[:, 1])
    return Stand(
        forward=over[:, 0] + _TRUNK_ARM * lean - _STANDING_POINT,
        left=over[:, 1] - _TRUNK_ARM * trunk_roll,
        forward_velocity=velocity[:, 0] + _TRUNK_ARM * (pitch_rate + lumbar_pitch_rate),
        left_velocity=velocity[:, 1],
        pitch=pitch,
        pitch_rate=pitch_rate,
        trunk_roll=trunk_roll,
        grade_left=grade_left,
        stagger=apart[:, 0],
        width=apart[:, 1],
        loaded=np.asarray((force > _LOADED).all(axis=1)),
    )


def standing_feedback(s: Stand) -> np.ndarray:
    """Offsets (n, 17) rad of the servo targets that hold a stand."""
    ankle = -_ANKLE * s.forward - _ANKLE_RATE * s.forward_velocity
    hip = -_HIP * s.pitch - _HIP_RATE * s.pitch_rate
    side = _SIDE * s.left + _SIDE_RATE * s.left_velocity
    out = ankle[:, None] * _ANKLES + hip[:, None] * _HIPS + side[:, None] * _SIDEWAYS
    out -= _TRUNK_ROLL * s.trunk_roll[:, None] * _LUMBAR
    # Across a slope the uphill knee bends.
    out += np.maximum(-_UPHILL_KNEE * s.grade_left, 0)[:, None] * _BEND["r"]
    out += np.maximum(_UPHILL_KNEE * s.grade_left, 0)[:, None] * _BEND["l"]
    return out


class Gate:
    """Who walks and who stands.

    Attributes
    ----------
    value : (n,) 0 stands, 1 walks
    closing : (n,) bool, has decided to stand (or stands)
    """

    def __init__(self, n: int) -> None:
        self.value = np.ones(n)
        self.closing = np.zeros(n, dtype=bool)

    def place(self, mask_: np.ndarray, standing: np.ndarray) -> None:
        """Start the walkers in `mask_` standing or walking."""
        self.value[mask_] = np.where(standing, 0.0, 1.0)
        self.closing[mask_] = standing

    def decide(self, s: Stand, step_phase: np.ndarray, speed: np.ndarray, goal: np.ndarray) -> np.ndarray:
        """Update `closing`; returns (n,) bool: who decided to stand just now."""
        off_balance = (np.abs(s.capture_forward - 0.005) > 0.115 + 0.3 * s.stagger) | (
            np.abs(s.capture_left) > s.width / 2 + 0.035
        )
        go = (goal > GO_SPEED) | (self.closing & (self.value < 0.3) & off_balance)
        capturable = (
            (s.capture_forward > _FORWARD_MARGIN[0] - _STAGGER_SHARE * s.stagger)
            & (s.capture_forward < _FORWARD_MARGIN[1] + _STAGGER_SHARE * s.stagger)
            & (np.abs(s.capture_left) < s.width / 2 - _SIDE_MARGIN)
            & (s.stagger < _LARGEST_STAGGER)
            & s.loaded
        )
        stop = (speed < _STOP_SPEED) & (step_phase < 0.35) & capturable & ~go
        new = stop & ~self.closing
        self.closing = (self.closing | stop) & ~go
        return new

    def advance(self, dt: np.ndarray) -> np.ndarray:
        """Open or close for `dt` (n,) s; returns the value before."""
        before = self.value
        self.value = np.clip(before + np.where(self.closing, -dt / _GATE_DOWN_S, dt / _GATE_UP_S), 0, 1)
        return before

    @property
    def pace(self) -> np.ndarray:
        """(n,) factor on the cadence: the phase freezes in standing."""
        opening = np.where(self.value > 0, np.maximum(self.value, 0.5), 0.0)
        return np.where(self.closing, self.value**2, opening)
