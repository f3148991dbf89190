"""What a person may say of a file that does not say it itself."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Reading:
    """How to read a file.

    Attributes
    ----------
    sizes : quantity -> size of its unit in SI; wins over what the file says
    rate_hz : samples per second, in place of stamps
    columns : names of the columns in order, in place of the file's own; "-" for one that is none
    sensor : which of several
    gap_s : s, longest hole between samples in a swing that is bridged
    """

    sizes: Mapping[str, float] = field(default_factory=dict)
    rate_hz: float | None = None
    columns: tuple[str, ...] = ()
    sensor: str | None = None
    gap_s: float = 0.25
