"""What an IMU said: the only thing that navigation ever sees, simulated or real."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from footfall.columns import ACCEL, GYRO, POSITION, QUATERNION, RECORDING
from footfall.errors import InputError
from footfall.identity import content_digest
from footfall.shown import Shown, draw_triads
from footfall.tables import read_table, require_columns, write_table


@dataclass(frozen=True)
class Recording(Shown):
    """IMU samples in the body frame (x forward, y left, z up when level).

    Its arrays are read-only, because the next method gets them too. Change a copy (scipy's `Rotation.apply`
    needs one too).

    Attributes
    ----------
    t : (n,) s, from the first sample; each stamp ends its sampling interval
    gyro : (n, 3) rad/s
    accel : (n, 3) m/s2, specific force: +g upwards at rest
    temperature : (n,) degC, or None where the sensor reports none
    meta : provenance (scenario, seeds, versions)
    """

    t: np.ndarray
    gyro: np.ndarray
    accel: np.ndarray
    temperature: np.ndarray | None = None
    meta: Mapping[str, Any] = field(default_factory=dict)

    @cached_property
    def sha(self) -> str:
        """Hash of the content: the same for the same bits, wherever they come from."""
        return content_digest(self.t, self.gyro, self.accel, self.temperature)

    def __post_init__(self) -> None:
        n = len(self.t)
        if n < 2:
            raise InputError(f"{n} samples, expected at least 2", "recording")
        for name in ("gyro", "accel"):
            if getattr(self, name).shape != (n, 3):
                raise InputError(
                    f"{name} has shape {getattr(self, name).shape}, expected ({n}, 3)", "recording"
                )
        if self.temperature is not None and self.temperature.shape != (n,):
            raise InputError(f"temperature has shape {self.temperature.shape}, expected ({n},)", "recording")
        for name in ("t", "gyro", "accel", "temperature"):
            values = getattr(self, name)
            if values is not None and not np.isfinite(values).all():
                row = int(np.argwhere(~np.isfinite(values))[0][0])
                raise InputError(f"{name} is not finite at row {row}", "recording")
        step = np.diff(self.t)
        if (step <= 0).any():
            row = int(np.argmax(step <= 0)) + 1
            raise InputError(f"t does not increase at row {row} (t = {self.t[row]:.6g} s)", "recording")
        self._lock()

    def __setstate__(self, state: dict[str, Any]) -> None:
        # Pickled arrays come back writeable.
        self.__dict__.update(state)
        self._lock()

    def _lock(self) -> None:
        for name in ("t", "gyro", "accel", "temperature"):
            if (values := getattr(self, name)) is not None:
                view = values.view()
                view.flags.writeable = False
                object.__setattr__(self, name, view)

    @property
    def interval(self) -> float:
        """Median sampling interval (s)."""
        return float(np.median(np.diff(self.t)))

    def _columns(self) -> dict[str, np.ndarray]:
        columns = {"t": self.t}
        columns |= {name: self.gyro[:, i] for i, name in enumerate(GYRO)}
        columns |= {name: self.accel[:, i] for i, name in enumerate(ACCEL)}
        return columns if self.temperature is None else columns | {"temperature": self.temperature}

    def _units(self) -> Mapping[str, str]:
        return RECORDING

    def _draw(self) -> np.ndarray:
        return draw_triads(
            self.t, self.gyro, self.accel, f"{len(self.t):,} samples at {1 / self.interval:.0f} Hz"
        )


def write_recording(recording: Recording, path: str | os.PathLike[str]) -> None:
    """Write `recording` to Parquet: t, gyro_x..z, accel_x..z, and temperature where there is one."""
    write_table(path, recording._columns(), RECORDING, recording.meta)


def is_truth(names: Iterable[str]) -> bool:
    """Whether columns of these names hold the poses of a walk."""
    return set(names) >= {*POSITION, *QUATERNION}


def refuse_truth(path: str | os.PathLike[str], names: Iterable[str]) -> None:
    """Raise InputError where columns of these names are a walk's truth, which no IMU ever recorded."""
    if is_truth(names):
        raise InputError(
            "is the truth of a walk, expected what an IMU recorded of it: first "
            f"`footfall record {path} --imu perfect -o FILE` (or another IMU)",
            path,
        )


def read_recording(path: str | os.PathLike[str]) -> Recording:
    """Read a recording from Parquet or CSV.

    Raises
    ------
    InputError
        Missing columns, NaN, stamps that do not increase, or the truth of a walk.
    """
    columns, meta = read_table(path)
    refuse_truth(path, columns)
    require_columns(str(path), columns, ("t", *GYRO, *ACCEL))
    temperature = columns.get("temperature")
    try:
        return Recording(
            t=np.asarray(columns["t"], dtype=float),
            gyro=np.column_stack([columns[name] for name in GYRO]).astype(float),
            accel=np.column_stack([columns[name] for name in ACCEL]).astype(float),
            temperature=None if temperature is None else np.asarray(temperature, dtype=float),
            meta=meta,
        )
    except InputError as error:
        raise error.about(path, "recording") from None
