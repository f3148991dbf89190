"""What a recording holds, without navigating it: columns, rate, rests, noise, clipping."""

from __future__ import annotations

import os
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from footfall.errors import InputError
from footfall.formats.closure import rests_of
from footfall.formats.condition import Findings, condition
from footfall.formats.explain import described
from footfall.formats.files import open_content
from footfall.formats.options import Reading
from footfall.formats.physics import likely_units
from footfall.formats.reader import as_recording, is_simulated, judged, open_source
from footfall.formats.samples import joined
from footfall.formats.table import open_header
from footfall.pdr.rests import BLOCK_S, still_stretches
from footfall.recording import Recording

_BARS = " ▁▂▃▄▅▆▇█"


@dataclass(frozen=True)
class Inspection:
    """What a file holds.

    Attributes
    ----------
    format, rows, rate_hz, duration_s : of the recording
    columns : lines of a table: each column, its first cells, and what it was taken for
    findings : what was mended
    rests : (s, s) at rest
    up : which way is up where it is stillest, in the body's axes
    gyro_noise_rad_s, accel_noise_m_s2 : per axis at rest, standard deviation; None without a rest
    gyro_most_rad_s, accel_most_m_s2 : largest of any axis
    refused : why it would not be navigated; "" where nothing speaks against it
    turning, force : bars of a small picture: how fast it turns, and how far the force is from gravity
    """

    format: str
    rows: int
    rate_hz: float
    duration_s: float
    columns: tuple[str, ...]
    findings: tuple[str, ...]
    rests: tuple[tuple[float, float], ...]
    up: tuple[float, float, float]
    gyro_noise_rad_s: float | None
    accel_noise_m_s2: float | None
    gyro_most_rad_s: float
    accel_most_m_s2: float
    refused: str
    turning: str
    force: str

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return asdict(self)


def inspect(
    path: str | os.PathLike[str], format: str = "auto", reading: Reading | None = None, *, width: int = 72
) -> Inspection:
    """Look into a recording of any known format.

    Parameters
    ----------
    format, reading : as of `footfall.formats.open_source`
    width : bars in its picture

    Raises
    ------
    InputError
        It cannot be read. What speaks against navigating it is told in `refused` instead.
    """
    reading = reading or Reading()
    columns = _columns(Path(path), reading)
    source = open_source(path, format, reading=reading)
    try:
        samples, findings = condition(
            joined(source.blocks), source.format, gap_s=reading.gap_s, doubted=not is_simulated(source.meta)
        )
        samples, told = likely_units(samples, source.unstated, walk=True)
        findings = replace(findings, notes=(*source.notes, *told))
        recording = as_recording(samples, source, findings)
    except InputError as error:
        raise error.about(source.path, "recording") from None
    try:
        recording, findings = judged(recording, findings, walk=True)
        refused = ""
    except InputError as error:
        refused = error.message
    return _looked_at(recording, findings, columns, refused, width)


def _columns(path: Path, reading: Reading) -> tuple[str, ...]:
    """The table of its columns; nothing of a file that has none."""
    try:
        (content,) = open_content(path, reading.sensor)
        opened = open_header(content, reading.columns)
    except (InputError, ValueError):
        return ()
    return tuple(described(opened.header, opened.rows))


def _looked_at(
    recording: Recording, findings: Findings, columns: tuple[str, ...], refused: str, width: int
) -> Inspection:
    t = recording.t - recording.t[0]
    rests = still_stretches(recording)
    noise: list[float | None] = [None, None]
    if rests:
        longest = max(rests, key=lambda one: one.duration)
        rows = slice(longest.first, longest.stop)
        # From step to step: a foot that sways is no noise.
        noise = [
            float(np.sqrt(np.mean(np.var(np.diff(values[rows], axis=0), axis=0)) / 2))
            for values in (recording.gyro, recording.accel)
        ]
    turn = np.linalg.norm(recording.gyro, axis=1)
    off = np.abs(np.linalg.norm(recording.accel, axis=1) - 9.80665)
    return Inspection(
        format=findings.format,
        rows=findings.rows,
        rate_hz=findings.rate_hz,
        duration_s=float(t[-1]),
        columns=columns,
        findings=tuple(findings.sentences()),
        rests=tuple((float(t[one.first]), float(t[one.stop - 1])) for one in rests),
        up=_up(recording),
        gyro_noise_rad_s=noise[0],
        accel_noise_m_s2=noise[1],
        gyro_most_rad_s=float(np.abs(recording.gyro).max()),
        accel_most_m_s2=float(np.abs(recording.accel).max()),
        refused=refused,
        turning=bars(t, turn, width),
        force=bars(t, off, width),
    )


def _up(recording: Recording) -> tuple[float, float, float]:
    rows = rests_of(recording)
    force = np.median(recording.accel[rows] if len(rows) else recording.accel, axis=0)
    x, y, z = map(float, force / (np.linalg.norm(force) or 1.0))
    return x, y, z


def bars(t: np.ndarray, size: np.ndarray, width: int) -> str:
    """A line of `width` bars: the largest of (n,) `size` in each part of the time, beside the largest of all.

    Parts shorter than `BLOCK_S` are joined.
    """
    width = max(1, min(width, int(t[-1] / BLOCK_S)))
    part = np.minimum((t / (t[-1] or 1.0) * width).astype(int), width - 1)
    most = np.zeros(width)
    np.maximum.at(most, part, size)
    high = most.max() or 1.0
    return "".join(_BARS[round(float(x) / high * (len(_BARS) - 1))] for x in most)
