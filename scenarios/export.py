"""Tracks and truths for other tools."""

from __future__ import annotations

import os

import numpy as np

from footfall.errors import InputError
from footfall.pdr.track import Track, read_track
from footfall.recording import is_truth
from footfall.settings import did_you_mean
from footfall.simulate.walk import Walk, read_walk
from footfall.tables import read_table, replacing

NAMES = ("t", "x", "y", "z", "qx", "qy", "qz", "qw")


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


def write_kitti(poses: Track | Walk, path: str | os.PathLike[str]) -> None:
    """Write poses as KITTI odometry text: a line a pose, the 3 x 4 matrix (R | p) row by row; no times."""
    # Late: no other format needs it.
    from scipy.spatial.transform import Rotation

    tum = tum_poses(poses)
    pose = np.concatenate([Rotation.from_quat(tum[:, 4:]).as_matrix(), tum[:, 1:4, None]], axis=2)
    with replacing(path) as temporary:
        np.savetxt(temporary, pose.reshape(len(pose), 12), fmt="%.9f")


def write_csv(poses: Track | Walk, path: str | os.PathLike[str]) -> None:
    """Write poses as CSV: t, x, y, z, qx, qy, qz, qw under a line of these names (s, m)."""
    with replacing(path) as temporary:
        np.savetxt(
            temporary, tum_poses(poses), fmt="%.9f", delimiter=",", header=",".join(NAMES), comments=""
        )


# Format -> what writes it.
FORMATS = {"tum": write_tum, "kitti": write_kitti, "csv": write_csv}


def require_format(name: str) -> None:
    """Raise InputError where no format of `FORMATS` is called so."""
    if name not in FORMATS:
        raise InputError(f"format {name!r} is unknown{did_you_mean(name, FORMATS)}")


def export(source: str | os.PathLike[str], target: str | os.PathLike[str], format: str = "tum") -> int:
    """Write the file of a track or a walk for other tools; returns the number of poses.

    Parameters
    ----------
    format : one of `FORMATS`

    Raises
    ------
    InputError
        No such format; the file is neither, or cannot be written.
    """
    require_format(format)
    columns, _ = read_table(source)
    poses = read_walk(source) if is_truth(columns) else read_track(source)
    FORMATS[format](poses, target)
    return len(poses.t)
