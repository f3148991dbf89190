"""The walker of a scenario: a strip of moments (PNG), a moving picture (WebP), or MuJoCo's viewer."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from footfall.errors import InputError
from footfall.models import body
from footfall.models.policy import stock_policy
from footfall.simulate.draw import QUARTER_VIEW, SIDE_VIEW, Painter, Stage, Window
from footfall.simulate.episode import stroll
from footfall.simulate.plan import Plan
from footfall.simulate.signals import signal_panels
from footfall.simulate.walker.walkers import CONTROL_INTERVAL
from footfall.tables import replacing

STRIP_FRAMES, STRIP_EVERY = 7, 5  # control steps
_WIDTH, _HEIGHT = 560, 420
_STRIP_WIDTH = 240
_STAND_S = 1.0  # before the first step; a record wants more


def render(
    plan: Plan, output: Path, *, skip: float = 4.0, seconds: float = 4.0, signals: bool = False
) -> int:
    """Draw the beginning of a walk into `output` (.webp: moving, 33 pictures a second; .png: a strip).

    Parameters
    ----------
    skip : s after the first step at which the pictures begin
    seconds : s shown (of a strip: 7 pictures 0.15 s apart)
    signals : whether a moving picture shows the IMU's signals beside the walker

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
    size = ((_HEIGHT if signals else _WIDTH) if moving else _STRIP_WIDTH, _HEIGHT)
    pictures: list[np.ndarray] = []
    poses: list[np.ndarray] = []
    painter: Painter | None = None
    try:
        for stage, strode, pose in _scenes(plan):
            poses.append(pose)
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
    if signals and moving:
        panels = signal_panels(poses, len(pictures), _WIDTH, _HEIGHT)
        pictures = [np.hstack(pair) for pair in zip(pictures, panels, strict=True)]
    _write(pictures, output, moving)
    return len(pictures)


def _write(pictures: list[np.ndarray], output: Path, moving: bool) -> None:
    from PIL import Image

    with replacing(output) as temporary:
        if not moving:
            _timed(Image.fromarray(np.concatenate(pictures, axis=1)), len(pictures)).save(temporary, "PNG")
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


def _timed(strip: Any, count: int) -> Any:
    """A strip of `count` pictures with the time of each, from the first one, at its head."""
    from PIL import ImageDraw, ImageFont

    pen, font = ImageDraw.Draw(strip), ImageFont.load_default(18)
    for number in range(count):
        told = f"{number * STRIP_EVERY * CONTROL_INTERVAL:.2f} s"
        pen.text((_STRIP_WIDTH * (number + 0.5), 22), told, fill="#222222", font=font, anchor="mm")
    return strip


def view(plan: Plan) -> None:
    """Show a walk in MuJoCo's viewer as it is walked, until it ends or the window is closed.

    Raises
    ------
    InputError
        There is no screen; or the walker did not reach the end.
    """
    window: Window | None = None
    try:
        for stage, *_ in _scenes(plan):
            window = window or Window(stage)
            if not window.show():
                return
    finally:
        if window is not None:
            window.close()


def _scenes(plan: Plan) -> Iterator[tuple[Stage, float, np.ndarray]]:
    """The walk as it is drawn, step by step.

    Yields
    ------
    The stage; s since the first step (0 while it stands); the IMU's pose (k, 7) at each physics step, m.
    """
    stage, strode = None, 0.0
    for moment in stroll(plan, stock_policy(), stand=_STAND_S):
        stage = stage or Stage(moment.walkers, moment.episode.plan.subject.build, moment.episode)
        stage.update()
        strode += CONTROL_INTERVAL * bool(moment.walkers.gate.value[0] > 0)
        pose = moment.trace.sensor[0, :, body.sensor_imu(0)].copy()
        pose[:, :3] *= plan.subject.scale
        yield stage, strode, pose
