"""Tracks and truths for other tools."""

from __future__ import annotations

import os

import numpy as np

from footfall.pdr.track import Track, read_track
from footfall.recording import is_truth
from footfall.simulate.walk import Walk, read_walk
from footfall.tables import read_table, replacing


def tum_poses(poses: Track | Walk) -> np.ndarray:
    """(n, 8) rows t, x, y, z, qx, qy, qz, qw of the TUM RGB-D benchmark (Sturm et al. 2012); s, m, world.

    A track has headings alone: its attitudes are level.
    """
    if isinstance(poses, Walk):
        return np.column_stack([poses.t, poses.position, poses.quaternion[:, [1, 2, 3, 0]]])
    half, level = poses.heading / 2, np.zeros(len(poses))
    return np.column_stack([poses.t, poses.position, level, level, np.sin(half), np.cos(half)])


def write_tum(poses: Track | Walk, path: str | os.PathLike[str]) -> None:
    """Write a track or a walk's truth as TUM text, to 1e-9."""
    with replacing(path) as temporary:
        np.savetxt(temporary, tum_poses(poses), fmt="%.9f")


def export_tum(source: str | os.PathLike[str], target: str | os.PathLike[str]) -> int:
    """Write the file of a track or a walk as TUM text; returns the number of poses.

    Raises
    ------
    InputError
        It is neither, or cannot be written.
    """
    columns, _ = read_table(source)
    poses = read_walk(source) if is_truth(columns) else read_track(source)
    write_tum(poses, target)
    return len(poses.t)
