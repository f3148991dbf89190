"""What a track must be, whatever it says: shapes, time, finite numbers, a heading without jumps."""

from __future__ import annotations

from typing import Any

import numpy as np

from footfall.errors import InputError
from footfall.pdr.track import Track


def require_sound(track: Any, t: np.ndarray, culprit: str) -> None:
    """Refuse what is no track of a recording with these stamps (n,) s.

    Raises
    ------
    InputError
        Not a `Track`; arrays of other shapes; not finite; stamps that do not increase or lie outside; a
        heading that jumps, as one does that is not unwrapped.
    """
    fault = shape_fault(track) or finite_fault(track) or time_fault(track, t) or heading_fault(track)
    if fault:
        raise InputError(f"returned {fault}", culprit)


def shape_fault(track: Any) -> str:
    """What is wrong with its type and shapes; "" where nothing is."""
    if not isinstance(track, Track):
        kind = type(track).__name__
        return "None, expected a Track" if track is None else f"{article(kind)}, expected a Track"
    n = np.size(track.t)
    shapes = {"t": (n,), "position": (n, 3), "heading": (n,)} | dict.fromkeys(track.evidence, (n,))
    values = {"t": track.t, "position": track.position, "heading": track.heading, **track.evidence}
    for name, shape in shapes.items():
        array = np.asarray(values[name])
        if array.shape != shape or array.dtype.kind not in "fiub":
            return f"a track whose {name} is {array.dtype} of shape {array.shape}, expected numbers {shape}"
    return "" if n >= 2 else f"a track of {n} rows, expected at least 2"


def finite_fault(track: Track) -> str:
    """The first number that is not finite."""
    for name in ("t", "position", "heading"):
        bad = np.argwhere(~np.isfinite(getattr(track, name)))
        if len(bad):
            return f"a track whose {name} is not finite at row {bad[0][0]}"
    return ""


def time_fault(track: Track, t: np.ndarray) -> str:
    """Stamps that do not increase, or lie outside of those of the recording, (n,) s."""
    backwards = np.flatnonzero(~(np.diff(track.t) > 0))
    if len(backwards):
        row = backwards[0] + 1
        return f"a track whose t does not increase at row {row} (t = {track.t[row]:.6g} s)"
    slack = float(t[-1] - t[0]) / (len(t) - 1)  # a sample
    if track.t[0] < t[0] - slack or track.t[-1] > t[-1] + slack:
        return (
            f"a track from t = {track.t[0]:.6g} to {track.t[-1]:.6g} s of a recording from {t[0]:.6g} "
            f"to {t[-1]:.6g} s"
        )
    return ""


def heading_fault(track: Track) -> str:
    """A jump of more than 270 deg from row to row; less is a turn on the spot."""
    jump = np.abs(np.diff(track.heading))
    if not (jump > 1.5 * np.pi).any():
        return ""
    row = int(np.argmax(jump))
    return f"a heading that jumps by {np.degrees(jump[row]):.0f} deg at row {row + 1}: unwrap it"


def article(kind: str) -> str:
    """A word with "a" or "an" before it."""
    return f"{'an' if kind[0] in 'aeiou' else 'a'} {kind}"
