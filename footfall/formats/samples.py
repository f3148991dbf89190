"""Samples as a file has them: in SI, but with whatever its stamps and values suffer from."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from footfall.errors import InputError

MIRRORED = "an iPhone's accelerometers, which say -f: turned"
TORN = "the last row is cut short and was left out"


@dataclass(frozen=True)
class Samples:
    """A block of rows.

    Attributes
    ----------
    row : number of the first, counted from 0 over the file
    t : (n,) s
    gyro : (n, 3) rad/s
    accel : (n, 3) m/s2
    temperature : (n,) degC or None
    """

    row: int
    t: np.ndarray
    gyro: np.ndarray
    accel: np.ndarray
    temperature: np.ndarray | None = None

    def __len__(self) -> int:
        return len(self.t)

    def take(self, rows: np.ndarray | slice) -> Samples:
        """These rows; the number of the first stays."""
        temperature = None if self.temperature is None else self.temperature[rows]
        return Samples(self.row, self.t[rows], self.gyro[rows], self.accel[rows], temperature)


@dataclass(frozen=True)
class Source:
    """An opened file.

    Attributes
    ----------
    path : for messages
    format : its name
    rows : how many it has, about
    blocks : its samples, in order; may be run through once
    meta : what the file says of its origin
    notes : filled while the blocks are run through: what was wrong with the file itself
    unstated : quantities whose unit nothing says, "gyro" or "accel": physics may tell
    """

    path: Path
    format: str
    rows: int
    blocks: Iterator[Samples]
    meta: Mapping[str, Any] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    unstated: frozenset[str] = frozenset()


def joined(blocks: Iterator[Samples]) -> Samples:
    """All blocks in one.

    Raises
    ------
    InputError
        There are no rows.
    """
    parts = [block for block in blocks if len(block)]
    if not parts:
        raise InputError("no rows of samples", "recording")
    if len(parts) == 1:
        return parts[0]
    warm = [part.temperature for part in parts if part.temperature is not None]
    return Samples(
        row=parts[0].row,
        t=np.concatenate([part.t for part in parts]),
        gyro=np.concatenate([part.gyro for part in parts]),
        accel=np.concatenate([part.accel for part in parts]),
        temperature=np.concatenate(warm) if len(warm) == len(parts) else None,
    )
