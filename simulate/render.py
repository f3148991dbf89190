"""The walker of a scenario: a strip of moments (PNG), a moving picture (WebP), or MuJoCo's viewer."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from footfall.errors import InputError
from footfall.models.policy import stock_policy
from footfall.simulate.draw import QUARTER_VIEW, SIDE_VIEW, Painter, Stage, Window
from footfall.simulate.episode import stroll
from footfall.simulate.plan import Plan
from footfall.simulate.walker.walkers import CONTROL_INTERVAL
from footfall.tables import replacing

STRIP_FRAMES, STRIP_EVERY = 7, 5  # control steps
_WIDTH, _HEIGHT = 560, 420
_STRIP_WIDTH = 240
_STAND_S = 1.0  # before the first step; a record wants more


def render(plan: Plan, output: Path, *, skip: float = 4.0, seconds: float = 4.0) -> int:
    """Draw the beginning of a walk into `output` (.webp: moving, 33 pictures a second; .png: a strip).

    Parameters
    ----------
    skip : s after the first step at which the pictures begin
    seconds : s shown (of a strip: 7 pictures 0.15 s apart)

    Returns
    -------
    Number of pictures.

    Raises
    ------
    InputError
        Nothing to draw with, or a walk that ends before the first picture.
    """
    moving = output.suffix.lower() == ".webp"
    every = 1 if moving else STRIP_EVERY
    count = round(seconds / CONTROL_INTERVAL) if moving else STRIP_FRAMES
    size = (_WIDTH if moving else _STRIP_WIDTH, _HEIGHT)
    pictures: list[np.ndarray] = []
    painter: Painter | None = None
    try:
        for stage, strode in _scenes(plan):
            if strode < skip or round((strode - skip) / CONTROL_INTERVAL) % every:
                continue
            painter = painter or Painter(stage, *size)
            pictures.append(painter.paint(QUARTER_VIEW if moving else SIDE_VIEW))
            if len(pictures) == count:
                break
    finally:
        if painter is not None:
            painter.close()
    if not pictures:
        raise InputError(
            f"{plan.name}: the walk ends before the first picture, {skip:g} s after its first step"
        )
    _write(pictures, output, moving)
    return len(pictures)


def _write(pictures: list[np.ndarray], output: Path, moving: bool) -> None:
    from PIL import Image

    with replacing(output) as temporary:
        if not moving:
            Image.fromarray(np.concatenate(pictures, axis=1)).save(temporary, "PNG")
            return
        first, *others = [Image.fromarray(picture) for picture in pictures]
        first.save(
            temporary,
            "WEBP",
            save_all=True,
            append_images=others,
            duration=round(1000 * CONTROL_INTERVAL),
            loop=0,
            quality=80,
        )


def view(plan: Plan) -> None:
    """Show a walk in MuJoCo's viewer as it is walked, until it ends or the window is closed.

    Raises
    ------
    InputError
        There is no screen; or the walker did not reach the end.
    """
    window: Window | None = None
    try:
        for stage, _ in _scenes(plan):
            window = window or Window(stage)
            if not window.show():
                return
    finally:
        if window is not None:
            window.close()


def _scenes(plan: Plan) -> Iterator[tuple[Stage, float]]:
    """The walk as it is drawn, step by step, and s since the first step (0 while it stands)."""
    stage, strode = None, 0.0
    for moment in stroll(plan, stock_policy(), stand=_STAND_S):
        stage = stage or Stage(moment.walkers, moment.episode.plan.subject.build, moment.episode)
        stage.update()
        strode += CONTROL_INTERVAL * bool(moment.walkers.gate.value[0] > 0)
        yield stage, strode
