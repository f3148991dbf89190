"""How still does a real foot lie when a person sets out and after the last step? Beside `starts`.

No real recording tells the force on the foot, so the spans are found by the foot's motion: from the rest
before the walk until the heel's rise begins, and from the moment at which the foot of the last step is first
within 3 deg of its pose at rest until the end. Angles are the gyro's, less its mean at the first rest.

python -m benchmarks.validation.real_starts
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from rich.table import Table

from benchmarks._common import options, out, write_json
from benchmarks.validation._real import BESIDE
from benchmarks.validation.gait_realism import read_real
from footfall.errors import InputError
from footfall.pdr.gait.strides import BANDWIDTH_HZ, RATE_HZ
from footfall.simulate.learn.still_feet import LEVEL_DEG

_WALKS = np.radians(60.0)  # a foot that turns faster takes a step
_BEFORE_S, _AFTER_S, _MARGIN_S = 1.5, 2.0, 0.5  # of rest that is looked at, and that is not counted as rest
_SWUNG_DEG = 10.0  # a foot that swings or lands is tipped further than that


@dataclass(frozen=True)
class Turned:
    """How far a foot turned and tipped (deg), the largest over a span."""

    twist: float
    up: float
    down: float


def _largest(yaw: np.ndarray, pitch: np.ndarray, count: int | None = None) -> Turned:
    """The largest angles; toes-down among the first `count` samples only."""
    return Turned(
        float(np.abs(yaw).max()), max(0.0, float(pitch.max())), max(0.0, -float(pitch[:count].min()))
    )


def angles(rate: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Yaw and elevation (n,) deg from rates (n, 3) rad/s in the foot's level axes, from 0 on."""
    turned = np.degrees(np.cumsum(rate, axis=0)) / RATE_HZ
    return turned[:, 2], -turned[:, 1]


def setting_out(gyro: np.ndarray) -> Turned:
    """From the rest before the walk until the heel's rise; `gyro` (n, 3) rad/s, forward, left and up."""
    steps = int(np.flatnonzero(np.linalg.norm(gyro, axis=1) > _WALKS)[0])
    begin = max(steps - round(_BEFORE_S * RATE_HZ), 0)
    yaw, pitch = angles(gyro[begin:steps] - gyro[: max(begin, 1)].mean(axis=0))
    rise = len(pitch) - 1
    while rise > 0 and pitch[rise - 1] > pitch[rise]:
        rise -= 1
    return _largest(yaw, pitch, rise + 1)


def last_stance(gyro: np.ndarray) -> Turned:
    """After the last step, relative to the pose at the end; `gyro` as in `setting_out`."""
    moving = np.flatnonzero(np.linalg.norm(gyro, axis=1) > _WALKS)
    span = slice(max(moving[-1] - round(_AFTER_S * RATE_HZ), 0), moving[-1] + round(_AFTER_S * RATE_HZ))
    yaw, pitch = angles(gyro[span] - gyro[: max(moving[0] - round(_MARGIN_S * RATE_HZ), 1)].mean(axis=0))
    yaw, pitch = yaw - yaw[-1], pitch - pitch[-1]
    swung = np.flatnonzero(np.abs(pitch) > _SWUNG_DEG)
    landed = int(swung[-1]) + 1 if len(swung) else 0
    flat = landed + int(np.flatnonzero(np.abs(pitch[landed:]) < LEVEL_DEG)[0])
    return _largest(yaw[flat:], pitch[flat:])


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table."""
    parser = options(__doc__, processes=False)
    parser.add_argument("--data", type=Path, default=BESIDE, metavar="FOLDER", help="real recordings")
    chosen = parser.parse_args(arguments)
    try:
        feet = read_real(chosen.data, BANDWIDTH_HZ)
    except InputError as error:
        sys.exit(str(error))
    found = {
        name: (setting_out(foot.signals.gyro), last_stance(foot.signals.gyro)) for name, foot in feet.items()
    }
    table = Table(title="Real feet: deg, twist / toes up / toes down", title_justify="left")
    for heading in ("", "setting out", "after the last step"):
        table.add_column(heading, justify="right" if heading else "left")
    for name, both in found.items():
        table.add_row(name, *(f"{one.twist:.1f} / {one.up:.1f} / {one.down:.1f}" for one in both))
    tenths = [
        np.percentile([list(asdict(both[k]).values()) for both in found.values()], 90, axis=0) for k in (0, 1)
    ]
    table.add_row("90 %", *("{:.1f} / {:.1f} / {:.1f}".format(*values) for values in tenths))
    out.print(table)
    write_json(chosen.json, {name: [asdict(one) for one in both] for name, both in found.items()})


if __name__ == "__main__":
    main()
