"""Pictures of the walker: a strip of moments (PNG) or a moving picture (WebP).

Needs a screen, or EGL or OSMesa: MuJoCo reads the environment variable MUJOCO_GL when it is first imported.
"""

from __future__ import annotations

from collections import deque
from pathlib import Path

import mujoco
import numpy as np

from footfall.errors import InputError
from footfall.models import body
from footfall.models.policy import stock_policy
from footfall.simulate.journey import Moment, Plan, stroll
from footfall.simulate.walkers import CONTROL_INTERVAL
from footfall.tables import replacing

FRAME_EVERY = 2  # control steps: 17 frames a second
STRIP_FRAMES, STRIP_EVERY = 7, 5
_WIDTH, _HEIGHT = 480, 400
_LOAD_N = 150.0  # a foot that carries this leaves a footprint
_PRINT_SPACING = 0.3  # m
_OVER_SOLE = 0.035  # m, height of the sensed point, the foot's centre of mass, in stance


def render(plan: Plan, output: Path, *, skip: float = 3.0, seconds: float = 4.0) -> int:
    """Draw the beginning of a walk into `output` (.webp: moving; .png: a strip).

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
    pictures = _pictures(
        plan, skip, seconds if moving else STRIP_FRAMES * STRIP_EVERY * CONTROL_INTERVAL, moving
    )
    if not pictures:
        raise InputError(
            f"{plan.name}: the walk ends before the first picture, {skip:g} s after its first step"
        )
    from PIL import Image

    frames = [Image.fromarray(picture) for picture in pictures]
    with replacing(output) as temporary:
        if moving:
            duration = round(1000 * FRAME_EVERY * CONTROL_INTERVAL)
            frames[0].save(
                temporary,
                "WEBP",
                save_all=True,
                append_images=frames[1:],
                duration=duration,
                loop=0,
                quality=80,
            )
        else:
            Image.fromarray(np.concatenate(pictures, axis=1)).save(temporary, "PNG")
    return len(frames)


def _pictures(plan: Plan, skip: float, seconds: float, moving: bool) -> list[np.ndarray]:
    every = FRAME_EVERY if moving else STRIP_EVERY
    width = _WIDTH if moving else _HEIGHT * 3 // 5
    pictures: list[np.ndarray] = []
    prints: deque[np.ndarray] = deque(maxlen=60)
    since_start, renderer = 0, None
    camera = mujoco.MjvCamera()
    for moment in stroll(plan, stock_policy()):
        walkers, model = moment.walkers, moment.walkers.models[0]
        since_start += bool(walkers.gate.value[0] > 0)
        _leave_prints(moment, prints)
        shown = since_start * CONTROL_INTERVAL - skip
        if shown < 0 or since_start % every:
            continue
        if shown > seconds:
            break
        if renderer is None:
            # Clipping and shadows to the walker's scale, not to that of a landscape of a kilometre.
            model.stat.extent, model.stat.center[:] = 2.0, 0.0
            try:
                renderer = mujoco.Renderer(model, _HEIGHT, width)
            except Exception as error:
                raise InputError(f"nothing to draw with: MuJoCo's renderer says {error!s:.200}") from None
            data = mujoco.MjData(model)
        data.qpos[:] = walkers.qpos[0]
        mujoco.mj_forward(model, data)
        x, y, z = data.qpos[:3]
        heading = np.degrees(walkers.heading[0])
        camera.lookat[:] = [x, y, z - 0.1]
        camera.distance, camera.azimuth, camera.elevation = (
            (4.2, heading + 125, -14) if moving else (3.0, heading + 100, -8)
        )
        renderer.update_scene(data, camera)
        _draw_path(renderer.scene, plan, float(x), float(y))
        _draw_prints(renderer.scene, prints)
        pictures.append(renderer.render().copy())
    if renderer is not None:
        renderer.close()
    return pictures


def _leave_prints(moment: Moment, prints: deque[np.ndarray]) -> None:
    """Remember where a loaded foot stands: x, y, z, heading, side."""
    sensor = moment.walkers.sensor[0]
    force = sensor[body.SENSOR_TOUCH].reshape(2, 3)
    feet = sensor[body.SENSOR_FOOT_POSITION].reshape(2, 3)
    for side in (0, 1):
        if force[side, 1] < _LOAD_N:  # the ball carries
            continue
        place = np.array([*feet[side], moment.walkers.yaw[0], side])
        if all(
            np.linalg.norm(place[:2] - other[:2]) > _PRINT_SPACING for other in prints if other[4] == side
        ):
            prints.append(place)


def _add(
    scene: object, kind: int, size: list[float], place: np.ndarray, heading: float, rgba: list[float]
) -> None:
    if scene.ngeom >= scene.maxgeom:  # type: ignore[attr-defined]
        return
    c, s = np.cos(heading), np.sin(heading)
    matrix = np.array([c, -s, 0, s, c, 0, 0, 0, 1.0])
    geom = scene.geoms[scene.ngeom]  # type: ignore[attr-defined]
    mujoco.mjv_initGeom(geom, kind, np.array(size), place, matrix, np.array(rgba, dtype=np.float32))
    scene.ngeom += 1  # type: ignore[attr-defined]


def _draw_path(scene: object, plan: Plan, x: float, y: float) -> None:
    """The line to follow, near the walker."""
    route, scale = plan.route, plan.subject.scale
    near = np.flatnonzero(np.hypot(route.x / scale - x, route.y / scale - y) < 6.0)
    for i in near[::3]:
        place = np.array([route.x[i], route.y[i], route.z[i]]) / scale + [0, 0, 0.002]
        _add(
            scene,
            mujoco.mjtGeom.mjGEOM_BOX,
            [0.09, 0.02, 0.001],
            place,
            route.heading[i],
            [0.2, 0.45, 0.75, 1],
        )


def _draw_prints(scene: object, prints: deque[np.ndarray]) -> None:
    for place in prints:
        ground = place[:3] - [0, 0, _OVER_SOLE - 0.003]
        _add(scene, mujoco.mjtGeom.mjGEOM_BOX, [0.12, 0.042, 0.001], ground, place[3], [0.42, 0.4, 0.38, 1])
