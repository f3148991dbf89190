"""Real recordings as one long walk: one mount, sample by sample, with a rest in front."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.validation._real import Real
from footfall.hdr.tracks import pdr_track
from footfall.late import late
from footfall.pdr.detectors import DETECTORS
from footfall.pdr.footfalls import Footfalls
from footfall.pdr.reckoning import PdrParams, dead_reckon, detect, level_attitude
from footfall.pdr.rests import find_rest
from footfall.recording import Recording
from footfall.scenarios.judge.reference import score_closure, score_footprints

transform, optimize = late("scipy.spatial.transform"), late("scipy.optimize")

RATE_HZ = 200.0
REST_S = 30.0  # in front
JOINT_S = 1.0  # in which a foot at rest tilts from one recording's end to the next one's start
END_S = 0.2  # of a recording, in which it rests
MOST_DRIFT = np.radians(0.5)  # rad/s, of a gyro whose bias a short rest told
PLACE_M = 0.2  # to which a track without drift is right
REST_GYRO, REST_ACCEL = np.radians(0.1), 0.02  # rad/s and m/s2, noise of the rest in front
PATIENT = PdrParams(detector=DETECTORS["patient"])


@dataclass(frozen=True)
class Piece:
    """A recording that begins and ends at rest, at `RATE_HZ`, level when its foot stands, x as it walks.

    Attributes
    ----------
    name : of the recording
    gyro, accel : (n, 3) rad/s and m/s2; row k is the mean over the interval that ends with it
    drift : rad/s, what the gyro says too much about the standing foot's vertical
    start, end : (3,) m/s2, force while it rests
    """

    name: str
    gyro: np.ndarray
    accel: np.ndarray
    drift: float
    start: np.ndarray
    end: np.ndarray

    @property
    def seconds(self) -> float:
        """How long it is."""
        return len(self.gyro) / RATE_HZ

    def mirrored(self) -> Piece:
        """As the other foot would walk it, left for right."""
        across = np.array([1.0, -1.0, 1.0])
        return replace(
            self,
            gyro=-self.gyro * across,
            accel=self.accel * across,
            drift=-self.drift,
            start=self.start * across,
            end=self.end * across,
        )

    def backwards(self) -> Piece:
        """From its end to its start: the same forces, the opposite rates, and x turned round."""
        round_ = np.array([-1.0, -1.0, 1.0])
        return replace(
            self,
            gyro=-self.gyro[::-1] * round_,
            accel=self.accel[::-1] * round_,
            drift=-self.drift,
            start=self.end * round_,
            end=self.start * round_,
        )

    def variants(self) -> list[Piece]:
        """Four walks of one."""
        return [self, self.mirrored(), self.backwards(), self.mirrored().backwards()]


def piece_of(real: Real) -> Piece:
    """A recording without the bias that its rests tell.

    `drift` is the constant rate without which its track fits its measured footprints best, or ends nearest to
    its start, as far as the rests leave that open.
    """
    recording = real.recording
    rest = find_rest(recording, PATIENT)
    gyro = recording.gyro - rest.gyro_bias
    up = rest.force / np.linalg.norm(rest.force)

    def without(drift: float) -> Footfalls:
        drifting = replace(rest, gyro_bias=rest.gyro_bias + drift * up)
        return dead_reckon(recording, PATIENT, found=detect(recording, PATIENT, drifting))

    def unlikely(drift: float) -> float:
        track, prints = pdr_track(without(drift)), real.footprints
        if prints is None:
            off = score_closure(track).return_error_m
        else:
            off = score_footprints(track, prints).footprint_rmse_m * np.sqrt(len(prints))
        return float((off / PLACE_M) ** 2 + (drift / rest.bias_sd) ** 2)

    drift = float(optimize.minimize_scalar(unlikely, bounds=(-MOST_DRIFT, MOST_DRIFT), method="bounded").x)
    level = transform.Rotation.from_quat(level_attitude(rest.force), scalar_first=True)
    ahead = transform.Rotation.from_euler("z", -_ahead(without(drift)))
    onto = (ahead * level).as_matrix().T
    t = recording.t
    grid = t[0] + np.arange(1, int((t[-1] - t[0]) * RATE_HZ) + 1) / RATE_HZ
    return Piece(
        name=real.name,
        gyro=_means(t, gyro, grid) @ onto,
        accel=_means(t, recording.accel, grid) @ onto,
        drift=drift,
        start=rest.force @ onto,
        end=recording.accel[t > t[-1] - END_S].mean(axis=0) @ onto,
    )


def chain(pieces: Sequence[Piece], seed: int, true: bool = False) -> Recording:
    """One recording of all: `REST_S` of rest, then the pieces, between them a second in which the foot tilts.

    Parameters
    ----------
    seed : of the noise of the rest in front
    true : without what each piece's gyro says too much
    """
    random, rows = np.random.default_rng(seed), round(REST_S * RATE_HZ) + 1
    gyros = [random.normal(0.0, REST_GYRO, (rows, 3))]
    accels = [pieces[0].start + random.normal(0.0, REST_ACCEL, (rows, 3))]
    for before, piece in zip([None, *pieces[:-1]], pieces, strict=True):
        if before is not None:
            gyro, accel = joint(before.end, piece.start)
            gyros.append(gyro)
            accels.append(accel)
        up = piece.start / np.linalg.norm(piece.start)
        gyros.append(piece.gyro - piece.drift * up if true else piece.gyro)
        accels.append(piece.accel)
    gyro, accel = np.concatenate(gyros), np.concatenate(accels)
    return Recording(np.arange(len(gyro)) / RATE_HZ, gyro, accel, meta={"chain": [p.name for p in pieces]})


def joint(end: np.ndarray, start: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rates and forces (n, 3) of a foot at rest that tilts from force `end` to `start`, turning nowhere."""
    rows = round(JOINT_S * RATE_HZ)
    a, b = end / np.linalg.norm(end), start / np.linalg.norm(start)
    axis = np.cross(a, b)
    angle = np.arctan2(np.linalg.norm(axis), a @ b)
    turn = axis / max(float(np.linalg.norm(axis)), 1e-12) * angle  # of the force in the body, whose is -turn
    share = (np.arange(rows) + 0.5)[:, None] / rows
    tilted = transform.Rotation.from_rotvec(share * turn).apply(a)
    size = np.linalg.norm(end) + share * (np.linalg.norm(start) - np.linalg.norm(end))
    return np.tile(-turn / JOINT_S, (rows, 1)), tilted * size


def _means(t: np.ndarray, values: np.ndarray, grid: np.ndarray) -> np.ndarray:
    """Means of values (n, 3), each of the interval that ends at its stamp, over the intervals of a grid."""
    steps = np.diff(t)[:, None] * values[1:]
    total = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    edges = np.concatenate([[t[0]], grid])
    at = np.column_stack([np.interp(edges, t, column) for column in total.T])
    return np.diff(at, axis=0) * RATE_HZ


def _ahead(footfalls: Footfalls) -> float:
    """Mean angle from the x axis to the way that it walks (rad)."""
    dx, dy = np.diff(footfalls.position[:, :2], axis=0).T
    middle = (footfalls.heading[1:] + footfalls.heading[:-1]) / 2
    return float(np.angle(((dx + 1j * dy) * np.exp(-1j * middle)).sum()))
