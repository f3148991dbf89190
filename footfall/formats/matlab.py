"""MATLAB files with `imu` (n x 6: specific force m/s2, then rate rad/s) and `ts` (s)."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from footfall.errors import InputError
from footfall.formats.samples import Samples, Source


def is_matlab(path: Path, head: bytes) -> bool:
    """Whether this is a MATLAB file, by its ending or its first bytes."""
    return path.suffix.lower() == ".mat" or head.startswith(b"MATLAB ")


def open_matlab(path: Path, sizes: Mapping[str, float]) -> Source:
    """Open a MATLAB file (up to version 7).

    Parameters
    ----------
    sizes : quantity -> size of its unit, from flags; SI where there is none

    Raises
    ------
    InputError
        Unreadable, or `imu` and `ts` are absent or of another shape.
    """
    from scipy.io import loadmat, whosmat

    try:
        held = [name for name, _, _ in whosmat(path)]
        if not {"imu", "ts"} <= set(held):
            raise InputError(f"no variables 'imu' and 'ts' (it holds {', '.join(held) or 'nothing'})", path)
        found = loadmat(path, variable_names=["imu", "ts"])
    except NotImplementedError:
        raise InputError("MATLAB version 7.3, expected version 7 (save with '-v7')", path) from None
    except InputError:
        raise
    except Exception as error:  # scipy raises whatever a damaged file makes it stumble over
        raise InputError(f"not a readable MATLAB file ({error})", path) from None
    imu, ts = np.asarray(found["imu"]), np.asarray(found["ts"])
    if imu.ndim == 2 and imu.shape[1] != 6 and imu.shape[0] == 6:
        imu = imu.T
    if imu.ndim != 2 or imu.shape[1] != 6 or imu.dtype.kind not in "fiu":
        raise InputError(f"imu is {imu.dtype} of shape {imu.shape}, expected numbers, n x 6", path)
    if ts.size not in (1, len(imu)) or ts.dtype.kind not in "fiu":
        raise InputError(f"ts has {ts.size} values for {len(imu)} samples, expected one each", path)
    t = ts.ravel().astype(float) if ts.size == len(imu) else np.arange(len(imu)) * float(ts.item())
    samples = Samples(
        row=0,
        t=t * sizes.get("t", 1.0),
        gyro=imu[:, 3:].astype(float) * sizes.get("gyro", 1.0),
        accel=imu[:, :3].astype(float) * sizes.get("accel", 1.0),
    )
    return Source(path, "matlab", len(imu), iter([samples]))
