"""APDM's Opal in HDF5: `Sensors/ID/{Time, Accelerometer, Gyroscope}`, or `ID/Calibrated/...`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from footfall.errors import InputError
from footfall.formats.files import Content
from footfall.formats.options import Reading
from footfall.formats.samples import Samples, Source

HDF5 = b"\x89HDF\r\n\x1a\n"
_NAMES = (("Accelerometer", "Gyroscope"), ("Calibrated/Accelerometers", "Calibrated/Gyroscopes"))


def h5py(path: Path, what: str) -> Any:
    """The library, imported now.

    Raises
    ------
    InputError
        It is not installed.
    """
    try:
        import h5py as library
    except ImportError:
        raise InputError(f"{what}: reading it needs h5py (pip install h5py)", path) from None
    return library


def is_apdm(content: Content) -> bool:
    """Whether this HDF5 file holds sensors as APDM's do."""
    if content.name.lower().endswith(".mat"):
        return False
    library = h5py(content.path, "an HDF5 file")
    try:
        with library.File(content.at, "r") as file:
            return bool(_sensors(file))
    except Exception as error:  # h5py raises whatever a damaged file makes it stumble over
        raise InputError(f"not a readable HDF5 file ({error})", content.path) from None


def open_apdm(content: Content, reading: Reading) -> Source:
    """Open a file of APDM's: m/s2, rad/s, and microseconds.

    Raises
    ------
    InputError
        Damaged, no sensors as theirs, or several and none chosen.
    """
    library, path = h5py(content.path, "an HDF5 file"), content.path
    try:
        with library.File(content.at, "r") as file:
            found = _sensors(file)
            if not found:
                raise InputError("an HDF5 file without sensors as APDM's", path)
            place = _chosen(path, {label: name for name, (label, *_) in found.items()}, reading.sensor)
            _, accel, gyro, time = found[place]
            values = [_upright(np.asarray(file[name], dtype=float)) for name in (accel, gyro)]
            stamps = None if time is None else np.asarray(file[time], dtype=float).ravel()
            rate = float(np.ravel(file.attrs.get("SampleRate", [0.0]))[0])
    except InputError:
        raise
    except Exception as error:
        raise InputError(f"not a readable HDF5 file ({error})", path) from None
    for name, one in zip((accel, gyro), values, strict=True):
        if one.ndim != 2 or one.shape[1] != 3:
            raise InputError(f"{name} is of shape {one.shape}, expected n x 3", path)
    n = min(len(one) for one in values)
    if reading.rate_hz or (stamps is None and rate > 0):
        t = np.arange(n) / (reading.rate_hz or rate)
    elif stamps is not None and len(stamps) >= n:
        t = stamps[:n] * reading.sizes.get("t", 1e-6)
    else:
        raise InputError("no stamps and no rate (--rate)", path)
    samples = Samples(
        0,
        t,
        values[1][:n] * reading.sizes.get("gyro", 1.0),
        values[0][:n] * reading.sizes.get("accel", 1.0),
    )
    return Source(path, "apdm", n, iter([samples]))


def _upright(values: np.ndarray) -> np.ndarray:
    """A row a sample, as MATLAB's h5write does not have it."""
    return values.T if values.ndim == 2 and values.shape[0] == 3 != values.shape[1] else values


def _sensors(file: Any) -> dict[str, tuple[str, str, str, str | None]]:
    """Group -> label, accelerometer, gyro and stamps."""
    found = {}
    parents = [f"Sensors/{name}" for name in file["Sensors"]] if "Sensors" in file else list(file)
    for parent in parents:
        for accel, gyro in _NAMES:
            if f"{parent}/{accel}" in file and f"{parent}/{gyro}" in file:
                group = file[parent]
                told = group["Configuration"].attrs if "Configuration" in group else group.attrs
                label = next(
                    (told[key] for key in ("Label 0", "Label", "CaseIdLabel") if key in told), parent
                )
                label = label.decode() if isinstance(label, bytes) else str(label)
                time = f"{parent}/Time" if f"{parent}/Time" in file else None
                label = label.strip("\x00 ") or parent
                found[parent] = (label, f"{parent}/{accel}", f"{parent}/{gyro}", time)
    return found


def _chosen(path: Path, names: dict[str, str], sensor: str | None) -> str:
    if sensor is None and len(names) == 1:
        return next(iter(names.values()))
    if sensor in names:
        return names[sensor]
    listed = ", ".join(names)
    if sensor is None:
        raise InputError(f"holds {len(names)} sensors, choose one with --sensor: {listed}", path)
    raise InputError(f"holds no sensor {sensor!r}, but {listed}", path)
