"""MATLAB files: `imu` (n x 6: specific force m/s2, then rate rad/s) and `ts` (s), or the names of others.

LLIO, pyshoe and the gait-driven dataset write `imu` and `ts`; others keep gyro and accelerometer apart.
Version 7.3 is HDF5, read with h5py, where arrays lie transposed.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from footfall.errors import InputError
from footfall.formats.files import Content
from footfall.formats.hdf5 import HDF5, h5py
from footfall.formats.options import Reading
from footfall.formats.samples import Samples, Source

_IMU = ("imu", "inertial_data", "imu_data", "data_imu", "u")
_TIMES = ("ts", "t", "time", "timestamps", "timestamp", "imu_ts", "time_imu")
_GYROS = ("gyro", "gyr", "gyroscope", "w", "omega", "angular_velocity", "gyr_data", "gyro_data")
_ACCELS = ("accel", "acc", "accelerometer", "f", "specific_force", "acceleration", "acc_data", "accel_data")
_STEPS = ("dt", "ts", "sampling_period")
_RATES = ("fs", "rate", "freq", "sampling_rate", "sample_rate", "frequency")


def is_matlab(content: Content) -> bool:
    """Whether this is a MATLAB file, by its ending or its first bytes."""
    return content.name.lower().endswith(".mat") or content.head.startswith(b"MATLAB ")


def open_matlab(content: Content, reading: Reading) -> Source:
    """Open a MATLAB file of any version.

    Raises
    ------
    InputError
        Unreadable, or no arrays of the names and shapes above; or 7.3 without h5py.
    """
    path = content.path
    is_hdf5 = content.head[512:].startswith(HDF5) or content.head.startswith(HDF5)
    found = _variables_73(content) if is_hdf5 else _variables(content)
    by = {name.lower(): values for name, values in found.items()}
    both = next((by[name] for name in _IMU if name in by), None)
    if both is not None:
        imu = _rows(path, "imu", both, 6)
        accel, gyro = imu[:, :3], imu[:, 3:]
    else:
        triples = [
            next((_rows(path, name, by[name], 3) for name in names if name in by), None)
            for names in (_GYROS, _ACCELS)
        ]
        if triples[0] is None or triples[1] is None:
            held = ", ".join(found) or "nothing"
            raise InputError(f"no variables 'imu' and 'ts', nor 'gyro' and 'accel' (it holds {held})", path)
        gyro, accel = triples[0], triples[1]
        if len(gyro) != len(accel):
            raise InputError(f"{len(gyro)} rows of gyro, {len(accel)} of accel, expected as many", path)
    t = _time(path, by, len(gyro), reading)
    samples = Samples(
        row=0,
        t=t * reading.sizes.get("t", 1.0),
        gyro=gyro.astype(float) * reading.sizes.get("gyro", 1.0),
        accel=accel.astype(float) * reading.sizes.get("accel", 1.0),
    )
    unstated = frozenset({"gyro", "accel"} - set(reading.sizes))
    return Source(path, "matlab", len(gyro), iter([samples]), unstated=unstated)


def _time(path: Any, by: Mapping[str, Any], n: int, reading: Reading) -> np.ndarray:
    if reading.rate_hz is not None:
        return np.arange(n) / reading.rate_hz
    for name in _TIMES:
        if name in by and np.size(by[name]) == n and np.asarray(by[name]).dtype.kind in "fiu":
            return np.ravel(by[name]).astype(float)
    for names, power in ((_STEPS, 1), (_RATES, -1)):
        for name in names:
            if name in by and np.size(by[name]) == 1 and np.asarray(by[name]).dtype.kind in "fiu":
                value = float(np.ravel(by[name])[0])
                if value > 0:
                    return np.arange(n) * value**power
    stamps = next((name for name in _TIMES if name in by), None)
    if stamps is not None:
        raise InputError(
            f"{stamps} has {np.size(by[stamps])} values for {n} samples, expected one each", path
        )
    raise InputError(f"no variables 'imu' and 'ts', nor a rate (--rate): it holds {', '.join(by)}", path)


def _rows(path: Any, name: str, values: Any, width: int) -> np.ndarray:
    values = np.asarray(values)
    if values.ndim == 2 and values.shape[1] != width and values.shape[0] == width:
        values = values.T
    if values.ndim != 2 or values.shape[1] != width or values.dtype.kind not in "fiu":
        raise InputError(
            f"{name} is {values.dtype} of shape {values.shape}, expected numbers, n x {width}", path
        )
    return values


def _variables(content: Content) -> dict[str, Any]:
    """Numeric arrays of a file up to version 7; those within structures by their own names.

    Objects are built from data alone: nothing in a MATLAB file is executed.
    """
    from scipy.io import loadmat

    try:
        found = loadmat(content.at, struct_as_record=True, simplify_cells=False)
    except NotImplementedError:
        raise InputError("MATLAB version 7.3 whose first bytes are damaged", content.path) from None
    except Exception as error:  # scipy raises whatever a damaged file makes it stumble over
        raise InputError(f"not a readable MATLAB file ({error})", content.path) from None
    return _flattened({name: value for name, value in found.items() if not name.startswith("__")})


def _flattened(found: Mapping[str, Any], depth: int = 3) -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for name, value in found.items():
        value = np.asarray(value)
        if value.dtype.names and value.size == 1 and depth:
            inner = {key: value[key].item() for key in value.dtype.names}
            flat = {**_flattened(inner, depth - 1), **flat}
        else:
            flat[name] = value
    return flat


def _variables_73(content: Content) -> dict[str, Any]:
    library = h5py(content.path, "MATLAB version 7.3")
    found: dict[str, Any] = {}
    try:
        with library.File(content.at, "r") as file:

            def visit(name: str, node: Any) -> None:
                if isinstance(node, library.Dataset) and node.dtype.kind in "fiu" and "#refs#" not in name:
                    found.setdefault(name.rsplit("/", 1)[-1], node[()].T)

            file.visititems(visit)
    except Exception as error:  # h5py raises whatever a damaged file makes it stumble over
        raise InputError(f"not a readable MATLAB file ({error})", content.path) from None
    return found
