"""How far loaded feet turn and tip while they should lie still: setting out, and the last step before a stop.

Twist and pitch of a foot are its body's yaw and elevation relative to its pose at rest, the largest over all
samples in which it carries at least 0.2 body weights:

- setting out: from the wish to walk until the foot leaves the ground for its first swing (less than 0.2 body
  weights for 0.1 s), and for the foot that stands first until the other one has landed. Heels rise in
  push-off: toes-down counts until the last rise of the heel begins (the last run of samples in which the toes
  only sink), toes-up and twist to the end;
- last step: from the moment at which the foot, after its last landing (0.05 body weights), first lies within
  3 deg of its pose at rest until the end of the stand.
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

LOADED, TOUCHING, SWING_S, LEVEL_DEG = 0.2, 0.05, 0.1, 3.0


@dataclass(frozen=True)
class Moved:
    """A foot's largest twist, toes-up and toes-down (deg); `first`: it swung first, or landed last."""

    kind: str
    side: str
    first: bool
    twist: float
    up: float
    down: float


def feet(model: mujoco.MjModel, qpos: np.ndarray) -> np.ndarray:
    """(2, 2, n) deg: yaw and elevation of the right and the left foot in poses (n, 26)."""
    data, found = mujoco.MjData(model), np.empty((2, 2, len(qpos)))
    for i, pose in enumerate(qpos):
        data.qpos[:] = pose
        mujoco.mj_kinematics(model, data)
        for foot, side in enumerate("rl"):
            x, y, z = data.body(f"foot_{side}").xmat.reshape(3, 3)[:, 0]
            found[foot, :, i] = np.degrees([np.arctan2(y, x), np.arctan2(z, np.hypot(x, y))])
    return found


def first_swing(load: np.ndarray, step: float) -> int:
    """The sample at which a foot leaves the ground; `load` (n,) in body weights, `step` s between samples."""
    count = round(SWING_S / step)
    low = np.concatenate([[0], np.cumsum(load < LOADED)])
    whole = np.flatnonzero(low[count:] - low[:-count] == count)
    return int(whole[0]) if len(whole) else len(load)


def largest(yaw: np.ndarray, pitch: np.ndarray, load: np.ndarray, heel_rises: bool) -> tuple[float, ...]:
    """Twist, toes-up and toes-down (deg) while loaded; all (n,), relative to rest."""
    rise = len(pitch) - 1
    while heel_rises and rise > 0 and pitch[rise - 1] >= pitch[rise] - 1e-3:
        rise -= 1
    loaded = load >= LOADED
    flat = loaded & (np.arange(len(pitch)) <= rise)
    if not loaded.any():
        return 0.0, 0.0, 0.0
    down = -float(pitch[flat].min()) if flat.any() else 0.0
    return float(np.abs(yaw[loaded]).max()), max(0.0, float(pitch[loaded].max())), max(0.0, down)


def set_out(kind: str, yaw: np.ndarray, pitch: np.ndarray, load: np.ndarray, step: float) -> list[Moved]:
    """Both feet (2, n) from the wish to walk on; `step` s between samples."""
    leave = [first_swing(one, step) for one in load]
    first = int(leave[1] < leave[0])
    swing = leave[first] + round(0.15 / step)
    landed = np.flatnonzero(load[first, swing:] > LOADED)
    ends = {
        first: leave[first],
        1 - first: min(leave[1 - first], swing + int(landed[0]) if len(landed) else 10**9),
    }
    return [
        Moved(kind, "rl"[f], f == first, *largest(yaw[f, :end], pitch[f, :end], load[f, :end], True))
        for f, end in ends.items()
    ]


def last_step(yaw: np.ndarray, pitch: np.ndarray, load: np.ndarray) -> list[Moved]:
    """Both feet (2, n) until they are at rest, relative to their pose then."""
    landed = [int(np.flatnonzero(one < TOUCHING)[-1]) + 1 if (one < TOUCHING).any() else 0 for one in load]
    moved = []
    for f, land in enumerate(landed):
        level = np.flatnonzero(np.abs(pitch[f, land:]) < LEVEL_DEG)
        if not len(level):  # it hangs in the air
            continue
        flat = land + int(level[0])
        found = largest(yaw[f, flat:], pitch[f, flat:], load[f, flat:], False)
        moved.append(Moved("stop", "rl"[f], land == max(landed), *found))
    return moved
