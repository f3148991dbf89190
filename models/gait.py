"""The reference gait: normative joint curves of level walking, scaled with speed.

Curves of hip flexion, knee, ankle and hip adduction over one stride (0 = heel strike of that leg), rounded
from normative data (Winter; Perry & Burnfield); the foot's roll and yaw follow the gyros of real shoes. The
hip is shifted by the pelvic tilt, and the ankle was adjusted so that forward kinematics put the foot flat
from 10 to 40 % of the stride.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numba.extending import register_jitable
from scipy.interpolate import CubicSpline

from footfall.models.body import N_SERVOS, SERVOS

N_PHASE = 1000
_HARMONICS = 7
_PELVIC_TILT_DEG = 6.5
_TRUNK_COUNTER_ROTATION = 0.12  # rad, and the swing of the arms: without them the body spins
_ARM_SWING, _ARM_REST = 0.30, -0.03  # rad at the shoulder; the right arm is back at the right heel strike

# percent of the stride -> degrees
_HIP = {
    0: 28.5, 5: 27.5, 10: 24.5, 20: 15, 30: 4.5, 40: -5.5, 50: -11.5, 55: -10.5, 60: -4, 65: 4.5, 70: 13.5,
    75: 20.5, 80: 26, 85: 29.5, 90: 31, 95: 31,
}  # fmt: skip
_KNEE = {
    0: 3, 5: 9, 10: 14, 15: 16, 20: 15, 25: 12, 30: 9, 35: 6.5, 40: 5.5, 45: 7, 50: 13.1, 55: 23.3, 60: 37,
    65: 51.2, 70: 60.4, 73: 62.4, 77: 60.4, 80: 55.4, 85: 38, 90: 16, 95: 3,
}  # fmt: skip
_ANKLE = {
    0: 8.5, 3: 5.3, 7: -1.7, 10: -0.5, 15: 4.5, 20: 8, 30: 10.9, 40: 12.2, 45: 11.7, 50: 6.7, 55: -3.4,
    60: -14, 63: -16.9, 66: -14.9, 70: -9, 75: -1, 80: 4, 85: 5, 90: 6, 95: 8.5,
}  # fmt: skip
# The foot lands on the heel's outer edge, pronates, and supinates in push-off; in early swing toes turn out.
_SUBTALAR = {0: 5, 3: 4, 8: -1, 15: -1.7, 30: -2, 45: -0.7, 52: 0, 58: 4, 65: 7, 70: 7, 80: 3, 90: 2, 95: 4}
_TOES_OUT = {
    0: 0.1, 4: -0.1, 10: -0.1, 35: 0.1, 58: 0.1, 62: 0, 66: 0.5, 70: 2.1, 75: 3.5, 80: 3.4, 85: 2.4, 90: 1.4,
    94: 0.8, 97: 0.3,
}  # fmt: skip
# Where in the stride a foot may turn further out, or less, and back: how far is drawn for each step.
_ALOFT = (0.61, 0.905)
_ADDUCTION = {0: -1, 10: 3, 20: 5, 30: 4.5, 40: 3.5, 50: 1, 55: -2, 62: -5, 70: -4, 80: -3, 90: -2}
# In steady walking the pelvis sinks further over the standing leg, or the loaded foot creeps outwards. That
# alone would narrow the steps by a centimetre, so both legs are set a little wider.
_SINKS = {
    0: -0.25, 10: -0.25, 20: 1.5, 30: 1.5, 40: 1.5, 50: -0.25, 60: -0.25, 70: -0.25, 80: -0.25, 90: -0.25,
}  # fmt: skip
_SLOW, _STEADY = 0.4, 1.0  # m/s
_SLIGHT, _SHARP = 0.1, 0.5  # rad/s: in sharp turns it would turn too little

INDEX = {name: i for i, name in enumerate(SERVOS)}


def mask(*joints: str) -> np.ndarray:
    """1 at these servos (named without side: both sides), else 0."""
    out = np.zeros(N_SERVOS)
    for joint in joints:
        for name, i in INDEX.items():
            if name == joint or name[:-2] == joint:
                out[i] = 1.0
    return out


def _curve(anchors: Mapping[int, float]) -> np.ndarray:
    """Periodic spline through the anchors, cut to its first harmonics (rad)."""
    percent = np.array([*anchors, 100]) / 100
    degrees = np.array([*anchors.values(), anchors[0]], dtype=float)
    samples = CubicSpline(percent, np.radians(degrees), bc_type="periodic")(np.arange(N_PHASE) / N_PHASE)
    spectrum = np.fft.rfft(samples)
    spectrum[_HARMONICS + 1 :] = 0
    return np.fft.irfft(spectrum, N_PHASE)


def _table() -> np.ndarray:
    phase = np.arange(N_PHASE)
    curves = {
        "hip_flexion": _curve(_HIP) - np.radians(_PELVIC_TILT_DEG),
        "hip_adduction": _curve(_ADDUCTION),
        "knee": _curve(_KNEE),
        "ankle": _curve(_ANKLE),
        "subtalar": _curve(_SUBTALAR),
        "hip_rotation": -_curve(_TOES_OUT),
    }
    table = np.zeros((N_PHASE, N_SERVOS))
    for joint, curve in curves.items():
        table += _on_both_legs(joint, curve)
    swing = np.cos(2 * np.pi * phase / N_PHASE)
    table[:, INDEX["lumbar_yaw"]] = -_TRUNK_COUNTER_ROTATION * swing
    table[:, INDEX["shoulder_r"]] = _ARM_REST - _ARM_SWING * swing
    table[:, INDEX["shoulder_l"]] = _ARM_REST + _ARM_SWING * swing
    return table


def _on_both_legs(joint: str, curve: np.ndarray) -> np.ndarray:
    table = np.zeros((N_PHASE, N_SERVOS))
    for side, offset in (("r", 0), ("l", N_PHASE // 2)):
        table[:, INDEX[f"{joint}_{side}"]] = np.roll(curve, -offset)
    return table


def _turning_out() -> np.ndarray:
    """From 0 to 1 and back to 0 within the swing (N_PHASE,)."""
    begin, end = _ALOFT
    phase = (np.arange(N_PHASE) / N_PHASE - begin) % 1
    bump: np.ndarray = np.sin(np.pi * np.minimum(phase / (end - begin), 1)) ** 2
    return bump


TABLE = _table()  # (N_PHASE, N_SERVOS) rad, at 1.2 m/s
SINKING = _on_both_legs("hip_adduction", _curve(_SINKS))  # (N_PHASE, N_SERVOS) rad, in steady walking
TWIST = _on_both_legs("hip_rotation", -_turning_out())  # per rad of the swinging foot; outwards is negative
SWINGS = mask("hip_flexion", "shoulder", "lumbar_yaw")  # swing with the stride's length
BENDS = mask("knee", "ankle")


def _pose(**angles: float) -> np.ndarray:
    out = np.zeros(N_SERVOS)
    for name, angle in angles.items():
        out[INDEX[name]] = angle
    return out


# Standing with slightly bent knees and level feet (hip - knee + ankle = 0), rad.
STANDING = 0.06 * mask("hip_flexion") + 0.10 * mask("knee") + 0.04 * mask("ankle")
# Feet one before the other, or apart, with level soles.
STAGGER = _pose(hip_flexion_r=1, ankle_r=-1, hip_flexion_l=-1, ankle_l=1)
SPREAD = mask("hip_adduction") - mask("subtalar")


@register_jitable
def stride_frequency(speed: np.ndarray) -> np.ndarray:
    """Strides a second at `speed` (m/s) of the 1.75 m body; below 0.7 m/s the steps get short instead."""
    return 0.885 * (np.maximum(speed, 0.7) / 1.25) ** 0.45


@register_jitable
def hip_amplitude(speed: np.ndarray) -> np.ndarray:
    """Hip excursion relative to that at 1.2 m/s."""
    return (np.maximum(speed, 0.03) / 1.2) ** 0.55


@register_jitable
def knee_amplitude(speed: np.ndarray) -> np.ndarray:
    """Excursion of knee and ankle relative to that at speed: no high knees when stepping on the spot."""
    return np.minimum(np.maximum(0.4 + 0.6 * speed / 0.9, 0.4), 1.0)


@register_jitable
def steadiness(speed: np.ndarray, turn: np.ndarray | float = 0.0) -> np.ndarray:
    """0 in the slow steps before a stop and in sharp turns (rad/s), 1 from an easy walk straight on."""
    easy = np.minimum(np.maximum((speed - _SLOW) / (_STEADY - _SLOW), 0.0), 1.0)
    return easy * np.minimum(np.maximum((_SHARP - np.abs(turn)) / (_SHARP - _SLIGHT), 0.0), 1.0)


def reference_angles(phase: np.ndarray, speed: np.ndarray, amplitude: np.ndarray | float = 1.0) -> np.ndarray:
    """Servo angles of the reference gait.

    Parameters
    ----------
    phase : (...) stride phase in [0, 1), 0 at the right heel strike
    speed : (...) m/s, scales the hip's excursion and, when slow, that of knee and ankle
    amplitude : (...) further factor on the hip's excursion

    Returns
    -------
    (..., 17) rad
    """
    angles = TABLE[(phase * N_PHASE).astype(np.intp) % N_PHASE]
    hip = hip_amplitude(speed) * amplitude
    knee = knee_amplitude(speed)
    sinking = SINKING[(phase * N_PHASE).astype(np.intp) % N_PHASE] * steadiness(speed)[..., None]
    return sinking + angles * (1 + SWINGS * (hip[..., None] - 1) + BENDS * (knee[..., None] - 1))
